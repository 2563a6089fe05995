//! The colours of a frame's OpenEXR file, for a PNG that is missing and for movies.

use std::io::Cursor;

use exr::prelude::{ReadChannels, ReadLayers};
use glam::Vec3;

use super::accumulate::Pixel;
use super::frame_image::FrameImage;

/// A frame with the colours that a file has, and nothing else.
///
/// # Errors
/// The decoder's reason, in words.
pub fn read_colours(bytes: &[u8]) -> Result<FrameImage, String> {
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size, _| FrameImage::new(size.width() as u32, size.height() as u32),
            |image, at, (r, g, b, _): (f32, f32, f32, f32)| {
                let place = at.y() * image.width as usize + at.x();
                image.pixels[place] = Pixel { rgb: Vec3::new(r, g, b), ..Pixel::EMPTY };
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|error| error.to_string())?;
    Ok(image.layer_data.channel_data.pixels)
}
