//! The 8-bit picture to look at: tone-mapped, sRGB, dithered, PNG.
//!
//! A sky's gradient spans few of the 256 levels and would show bands. Every value is rounded up or down by a threshold
//! that depends on the pixel's place alone `[BAYER73]`:
//!
//! ```text
//! level = floor(255 v + (M(x, y) + 1/2) / 256)
//! ```
//!
//! M is the 16 x 16 Bayer matrix, each of 0 .. 255 once. The mean over a block is right to 1/512 of a level, exact
//! levels (black and white among them) stay as they are, nothing flickers between frames, and greys stay grey since
//! the channels share the threshold. The picture is opaque: it shows the sky.
//!
//! The exposure is in the file, as text by the name `floe:exposure` right behind the header `[PNG03]`:
//!
//! ```text
//! length of the data, "tEXt", name 0 value, CRC-32 of type and data
//! ```

use std::io::Read;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use rayon::prelude::*;

use super::frame_image::FrameImage;
use super::tonemap::ToneMap;

/// Name of the text with the exposure.
const EXPOSURE: &str = "floe:exposure";

/// Bytes of the signature and of the header, which is always first.
const HEAD: usize = 8 + 25;

/// The bytes of a PNG file of the frame at an exposure in stops.
///
/// # Errors
/// The encoder's, when the frame has no pixels or is too large for the format.
pub fn encode_png(image: &FrameImage, exposure: f32) -> Result<Vec<u8>, image::ImageError> {
    let levels = display_levels(image, exposure);
    let mut bytes = Vec::new();
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Default, FilterType::Adaptive).write_image(
        &levels,
        image.width,
        image.height,
        ExtendedColorType::Rgb8,
    )?;
    bytes.splice(HEAD..HEAD, exposure_chunk(exposure));
    Ok(bytes)
}

/// Whether a PNG file begins as those do that are made with an exposure.
pub fn has_exposure(file: impl Read, exposure: f32) -> bool {
    let chunk = exposure_chunk(exposure);
    let mut start = vec![0; HEAD + chunk.len()];
    let mut file = file;
    file.read_exact(&mut start).is_ok() && start[HEAD..] == chunk
}

fn exposure_chunk(exposure: f32) -> Vec<u8> {
    let named = format!("tEXt{EXPOSURE}\0{exposure}").into_bytes();
    let mut checksum = flate2::Crc::new();
    checksum.update(&named);
    let length = (named.len() - 4) as u32;
    [&length.to_be_bytes()[..], &named, &checksum.sum().to_be_bytes()].concat()
}

/// Three levels a pixel, row after row, at an exposure in stops.
pub fn display_levels(image: &FrameImage, exposure: f32) -> Vec<u8> {
    let tone_map = ToneMap::new(exposure);
    let mut levels = vec![0; image.pixels.len() * 3];
    let width = (image.width as usize).max(1);
    levels.par_chunks_mut(width * 3).zip(image.pixels.par_chunks(width)).enumerate().for_each(
        |(y, (levels, row))| {
            for (x, (level, pixel)) in levels.chunks_exact_mut(3).zip(row).enumerate() {
                let threshold = (f32::from(bayer(x, y)) + 0.5) / 256.0;
                let shown = tone_map.apply(pixel.rgb);
                for (level, value) in level.iter_mut().zip(shown.to_array()) {
                    *level = (255.0 * value + threshold) as u8;
                }
            }
        },
    );
    levels
}

/// The 16 x 16 Bayer matrix: the bits of x XOR y and y interleaved, the lowest ones first.
fn bayer(x: usize, y: usize) -> u8 {
    let mixed = x ^ y;
    (0..4).fold(0, |m, bit| (m << 2) | ((((mixed >> bit) & 1) as u8) << 1) | ((y >> bit) & 1) as u8)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::film::accumulate::Pixel;

    fn flat(width: u32, height: u32, rgb: Vec3) -> FrameImage {
        let mut image = FrameImage::new(width, height);
        image.pixels.fill(Pixel { rgb, ..Pixel::EMPTY });
        image
    }

    #[test]
    fn the_matrix_holds_every_threshold_once() {
        let mut seen = [false; 256];
        for y in 0..16 {
            for x in 0..16 {
                assert!(!std::mem::replace(&mut seen[usize::from(bayer(x, y))], true));
                assert_eq!(bayer(x, y), bayer(x + 16, y + 32));
            }
        }
        // The 2 x 2 matrix of the source in its coarsest steps.
        assert_eq!([bayer(0, 0), bayer(1, 0), bayer(0, 1), bayer(1, 1)], [0, 128, 192, 64]);
    }

    #[test]
    fn dither_keeps_the_mean_within_a_level() {
        for grey in [0.002, 0.1, 0.18, 0.37, 0.9] {
            let image = flat(16, 16, Vec3::splat(grey));
            let levels = display_levels(&image, 0.0);
            let wanted = 255.0 * f64::from(ToneMap::new(0.0).apply(Vec3::splat(grey)).x);
            let mean = levels.iter().map(|&l| f64::from(l)).sum::<f64>() / levels.len() as f64;
            assert!((mean - wanted).abs() <= 1.0 / 512.0 + 1e-4, "{grey}: {mean} for {wanted}");
            let (least, greatest) = (levels.iter().min().unwrap(), levels.iter().max().unwrap());
            assert!(greatest - least <= 1, "{grey}: {least} to {greatest}");
            assert!(levels.chunks_exact(3).all(|l| l[0] == l[1] && l[1] == l[2]), "grey stays grey");
        }
    }

    #[test]
    fn black_and_white_have_no_noise() {
        let levels = |rgb| display_levels(&flat(32, 16, rgb), 0.0);
        assert!(levels(Vec3::ZERO).iter().all(|&l| l == 0));
        for bright in [1e5, 1e20, f32::MAX, f32::INFINITY] {
            assert!(levels(Vec3::splat(bright)).iter().all(|&l| l == 255), "{bright}");
        }
    }

    #[test]
    fn the_exposure_is_in_the_file_and_readers_pass_over_it() {
        let image = flat(20, 3, Vec3::splat(0.2));
        for exposure in [0.0, -1.5, 0.1] {
            let bytes = encode_png(&image, exposure).unwrap();
            for other in [0.0, -1.5, 0.1, 1.0] {
                assert_eq!(has_exposure(&bytes[..], other), other == exposure, "{other} in {exposure}");
            }
            assert!(!has_exposure(&bytes[..HEAD + 20], exposure));
            // The decoder checks the checksum of every chunk.
            let read = image::load_from_memory(&bytes).unwrap().into_rgb8();
            assert_eq!(read.into_raw(), display_levels(&image, exposure));
        }
    }

    #[test]
    fn a_frame_without_pixels_is_an_error() {
        assert!(encode_png(&FrameImage::new(0, 0), 0.0).is_err());
    }
}
