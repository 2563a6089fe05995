//! What can be wrong with a sequence, by who has to mend it.

use std::io;
use std::path::PathBuf;

use super::FrameNumber;

/// What can be wrong with a sequence of frames.
#[derive(Debug, thiserror::Error)]
pub enum SequenceError {
    /// The folder cannot be read.
    #[error("cannot list the folder {}: {source}: check that it exists and that it may be read", folder.display())]
    Io {
        /// The folder.
        folder: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// No file matches.
    #[error("no frames in {}: looked for {wanted}: check `frames.path`, or wait until the simulator has written its first frame", folder.display())]
    NothingFound {
        /// The folder that was searched.
        folder: PathBuf,
        /// What was looked for, in words.
        wanted: String,
    },
    /// Two files claim one frame number.
    #[error("frame {number} is there twice, as {} and as {}: remove one, or name the frames with a pattern such as frame_####.ply", first.display(), second.display())]
    DuplicateNumber {
        /// The number.
        number: FrameNumber,
        /// One of the files.
        first: PathBuf,
        /// The other file.
        second: PathBuf,
    },
    /// A folder or glob holds files of more than one kind of name.
    #[error("{} holds more than one sequence, such as {first} and {second}: name one of them in `frames.path`", folder.display())]
    SeveralSequences {
        /// The folder.
        folder: PathBuf,
        /// One of the patterns.
        first: String,
        /// Another pattern.
        second: String,
    },
    /// Several meshes, none of which has a number.
    #[error("{} and {} in {} have no number in their names: number the frames, or name one file in `frames.path`", first, second, folder.display())]
    Unnumbered {
        /// The folder.
        folder: PathBuf,
        /// One of the files.
        first: String,
        /// Another file.
        second: String,
    },
    /// A file's number does not fit a frame number.
    #[error("the number `{digits}` in {} is not a frame number: use at most {limit} with up to 6 decimals", path.display(), limit = FrameNumber::LIMIT)]
    Number {
        /// The file.
        path: PathBuf,
        /// The digits in its name.
        digits: String,
    },
    /// A pattern that cannot be used.
    #[error("the pattern `{pattern}` cannot be used: {reason}")]
    Pattern {
        /// The pattern.
        pattern: String,
        /// What is wrong and what to write instead.
        reason: String,
    },
    /// Several frames would be written to one file.
    #[error(
        "the output `{pattern}` has no place for the number of {frames} frames: write for example `{example}`"
    )]
    NoPlace {
        /// The output pattern.
        pattern: String,
        /// How many frames there are.
        frames: usize,
        /// A pattern that would do.
        example: String,
    },
    /// A frame selection that cannot be understood.
    #[error("the frames `{text}` cannot be understood at `{part}`: {reason}")]
    Selection {
        /// The whole selection.
        text: String,
        /// The part between commas.
        part: String,
        /// What is wrong and what to write instead.
        reason: String,
    },
    /// A shard that cannot be.
    #[error("the shard `{text}` cannot be understood: {reason}")]
    Shard {
        /// The text.
        text: String,
        /// What is wrong and what to write instead.
        reason: String,
    },
    /// The selection leaves no frame.
    #[error("none of the frames `{selection}` is in the sequence, which has {available}: choose from those")]
    NoneSelected {
        /// What was asked for.
        selection: String,
        /// What there is.
        available: String,
    },
    /// A frame that was asked for by its number is not there.
    #[error(
        "frame {number} is not in the sequence, which has {available}: leave it out, or wait until it is written"
    )]
    NotThere {
        /// The frame.
        number: FrameNumber,
        /// What there is.
        available: String,
    },
}
