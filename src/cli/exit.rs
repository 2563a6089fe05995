//! Exit codes: those of `sysexits.h`, which schedulers understand.

use std::process::ExitCode;

use crate::driver::RenderError;
use crate::driver::error::Blame;

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Exit {
    /// Everything that was asked for is there.
    Complete = 0,
    /// The command line is wrong.
    Usage = 2,
    /// An input file is bad.
    BadData = 65,
    /// An input file is not there.
    Missing = 66,
    /// The program or the machine is at fault.
    Internal = 70,
    /// An output file cannot be created.
    CannotCreate = 73,
    /// An output file cannot be written.
    CannotWrite = 74,
    /// The scene file is wrong.
    Configuration = 78,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

impl From<&RenderError> for Exit {
    fn from(error: &RenderError) -> Self {
        match error.blame() {
            Blame::Configuration => Self::Configuration,
            Blame::Data => Self::BadData,
            Blame::Missing => Self::Missing,
            Blame::CannotCreate => Self::CannotCreate,
            Blame::CannotWrite => Self::CannotWrite,
            Blame::Internal => Self::Internal,
        }
    }
}
