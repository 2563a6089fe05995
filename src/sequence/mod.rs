//! Which files are frames, and in which order.
//!
//! A sequence is named by a pattern (`frame_####.ply`, `frame_%04d.ply`, `frame_$F4.ply`), a glob
//! (`frame_*.ply`, `cut/*/surface.vtp`) or a folder. [`discover`] finds its files in ascending order of their [`FrameNumber`]s.
//! Padding never matters for the order, gaps are allowed, and whatever is ambiguous (two files of one number,
//! two kinds of names in one folder) is an error that names both files rather than a guess.
//!
//! [`FrameSelection`] is the part of the sequence that the command line asks for, and a [`Shard`] what one of several
//! machines does of that; [`output_path`] names the pictures.

mod error;
mod folders;
mod frames;
mod gaps;
mod glob;
mod name;
mod number;
mod output;
mod pattern;
mod selection;
mod shard;

use std::path::PathBuf;

pub use error::SequenceError;
pub use frames::{discover, discover_pictures, is_sequence, listed_folder};
pub use gaps::{Gap, gaps};
#[cfg(test)]
pub(crate) use name::is_frame_name;
pub use number::FrameNumber;
pub use output::{check_output_pattern, frame_path, has_place, output_path};
pub use selection::{FrameSelection, format_numbers};
pub use shard::{Deal, Shard};

/// One frame of a sequence on disk.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct FrameFile {
    /// The number in the file's name.
    pub number: FrameNumber,
    /// Where the file is.
    pub path: PathBuf,
}
