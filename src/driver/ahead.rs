//! Makes each frame ready while the one before is rendered.
//!
//! One spare thread reads, checks and assembles frame k + 1 and makes its hierarchy; all others render frame k. There is
//! never more than one frame ahead, and its memory is that of frame k - 1. The hierarchy starts from a copy of that of
//! the last frame that could be assembled, whatever the threads do, so that which frames are refitted does not depend
//! on time. What goes wrong with a frame is told when its turn comes.

use std::time::Instant;

use rayon::ThreadPool;

use super::error::RenderError;
use super::fingerprint::{Fingerprints, FrameSource, Identity, Parsed};
use super::guard::guarded;
use super::job::FrameTask;
use crate::scene::assembly::{Assembled, Buffers};
use crate::scene::frame::Frame;
use crate::scene::world::World;

/// What making a frame ready took.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Preparation {
    /// Reading the mesh.
    pub read_seconds: f64,
    /// Checking it, stitching, normals, hierarchy.
    pub build_seconds: f64,
    /// How long nothing could be rendered because of it.
    pub wait_seconds: f64,
}

/// The threads: those that render, and one more.
pub(super) struct Pools {
    pub render: ThreadPool,
    spare: ThreadPool,
}

impl Pools {
    /// `threads` that render, without a number as many as everything else has, and the spare one.
    pub fn new(threads: Option<usize>) -> Result<Self, RenderError> {
        Ok(Self { render: Self::render_only(threads)?, spare: pool("ahead", 1)? })
    }

    /// Those that render alone.
    pub fn render_only(threads: Option<usize>) -> Result<ThreadPool, RenderError> {
        pool("render", threads.unwrap_or_else(rayon::current_num_threads))
    }
}

/// Threads have names by which those that look at a machine tell them apart.
fn pool(name: &'static str, threads: usize) -> Result<ThreadPool, RenderError> {
    let builder = rayon::ThreadPoolBuilder::new().thread_name(move |index| format!("{name}-{index}"));
    let built = builder.num_threads(threads).build();
    built.map_err(|e| RenderError::Threads { threads, reason: e.to_string() })
}

/// A frame that is ready, and which it is.
#[derive(Debug)]
pub(super) struct Ready {
    pub assembled: Assembled,
    pub identity: Identity,
}

/// A frame that is ready, or what is wrong with it.
type Outcome = (Result<Ready, RenderError>, Preparation);

/// Gives `turn` each task in order with its frame, while the next one is made ready; stops when it returns false.
pub(super) fn one_ahead(
    world: &World,
    fingerprints: &Fingerprints,
    pools: &Pools,
    tasks: &[FrameTask],
    mut turn: impl FnMut(&FrameTask, Result<&Ready, RenderError>, Preparation) -> bool,
) {
    let mut latest: Option<Ready> = None;
    let mut next: Option<Outcome> = None;
    let mut waiting = Instant::now();
    for (i, task) in tasks.iter().enumerate() {
        let (outcome, mut preparation) = next.take().unwrap_or_else(|| {
            // Nothing is rendered: the first frame, or one after a bad one.
            let previous = latest.as_ref().map(|ready| &ready.assembled.frame);
            pools.render.install(|| prepare(world, fingerprints, task, previous, Buffers::default()))
        });
        preparation.wait_seconds = waiting.elapsed().as_secs_f64();
        let mut take_turn = |prepared: Result<&Ready, RenderError>| {
            let goes_on = turn(task, prepared, preparation);
            waiting = Instant::now();
            goes_on
        };
        let goes_on = match outcome {
            Err(error) => take_turn(Err(error)),
            Ok(ready) => {
                let before = latest.take().map(|before| Buffers::from(before.assembled.frame));
                let buffers = before.unwrap_or_default();
                let latest: &Ready = latest.insert(ready);
                pools.spare.in_place_scope(|scope| {
                    if let Some(task) = tasks.get(i + 1) {
                        let (next, previous) = (&mut next, Some(&latest.assembled.frame));
                        scope.spawn(move |_| {
                            *next = Some(prepare(world, fingerprints, task, previous, buffers))
                        });
                    }
                    take_turn(Ok(latest))
                })
            }
        };
        if !goes_on {
            return;
        }
    }
}

fn prepare(
    world: &World,
    fingerprints: &Fingerprints,
    task: &FrameTask,
    previous: Option<&Frame>,
    buffers: Buffers,
) -> Outcome {
    let mut preparation = Preparation::default();
    let path = task.files.first().unwrap_or(&world.description.file);
    let outcome = guarded(path, || assembled(world, fingerprints, task, previous, buffers, &mut preparation));
    (outcome, preparation)
}

fn assembled(
    world: &World,
    fingerprints: &Fingerprints,
    task: &FrameTask,
    previous: Option<&Frame>,
    buffers: Buffers,
    preparation: &mut Preparation,
) -> Result<Ready, RenderError> {
    let read = || FrameSource::read(world, fingerprints, task)?.parse(world);
    let Parsed { meshes, inputs, identity, warnings } = timed(&mut preparation.read_seconds, read)?;
    let assemble = || world.assemble_into(buffers, task.number, meshes, inputs, previous);
    let mut assembled = timed(&mut preparation.build_seconds, assemble)?;
    assembled.warnings.extend(warnings);
    Ok(Ready { assembled, identity })
}

/// Adds the time that some work takes.
pub(super) fn timed<T>(seconds: &mut f64, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    *seconds += start.elapsed().as_secs_f64();
    result
}
