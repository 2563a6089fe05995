//! Pictures of where two pictures differ.
//!
//! A PNG shows FLIP from 0 to 1 in the colours of magma, whose lightness rises evenly: black where nobody sees a
//! difference. An EXR has the numbers: `R G B` are those of A less those of B, `relative` is their signed relative
//! difference, (6) of [`metrics`](crate::study::metrics), and `flip`.

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Image, WritableImage};
use glam::Vec3;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

use super::measure::Comparison;
use crate::film::FilmError;
use crate::film::exr_layers::StoredPicture;
use crate::study::metrics::relative_differences;

/// The bytes of the FLIP map as a PNG; `path` is only for messages.
///
/// # Errors
/// [`FilmError::CannotEncode`] for a picture that the format cannot hold.
pub fn png(found: &Comparison, path: &Path) -> Result<Vec<u8>, FilmError> {
    let colour = |e: &f32| colorous::MAGMA.eval_continuous(f64::from(*e).clamp(0.0, 1.0)).as_array();
    let levels: Vec<u8> = found.flip_map.iter().flat_map(colour).collect();
    let [width, height] = found.size.map(|n| n as u32);
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes)
        .write_image(&levels, width, height, ExtendedColorType::Rgb8)
        .map_err(|error| cannot_encode(found, path, error.to_string()))?;
    Ok(bytes)
}

/// The bytes of the differences as an EXR; `path` is only for messages.
///
/// # Errors
/// [`FilmError::CannotEncode`] for a picture that the format cannot hold.
pub fn exr(
    a: &StoredPicture,
    b: &StoredPicture,
    found: &Comparison,
    path: &Path,
) -> Result<Vec<u8>, FilmError> {
    let of = |value: fn(Vec3) -> f32| a.colours.iter().zip(&b.colours).map(|(a, b)| value(*a - *b)).collect();
    let relative = relative_differences(&a.colours, &b.colours).into_iter().map(|d| d as f32).collect();
    let channels: [(&str, Vec<f32>); 5] = [
        ("R", of(|d| d.x)),
        ("G", of(|d| d.y)),
        ("B", of(|d| d.z)),
        ("relative", relative),
        ("flip", found.flip_map.clone()),
    ];
    let channels = channels.map(|(name, values)| AnyChannel::new(name, FlatSamples::F32(values)));
    let channels = AnyChannels::sort(channels.into_iter().collect());
    let mut bytes = Cursor::new(Vec::new());
    Image::from_channels((found.size[0], found.size[1]), channels)
        .write()
        .non_parallel()
        .to_buffered(&mut bytes)
        .map_err(|error| cannot_encode(found, path, error.to_string()))?;
    Ok(bytes.into_inner())
}

fn cannot_encode(found: &Comparison, path: &Path, reason: String) -> FilmError {
    let [width, height] = found.size.map(|n| n as u32);
    FilmError::CannotEncode { path: path.into(), width, height, reason }
}
