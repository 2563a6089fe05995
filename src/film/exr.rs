//! The frame as measured: OpenEXR, 32-bit float, one part, ZIP.
//!
//! Layers are channels with a prefix: `R G B A`, then on request `albedo.R/G/B`, `N.X/Y/Z`, `P.X/Y/Z`, `Z`, and
//! `variance.R/G/B` (of the mean) with `samples`. Attributes: `framesPerSecond`, `timeCode`, `imageCounter`,
//! `worldToCamera`, `worldToNDC`, `chromaticities`, `software`, and those of the scene under `floe:`, with the checksum
//! of [`super::exr_seal`].
//!
//! The bytes depend on the pixels and the metadata alone. Blocks of rows are compressed on the threads of the current
//! pool and written in order; attributes are sorted; no date, host, run time or thread count is in the file. The test
//! `bytes_are_the_same_on_any_number_of_threads` in `tests/film_files.rs` checks this.

use std::io::Cursor;
use std::path::Path;

use exr::block::writer::ChunksWriter;
use exr::block::{BlockIndex, UncompressedBlock};
use rayon::prelude::*;

use super::error::FilmError;
use super::exr_channels::{Channel, channels};
use super::exr_header::{header, sort_attributes};
use super::exr_seal::seal;
use super::frame_image::FrameImage;
use super::metadata::ImageMetadata;
use crate::scene::description::Aov;

/// The bytes of an OpenEXR file of the frame; `path` is only for messages.
///
/// # Errors
/// [`FilmError::CannotEncode`] for a frame without pixels, [`FilmError::Attribute`] for an attribute whose name is not
/// valid.
pub fn encode_exr(
    image: &FrameImage,
    metadata: &ImageMetadata,
    aovs: &[Aov],
    path: &Path,
) -> Result<Vec<u8>, FilmError> {
    let refused = |reason: String| FilmError::CannotEncode {
        path: path.to_path_buf(),
        width: image.width,
        height: image.height,
        reason,
    };
    if image.width == 0 || image.height == 0 {
        return Err(refused(String::from("it has no pixels")));
    }
    let channels = channels(aovs);
    let header = header(image.width, image.height, &channels, metadata)?;
    let mut file = Cursor::new(Vec::new());
    exr::block::write(&mut file, [header].into_iter().collect(), true, |meta, writer| {
        let blocks: Vec<_> = meta.enumerate_ordered_header_block_indices().collect();
        let chunks = blocks
            .into_par_iter()
            .map(|(place, index)| {
                let data = block_bytes(image, &channels, index);
                Ok((place, UncompressedBlock { index, data }.compress_to_chunk(&meta.headers)?))
            })
            .collect::<exr::error::Result<Vec<_>>>()?;
        for (place, chunk) in chunks {
            writer.write_chunk(place, chunk)?;
        }
        Ok(())
    })
    .map_err(|error| refused(error.to_string()))?;
    let mut bytes = file.into_inner();
    sort_attributes(&mut bytes)
        .and_then(|()| seal(&mut bytes))
        .ok_or_else(|| refused(String::from("its header is not well formed")))?;
    Ok(bytes)
}

/// The numbers of a block as the encoder wants them: row by row, in each row channel by channel.
fn block_bytes(image: &FrameImage, channels: &[Channel], index: BlockIndex) -> Vec<u8> {
    let (first, rows) = (index.pixel_position.y(), index.pixel_size.y());
    let mut bytes = Vec::with_capacity(index.pixel_size.area() * channels.len() * size_of::<f32>());
    for y in first..first + rows {
        for channel in channels {
            let row = image.row(y as u32);
            bytes.extend(row.iter().flat_map(|pixel| (channel.value)(pixel).to_ne_bytes()));
        }
    }
    bytes
}
