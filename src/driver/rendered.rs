//! A frame that was rendered in memory: its pixels, what is known of them, and how they become files.

use std::path::Path;

use super::error::RenderError;
use super::ledger::FrameRecord;
use crate::film::write::write_atomically;
use crate::film::{FrameImage, ImageMetadata, png_bytes, write_frame};
use crate::scene::description::OutputDescription;

/// A frame that was rendered in memory.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// The pixels.
    pub image: FrameImage,
    /// Counts, seconds, the estimated error and warnings: what the ledger says of a frame.
    pub record: FrameRecord,
    pub(super) metadata: ImageMetadata,
    pub(super) output: OutputDescription,
}

impl Rendered {
    /// Red, green, blue and alpha of each pixel, row after row from the top: linear Rec. 709, as in the OpenEXR file.
    pub fn rgba(&self) -> impl ExactSizeIterator<Item = [f32; 4]> {
        self.image.pixels.iter().map(|pixel| [pixel.rgb.x, pixel.rgb.y, pixel.rgb.z, pixel.alpha])
    }

    /// Writes the OpenEXR file, and a PNG beside it if the scene wants one, both whole or not at all.
    ///
    /// # Errors
    /// [`RenderError::Film`].
    pub fn write(&self, exr: &Path) -> Result<(), RenderError> {
        let OutputDescription { png, exposure, aovs, .. } = &self.output;
        let png = png.then(|| exr.with_extension("png"));
        Ok(write_frame(&self.image, &self.metadata, exr, png.as_deref(), aovs, *exposure)?)
    }

    /// Writes a PNG alone.
    ///
    /// # Errors
    /// [`RenderError::Film`].
    pub fn write_png(&self, png: &Path) -> Result<(), RenderError> {
        Ok(write_atomically(png, &png_bytes(&self.image, self.output.exposure, png)?)?)
    }
}
