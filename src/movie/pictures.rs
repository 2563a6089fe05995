//! The pictures of a sequence, each as its PNG or, where there is none that is up to date, as its EXR.
//!
//! A picture is written as its PNG first and its EXR last, so a PNG that is older than its EXR shows something else. One
//! without any EXR may be a preview of a watch that was broken off: of a scene it is no picture. Where no scene says what
//! the pictures are, someone may have kept the PNGs alone.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use image::RgbImage;

use super::error::MovieError;
use crate::driver::Job;
use crate::film::exr_read::read_colours;
use crate::film::png;
use crate::sequence::{FrameFile, FrameNumber, SequenceError, discover, discover_pictures, has_place};

/// Frames a second that a movie may have.
pub const FRAME_RATES: RangeInclusive<f64> = 0.001..=1000.0;

/// The pictures of a sequence, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Pictures {
    /// One file a frame: a PNG, or an EXR that has none beside it which is up to date.
    pub files: Vec<FrameFile>,
    /// Frames of which there is a PNG, but not the picture.
    pub unfinished: Vec<FrameNumber>,
    /// The pattern or folder that they were found by.
    pub pattern: PathBuf,
    /// Frames a second, as the scene or the first EXR says; 24 where neither does.
    pub fps: f64,
    /// Exposure in stops at which an EXR is shown: that of the scene, or 0.
    pub exposure: f32,
}

impl Pictures {
    /// Finds the pictures that a scene renders to, those in a folder, or those of a pattern.
    ///
    /// A folder with a scene file stands for what that scene renders to: into the folder itself, if it has such pictures,
    /// since names of outputs are relative to where floe is run.
    ///
    /// # Errors
    /// When there are none, or a scene or their names cannot be understood.
    pub fn find(what: &Path) -> Result<Self, MovieError> {
        let is_scene = what.join("scene.toml").is_file() || what.extension().is_some_and(|e| e == "toml");
        let pictures = if is_scene { Self::of_scene(what)? } else { Self::of_files(what)? };
        if pictures.files.is_empty() {
            return Err(MovieError::NoPictures { wanted: pictures.pattern, unfinished: pictures.unfinished });
        }
        Ok(pictures)
    }

    fn of_scene(what: &Path) -> Result<Self, MovieError> {
        let job = Job::open(what)?;
        let elsewhere = PathBuf::from(job.output_pattern());
        let here = elsewhere.file_name().filter(|_| what.is_dir()).map(|name| what.join(name));
        let mut found = Files::of_pattern(&elsewhere)?;
        let mut pattern = elsewhere;
        if let Some(here) = here {
            let files = Files::of_pattern(&here)?;
            if !files.exr.is_empty() {
                (found, pattern) = (files, here);
            }
        }
        let (files, unfinished) = found.of_scene();
        let fps = job.world.fps();
        Ok(Self { files, unfinished, pattern, fps, exposure: job.world.description.output.exposure })
    }

    fn of_files(what: &Path) -> Result<Self, MovieError> {
        let found = if what.is_dir() {
            let all = |extension| found_or_none(discover_pictures(what, extension));
            Files { exr: all("exr")?, png: all("png")? }
        } else {
            Files::of_pattern(what)?
        };
        let fps = found.exr.first().and_then(|first| read_frame_rate(&first.path));
        let (pattern, unfinished) = (what.into(), Vec::new());
        Ok(Self { files: found.shown(), unfinished, pattern, fps: fps.unwrap_or(24.0), exposure: 0.0 })
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
        let frame = read_colours(&bytes).map_err(damaged)?;
        let levels = png::display_levels(&frame, self.exposure);
        RgbImage::from_raw(frame.width, frame.height, levels)
            .ok_or_else(|| damaged("it has no pixels".into()))
    }
}

/// What there is, of both kinds.
struct Files {
    exr: Vec<FrameFile>,
    png: Vec<FrameFile>,
}

impl Files {
    /// The pictures of a pattern of names, whichever of the two kinds it names; without a place, the one picture.
    fn of_pattern(pattern: &Path) -> Result<Self, MovieError> {
        let named = |extension| {
            let name = pattern.with_extension(extension).to_string_lossy().into_owned();
            if !has_place(&name) && !Path::new(&name).is_file() {
                return Ok(Vec::new());
            }
            found_or_none(discover(Path::new(""), &name))
        };
        Ok(Self { exr: named("exr")?, png: named("png")? })
    }

    /// Each EXR, or its PNG if that is up to date; and the PNGs that have no EXR.
    fn shown(self) -> Vec<FrameFile> {
        let (mut files, others) = self.parted();
        files.extend(others);
        files.sort_unstable();
        files
    }

    /// Each EXR, or its PNG if that is up to date; and which frames have a PNG alone.
    fn of_scene(self) -> (Vec<FrameFile>, Vec<FrameNumber>) {
        let (files, others) = self.parted();
        (files, others.iter().map(|file| file.number).collect())
    }

    fn parted(self) -> (Vec<FrameFile>, Vec<FrameFile>) {
        let png: BTreeMap<FrameNumber, FrameFile> =
            self.png.into_iter().map(|file| (file.number, file)).collect();
        let mut others = png.clone();
        let shown = |exr: FrameFile| {
            others.remove(&exr.number);
            let png = png.get(&exr.number).filter(|png| !is_older(&png.path, &exr.path));
            png.cloned().unwrap_or(exr)
        };
        let files = self.exr.into_iter().map(shown).collect();
        (files, others.into_values().collect())
    }
}

/// Whether a file was written before another; false where the system does not tell.
fn is_older(file: &Path, other: &Path) -> bool {
    let [file, other] = [file, other].map(|path| std::fs::metadata(path).and_then(|about| about.modified()));
    matches!((file, other), (Ok(file), Ok(other)) if file < other)
}

/// The frames a second that an EXR says it is one of.
fn read_frame_rate(path: &Path) -> Option<f64> {
    let about = exr::meta::MetaData::read_from_file(path, false).ok()?;
    let (frames, seconds) = about.headers.first()?.own_attributes.frames_per_second?;
    let fps = f64::from(frames) / f64::from(seconds);
    FRAME_RATES.contains(&fps).then_some(fps)
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

/// Whether a file has an extension, in capitals or not.
pub(super) fn is(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension))
}
