//! Reads pictures of the sky: OpenEXR and Radiance HDR.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use glam::Vec3;
use image::codecs::hdr::HdrDecoder;
use image::{DynamicImage, ImageDecoder};

/// Linear Rec. 709 RGB, row 0 on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Texels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Row by row.
    pub texels: Vec<Vec3>,
}

/// Why a picture cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// The file is not there or cannot be read.
    #[error("{path}: {source}; check sky.image, which is relative to the scene file")]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file is not a picture that can be read.
    #[error("{path}: {reason}; give an OpenEXR (.exr) or Radiance (.hdr) picture")]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What the reader says.
        reason: String,
    },
    /// A texel is not a radiance.
    #[error(
        "{path}: texel ({x}, {y}) is {value}: radiance must be finite and not negative; repair the picture"
    )]
    Invalid {
        /// The file.
        path: PathBuf,
        /// Column.
        x: usize,
        /// Row.
        y: usize,
        /// What is there.
        value: Vec3,
    },
}

impl Picture {
    /// Reads `.exr` or `.hdr`.
    ///
    /// # Errors
    /// When the file is missing, malformed, or has a texel that is negative or not finite.
    pub fn read(path: &Path) -> Result<Self, ImageError> {
        let bytes = std::fs::read(path).map_err(|source| ImageError::Io { path: path.into(), source })?;
        Self::read_bytes(&bytes, path)
    }

    /// Reads the contents of a file; `path` is only named in messages.
    ///
    /// # Errors
    /// When the contents are malformed, or have a texel that is negative or not finite.
    pub fn read_bytes(bytes: &[u8], path: &Path) -> Result<Self, ImageError> {
        let is_exr = bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]);
        let picture = if is_exr { read_exr(bytes) } else { read_hdr(bytes) }
            .map_err(|reason| ImageError::Malformed { path: path.into(), reason })?;
        let wrong = picture.texels.iter().position(|t| !(t.is_finite() && t.min_element() >= 0.0));
        match wrong {
            Some(at) => Err(ImageError::Invalid {
                path: path.into(),
                x: at % picture.width,
                y: at / picture.width,
                value: picture.texels[at],
            }),
            None => Ok(picture),
        }
    }
}

/// Reads the colours of an OpenEXR file, of any values.
///
/// # Errors
/// The decoder's reason, in words.
pub(crate) fn read_exr(bytes: &[u8]) -> Result<Picture, String> {
    use exr::prelude::*;
    check_exr_size(bytes)?;
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size, _| (size.width(), vec![Vec3::ZERO; size.width() * size.height()]),
            |(width, texels), position, (r, g, b, _): (f32, f32, f32, f32)| {
                texels[position.y() * *width + position.x()] = Vec3::new(r, g, b);
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|e| e.to_string())?;
    let (width, texels) = image.layer_data.channel_data.pixels;
    Ok(Picture { width, height: texels.len() / width.max(1), texels })
}

fn read_hdr(bytes: &[u8]) -> Result<Picture, String> {
    let decoder = HdrDecoder::new(bytes).map_err(|e| e.to_string())?;
    let (width, height) = decoder.dimensions();
    check_size([width as usize, height as usize], bytes)?;
    let rgb = DynamicImage::from_decoder(decoder).map_err(|e| e.to_string())?.into_rgb32f();
    let texels = rgb.pixels().map(|p| Vec3::from_array(p.0)).collect();
    Ok(Picture { width: width as usize, height: height as usize, texels })
}

/// Refuses an OpenEXR file that declares more pixels than it can hold.
///
/// # Errors
/// What it declares, or why its header cannot be read, in words.
pub(crate) fn check_exr_size(bytes: &[u8]) -> Result<(), String> {
    let meta =
        exr::meta::MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(|e| e.to_string())?;
    let sizes = meta.headers.iter().map(|header| header.layer_size);
    sizes.into_iter().try_for_each(|size| check_size([size.width(), size.height()], bytes))
}

/// Refuses a size of which no file of so many bytes holds the pixels, before memory is asked for.
///
/// Deflate packs a thousand bytes into one at most, of pixels that are all alike: 170 pixels of half precision. A small
/// file may have 4096 x 4096.
fn check_size([width, height]: [usize; 2], bytes: &[u8]) -> Result<(), String> {
    let most = (1 << 24) + 200 * bytes.len();
    match width.checked_mul(height) {
        Some(pixels) if pixels <= most => Ok(()),
        _ => Err(format!(
            "{width} x {height} pixels are declared, more than {} bytes can hold: the file is truncated or its header wrong",
            bytes.len()
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(bytes: &[u8]) -> String {
        Picture::read_bytes(bytes, Path::new("sky")).unwrap_err().to_string()
    }

    #[test]
    fn sizes_that_the_file_cannot_hold_are_refused_before_memory_is_asked_for() {
        let header = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 200000 +X 300000\n";
        assert!(refused(header).contains("300000 x 200000 pixels are declared"), "{}", refused(header));

        let mut exr = std::fs::read("sequences/iceberg/sky.exr").unwrap();
        let name = b"dataWindow\0box2i\0";
        let at = exr.windows(name.len()).position(|bytes| bytes == name).unwrap() + name.len() + 4;
        // The greatest x and y of the window.
        exr[at + 8..at + 16].copy_from_slice(&[0, 0, 4, 0, 0, 0, 4, 0]);
        assert!(refused(&exr).contains("pixels are declared"), "{}", refused(&exr));
    }
}
