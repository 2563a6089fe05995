//! The files of the `[[meshes]]`, frame by frame.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::scene::description::SceneDescription;
use crate::sequence::{FrameFile, FrameNumber, SequenceError, discover, frame_path, is_sequence};

/// One of the `[[meshes]]` that change from frame to frame.
#[derive(Clone, Debug)]
pub struct MeshSequence {
    /// Which.
    pub mesh: usize,
    /// Its files in order.
    pub files: Vec<FrameFile>,
    /// Its path in the scene file, with the folder of that.
    pattern: PathBuf,
}

impl MeshSequence {
    /// Finds the files of those that change.
    pub(super) fn of(scene: &SceneDescription) -> Result<Vec<Self>, SequenceError> {
        let meshes = scene.meshes.iter().enumerate();
        let moving = meshes.filter(|(_, mesh)| is_sequence(&scene.directory, &mesh.path));
        let found = moving.map(|(which, mesh)| {
            let files = discover(&scene.directory, &mesh.path)?;
            Ok(Self { mesh: which, files, pattern: scene.directory.join(&mesh.path) })
        });
        found.collect()
    }

    /// Every number that one of them has, with the first file of that number.
    pub(super) fn numbered(meshes: &[Self]) -> Vec<FrameFile> {
        let mut first = BTreeMap::new();
        for file in meshes.iter().flat_map(|mesh| &mesh.files) {
            first.entry(file.number).or_insert_with(|| file.clone());
        }
        first.into_values().collect()
    }

    /// The file of a frame: where it is, or ought to be.
    pub(super) fn file(&self, number: FrameNumber) -> PathBuf {
        let there = self.files.iter().find(|file| file.number == number);
        there.map_or_else(|| self.expected(number), |file| file.path.clone())
    }

    /// A folder or a glob has no one name for it.
    fn expected(&self, number: FrameNumber) -> PathBuf {
        let pattern = self.pattern.to_string_lossy();
        frame_path(&pattern, number).map_or_else(|_| self.pattern.clone(), |path| Path::new(&path).into())
    }
}
