//! Why pictures were not compared.

use std::path::PathBuf;

use crate::film::FilmError;
use crate::sequence::SequenceError;

/// What went wrong on the way from two names to a comparison.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// Which files are pictures.
    #[error(transparent)]
    Sequence(#[from] SequenceError),
    /// A difference image could not be written.
    #[error(transparent)]
    Film(#[from] FilmError),
    /// There is nothing under a name.
    #[error("{}: no such picture; give an EXR file, a folder of them, or the pattern of their names", path.display())]
    Missing {
        /// The name.
        path: PathBuf,
    },
    /// A folder or a pattern has nothing.
    #[error("{}: no pictures (.exr) there; render them first, or check the name", path.display())]
    NoPictures {
        /// The folder or the pattern.
        path: PathBuf,
    },
    /// No frame has both.
    #[error("{} and {} have no frame in common: {a_frames} and {b_frames}; check the names", a.display(), b.display())]
    NothingInCommon {
        /// Where the candidates are.
        a: PathBuf,
        /// Which frames they are.
        a_frames: String,
        /// Where the references are.
        b: PathBuf,
        /// Which frames they are.
        b_frames: String,
    },
    /// One is a sequence, the other one picture.
    #[error(
        "{} is a folder or a pattern, and {} is one picture; give two pictures, or two folders or patterns",
        many.display(), one.display()
    )]
    ManyAndOne {
        /// The sequence.
        many: PathBuf,
        /// The picture.
        one: PathBuf,
    },
    /// A picture cannot be read.
    #[error("{}: {reason}; render it again, or give a picture in linear RGB", path.display())]
    Unreadable {
        /// The picture.
        path: PathBuf,
        /// What the reader says.
        reason: String,
    },
    /// Pictures of different sizes.
    #[error(
        "{} has {} x {} pixels, and {} has {} x {}; render both with one resolution",
        a.display(), a_size[0], a_size[1], b.display(), b_size[0], b_size[1]
    )]
    Size {
        /// The candidate.
        a: PathBuf,
        /// Its columns and rows.
        a_size: [usize; 2],
        /// The reference.
        b: PathBuf,
        /// Its columns and rows.
        b_size: [usize; 2],
    },
}
