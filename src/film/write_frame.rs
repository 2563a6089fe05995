//! A frame's files: the OpenEXR one and, on request, a PNG to look at.

use std::path::Path;

use super::error::FilmError;
use super::exr::encode_exr;
use super::exr_read::read_colours;
use super::frame_image::FrameImage;
use super::metadata::ImageMetadata;
use super::png::encode_png;
use super::write::StagedFile;
use crate::scene::description::Aov;

/// Writes a frame; `exposure` of the PNG is in stops.
///
/// Both files are complete on the disk before either has its name, and the OpenEXR file gets its name last: where it
/// is, the frame is done.
///
/// # Errors
/// Any [`FilmError`]. No temporary file is left; a PNG of the frame may be there if only the OpenEXR file could not
/// take its name.
pub fn write_frame(
    image: &FrameImage,
    metadata: &ImageMetadata,
    exr_path: &Path,
    png_path: Option<&Path>,
    aovs: &[Aov],
    exposure: f32,
) -> Result<(), FilmError> {
    let exr = StagedFile::new(exr_path, &encode_exr(image, metadata, aovs, exr_path)?)?;
    if let Some(path) = png_path {
        write_png(image, path, exposure)?;
    }
    exr.commit()
}

/// Writes the PNG of a frame whose OpenEXR file is there; the same as if both had been written at once.
///
/// # Errors
/// Any [`FilmError`].
pub fn write_png_of(exr_path: &Path, png_path: &Path, exposure: f32) -> Result<(), FilmError> {
    let unreadable = |reason: String| FilmError::CannotRead { path: exr_path.to_path_buf(), reason };
    let bytes = std::fs::read(exr_path).map_err(|error| unreadable(error.to_string()))?;
    write_png(&read_colours(&bytes).map_err(unreadable)?, png_path, exposure)
}

fn write_png(image: &FrameImage, path: &Path, exposure: f32) -> Result<(), FilmError> {
    StagedFile::new(path, &png_bytes(image, exposure, path)?)?.commit()
}

/// The bytes of the PNG of a frame; `path` is only for messages.
///
/// # Errors
/// [`FilmError::CannotEncode`] for a frame that the format cannot hold.
pub fn png_bytes(image: &FrameImage, exposure: f32, path: &Path) -> Result<Vec<u8>, FilmError> {
    encode_png(image, exposure).map_err(|error| FilmError::CannotEncode {
        path: path.to_path_buf(),
        width: image.width,
        height: image.height,
        reason: error.to_string(),
    })
}
