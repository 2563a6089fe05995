//! Renders meshes that are in memory: a simulator draws its frames without writing them.
//!
//! The mesh takes the place of the files of `[frames]`; all else is as the scene says, and a frame has the pixels, to the
//! last bit, that it would have from a file with the same numbers. What a mesh of V vertices and T triangles takes:
//!
//! ```text
//! 24 V + 12 T bytes, + 8 T with labels, + 12 V with velocities
//!                        a mesh that is moved in: the simulator's own, nothing is copied, and all is free again when
//!                        its triangles are in the frame. From slices: one copy, which goes the same way
//! the frame              positions in single precision, normals, the hierarchy: kept until the next frame is made, whose
//!                        hierarchy begins with that of this one where triangles are the same
//! ```
//! Of a closed mesh of 131,072 triangles the first frame takes at most 231 bytes a triangle beyond the mesh, one that is
//! refitted 124, and 90 are kept; a copy is 32. `tests/in_process_memory.rs` measures it and checks that there are no others.

use std::path::Path;

use glam::DVec3;
use rayon::ThreadPool;

use super::ahead::{Pools, Preparation, timed};
use super::error::RenderError;
use super::fingerprint::{Fingerprints, Identity, STANDS_STILL};
use super::guard::guarded;
use super::job::{FrameTask, Job, bounds_of};
use super::ledger::Status;
use super::render::{Observer, RenderOptions};
use super::rendered::Rendered;
use super::session::{Of, Session};
use crate::mesh::{RawMesh, VelocityName};
use crate::scene::assembly::{Assembled, Buffers, FrameMesh};
use crate::scene::description::{Placement, SceneDescription, automatic_placement};
use crate::scene::frame::Frame;
use crate::scene::inputs::Inputs;
use crate::scene::world::World;
use crate::sequence::FrameNumber;

/// What messages call a mesh that no file holds.
pub const IN_MEMORY: &str = "mesh in memory";

/// Renders one mesh after the other.
#[derive(Debug)]
pub struct Renderer {
    description: SceneDescription,
    options: RenderOptions,
    threads: ThreadPool,
    /// There once it is known where the camera is.
    job: Option<Job>,
    latest: Option<Frame>,
}

impl Renderer {
    /// Opens a scene file. `frames.path` is not looked for; without `[frames]` its defaults hold. A scene that does not say
    /// where its camera is has it where it frames the first mesh.
    ///
    /// Of the options `samples`, `target_error`, `time_budget`, `seed`, `threads` and `interrupt` hold; the others are
    /// about files.
    ///
    /// # Errors
    /// When the scene is wrong, a file that it names is, or the threads cannot be started.
    pub fn open(scene: &Path, options: RenderOptions) -> Result<Self, RenderError> {
        Self::new(SceneDescription::from_file(scene)?, options)
    }

    /// Takes the text of a scene file; `file` is what messages call it, and its folder is what inputs are relative to.
    ///
    /// # Errors
    /// Those of [`Renderer::open`].
    pub fn parse(text: &str, file: &Path, options: RenderOptions) -> Result<Self, RenderError> {
        Self::new(SceneDescription::parse(text, file)?, options)
    }

    /// Takes a scene as it is.
    ///
    /// # Errors
    /// Those of [`Renderer::open`].
    pub fn new(mut description: SceneDescription, options: RenderOptions) -> Result<Self, RenderError> {
        if !description.meshes.is_empty() {
            return Err(RenderError::MeshesInMemory { scene: description.file });
        }
        description.frames.get_or_insert_default();
        let options = RenderOptions { samples_range: None, ..options };
        let threads = Pools::render_only(options.threads)?;
        let placement = description.camera.placement;
        let job = placement.map(|placement| job_of(&description, placement)).transpose()?;
        Ok(Self { description, options, threads, job, latest: None })
    }

    /// Columns and rows of its pictures.
    pub fn resolution(&self) -> [u32; 2] {
        self.description.camera.resolution
    }

