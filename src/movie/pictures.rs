//! The pictures of a sequence, each as its PNG or, where there is none, as its EXR.

use std::path::{Path, PathBuf};

use glam::Vec3;
use image::RgbImage;

use super::error::MovieError;
use crate::driver::Job;
use crate::film::{FrameImage, Pixel, png};
use crate::sequence::{FrameFile, SequenceError, discover, discover_pictures, has_place};

/// The pictures of a sequence, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Pictures {
    /// One file a frame: a PNG, or an EXR that has none beside it.
    pub files: Vec<FrameFile>,
    /// The pattern or folder that they were found by.
    pub pattern: PathBuf,
    /// Frames a second.
    pub fps: f64,
    /// Exposure in stops at which an EXR is shown.
    pub exposure: f32,
}

impl Pictures {
    /// Finds the pictures that a scene renders to, those in a folder, or those of a pattern.
    ///
    /// A folder with a scene file stands for what that scene renders to.
    ///
    /// # Errors
    /// When there are none, or a scene or their names cannot be understood.
    pub fn find(what: &Path) -> Result<Self, MovieError> {
        let found = |pattern: PathBuf, files| Self { files, pattern, fps: 24.0, exposure: 0.0 };
        let is_scene = what.join("scene.toml").is_file() || what.extension().is_some_and(|e| e == "toml");
        let pictures = if is_scene {
            let job = Job::open(what)?;
            let pattern = PathBuf::from(job.output_pattern());
            let files = of_pattern(&pattern)?;
            let fps = job.world.frames().map_or(24.0, |frames| frames.fps);
            Self { fps, exposure: job.world.description.output.exposure, ..found(pattern, files) }
        } else if what.is_dir() {
            let all = |extension| found_or_none(discover_pictures(what, extension));
            found(what.into(), shown_as_png(all("exr")?, all("png")?))
        } else {
            found(what.into(), of_pattern(what)?)
        };
        if pictures.files.is_empty() {
            return Err(MovieError::NoPictures { wanted: pictures.pattern });
        }
        Ok(pictures)
    }

    /// A picture as a screen shows it.
    ///
    /// # Errors
    /// [`MovieError::Picture`] when the file is damaged or is no picture.
    pub fn read(&self, file: &FrameFile) -> Result<RgbImage, MovieError> {
        let damaged = |reason| MovieError::Picture { path: file.path.clone(), reason };
        let bytes = std::fs::read(&file.path).map_err(|error| damaged(error.to_string()))?;
        if is(&file.path, "png") {
            let read = image::load_from_memory_with_format(&bytes, image::ImageFormat::Png);
            return Ok(read.map_err(|error| damaged(error.to_string()))?.into_rgb8());
        }
        let frame = read_exr(&bytes).map_err(damaged)?;
        let levels = png::display_levels(&frame, self.exposure);
        RgbImage::from_raw(frame.width, frame.height, levels)
            .ok_or_else(|| damaged("it has no pixels".into()))
    }
}

/// The pictures of a pattern of names, whichever of the two kinds it names; without a place, the one picture.
fn of_pattern(pattern: &Path) -> Result<Vec<FrameFile>, MovieError> {
    let named = |extension| {
        let name = pattern.with_extension(extension).to_string_lossy().into_owned();
        if !has_place(&name) && !Path::new(&name).is_file() {
            return Ok(Vec::new());
        }
        found_or_none(discover(Path::new(""), &name))
    };
    Ok(shown_as_png(named("exr")?, named("png")?))
}

/// Nothing found is no error: it may be of the other kind.
fn found_or_none(found: Result<Vec<FrameFile>, SequenceError>) -> Result<Vec<FrameFile>, SequenceError> {
    match found {
        Err(SequenceError::NothingFound { .. }) => Ok(Vec::new()),
        Err(SequenceError::Io { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => {
            Ok(Vec::new())
        }
        found => found,
    }
}

/// The PNGs, and the EXRs of the other frames.
fn shown_as_png(exr: Vec<FrameFile>, mut files: Vec<FrameFile>) -> Vec<FrameFile> {
    let lacking = |file: &FrameFile| !files.iter().any(|png| png.number == file.number);
    let others: Vec<FrameFile> = exr.into_iter().filter(lacking).collect();
    files.extend(others);
    files.sort_unstable();
    files
}

/// Whether a file has an extension, in capitals or not.
pub(super) fn is(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension))
}

fn read_exr(bytes: &[u8]) -> Result<FrameImage, String> {
    use exr::prelude::{ReadChannels, ReadLayers};
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size, _| FrameImage::new(size.width() as u32, size.height() as u32),
            |frame, position, (r, g, b, _): (f32, f32, f32, f32)| {
                let at = position.y() * frame.width as usize + position.x();
                frame.pixels[at] = Pixel { rgb: Vec3::new(r, g, b), ..Pixel::EMPTY };
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_buffered(std::io::Cursor::new(bytes))
        .map_err(|error| error.to_string())?;
    Ok(image.layer_data.channel_data.pixels)
}
