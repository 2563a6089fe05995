//! A thread that renders what the loop hands it, so that the loop never stops looking.
//!
//! There are two: one makes finished pictures, the other previews, each on threads of its own. So a frame that has just
//! come is seen soon, and nothing that was begun is thrown away for it.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::Scope;

use rayon::ThreadPool;

use super::wake::News;
use crate::driver::ahead::{Preparation, Ready, timed};
use crate::driver::arrivals::Came;
use crate::driver::error::RenderError;
use crate::driver::fingerprint::Identity;
use crate::driver::job::{FrameTask, Job};
use crate::driver::picture::picture_path;
use crate::driver::ready::Signature;
use crate::driver::session::Session;
use crate::film::FrameImage;
use crate::film::png::encode_png;
use crate::film::write::write_atomically;
use crate::scene::assembly::{Assembled, Buffers, FrameMesh};
use crate::scene::inputs::Inputs;

/// A frame whose bytes were read, checked and hashed.
pub(super) struct Commission {
    /// Which, and where its file is.
    pub task: FrameTask,
    /// The mesh in those bytes.
    pub mesh: FrameMesh,
    /// The other files that it is made of.
    pub inputs: Inputs,
    /// What picture this makes.
    pub identity: Identity,
    /// The signature of the file.
    pub signature: Signature,
    /// When it came.
    pub came: Came,
    /// What reading it took.
    pub read_seconds: f64,
}

/// What became of it.
pub(super) struct Done {
    /// Which frame.
    pub task: FrameTask,
    /// Whether it is a preview.
    pub preview: bool,
    /// The hash of the mesh.
    pub mesh_hash: String,
    /// The signature of its file.
    pub signature: Signature,
    /// When it came.
    pub came: Came,
    /// The picture as PNG.
    pub outcome: Result<Vec<u8>, RenderError>,
}

/// The loop's end of a worker.
pub(super) struct Worker {
    commissions: Sender<Commission>,
    /// Whether it has something to do.
    pub busy: bool,
}

impl Worker {
    /// Starts a thread; `session` makes what the worker renders with.
    pub fn start<'scope, 'job: 'scope>(
        scope: &'scope Scope<'scope, '_>,
        mut easel: Easel<'job>,
        news: Sender<News>,
    ) -> Self {
        let (commissions, orders) = channel();
        scope.spawn(move || {
            let news = LastWord(news);
            easel.work(&orders, &news.0);
        });
        Self { commissions, busy: false }
    }

    /// Hands it a frame; it has to be idle.
    pub fn give(&mut self, commission: Commission) {
        self.busy = true;
        // If it has panicked, its last word is on the way.
        let _ = self.commissions.send(commission);
    }
}

/// Tells the loop when a worker ends, however it does.
struct LastWord(Sender<News>);

impl Drop for LastWord {
    fn drop(&mut self) {
        let _ = self.0.send(News::Gone);
    }
}

/// What a worker renders with.
pub(super) struct Easel<'a> {
    pub job: &'a Job,
    pub session: Session<'a>,
    pub pattern: String,
    pub pool: ThreadPool,
    pub preview: bool,
}

impl Easel<'_> {
    fn work(&mut self, commissions: &Receiver<Commission>, news: &Sender<News>) {
        let mut latest: Option<Assembled> = None;
        while let Ok(commission) = commissions.recv() {
            let Commission { task, mesh, inputs, identity, signature, came, read_seconds } = commission;
            let mesh_hash = identity.mesh_hash.clone();
            let mut preparation = Preparation { read_seconds, ..Preparation::default() };
            let world = &self.job.world;
            let previous = latest.take();
            let prepared = self.pool.install(|| {
                timed(&mut preparation.build_seconds, || {
                    let before = previous.as_ref().map(|assembled| &assembled.frame);
                    world.assemble_into(Buffers::default(), task.number, Some(mesh), inputs, before)
                })
            });
            preparation.wait_seconds = preparation.build_seconds;
            let prepared = prepared.map(|assembled| Ready { assembled, identity }).map_err(RenderError::from);
            let outcome = self.draw(&task, prepared.as_ref(), preparation);
            let outcome = match (outcome, prepared) {
                (outcome, Ok(ready)) => {
                    latest = Some(ready.assembled);
                    outcome
                }
                (_, Err(error)) => Err(error),
            };
            let done = Done { task, preview: self.preview, mesh_hash, signature, came, outcome };
            let _ = news.send(News::Done(Box::new(done)));
        }
    }
}