    /// Renders a mesh as a frame of this number, which tells the camera's place and the random numbers.
    ///
    /// The mesh is checked and prepared as one from a file; whatever is wrong with it costs this frame only. It may be
    /// moved in, or be a copy of [`MeshSlices`](crate::mesh::MeshSlices). A request to stop ends the frame that is being
    /// rendered, or the next one, and is then over. The observer hears of tiles and warnings. Nothing is denoised.
    ///
    /// # Errors
    /// Those of a frame from a file, and [`RenderError::Stopped`].
    pub fn render(
        &mut self,
        number: impl Into<FrameNumber>,
        mesh: impl Into<RawMesh>,
        observer: &dyn Observer,
    ) -> Result<Rendered, RenderError> {
        let (number, mesh) = (number.into(), mesh.into());
        let is_first = self.job.is_none();
        let rendered = guarded(Path::new(IN_MEMORY), || self.frame(number, mesh, observer));
        // A mesh that made no frame is none to frame by.
        if is_first && self.latest.is_none() {
            self.job = None;
        }
        self.options.interrupt.withdraw();
        rendered
    }

    /// Frees the memory of the latest frame. The next hierarchy is made anew.
    pub fn forget(&mut self) {
        self.latest = None;
    }

    fn frame(
        &mut self,
        number: FrameNumber,
        mut mesh: RawMesh,
        observer: &dyn Observer,
    ) -> Result<Rendered, RenderError> {
        mesh.check(Path::new(IN_MEMORY)).map_err(crate::scene::FrameError::from)?;
        let Self { description, options, threads, job, latest } = self;
        let job = match job {
            Some(job) => job,
            None => job.insert(job_of(description, framed(description, &mesh))?),
        };
        let world = &job.world;
        if world.velocity_name() == VelocityName::Nothing {
            mesh.velocities = None;
        }
        let mut session = Session::unrecorded(job, options, observer);
        let inputs = Inputs::of_frame(world, number, &[])?;
        let fingerprints = Fingerprints::new(world, &options.settings(&world.description.render));
        let identity = Identity::new(&fingerprints, number, &[mesh.content_hash()], &inputs.hashes());
        let task = FrameTask { number, files: vec![IN_MEMORY.into()], next: None };
        let mut preparation = Preparation::default();
        let assembled = timed(&mut preparation.build_seconds, || {
            threads.install(|| assembled(world, number, mesh, inputs, latest.as_ref()))
        })?;
        let mut record = session.record(&task, preparation);
        let draw = |session: &Session| session.draw(&assembled.frame, None);
        let drawn = threads.install(|| session.trace(&task, &assembled, true, &mut record, draw));
        let of = Of { number, identity: &identity, stopped_by: record.stopped_by };
        let metadata = session.metadata(&assembled.frame.views.opening, of, false);
        // Also of a picture that failed: where the triangles are is right.
        *latest = Some(assembled.frame);
        record.status = Status::Complete;
        let image = drawn.map_err(|error| match error {
            RenderError::Interrupted => RenderError::Stopped { number },
            other => other,
        })?;
        Ok(Rendered { image, record, metadata, output: world.description.output.clone() })
    }
}

fn job_of(description: &SceneDescription, placement: Placement) -> Result<Job, RenderError> {
    let world = World::new(description.clone(), placement)?;
    Ok(Job { world, files: Vec::new(), meshes: Vec::new(), written_scene: None, name: String::new() })
}

/// A camera on the bounds of the first mesh.
fn framed(description: &SceneDescription, mesh: &RawMesh) -> Placement {
    let scale = description.frames.as_ref().map_or(1.0, |frames| frames.scale);
    let camera = &description.camera;
    let bounds: [DVec3; 2] = bounds_of(mesh).into();
    automatic_placement(bounds.map(|corner| corner * scale).into(), camera.up, camera.fov, camera.resolution)
}

fn assembled(
    world: &World,
    number: FrameNumber,
    mesh: RawMesh,
    inputs: Inputs,
    previous: Option<&Frame>,
) -> Result<Assembled, RenderError> {
    let mesh = FrameMesh { path: IN_MEMORY.into(), mesh };
    let mut assembled = world.assemble_into(Buffers::default(), number, Some(mesh), inputs, previous)?;
    if world.follows_vertices() {
        let text = format!("{IN_MEMORY}: there is no next frame to take velocities from; {STANDS_STILL}");
        assembled.warnings.push(text);
    }
    Ok(assembled)
}
