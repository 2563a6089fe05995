//! What can be wrong with a scene file.

use std::fmt;
use std::io;
use std::path::PathBuf;

/// A place in a scene file; lines and columns (in characters) count from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The scene file.
    pub file: PathBuf,
    /// Line.
    pub line: usize,
    /// Column.
    pub column: usize,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.file.display(), self.line, self.column)
    }
}

/// What can be wrong with a scene file, by what has to be mended.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The file cannot be read.
    #[error("cannot read the scene file {}: {source}: check that it exists and that it may be read", file.display())]
    Io {
        /// The scene file.
        file: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The file is far too long for a scene.
    #[error("{} has more than {limit} bytes: a scene file is a short text in TOML; give the scene file or its folder", file.display())]
    TooLong {
        /// The file.
        file: PathBuf,
        /// The greatest length that is read.
        limit: u64,
    },
    /// The text is not TOML.
    #[error("{place}: this is not TOML: {message}")]
    Syntax {
        /// Where.
        place: Place,
        /// What the parser says.
        message: String,
    },
    /// A key that means nothing.
    #[error("{place}: unknown key `{key}` in {table}{cure}")]
    UnknownKey {
        /// Where the key stands.
        place: Place,
        /// The key.
        key: String,
        /// The table that holds it.
        table: String,
        /// The nearest known key, or all of them.
        cure: String,
    },
    /// A key without which the table means nothing.
    #[error("{place}: {table} has no `{key}`: {cure}")]
    MissingKey {
        /// Where the table starts.
        place: Place,
        /// The table.
        table: String,
        /// The key that it needs.
        key: &'static str,
        /// What to write.
        cure: String,
    },
    /// A value that cannot be used.
    #[error("{place}: {what}: {found}: {cure}")]
    Invalid {
        /// Where the value stands.
        place: Place,
        /// Which value it is, such as `media.sea.ior`.
        what: String,
        /// The value as written.
        found: String,
        /// What is expected.
        cure: String,
    },
}

impl SceneError {
    /// Where it is, if it is in a text.
    pub(super) fn place_mut(&mut self) -> Option<&mut Place> {
        match self {
            Self::Io { .. } | Self::TooLong { .. } => None,
            Self::Syntax { place, .. }
            | Self::UnknownKey { place, .. }
            | Self::MissingKey { place, .. }
            | Self::Invalid { place, .. } => Some(place),
        }
    }
}
