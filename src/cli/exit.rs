//! Exit codes: those of `sysexits.h`, which schedulers understand.

use std::process::ExitCode;

use crate::driver::RenderError;
use crate::driver::error::Blame;

/// The end of the help text.
pub(super) const HELP: &str = "\
Exit codes: 0 all is there, 1 pictures differ, 2 usage, 65 bad input data, 66 input missing, 70 internal error, or
restarts that bring nothing new,
73 cannot create or 74 cannot write an output, 75 interrupted (run it again with --resume),
78 bad scene file; of several 75, else the greatest.";

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Exit {
    /// Everything that was asked for is there.
    Complete = 0,
    /// Pictures differ from their references.
    Different = 1,
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
    /// It was asked to stop, or frames are not there yet: the same command with `--resume` goes on.
    Interrupted = 75,
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
            Blame::Interrupted => Self::Interrupted,
        }
    }
}
