//! Why a sequence, or a frame of it, was not rendered.

use std::path::PathBuf;

use super::samples_range::SamplesRange;
use crate::film::{DenoiseError, FilmError};
use crate::scene::FrameError;
use crate::scene::description::SceneError;
use crate::scene::domain::DomainError;
use crate::sequence::{FrameNumber, SequenceError};

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
    /// The picture could not be denoised.
    #[error(transparent)]
    Denoise(#[from] DenoiseError),
    /// A scene file is text, and the name of the folder is not.
    #[error("{}: the name of this folder is not UTF-8, so no scene file can be written for it; rename it", path.display())]
    NotUtf8 {
        /// The folder.
        path: PathBuf,
    },
    /// Neither a scene file nor a folder.
    #[error("{path}: no such file or folder; give a scene file or a folder with frames")]
    NotFound {
        /// What was given.
        path: PathBuf,
    },
    /// One of several meshes has no file of a frame that others have.
    #[error(
        "{path}: there is no such file of frame {number}, which others of the [[meshes]] have; each needs a file of every \
         frame: write it, or leave the frame out with --frames"
    )]
    MissingMesh {
        /// The file, or the pattern where that does not tell its name.
        path: PathBuf,
        /// The frame.
        number: FrameNumber,
    },
    /// The scene has no frames that could come.
    #[error(
        "{scene}: there is no [frames] in it, so there is nothing to wait for; draw it with `floe render`"
    )]
    NothingToWatch {
        /// The scene file.
        scene: PathBuf,
    },
    /// A watch waits for one file a frame.
    #[error(
        "{scene}: `floe watch` follows the one mesh a frame that [frames] names; with [[meshes]] draw what is there with \
         `floe render --resume`, again when there is more"
    )]
    SeveralMeshes {
        /// The scene file.
        scene: PathBuf,
    },
    /// A mesh in memory stands for the one mesh of `[frames]`.
    #[error(
        "{scene}: a mesh in memory takes the place of the one that [frames] names, and there are [[meshes]]: give one mesh \
         with labels, or render from files"
    )]
    MeshesInMemory {
        /// The scene file.
        scene: PathBuf,
    },
    /// The scene that was written for a folder of this name is about another folder.
    #[error(
        "{scene}: its frames.path is `{frames}`, not in {folder}: it was written for another folder of the same name; \
         put a scene.toml into {folder}, or move {scene} away, or run in another folder"
    )]
    OtherFolder {
        /// The scene file beside the output.
        scene: PathBuf,
        /// What it says of its frames.
        frames: String,
        /// The folder that was given.
        folder: PathBuf,
    },
    /// The name of the pictures is not that of OpenEXR files.
    #[error(
        "the output `{pattern}` does not end with .exr: write for example `{example}` (a PNG is written beside it)"
    )]
    NotExr {
        /// The name, or pattern of names.
        pattern: String,
        /// A name that would do.
        example: String,
    },
    /// The ledger cannot be made.
    #[error("{path}: cannot be created: {source}; check that the folder may be written to")]
    CannotCreate {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The ledger cannot be written.
    #[error("{path}: cannot be written: {source}; check the space on the disk")]
    CannotWrite {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// Labels disagree so often that the picture would be wrong.
    #[error(
        "{path}: at {mismatches} of {rays} rays the surface belongs to another medium than the one the ray was in; \
         the mesh is open, overlaps itself, or its labels are wrong (a warning for this frame, if there is one, names the place); \
         closed meshes that touch or overlap may each be a file of [[meshes]]; no picture is written"
    )]
    Mismatches {
        /// The frame's file.
        path: PathBuf,
        /// How often.
        mismatches: u64,
        /// Of how many.
        rays: u64,
    },
    /// The samples of a frame cannot be parted so.
    #[error("--samples-range {range}: {problem}")]
    SamplesRange {
        /// What was asked for.
        range: SamplesRange,
        /// Why not, and what to do.
        problem: String,
    },
    /// A partial that is no part of the frame, or not the only one.
    #[error("{path}: the partial {problem}")]
    Partial {
        /// The file.
        path: PathBuf,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// Samples that no partial has.
    #[error(
        "{picture}: samples {gaps} of {samples} are in no partial beside it; render them with --samples-range {first}, or \
         wait for those who do"
    )]
    NoSamples {
        /// The picture that is to be.
        picture: PathBuf,
        /// The ranges.
        gaps: String,
        /// Samples in all.
        samples: u32,
        /// The first of the ranges.
        first: SamplesRange,
    },
    /// No frame has anything to be merged.
    #[error(
        "there are no partials beside {pictures}: render them with --samples-range, or tell with --output where they are"
    )]
    NothingToMerge {
        /// The pattern of the pictures.
        pictures: String,
    },
    /// The run was asked to stop.
    #[error("interrupted; what is done is kept, and the same command with --resume goes on")]
    Interrupted,
    /// A frame in memory was asked to stop.
    #[error(
        "frame {number}: it was stopped before it had its samples, and nothing of it is kept; render it again"
    )]
    Stopped {
        /// Its number.
        number: FrameNumber,
    },
    /// Frames follow each other in one sequence of random numbers, and this one has no place there.
    #[error(
        "frame {number}: seed_mode = \"sequence\" takes frames with whole numbers only; \
         write seed_mode = \"frame\" into [render] of the scene file"
    )]
    DecimalFrame {
        /// Its number.
        number: FrameNumber,
    },
    /// floe itself is wrong.
    #[error(
        "{path}: floe fails on this frame ({reason}), which is a fault of floe whatever the file says: please report it \
         together with the file, and draw the other frames with --keep-going"
    )]
    Fault {
        /// The frame's file.
        path: PathBuf,
        /// What the panic says.
        reason: String,
    },
    /// Restarts of a job bring nothing new.
    #[error(
        "{path}: restart {count} of job {job} finds frame {number} as the {fruitless} restarts before it did, none of which \
         brought a picture or a sample more: it gives up; {cure}. To try again remove this file"
    )]
    Fruitless {
        /// Where it is noted what restarts found.
        path: PathBuf,
        /// The first frame that is not done.
        number: FrameNumber,
        /// The job.
        job: u64,
        /// How often it was started again.
        count: u32,
        /// Restarts before this one that brought nothing.
        fruitless: u32,
        /// What may be wrong, and what to do.
        cure: String,
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
    /// Whoever stopped the run.
    Interrupted,
}

