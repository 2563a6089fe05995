//! The header of a frame's OpenEXR file: channels and attributes, in an order that is always the same.
//!
//! Matrices: OpenEXR multiplies row vectors from the left, p' = p M, and stores M row by row. That is the transpose of
//! the matrix for column vectors, stored column by column: the same 16 numbers in the same order.
//!
//! The encoder keeps attributes without a field of their own in a hash map and writes them in its order, which differs
//! from run to run. [`sort_attributes`] puts the attributes of a finished file into alphabetical order, as the reference
//! implementation writes them `[OPENEXR]`. Their total length stays, so the offsets behind them hold.

use std::ops::Range;

use exr::meta::BlockDescription;
use exr::meta::header::Header;
use exr::prelude::{
    AttributeValue, ChannelDescription, Compression, LayerAttributes, LineOrder, SampleType, Text, Vec2,
    attribute,
};

use super::error::FilmError;
use super::exr_channels::Channel;
use super::exr_seal::{CHECKSUM, UNKNOWN};
use super::metadata::{ImageMetadata, frame_rate, time_code};

/// Bytes before the attributes: the magic number and the version.
pub(super) const PREAMBLE: usize = 8;

/// The header of a frame, in scan lines, ZIP in blocks of 16 rows, from top to bottom.
///
/// # Errors
/// [`FilmError::Attribute`] for an attribute that has no valid name.
pub fn header(
    width: u32,
    height: u32,
    channels: &[Channel],
    metadata: &ImageMetadata,
) -> Result<Header, FilmError> {
    let descriptions = channels
        .iter()
        .map(|channel| ChannelDescription {
            name: Text::from(channel.name),
            sample_type: SampleType::F32,
            quantize_linearly: false,
            sampling: Vec2(1, 1),
        })
        .collect();
    let size = Vec2(width as usize, height as usize);
    let mut header = Header::new(Text::default(), size, descriptions)
        .with_encoding(Compression::ZIP16, BlockDescription::ScanLines, LineOrder::Increasing)
        .with_attributes(own_attributes(metadata)?);
    header.shared_attributes.chromaticities = Some(REC709_CHROMATICITIES);
    header.shared_attributes.time_code =
        time_code(metadata.frame_number, metadata.fps).map(|[hours, minutes, seconds, frame]| {
            attribute::TimeCode { hours, minutes, seconds, frame, ..Default::default() }
        });
    Ok(header)
}

/// Rec. 709 primaries and D65 `[BT709]`.
const REC709_CHROMATICITIES: attribute::Chromaticities = attribute::Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

fn own_attributes(metadata: &ImageMetadata) -> Result<LayerAttributes, FilmError> {
    let mut own = LayerAttributes {
        software_name: Some(Text::from(concat!("floe ", env!("CARGO_PKG_VERSION")))),
        frames_per_second: frame_rate(metadata.fps),
        world_to_camera: Some(metadata.world_to_camera.to_cols_array()),
        world_to_normalized_device: Some(metadata.world_to_ndc.to_cols_array()),
        ..LayerAttributes::default()
    };
    own.other.insert(Text::from("imageCounter"), AttributeValue::I32(metadata.frame_number));
    own.other.insert(Text::from(CHECKSUM), AttributeValue::Text(Text::from(UNKNOWN)));
    for (name, value) in metadata.prefixed_attributes()? {
        // Names are ASCII by now; values are UTF-8, which readers expect.
        let value = AttributeValue::Text(Text::from_slice_unchecked(value.as_bytes()));
        own.other.insert(Text::from(name.as_str()), value);
    }
    Ok(own)
}

/// Sorts the attributes of a single-part file by name, in place; `None` if the bytes do not begin with a header.
pub fn sort_attributes(file: &mut [u8]) -> Option<()> {
    let mut attributes: Vec<Range<usize>> = Vec::new();
    let mut at = PREAMBLE;
    while *file.get(at)? != 0 {
        let end = attribute_end(file, at)?;
        attributes.push(at..end);
        at = end;
    }
    // A name ends in 0, so comparing whole attributes compares names first, and no two names are the same.
    attributes.sort_by_key(|range| &file[range.clone()]);
    let sorted: Vec<u8> = attributes.into_iter().flat_map(|range| file[range].iter().copied()).collect();
    file[PREAMBLE..at].copy_from_slice(&sorted);
    Some(())
}

/// Where the attribute that begins at `start` ends: name, 0, type, 0, size in 4 bytes, value.
pub(super) fn attribute_end(file: &[u8], start: usize) -> Option<usize> {
    let after_text = |from: usize| Some(from + file.get(from..)?.iter().position(|&b| b == 0)? + 1);
    let size_at = after_text(after_text(start)?)?;
    let size = file.get(size_at..size_at + 4)?;
    let size = u32::from_le_bytes(size.try_into().ok()?) as usize;
    let end = (size_at + 4).checked_add(size)?;
    (end <= file.len()).then_some(end)
}

#[cfg(test)]
mod tests {
    use glam::{Mat4, Vec3};

    use super::*;

    fn raw_attribute(name: &str, value: &[u8]) -> Vec<u8> {
        let mut bytes = format!("{name}\0string\0").into_bytes();
        bytes.extend((value.len() as u32).to_le_bytes());
        bytes.extend(value);
        bytes
    }

    #[test]
    fn attributes_are_sorted_and_nothing_else_moves() {
        let (b, a, ab) = (raw_attribute("b", b"x"), raw_attribute("a", &[0, 0, 1]), raw_attribute("ab", b""));
        let rest = [0, 7, 8, 9];
        let mut file = [&[1; PREAMBLE][..], &b, &ab, &a, &rest].concat();
        assert_eq!(sort_attributes(&mut file), Some(()));
        assert_eq!(file, [&[1; PREAMBLE][..], &a, &ab, &b, &rest].concat());
    }

    #[test]
    fn bytes_that_are_no_header_are_refused() {
        let whole = [&[1; PREAMBLE][..], &raw_attribute("name", b"value"), &[0]].concat();
        for length in 0..whole.len() {
            assert_eq!(sort_attributes(&mut whole[..length].to_vec()), None, "{length} bytes");
        }
        assert_eq!(sort_attributes(&mut whole.clone()), Some(()));
    }

    #[test]
    fn matrices_act_on_row_vectors() {
        let metadata = ImageMetadata {
            frame_number: 1,
            fps: 24.0,
            world_to_camera: Mat4::from_translation(Vec3::new(1.0, 2.0, 3.0)),
            world_to_ndc: Mat4::IDENTITY,
            attributes: Vec::new(),
        };
        let m = own_attributes(&metadata).unwrap().world_to_camera.unwrap();
        let p = [5.0, 7.0, 9.0, 1.0_f32];
        let image: Vec<f32> = (0..4).map(|j| (0..4).map(|i| p[i] * m[4 * i + j]).sum()).collect();
        assert_eq!(image, [6.0, 9.0, 12.0, 1.0]);
    }
}
