//! Why a frame cannot be made ready for rays.

use std::path::PathBuf;

use super::domain::DomainError;
use super::layers::Insides;
use crate::light::ImageError;
use crate::mesh::MeshError;
use crate::optics::particles::MixtureError;
use crate::optics::volume::VolumeError;
use crate::sequence::SequenceError;

/// What went wrong between the files and the rays.
#[derive(Debug, thiserror::Error)]
pub enum FrameError {
    /// A mesh cannot be read.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The picture of the sky cannot be read.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// The grid of a medium's density cannot be read.
    #[error(transparent)]
    Volume(#[from] VolumeError),
    /// A pattern of a surface's mesh cannot be filled in.
    #[error(transparent)]
    Sequence(#[from] SequenceError),
    /// The domain does not fit.
    #[error("{path}: {source}")]
    Domain {
        /// The frame's file.
        path: PathBuf,
        /// What is wrong.
        source: DomainError,
    },
    /// What is in a medium cannot be computed.
    #[error("{scene}: [media.{medium}]: {source}")]
    Mixture {
        /// The scene file.
        scene: PathBuf,
        /// Name of the medium.
        medium: String,
        /// What is wrong.
        source: Box<MixtureError>,
    },
    /// A label has no medium.
    #[error("{path}: label {label} has no medium; add `{label} = \"NAME\"` to [regions] in {scene}")]
    NoMedium {
        /// The frame's file.
        path: PathBuf,
        /// The label.
        label: i32,
        /// The scene file.
        scene: PathBuf,
    },
    /// A label of one of the `[[meshes]]` has no medium.
    #[error(
        "{path}: label {label} has no medium; add `{label} = \"NAME\"` to regions of this mesh in {scene}"
    )]
    NoMediumInMesh {
        /// The mesh.
        path: PathBuf,
        /// The label.
        label: i32,
        /// The scene file.
        scene: PathBuf,
    },
    /// A mesh has labels where it was not said what they are.
    #[error(
        "{path}: its triangles carry labels: in {scene}, write regions = {{ 1 = \"NAME\" }} for this mesh in place of `inside`"
    )]
    Labelled {
        /// The mesh.
        path: PathBuf,
        /// The scene file.
        scene: PathBuf,
    },
    /// More meshes overlap than a ray keeps account of.
    #[error(
        "{scene}: the [[meshes]] that overlap have more than {} regions: write some of them as one labelled mesh",
        Insides::MOST
    )]
    TooManyLayers {
        /// The scene file.
        scene: PathBuf,
    },
    /// A vertex cannot be expressed in single precision.
    #[error(
        "{path}: vertex {vertex} is {distance:e} m from the camera, more than single precision holds; check frames.scale"
    )]
    TooFar {
        /// The frame's file.
        path: PathBuf,
        /// Which vertex.
        vertex: usize,
        /// Its distance.
        distance: f64,
    },
}

impl FrameError {
    /// True when a file is not there, as opposed to being bad.
    pub fn is_not_found(&self) -> bool {
        match self {
            Self::Mesh(error) => error.is_not_found(),
            Self::Image(ImageError::Io { source, .. }) | Self::Volume(VolumeError::Io { source, .. }) => {
                source.kind() == std::io::ErrorKind::NotFound
            }
            _ => false,
        }
    }
}
