//! What a comparison needs of a picture: the colours of any OpenEXR file, and what floe writes beside them.
//!
//! Channels are known by name: `R`, `G`, `B`, and where they are there `A`, `variance.R/G/B` (of the pixel's mean) and
//! `samples`. Numbers may be half, single or whole. A file that carries floe's checksum has to be whole.

use std::io::Cursor;

use exr::prelude::{AnyChannels, FlatSamples, ReadChannels, ReadLayers};
use glam::Vec3;

use super::exr_seal::{CHECKSUM, check_seal, text_attribute};

/// A picture that was read.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredPicture {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Linear RGB, row after row from the top.
    pub colours: Vec<Vec3>,
    /// Coverage.
    pub alpha: Option<Vec<f32>>,
    /// Variance of the mean of each channel.
    pub variances: Option<Vec<Vec3>>,
    /// Samples of each pixel, of a file that says so.
    pub samples: Option<Vec<f32>>,
    /// How far the file's numbers may be rounded, as a part of each.
    pub rounding: f64,
    /// Whether the errors of different pixels have to do with each other, as those of photons have.
    pub shares_noise: bool,
}

/// Roundings of half and of single precision: half a unit in the last place of the former; light transport in single
/// precision rounds more than once, and is given two units.
const ROUNDING: [f64; 2] = [1.0 / 2048.0, 1.0 / 4_194_304.0];

/// Reads a picture.
///
/// # Errors
/// What is wrong with the bytes, or which channel is missing, in words.
pub fn read_layers(bytes: &[u8]) -> Result<StoredPicture, String> {
    if text_attribute(bytes, CHECKSUM).is_some() {
        check_seal(bytes)?;
    }
    let layer = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|error| error.to_string())?
        .layer_data;
    let pixels = layer.size.area();
    let channels = &layer.channel_data;
    let [r, g, b] = ["R", "G", "B"].map(|name| {
        let numbers = numbers(channels, name, pixels);
        numbers.ok_or_else(|| format!("it has no channel {name} for each pixel, but {}", names(channels)))
    });
    let variances = ["variance.R", "variance.G", "variance.B"].map(|name| numbers(channels, name, pixels));
    Ok(StoredPicture {
        width: layer.size.width(),
        height: layer.size.height(),
        colours: joined([r?, g?, b?]),
        alpha: numbers(channels, "A", pixels),
        variances: match variances {
            [Some(r), Some(g), Some(b)] => Some(joined([r, g, b])),
            _ => None,
        },
        samples: numbers(channels, "samples", pixels),
        rounding: if is_half(channels) { ROUNDING[0] } else { ROUNDING[1] },
        shares_noise: text_attribute(bytes, "floe:integrator") == Some("photon"),
    })
}

/// The numbers of a channel; `None` if there is none, or it is coarser than the pixels.
fn numbers(channels: &AnyChannels<FlatSamples>, name: &str, pixels: usize) -> Option<Vec<f32>> {
    let channel = channels.list.iter().find(|channel| channel.name.to_string() == name)?;
    let numbers: Vec<f32> = channel.sample_data.values_as_f32().collect();
    (numbers.len() == pixels).then_some(numbers)
}

fn joined([r, g, b]: [Vec<f32>; 3]) -> Vec<Vec3> {
    r.into_iter().zip(g).zip(b).map(|((r, g), b)| Vec3::new(r, g, b)).collect()
}

fn is_half(channels: &AnyChannels<FlatSamples>) -> bool {
    let colours = channels.list.iter().filter(|c| ["R", "G", "B"].contains(&c.name.to_string().as_str()));
    colours.into_iter().any(|channel| matches!(channel.sample_data, FlatSamples::F16(_)))
}

fn names(channels: &AnyChannels<FlatSamples>) -> String {
    channels.list.iter().map(|channel| channel.name.to_string()).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use exr::prelude::{AnyChannel, Image, WritableImage, f16};

    use super::*;

    fn file(channels: &[(&str, FlatSamples)]) -> Vec<u8> {
        let channels =
            channels.iter().map(|(name, samples)| AnyChannel::new(*name, samples.clone())).collect();
        let mut bytes = Cursor::new(Vec::new());
        Image::from_channels((2, 1), AnyChannels::sort(channels)).write().to_buffered(&mut bytes).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn files_of_other_programs_are_read() {
        let half = FlatSamples::F16(vec![f16::from_f32(0.5), f16::from_f32(2.0)]);
        let bytes = file(&[
            ("G", half),
            ("R", FlatSamples::F32(vec![1.0, 0.25])),
            ("B", FlatSamples::U32(vec![0, 7])),
        ]);
        let read = read_layers(&bytes).unwrap();
        assert_eq!((read.width, read.height), (2, 1));
        assert_eq!(read.colours, [Vec3::new(1.0, 0.5, 0.0), Vec3::new(0.25, 2.0, 7.0)]);
        assert_eq!((read.alpha, read.variances, read.samples), (None, None, None));
        assert_eq!((read.rounding, read.shares_noise), (ROUNDING[0], false));
    }

    #[test]
    fn what_is_no_picture_says_why() {
        let grey = read_layers(&file(&[("Y", FlatSamples::F32(vec![1.0, 2.0]))])).unwrap_err();
        assert_eq!(grey, "it has no channel R for each pixel, but Y");
        assert!(read_layers(b"\x76\x2f\x31\x01no picture").is_err() && read_layers(b"").is_err());
    }
}
