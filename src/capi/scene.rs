//! What a handle of C stands for: a renderer, the mesh that is next, and the picture that was last.
//!
//! | calls | wait for |
//! |---|---|
//! | `floe_render` | another `floe_render` of the same scene |
//! | `floe_set_mesh`, `floe_pixels`, `floe_record`, `floe_write`, `floe_error_message` | each other, never for a frame that is rendered |
//! | `floe_interrupt`, `floe_size` | nothing |
//!
//! So a simulation may set the mesh of the next frame from one thread while another renders. Scenes have nothing to do
//! with each other.

use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::status::{Failure, Status};
use crate::driver::renderer::IN_MEMORY;
use crate::driver::{Interrupt, RenderError, RenderOptions, Rendered, Renderer};
use crate::mesh::RawMesh;
use crate::scene::FrameError;
use crate::sequence::FrameNumber;

/// A scene that is open.
#[derive(Debug)]
pub struct Scene {
    renderer: Mutex<Renderer>,
    interrupt: Interrupt,
    resolution: [u32; 2],
    mesh: Mutex<Option<RawMesh>>,
    rendered: Mutex<Option<Arc<Rendered>>>,
    message: Mutex<String>,
}

/// Threads of C share it, and nobody checks that for them.
const _: () = {
    const fn is_shared<T: Send + Sync>() {}
    is_shared::<Scene>();
};

/// What panicked with a lock leaves whole values: each is replaced in one step.
fn locked<T>(value: &Mutex<T>) -> MutexGuard<'_, T> {
    value.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Scene {
    /// Opens a scene on so many threads, all cores for 0.
    pub(super) fn new(
        threads: u32,
        open: impl FnOnce(RenderOptions) -> Result<Renderer, RenderError>,
    ) -> Result<Self, Failure> {
        let threads = u16::try_from(threads).map_err(|_| {
            let message = format!("threads is {threads}: give at most {}, or 0 for all cores", u16::MAX);
            Failure::new(Status::BadArgument, message)
        })?;
        let threads = (threads > 0).then_some(threads.into());
        let interrupt = Interrupt::default();
        let options = RenderOptions { threads, interrupt: interrupt.clone(), ..RenderOptions::default() };
        let renderer = open(options)?;
        Ok(Self {
            resolution: renderer.resolution(),
            renderer: Mutex::new(renderer),
            interrupt,
            mesh: Mutex::default(),
            rendered: Mutex::default(),
            message: Mutex::default(),
        })
    }

    pub(super) fn resolution(&self) -> [u32; 2] {
        self.resolution
    }

    pub(super) fn set_mesh(&self, mesh: RawMesh) -> Result<(), Failure> {
        mesh.check(Path::new(IN_MEMORY)).map_err(|error| RenderError::from(FrameError::from(error)))?;
        *locked(&self.mesh) = Some(mesh);
        Ok(())
    }

    pub(super) fn render(&self, frame: i64) -> Result<(), Failure> {
        let number = FrameNumber::from_integer(frame).ok_or_else(|| {
            let limit = FrameNumber::LIMIT;
            let message = format!("frame {frame}: numbers of frames go from -{limit} to {limit}");
            Failure::new(Status::BadArgument, message)
        })?;
        let mut renderer = locked(&self.renderer);
        // A frame that fails must not leave that of another time in its place.
        *locked(&self.rendered) = None;
        let mesh = locked(&self.mesh).take().ok_or_else(|| {
            let message = format!("frame {frame}: there is no mesh; call floe_set_mesh before each frame");
            Failure::new(Status::TooEarly, message)
        })?;
        let rendered = renderer.render(number, mesh, &())?;
        *locked(&self.rendered) = Some(Arc::new(rendered));
        Ok(())
    }

    pub(super) fn interrupt(&self) {
        self.interrupt.request();
    }

    pub(super) fn rendered(&self) -> Result<Arc<Rendered>, Failure> {
        let none = || Failure::new(Status::TooEarly, "there is no picture; floe_render has not made one");
        locked(&self.rendered).clone().ok_or_else(none)
    }

    pub(super) fn keep_message(&self, text: String) {
        *locked(&self.message) = text;
    }

    pub(super) fn message(&self) -> String {
        locked(&self.message).clone()
    }
}