impl RenderError {
    /// Who is to blame.
    pub fn blame(&self) -> Blame {
        match self {
            Self::Scene(SceneError::Io { .. })
            | Self::NotFound { .. }
            | Self::MissingMesh { .. }
            | Self::NoSamples { .. }
            | Self::NothingToMerge { .. } => Blame::Missing,
            Self::Scene(_) | Self::NotUtf8 { .. } => Blame::Configuration,
            Self::Sequence(error) => blame_of_sequence(error),
            Self::NotExr { .. }
            | Self::OtherFolder { .. }
            | Self::NothingToWatch { .. }
            | Self::SeveralMeshes { .. }
            | Self::SamplesRange { .. }
            | Self::MeshesInMemory { .. }
            | Self::DecimalFrame { .. } => Blame::Configuration,
            Self::Frame(error) if error.is_not_found() => Blame::Missing,
            Self::Frame(
                FrameError::NoMedium { .. }
                | FrameError::NoMediumInMesh { .. }
                | FrameError::Labelled { .. }
                | FrameError::TooManyLayers { .. },
            ) => Blame::Configuration,
            Self::Frame(FrameError::Domain { source, .. }) => blame_of_domain(source),
            Self::Frame(FrameError::Sequence(error)) => blame_of_sequence(error),
            Self::Frame(_) | Self::Mismatches { .. } | Self::Partial { .. } => Blame::Data,
            Self::Film(FilmError::CannotCreate { .. }) | Self::CannotCreate { .. } => Blame::CannotCreate,
            Self::Film(_) | Self::CannotWrite { .. } => Blame::CannotWrite,
            Self::Threads { .. } | Self::Fruitless { .. } | Self::Fault { .. } | Self::Denoise(_) => {
                Blame::Internal
            }
            Self::Interrupted | Self::Stopped { .. } => Blame::Interrupted,
        }
    }
}

fn blame_of_sequence(error: &SequenceError) -> Blame {
    match error {
        SequenceError::NothingFound { .. }
        | SequenceError::Io { .. }
        | SequenceError::NoneSelected { .. }
        | SequenceError::NotThere { .. } => Blame::Missing,
        SequenceError::DuplicateNumber { .. } | SequenceError::Number { .. } => Blame::Data,
        SequenceError::SeveralSequences { .. }
        | SequenceError::Unnumbered { .. }
        | SequenceError::Pattern { .. }
        | SequenceError::NoPlace { .. }
        | SequenceError::Selection { .. }
        | SequenceError::Shard { .. } => Blame::Configuration,
    }
}

fn blame_of_domain(error: &DomainError) -> Blame {
    match error {
        DomainError::Unlabelled { .. } | DomainError::TooLarge { .. } => Blame::Data,
        DomainError::Box { .. }
        | DomainError::BottomKept
        | DomainError::BottomAlone
        | DomainError::TopExtended => Blame::Configuration,
    }
}
