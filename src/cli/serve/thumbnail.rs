//! Small pictures for the filmstrip.

use std::io::Cursor;

use image::ImageFormat;

/// Longest side in pixels.
const SIDE: u32 = 160;

/// A small PNG of a PNG; `None` when it is none.
pub fn thumbnail(png: &[u8]) -> Option<Vec<u8>> {
    let whole = image::load_from_memory_with_format(png, ImageFormat::Png).ok()?;
    let mut small = Cursor::new(Vec::new());
    whole.thumbnail(SIDE, SIDE).write_to(&mut small, ImageFormat::Png).ok()?;
    Some(small.into_inner())
}
