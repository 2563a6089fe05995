//! A contact sheet: all pictures of a sequence small in one, with the frame numbers beneath.

use image::imageops::{overlay, thumbnail};
use image::{ImageFormat, Rgb, RgbImage};

use super::digits;
use super::error::MovieError;
use super::pictures::Pictures;
use crate::sequence::FrameFile;

/// Greatest width and height of a small picture in pixels.
const THUMBNAIL: u32 = 240;
/// Pixels between and around pictures.
const MARGIN: u32 = 8;

const BACKGROUND: Rgb<u8> = Rgb([32; 3]);
const INK: Rgb<u8> = Rgb([208; 3]);

/// The bytes of a PNG file of all pictures in so many columns; without a number, about as wide as high.
///
/// # Errors
/// [`MovieError::Picture`] for a picture that is damaged.
pub fn contact_sheet(pictures: &Pictures, columns: Option<u32>) -> Result<Vec<u8>, MovieError> {
    let small = |file: &FrameFile| Ok(shrunk(&pictures.read(file)?));
    let thumbnails = pictures.files.iter().map(small).collect::<Result<Vec<RgbImage>, MovieError>>()?;
    let widest = |size: fn(&RgbImage) -> u32| thumbnails.iter().map(size).max().unwrap_or(1);
    let cell = [widest(RgbImage::width) + MARGIN, widest(RgbImage::height) + digits::HEIGHT + 2 * MARGIN];
    let count = thumbnails.len() as u32;
    let columns = columns.unwrap_or_else(|| square(count, cell)).min(count);
    let [width, height] = [columns * cell[0] + MARGIN, count.div_ceil(columns) * cell[1] + MARGIN];
    let mut sheet = RgbImage::from_pixel(width, height, BACKGROUND);
    for ((thumbnail, file), i) in thumbnails.iter().zip(&pictures.files).zip(0..) {
        let [x, y] = [i % columns * cell[0] + MARGIN, i / columns * cell[1] + MARGIN];
        overlay(&mut sheet, thumbnail, x.into(), y.into());
        let beneath = y + thumbnail.height() + MARGIN;
        digits::draw(&mut sheet, &file.number.to_string(), x + thumbnail.width() / 2, beneath, INK);
    }
    let mut bytes = std::io::Cursor::new(Vec::new());
    let written = sheet.write_to(&mut bytes, ImageFormat::Png);
    written.map_err(|e| MovieError::Picture { path: pictures.pattern.clone(), reason: e.to_string() })?;
    Ok(bytes.into_inner())
}

/// The picture within a square of [`THUMBNAIL`] pixels; small ones stay as they are.
fn shrunk(picture: &RgbImage) -> RgbImage {
    let (width, height) = picture.dimensions();
    let longer = width.max(height);
    if longer <= THUMBNAIL {
        return picture.clone();
    }
    let scaled = |n: u32| (u64::from(n) * u64::from(THUMBNAIL) / u64::from(longer)).max(1) as u32;
    thumbnail(picture, scaled(width), scaled(height))
}

/// The least columns with which cells make a sheet that is at least as wide as high.
fn square(count: u32, [width, height]: [u32; 2]) -> u32 {
    let is_wide =
        |columns: &u32| u64::from(columns * width) >= u64::from(count.div_ceil(*columns)) * u64::from(height);
    (1..count).find(is_wide).unwrap_or(count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sheet_is_about_as_wide_as_high() {
        assert_eq!(square(1, [100, 70]), 1);
        assert_eq!(square(24, [100, 70]), 5);
        assert_eq!(square(3, [10, 1000]), 3);
    }

    #[test]
    fn pictures_keep_their_shape() {
        assert_eq!(shrunk(&RgbImage::new(960, 480)).dimensions(), (240, 120));
        assert_eq!(shrunk(&RgbImage::new(1, 4800)).dimensions(), (1, 240));
        assert_eq!(shrunk(&RgbImage::new(32, 18)).dimensions(), (32, 18));
    }
}
