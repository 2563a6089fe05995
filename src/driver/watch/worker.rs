//! A thread that renders what the loop hands it, so that the loop never stops looking.
//!
//! There are two: one makes finished pictures, the other previews, each on threads of its own. So a frame that has just
//! come is seen soon, and nothing that was begun is thrown away for it.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::Scope;

use rayon::ThreadPool;

use super::showcase::Showcase;
use super::status::Rendering;
use super::wake::News;
use crate::driver::ahead::{Preparation, Ready, timed};
use crate::driver::arrivals::Came;
use crate::driver::error::RenderError;
use crate::driver::fingerprint::{Fingerprint, Identity};
use crate::driver::guard::guarded;
use crate::driver::job::{FrameTask, Job};
use crate::driver::ledger::FrameRecord;
use crate::driver::picture::picture_path;
use crate::driver::ready::Signature;
use crate::driver::render::Observer;
use crate::driver::session::Session;
use crate::film::{FrameImage, png_bytes};
use crate::scene::assembly::{Assembled, Buffers, FrameMesh};
use crate::scene::inputs::Inputs;
use crate::sequence::FrameNumber;

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
    /// The signature of its files.
    pub signature: Signature,
    /// When it came.
    pub came: Came,
    /// What reading it took.
    pub read_seconds: f64,
}

/// What became of it.
pub(super) struct Done {
    /// Which frame.
    pub number: FrameNumber,
    /// Whether it is a preview.
    pub preview: bool,
    /// What the picture is of.
    pub fingerprint: Fingerprint,
    /// The signature of its files.
    pub signature: Signature,
    /// When it came.
    pub came: Came,
    /// The picture as PNG, or why there is none; `None` when it was to stop.
    pub outcome: Option<Result<Vec<u8>, RenderError>>,
}

/// The loop's end of a worker.
pub(super) struct Worker {
    commissions: Sender<Commission>,
    /// Whether it has something to do.
    pub busy: bool,
}

impl Worker {
    /// Starts a thread that renders with an easel until this end is dropped.
    pub fn start<'scope, 'job: 'scope>(
        scope: &'scope Scope<'scope, '_>,
        mut easel: Easel<'job>,
        news: Sender<News>,
    ) -> Self {
        let (commissions, receiver) = channel();
        scope.spawn(move || {
            let news = LastWord(news);
            easel.work(&receiver, &news.0);
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
    pub pattern: &'a str,
    pub showcase: &'a Showcase,
    pub pool: ThreadPool,
    pub observer: &'a Tagged<'a>,
}

impl Easel<'_> {
    fn work(&mut self, commissions: &Receiver<Commission>, news: &Sender<News>) {
        let mut latest: Option<Assembled> = None;
        while let Ok(commission) = commissions.recv() {
            let Commission { task, mesh, inputs, identity, signature, came, read_seconds } = commission;
            let fingerprint = identity.fingerprint;
            let mut preparation = Preparation { read_seconds, ..Preparation::default() };
            let previous = latest.take();
            let prepared = self.pool.install(|| {
                timed(&mut preparation.build_seconds, || {
                    let before = previous.as_ref().map(|assembled| &assembled.frame);
                    let world = &self.job.world;
                    let path = mesh.path.clone();
                    let buffers = Buffers::default();
                    guarded(&path, || {
                        Ok(world.assemble_into(buffers, task.number, vec![mesh], inputs, before)?)
                    })
                })
            });
            preparation.wait_seconds = preparation.read_seconds + preparation.build_seconds;
            let outcome = match prepared {
                Ok(assembled) => {
                    let ready = Ready { assembled, identity };
                    let outcome = self.draw(&task, Ok(&ready), preparation);
                    latest = Some(ready.assembled);
                    outcome
                }
                Err(error) => self.draw(&task, Err(error), preparation),
            };
            let preview = self.observer.preview;
            let done = Done { number: task.number, preview, fingerprint, signature, came, outcome };
            self.observer.rest();
            let _ = news.send(News::Done(Box::new(done)));
        }
    }

    /// A finished picture, or a preview of it.
    fn draw(
        &mut self,
        task: &FrameTask,
        prepared: Result<&Ready, RenderError>,
        preparation: Preparation,
    ) -> Option<Result<Vec<u8>, RenderError>> {
        let Self { job, session, pattern, showcase, pool, observer } = self;
        let output = &job.world.description.output;
        let path = picture_path(pattern, task.number);
        let png = path.with_extension("png");
        let mut bytes = Vec::new();
        let is_there = match (prepared, observer.preview) {
            (prepared, false) => {
                let image = pool.install(|| session.turn(task, prepared, preparation));
                image.map(|image| {
                    bytes = png_bytes(&image, output.exposure, &png)?;
                    if output.png { showcase.finished(&path, &bytes) } else { Ok(()) }
                })
            }
            // What is wrong with it is told when its picture is to be finished.
            (Err(error), true) => return Some(Err(error)),
            (Ok(ready), true) => {
                let shown = |image: &FrameImage| {
                    bytes = png_bytes(image, output.exposure, &png)?;
                    if output.png {
                        showcase.preview(&path, &bytes)?;
                    }
                    Ok(())
                };
                pool.install(|| session.preview(task, ready, preparation, shown)).then_some(Ok(()))
            }
        };
        session.report.frames.clear();
        match is_there {
            Some(encoded) => Some(encoded.map(|()| bytes).map_err(RenderError::from)),
            None => session.report.failures.pop().map(|(_, error)| Err(error)),
        }
    }
}

/// Passes on what a worker tells, and keeps how far it is.
pub(super) struct Tagged<'a> {
    observer: &'a dyn Observer,
    /// Whether the worker makes previews.
    pub preview: bool,
    rendering: Mutex<Option<Rendering>>,
}

impl<'a> Tagged<'a> {
    pub fn new(observer: &'a dyn Observer, preview: bool) -> Self {
        Self { observer, preview, rendering: Mutex::new(None) }
    }

    /// What the worker renders.
    pub fn rendering(&self) -> Option<Rendering> {
        *self.lock()
    }

    fn rest(&self) {
        *self.lock() = None;
    }

    fn lock(&self) -> MutexGuard<'_, Option<Rendering>> {
        self.rendering.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Observer for Tagged<'_> {
    fn frame(&self, number: FrameNumber) {
        *self.lock() = Some(Rendering { number, preview: self.preview, share: 0.0 });
        self.observer.frame(number);
    }

    fn tiles(&self, done: usize, of: usize) {
        let share = done as f32 / of.max(1) as f32;
        if let Some(rendering) = &mut *self.lock() {
            // Threads may report out of order.
            rendering.share = rendering.share.max(share);
        }
        self.observer.tiles(done, of);
    }

    fn warning(&self, text: &str) {
        // The finished picture has the same warnings.
        if !self.preview {
            self.observer.warning(text);
        }
    }

    fn finished(&self, record: &FrameRecord) {
        self.observer.finished(record);
    }
}
