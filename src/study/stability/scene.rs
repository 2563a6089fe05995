//! A scene that no file holds: the text of a scene file, and its meshes in memory.

use std::path::{Path, PathBuf};

use glam::DVec3;

use super::picture::{Picture, render};
use super::shapes::Shape;
use crate::driver::RenderError;
use crate::driver::tiles::Sampling;
use crate::mesh::RawMesh;
use crate::scene::assembly::FrameMesh;
use crate::scene::description::{Placement, SceneDescription};
use crate::scene::frame::Frame;
use crate::scene::inputs::Inputs;
use crate::scene::world::World;
use crate::sequence::FrameNumber;
use crate::study::StudyError;

/// What messages call the scene file.
const NAME: &str = "stability.toml";

/// A scene being put together.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    inputs: Inputs,
    frame: Vec<FrameMesh>,
}

/// A scene whose frame is ready for rays.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// The frame.
    pub frame: Frame,
    /// How its pixels are sampled.
    pub sampling: Sampling,
    /// What the user would be told.
    pub warnings: Vec<String>,
}

impl Scene {
    /// Without any files.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a mesh of `[[surfaces]]` or `[[meshes]]`.
    #[must_use]
    pub fn mesh(self, name: &str, shape: &Shape) -> Self {
        self.file(name, shape.ply().into_bytes())
    }

    /// Adds any file that the scene names.
    #[must_use]
    pub fn file(mut self, name: &str, contents: Vec<u8>) -> Self {
        // As the parser joins the folder of a bare name with what the scene says.
        self.inputs = self.inputs.with(Path::new(".").join(name), contents);
        self
    }

    /// Adds the mesh of the frame, for scenes with `[frames]`, or the next of those `[[meshes]]` that have a pattern.
    #[must_use]
    pub fn frame(mut self, mesh: RawMesh) -> Self {
        let path = PathBuf::from(format!("frame mesh {}", self.frame.len() + 1));
        self.frame.push(FrameMesh { path, mesh });
        self
    }

    /// Makes the scene of this text ready for rays. A camera without `eye` and `target` looks at the origin from (0, -4, 0).
    ///
    /// # Errors
    /// What is wrong with the text or a mesh.
    pub fn prepare(&self, text: &str) -> Result<Prepared, StudyError> {
        self.prepare_after(text, None)
    }

    /// The same with what is kept of the frame before it.
    ///
    /// # Errors
    /// Those of [`Self::prepare`].
    pub fn prepare_after(&self, text: &str, before: Option<&Frame>) -> Result<Prepared, StudyError> {
        let description = SceneDescription::parse(text, Path::new(NAME)).map_err(RenderError::from)?;
        let sampling = Sampling::new(&description.render);
        let placement = Placement { eye: DVec3::new(0.0, -4.0, 0.0), target: DVec3::ZERO };
        let world =
            World::of_inputs(description, placement, self.inputs.clone()).map_err(RenderError::from)?;
        let assembled = world
            .assemble(FrameNumber::ONE, self.frame.iter().cloned(), before)
            .map_err(RenderError::from)?;
        Ok(Prepared { frame: assembled.frame, sampling, warnings: assembled.warnings })
    }

    /// Renders the scene of this text with the samples that it asks for.
    ///
    /// # Errors
    /// Those of [`Self::prepare`].
    pub fn render(&self, text: &str) -> Result<Picture, StudyError> {
        Ok(render(&self.prepare(text)?))
    }
}
