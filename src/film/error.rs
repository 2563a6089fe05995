//! What can go wrong when a frame is written.

use std::io;
use std::path::PathBuf;

/// Why a frame was not written. Nothing of it is left on the disk.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FilmError {
    /// The folder or the file cannot be made: rights, a file where a folder should be, a read-only disk.
    #[error("{}: cannot create it: {source}; check that the folder exists and may be written to", path.display())]
    CannotCreate {
        /// The folder or file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The file was begun but its bytes did not reach the disk, or it could not take its name.
    #[error("{}: cannot write it: {source}; check the space on the disk and that no folder has this name", path.display())]
    CannotWrite {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A picture that is there cannot be read.
    #[error("{}: cannot read it: {reason}; remove it to have it drawn again", path.display())]
    CannotRead {
        /// The file.
        path: PathBuf,
        /// The system's or the decoder's reason.
        reason: String,
    },
    /// The format cannot hold the frame, such as one without pixels.
    #[error("{}: cannot encode a frame of {width} x {height} pixels: {reason}; check the resolution", path.display())]
    CannotEncode {
        /// The file.
        path: PathBuf,
        /// Columns of the frame.
        width: u32,
        /// Rows of the frame.
        height: u32,
        /// The encoder's reason.
        reason: String,
    },
    /// The name of an attribute is not one that OpenEXR files can have.
    #[error("attribute \"{name}\": its name {reason}; give it another")]
    Attribute {
        /// The name with its prefix.
        name: String,
        /// What is wrong with it.
        reason: &'static str,
    },
}
