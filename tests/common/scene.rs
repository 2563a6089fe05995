//! A scene in a folder that goes away with it.

use std::path::PathBuf;

use floe::driver::{Job, RenderError};

use super::mesh::TestMesh;
use super::render::{Prepared, prepare};

/// A temporary folder with a scene file and meshes.
pub struct SceneFolder {
    folder: tempfile::TempDir,
}

impl SceneFolder {
    /// An empty folder.
    pub fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap_or_else(|e| panic!("no temporary folder: {e}")) }
    }

    /// Adds a mesh.
    #[must_use]
    pub fn mesh(self, name: &str, mesh: &TestMesh) -> Self {
        self.file(name, mesh.ply().as_bytes())
    }

    /// Adds any file.
    #[must_use]
    pub fn file(self, name: &str, bytes: &[u8]) -> Self {
        let path = self.path(name);
        std::fs::write(&path, bytes).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        self
    }

    /// The scene of this text, ready for rays.
    pub fn scene(&self, toml: &str) -> Prepared {
        let file = self.path("scene.toml");
        std::fs::write(&file, toml).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        prepare(&file)
    }

    /// Why the scene of this text cannot be opened.
    pub fn refused(&self, toml: &str) -> RenderError {
        let file = self.path("scene.toml");
        std::fs::write(&file, toml).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        Job::open(&file).err().unwrap_or_else(|| panic!("this scene was opened: {toml}"))
    }

    /// Why the first frame of the scene of this text cannot be made ready.
    pub fn not_assembled(&self, toml: &str) -> RenderError {
        let file = self.path("scene.toml");
        std::fs::write(&file, toml).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        let job = Job::open(&file).unwrap_or_else(|e| panic!("{e}"));
        let task = job.tasks().swap_remove(0);
        let read = task.read(&job.world);
        let assembled = read.and_then(|frame| Ok(job.world.assemble(task.number, frame.meshes, None)?));
        assembled.err().unwrap_or_else(|| panic!("this scene was assembled: {toml}"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }
}
