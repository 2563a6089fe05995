//! The files that a scene names, each read once, so that what is parsed is what was hashed: files may change at any time.

use std::io;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use super::error::FrameError;
use super::world::World;
use crate::light::{ImageError, Picture};
use crate::mesh::{self, MeshError, RawMesh, VelocityName};
use crate::optics::volume::{self, Volume, VolumeError};
use crate::sequence::FrameNumber;

/// SHA-256 of the contents of a file.
pub type ContentHash = [u8; 32];

/// In place of the hash of a file that is not there; no contents are known that hash to it.
pub const NO_FILE: ContentHash = [0; 32];

/// Contents of files in the order in which they were first asked for.
#[derive(Clone, Debug, Default)]
pub struct Inputs {
    files: Vec<(PathBuf, Vec<u8>)>,
    /// The meshes of the frame, each with the file beside it that has its velocities.
    velocities: Vec<(PathBuf, Option<PathBuf>)>,
}

impl Inputs {
    /// Every file that only one frame is made of, its own `meshes` aside but not the velocities beside them.
    ///
    /// # Errors
    /// When one cannot be read, or a pattern cannot be filled in.
    pub fn of_frame(world: &World, number: FrameNumber, meshes: &[PathBuf]) -> Result<Self, FrameError> {
        let mut inputs = Self::default();
        for mesh in meshes {
            let beside = mesh::velocities_beside(mesh, &world.velocity_name());
            beside.as_ref().map_or(Ok(&[][..]), |path| inputs.mesh_bytes(path))?;
            inputs.velocities.push((mesh.clone(), beside));
        }
        for path in world.surfaces_of_frame(number) {
            inputs.mesh_bytes(&path?.1)?;
        }
        for path in world.grids_of_frame(number) {
            inputs.volume_bytes(&path?)?;
        }
        Ok(inputs)
    }

    /// A file that need not be on any disk.
    #[must_use]
    pub fn with(mut self, path: PathBuf, contents: Vec<u8>) -> Self {
        self.files.push((path, contents));
        self
    }

    /// The names of those files; such as are wrong are told by [`Self::of_frame`].
    pub fn paths_of_frame(world: &World, number: FrameNumber, mesh: &Path) -> Vec<PathBuf> {
        let velocities = mesh::velocities_beside(mesh, &world.velocity_name());
        let surfaces = world.surfaces_of_frame(number).filter_map(|found| Some(found.ok()?.1));
        velocities.into_iter().chain(surfaces).chain(world.grids_of_frame(number).flatten()).collect()
    }

    /// Names and contents of the meshes of surfaces that only one frame has.
    pub fn surfaces(&self, world: &World, number: FrameNumber) -> Vec<(&Path, &[u8])> {
        let wanted: Vec<PathBuf> = world.surfaces_of_frame(number).flatten().map(|(_, path)| path).collect();
        let files = self.files.iter().filter(|(path, _)| wanted.contains(path));
        files.map(|(path, bytes)| (path.as_path(), bytes.as_slice())).collect()
    }

    /// The hash of each file, behind which meshes have velocities beside them: [`NO_FILE`] where there are none.
    pub fn hashes(&self) -> Vec<ContentHash> {
        let hash = |bytes: &[u8]| -> ContentHash { Sha256::digest(bytes).into() };
        let beside = self.velocities.iter().map(|(_, beside)| beside.as_deref());
        let beside = beside.map(|path| path.and_then(|path| self.known(path)).map_or(NO_FILE, hash));
        beside.chain(self.files.iter().map(|(_, bytes)| hash(bytes))).collect()
    }

    pub(super) fn mesh(&mut self, path: &Path, velocity: &VelocityName) -> Result<RawMesh, MeshError> {
        mesh::parse(self.mesh_bytes(path)?, velocity, path)
    }

    /// Gives a mesh the velocities of the file that was beside it when these were read, if they are asked for.
    ///
    /// # Errors
    /// When it is wrong.
    pub fn add_velocities(
        &self,
        mesh: &mut RawMesh,
        path: &Path,
        velocity: &VelocityName,
    ) -> Result<(), MeshError> {
        if *velocity == VelocityName::Nothing {
            return Ok(());
        }
        // The file may have come or gone meanwhile: what counts is what the fingerprint knows of.
        let beside =
            self.velocities.iter().find(|(of, _)| of == path).and_then(|(_, beside)| beside.as_deref());
        let known = beside.and_then(|beside| Some((beside, self.known(beside)?)));
        known.map_or(Ok(()), |(beside, bytes)| mesh::add_velocities(mesh, bytes, beside))
    }

    /// The contents of a file that has been asked for.
    fn known(&self, path: &Path) -> Option<&[u8]> {
        self.files.iter().find(|(known, _)| known == path).map(|(_, bytes)| bytes.as_slice())
    }

    pub(super) fn volume(&mut self, path: &Path) -> Result<Volume, VolumeError> {
        volume::read_bytes(self.volume_bytes(path)?, path)
    }

    pub(super) fn picture(&mut self, path: &Path) -> Result<Picture, ImageError> {
        let bytes = self.bytes(path).map_err(|source| ImageError::Io { path: path.into(), source })?;
        Picture::read_bytes(bytes, path)
    }

    fn mesh_bytes(&mut self, path: &Path) -> Result<&[u8], MeshError> {
        self.bytes(path).map_err(|source| MeshError::Io { path: path.into(), source })
    }

    fn volume_bytes(&mut self, path: &Path) -> Result<&[u8], VolumeError> {
        self.bytes(path).map_err(|source| VolumeError::Io { path: path.into(), source })
    }

    fn bytes(&mut self, path: &Path) -> io::Result<&[u8]> {
        let at = match self.files.iter().position(|(known, _)| known == path) {
            Some(at) => at,
            None => {
                self.files.push((path.into(), std::fs::read(path)?));
                self.files.len() - 1
            }
        };
        Ok(&self.files[at].1)
    }
}
