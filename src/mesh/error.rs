//! What can be wrong with a mesh file, sorted by who has to act.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// Why a mesh could not be read; every message names the file, the place, the value and the cure.
#[derive(Debug, thiserror::Error)]
pub enum MeshError {
    /// The file system refused.
    #[error("{}: cannot be read: {source}; check that the file exists and is readable", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The bytes do not follow the format.
    #[error("{}: {place}{problem}; {cure}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Where in it.
        place: Place,
        /// What is wrong there.
        problem: String,
        /// What to do about it.
        cure: &'static str,
    },
    /// The format is followed, but what it says cannot be a mesh.
    #[error("{}: {place}{problem}; {cure}", path.display())]
    Invalid {
        /// The file.
        path: PathBuf,
        /// Where in it.
        place: Place,
        /// What is wrong there.
        problem: String,
        /// What to do about it.
        cure: &'static str,
    },
    /// More data than a mesh of this program can have.
    #[error("{}: {place}{problem}; {cure}", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Where in it.
        place: Place,
        /// What is too large.
        problem: String,
        /// What to do about it.
        cure: &'static str,
    },
    /// A format, or a part of one, that is not read here.
    #[error("{}: {place}{problem}; {cure}", path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// Where in it.
        place: Place,
        /// What is not supported.
        problem: String,
        /// What to do about it.
        cure: &'static str,
    },
}

impl MeshError {
    /// The file that the error is about.
    pub fn path(&self) -> &Path {
        match self {
            Self::Io { path, .. }
            | Self::Malformed { path, .. }
            | Self::Invalid { path, .. }
            | Self::TooLarge { path, .. }
            | Self::Unsupported { path, .. } => path,
        }
    }

    /// True when there is no such file, as opposed to a file with bad contents.
    pub fn is_not_found(&self) -> bool {
        matches!(self, Self::Io { source, .. } if source.kind() == io::ErrorKind::NotFound)
    }

    /// True when the contents are at fault and not the file system.
    pub fn is_bad_data(&self) -> bool {
        !matches!(self, Self::Io { .. })
    }
}

/// A place in a mesh file. Lines count from 1, elements from 0 as their indices do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    File,
    /// A line of text; in a compressed file, of the text inside.
    Line(usize),
    /// A byte from the beginning, where binary data came before; in a compressed file, of the data inside.
    Byte(usize),
    /// An element of a list that the file declares.
    Element {
        /// The name of the list, such as `vertex`.
        name: String,
        /// Its index from 0.
        index: usize,
    },
}

impl Place {
    pub(super) fn element(name: &str, index: usize) -> Self {
        Self::Element { name: name.to_owned(), index }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => Ok(()),
            Self::Line(line) => write!(f, "line {line}: "),
            Self::Byte(byte) => write!(f, "byte {byte}: "),
            Self::Element { name, index } => write!(f, "{name} {index}: "),
        }
    }
}

/// Whose fault it is; the variants of [`MeshError`] that a format's reader can tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Blame {
    Malformed,
    Invalid,
    TooLarge,
    Unsupported,
}

/// An error before the file's name is known to it.
#[derive(Debug)]
pub(super) struct Fault {
    pub blame: Blame,
    pub place: Place,
    pub problem: String,
    pub cure: &'static str,
}

impl Fault {
    pub fn malformed(place: Place, problem: impl Into<String>, cure: &'static str) -> Self {
        Self { blame: Blame::Malformed, place, problem: problem.into(), cure }
    }

    pub fn invalid(place: Place, problem: impl Into<String>, cure: &'static str) -> Self {
        Self { blame: Blame::Invalid, place, problem: problem.into(), cure }
    }

    pub fn too_large(place: Place, problem: impl Into<String>, cure: &'static str) -> Self {
        Self { blame: Blame::TooLarge, place, problem: problem.into(), cure }
    }

    pub fn unsupported(place: Place, problem: impl Into<String>, cure: &'static str) -> Self {
        Self { blame: Blame::Unsupported, place, problem: problem.into(), cure }
    }

    /// The error of a file.
    pub fn in_file(self, path: &Path) -> MeshError {
        let Self { blame, place, problem, cure } = self;
        let path = path.to_owned();
        match blame {
            Blame::Malformed => MeshError::Malformed { path, place, problem, cure },
            Blame::Invalid => MeshError::Invalid { path, place, problem, cure },
            Blame::TooLarge => MeshError::TooLarge { path, place, problem, cure },
            Blame::Unsupported => MeshError::Unsupported { path, place, problem, cure },
        }
    }
}

/// Text of a file as a message can show it: one line, printable, at most 60 characters.
pub(super) fn excerpt(text: &[u8]) -> String {
    const LONGEST: usize = 60;
    let head = &text[..text.len().min(4 * LONGEST)];
    let head = String::from_utf8_lossy(head);
    let line: String = head.trim().chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let short: String = line.chars().take(LONGEST).collect();
    if short.len() < line.len() || head.len() < text.len() { format!("{short}...") } else { short }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_name_file_place_problem_and_cure() {
        let fault = Fault::invalid(Place::Line(7), "x is NaN", "write finite coordinates");
        let error = fault.in_file(Path::new("a/b.obj"));
        assert_eq!(error.to_string(), "a/b.obj: line 7: x is NaN; write finite coordinates");
        assert!(error.is_bad_data() && !error.is_not_found());
        let fault = Fault::too_large(Place::element("face", 3), "p", "c").in_file(Path::new("f"));
        assert_eq!(fault.to_string(), "f: face 3: p; c");
    }

    #[test]
    fn a_missing_file_is_told_apart() {
        let source = io::Error::from(io::ErrorKind::NotFound);
        let error = MeshError::Io { path: "x.ply".into(), source };
        assert!(error.is_not_found() && !error.is_bad_data());
        let source = io::Error::from(io::ErrorKind::PermissionDenied);
        assert!(!MeshError::Io { path: "x.ply".into(), source }.is_not_found());
    }

    #[test]
    fn excerpts_are_short_and_printable() {
        assert_eq!(excerpt(b" v 1 2 \r\n"), "v 1 2");
        assert_eq!(excerpt(b"a\tb\x01c"), "a b c");
        let long = excerpt(&[b'x'; 1000]);
        assert!(long.ends_with("...") && long.len() == 63, "{long}");
        assert!(excerpt(&[0xff, b'a']).ends_with('a'));
    }
}
