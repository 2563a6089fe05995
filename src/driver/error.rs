//! Why a sequence, or a frame of it, was not rendered.

use std::path::PathBuf;

use crate::film::FilmError;
use crate::scene::FrameError;
use crate::scene::description::SceneError;
use crate::sequence::SequenceError;

/// What went wrong, for a frame or for the whole job.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The scene file.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Which files are frames.
    #[error(transparent)]
    Sequence(#[from] SequenceError),
    /// A frame's meshes or pictures.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// The picture could not be written.
    #[error(transparent)]
    Film(#[from] FilmError),
    /// Neither a scene file nor a folder.
    #[error("{path}: no such file or folder; give a scene file or a folder with frames")]
    NotFound {
        /// What was given.
        path: PathBuf,
    },
    /// A file beside the pictures cannot be written.
    #[error("{path}: cannot be written: {source}; check that the folder may be written to")]
    CannotWrite {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// Labels disagree so often that the picture would be wrong.
    #[error(
        "{path}: at {mismatches} of {rays} rays the surface belongs to another medium than the one the ray was in; \
         the mesh is open, overlaps itself, or its labels are wrong (the warnings above name places); no picture is written"
    )]
    Mismatches {
        /// The frame's file.
        path: PathBuf,
        /// How often.
        mismatches: u64,
        /// Of how many.
        rays: u64,
    },
    /// The threads could not be started.
    #[error("cannot start {threads} threads: {reason}; ask for fewer with --threads")]
    Threads {
        /// How many were asked for.
        threads: usize,
        /// What the system says.
        reason: String,
    },
}

/// Who is to blame, which is what exit codes tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Blame {
    /// The scene file says something that cannot be.
    Configuration,
    /// A file is there but bad.
    Data,
    /// A file is not there.
    Missing,
    /// An output cannot be created.
    CannotCreate,
    /// An output cannot be written.
    CannotWrite,
    /// The program or the machine.
    Internal,
}

impl RenderError {
    /// Who is to blame.
    pub fn blame(&self) -> Blame {
        match self {
            Self::Scene(SceneError::Io { .. }) | Self::NotFound { .. } => Blame::Missing,
            Self::Scene(_) => Blame::Configuration,
            Self::Sequence(SequenceError::NothingFound { .. } | SequenceError::Io { .. }) => Blame::Missing,
            Self::Sequence(_) => Blame::Configuration,
            Self::Frame(error) if error.is_not_found() => Blame::Missing,
            Self::Frame(_) | Self::Mismatches { .. } => Blame::Data,
            Self::Film(FilmError::CannotCreate { .. }) => Blame::CannotCreate,
            Self::Film(_) | Self::CannotWrite { .. } => Blame::CannotWrite,
            Self::Threads { .. } => Blame::Internal,
        }
    }
}
