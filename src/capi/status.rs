//! How a call ended; the numbers from 65 on are the exit codes of the command line.

use crate::driver::RenderError;
use crate::driver::error::Blame;

/// How a call ended. `floe_error_message` has the words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum Status {
    /// It did what it was to do.
    Ok = 0,
    /// A pointer is null or not aligned, a text is not UTF-8, a count or a number is none that there can be.
    BadArgument = 2,
    /// There is no mesh to be rendered, or no picture yet.
    TooEarly = 3,
    /// A mesh, or a file that the scene names, is wrong.
    BadData = 65,
    /// A file is not there.
    Missing = 66,
    /// floe itself or the machine failed.
    Internal = 70,
    /// A picture cannot be created.
    CannotCreate = 73,
    /// A picture cannot be written.
    CannotWrite = 74,
    /// `floe_interrupt` stopped it.
    Interrupted = 75,
    /// The scene is wrong, or has no medium for a label of the mesh.
    BadScene = 78,
}

/// A call that failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Failure {
    pub status: Status,
    pub message: String,
}

impl Failure {
    pub fn new(status: Status, message: impl Into<String>) -> Self {
        Self { status, message: message.into() }
    }
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        let status = match error.blame() {
            Blame::Configuration => Status::BadScene,
            Blame::Data => Status::BadData,
            Blame::Missing => Status::Missing,
            Blame::CannotCreate => Status::CannotCreate,
            Blame::CannotWrite => Status::CannotWrite,
            Blame::Internal => Status::Internal,
            Blame::Interrupted => Status::Interrupted,
        };
        Self::new(status, error.to_string())
    }
}
