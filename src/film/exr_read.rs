//! The colours of a frame's OpenEXR file, for a PNG that is missing and for movies.

use super::accumulate::Pixel;
use super::frame_image::FrameImage;
use crate::light::read_exr;

/// A frame with the colours that a file has, and nothing else.
///
/// # Errors
/// The decoder's reason, in words.
pub fn read_colours(bytes: &[u8]) -> Result<FrameImage, String> {
    let picture = read_exr(bytes)?;
    let mut image = FrameImage::new(picture.width as u32, picture.height as u32);
    for (pixel, rgb) in image.pixels.iter_mut().zip(picture.texels) {
        *pixel = Pixel { rgb, ..Pixel::EMPTY };
    }
    Ok(image)
}
