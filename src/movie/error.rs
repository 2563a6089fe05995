//! Why no movie or sheet was made.

use std::path::PathBuf;

use crate::driver::RenderError;
use crate::film::FilmError;
use crate::sequence::{FrameNumber, Gap, SequenceError, format_numbers};

/// What went wrong on the way from pictures to a movie or a sheet.
#[derive(Debug, thiserror::Error)]
pub enum MovieError {
    /// The scene that names the pictures.
    #[error(transparent)]
    Scene(#[from] RenderError),
    /// Which files are pictures.
    #[error(transparent)]
    Sequence(#[from] SequenceError),
    /// The result could not be written.
    #[error(transparent)]
    Film(#[from] FilmError),
    /// There are no pictures yet.
    #[error(
        "no pictures {}: render them first, or give the folder or the pattern of their names{}",
        wanted.display(), but_previews(unfinished)
    )]
    NoPictures {
        /// The name, or pattern of names, that they would have.
        wanted: PathBuf,
        /// Frames of which there is only a PNG.
        unfinished: Vec<FrameNumber>,
    },
    /// A picture would be held for ages.
    #[error(
        "{}: frames {gap} before it are missing, and a movie would hold still for {count} frames (at most {most}): if it \
         belongs to another sequence, move it into another folder, or give it a number next to the others",
        path.display()
    )]
    Gap {
        /// The picture behind the gap.
        path: PathBuf,
        /// What is missing.
        gap: Gap,
        /// Frames to be held, in this gap and those before it.
        count: i64,
        /// The most of them.
        most: i64,
    },
    /// MP4 has fewer qualities than WebM.
    #[error("--crf {crf}: {} can have 0 to {most}, less is better", path.display())]
    Quality {
        /// The movie.
        path: PathBuf,
        /// What was asked for.
        crf: u8,
        /// The worst that there is.
        most: u8,
    },
    /// It was asked to stop.
    #[error("interrupted; no movie is written")]
    Interrupted,
    /// A picture cannot be read.
    #[error("{}: {reason}; render this frame again", path.display())]
    Picture {
        /// The picture.
        path: PathBuf,
        /// What the reader says.
        reason: String,
    },
    /// A movie has one size.
    #[error(
        "{}: {} x {} pixels, where the frames before it have {} x {}; render all frames with one resolution",
        path.display(), found[0], found[1], expected[0], expected[1]
    )]
    Size {
        /// The picture.
        path: PathBuf,
        /// Its width and height.
        found: [u32; 2],
        /// Those of the first picture.
        expected: [u32; 2],
    },
    /// No movie can be made without ffmpeg.
    #[error(
        "ffmpeg is not on the PATH; install it (apt install ffmpeg, dnf install ffmpeg-free, brew install ffmpeg, \
         winget install ffmpeg) and run this again. It would run\n  {command}"
    )]
    NoFfmpeg {
        /// What would be run.
        command: String,
    },
    /// ffmpeg could not make the movie.
    #[error("ffmpeg failed ({status}): {message}\nit was run as\n  {command}")]
    Ffmpeg {
        /// How it ended.
        status: String,
        /// The end of what it said.
        message: String,
        /// How it was run.
        command: String,
    },
    /// The kind of movie is known by the end of its name.
    #[error("the movie `{}` has an unknown ending: write .mp4, .webm or .gif", path.display())]
    UnknownKind {
        /// Its name.
        path: PathBuf,
    },
}

fn but_previews(unfinished: &[FrameNumber]) -> String {
    match unfinished {
        [] => String::new(),
        numbers => format!("; there are PNGs of {} alone, which may be previews", format_numbers(numbers)),
    }
}
