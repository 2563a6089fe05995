//! Why a study was not made.

use std::path::PathBuf;

use crate::driver::RenderError;
use crate::optics::lorenz_mie::SphereError;
use crate::sequence::FrameNumber;

/// What a study lacks.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A frame cannot be rendered.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// Means over several frames need as many.
    #[error(
        "{found} frames are too few: a temporal study takes at least {least}; ask for more with --frames"
    )]
    TooFewFrames {
        /// How many there are.
        found: usize,
        /// How many it takes.
        least: usize,
    },
    /// More frames of a still than anybody has time for.
    #[error("more than {most} frames of a still are asked for: ask for fewer with --frames")]
    TooManyFrames {
        /// The greatest number.
        most: usize,
    },
    /// Nothing says which numbers the frames of a still are to have.
    #[error(
        "a still has no frames of its own: say which numbers it is to be rendered with, such as --frames 1-16"
    )]
    NoNumbers,
    /// The frame that is to be held is not there.
    #[error("frame {number}, which is to be held, is not there: there are {available}")]
    NothingToHold {
        /// Its number.
        number: FrameNumber,
        /// The numbers that are there.
        available: String,
    },
    /// A file of results of no kind that is written.
    #[error("{file} does not end with .csv or .json: write for example {file}.csv", file = file.display())]
    NotATable {
        /// As it was given.
        file: PathBuf,
    },
    /// The picture that was given as a reference is none.
    #[error("{file}: {reason}", file = file.display())]
    Reference {
        /// The picture.
        file: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// A setting that is not one of a series.
    #[error("`{text}` sets samples or the seed: these are --budgets and --seed")]
    NotASetting {
        /// The settings.
        text: String,
    },
    /// A sphere that is none.
    #[error(transparent)]
    Sphere(#[from] SphereError),
    /// Time was up before anything was measured.
    #[error(
        "time was up before the reference was done: give more --time, fewer --reference-samples, or a --reference"
    )]
    NoTime,
}
