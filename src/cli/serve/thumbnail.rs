//! Small pictures for the filmstrip.

use std::io::Cursor;
use std::sync::{Mutex, PoisonError};

use image::ImageFormat;

/// Longest side in pixels.
const SIDE: u32 = 160;

/// One at a time: the pixels of a picture take far more memory than its file.
static TURN: Mutex<()> = Mutex::new(());

/// A small PNG of a PNG; `None` when it is none.
pub fn thumbnail(png: &[u8]) -> Option<Vec<u8>> {
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let whole = image::load_from_memory_with_format(png, ImageFormat::Png).ok()?;
    let mut small = Cursor::new(Vec::new());
    whole.thumbnail(SIDE, SIDE).write_to(&mut small, ImageFormat::Png).ok()?;
    Some(small.into_inner())
}
