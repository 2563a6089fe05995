//! What can be wrong with a grid's file, sorted by who has to act.

use std::io;
use std::path::{Path, PathBuf};

/// Why a grid cannot be used; every message names the file, the place, the value and the cure.
#[derive(Debug, thiserror::Error)]
pub enum VolumeError {
    /// The file system refused.
    #[error("{}: cannot be read: {source}; check density.grid, which is relative to the scene file", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The bytes do not follow the format.
    #[error("{}: {problem}; {cure}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Where in it, and what is wrong there.
        problem: String,
        /// What to do about it.
        cure: &'static str,
    },
    /// The format is followed, but a value cannot be a relative density.
    #[error("{}: {problem}; {cure}", path.display())]
    Invalid {
        /// The file.
        path: PathBuf,
        /// Where in it, and what is wrong there.
        problem: String,
        /// What to do about it.
        cure: &'static str,
    },
    /// A format, or a part of one, that is not read here.
    #[error("{}: {problem}; {cure}", path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// Where in it, and what is not supported.
        problem: String,
        /// What to do about it.
        cure: &'static str,
    },
}

/// An error before the file's name is known to it.
#[derive(Debug)]
pub(super) enum Fault {
    Malformed(String, &'static str),
    Invalid(String, &'static str),
    Unsupported(String, &'static str),
}

impl Fault {
    /// The error of a file.
    pub fn in_file(self, path: &Path) -> VolumeError {
        let path = path.to_owned();
        match self {
            Self::Malformed(problem, cure) => VolumeError::Malformed { path, problem, cure },
            Self::Invalid(problem, cure) => VolumeError::Invalid { path, problem, cure },
            Self::Unsupported(problem, cure) => VolumeError::Unsupported { path, problem, cure },
        }
    }
}

/// Text of a file as a message can show it: one line, printable, at most 60 characters.
pub(super) fn excerpt(text: &str) -> String {
    const LONGEST: usize = 60;
    let line: String = text.trim().chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    if line.chars().count() > LONGEST {
        line.chars().take(LONGEST).chain("...".chars()).collect()
    } else {
        line
    }
}
