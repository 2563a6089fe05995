//! Makes each frame ready while the one before is rendered.
//!
//! One spare thread reads, checks and assembles frame k + 1 and makes its hierarchy; all others render frame k. There is
//! never more than one frame ahead, and its memory is that of frame k - 1. The hierarchy starts from a copy of that of
//! the last frame that could be assembled, whatever the threads do, so that which frames are refitted does not depend
//! on time. What goes wrong with a frame is told when its turn comes.

use std::time::Instant;

use rayon::ThreadPool;

use super::error::RenderError;
use super::job::FrameTask;
use crate::mesh;
use crate::scene::assembly::{Assembled, Buffers, FrameMesh};
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
    /// `threads` that render, all cores without a number, and the spare one.
    pub fn new(threads: Option<usize>) -> Result<Self, RenderError> {
        let pool = |threads: usize| {
            let built = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            built.map_err(|e| RenderError::Threads { threads, reason: e.to_string() })
        };
        Ok(Self { render: pool(threads.unwrap_or(0))?, spare: pool(1)? })
    }
}

/// A frame that is ready, or what is wrong with it.
type Outcome = (Result<Assembled, RenderError>, Preparation);

/// Gives `turn` each task in order with its frame, while the next one is made ready; stops when it returns false. Returns
/// how many had their turn.
pub(super) fn one_ahead(
    world: &World,
    pools: &Pools,
    tasks: &[FrameTask],
    mut turn: impl FnMut(&FrameTask, Result<&Assembled, RenderError>, Preparation) -> bool,
) -> usize {
    let mut latest: Option<Assembled> = None;
    let mut next: Option<Outcome> = None;
    let mut waiting = Instant::now();
    for (i, task) in tasks.iter().enumerate() {
        let (outcome, mut preparation) = next.take().unwrap_or_else(|| {
            // Nothing is rendered: the first frame, or one after a bad one.
            let previous = latest.as_ref().map(|assembled| &assembled.frame);
            pools.render.install(|| prepare(world, task, previous, Buffers::default()))
        });
        preparation.wait_seconds = waiting.elapsed().as_secs_f64();
        let mut take_turn = |prepared: Result<&Assembled, RenderError>| {
            let goes_on = turn(task, prepared, preparation);
            waiting = Instant::now();
            goes_on
        };
        let goes_on = match outcome {
            Err(error) => take_turn(Err(error)),
            Ok(assembled) => {
                let buffers = latest.take().map(|before| Buffers::from(before.frame)).unwrap_or_default();
                let latest: &Assembled = latest.insert(assembled);
                pools.spare.in_place_scope(|scope| {
                    if let Some(task) = tasks.get(i + 1) {
                        let (next, previous) = (&mut next, Some(&latest.frame));
                        scope.spawn(move |_| *next = Some(prepare(world, task, previous, buffers)));
                    }
                    take_turn(Ok(latest))
                })
            }
        };
        if !goes_on {
            return i + 1;
        }
    }
    tasks.len()
}

fn prepare(world: &World, task: &FrameTask, previous: Option<&Frame>, buffers: Buffers) -> Outcome {
    let mut preparation = Preparation::default();
    let outcome =
        timed(&mut preparation.read_seconds, || read(world, task)).and_then(|(meshes, warnings)| {
            let assemble = || world.assemble_into(buffers, task.number, meshes, previous);
            let mut assembled = timed(&mut preparation.build_seconds, assemble)?;
            assembled.warnings.extend(warnings);
            Ok(assembled)
        });
    (outcome, preparation)
}

/// The meshes of a frame, and what there is to say about their velocities.
fn read(world: &World, task: &FrameTask) -> Result<(Vec<FrameMesh>, Vec<String>), RenderError> {
    let mut meshes = task.read(&world.velocity_name())?;
    let mut warnings = Vec::new();
    if world.follows_vertices() {
        for (i, mesh) in meshes.iter_mut().enumerate() {
            let unknown = follow_next(world, task, i, mesh).err();
            warnings.extend(unknown.map(|why| format!("{}: {why}; {STANDS_STILL}", mesh.path.display())));
        }
    }
    Ok((meshes, warnings))
}

const STANDS_STILL: &str = "nothing in it moves while the shutter is open";

/// Takes the velocities of mesh `i` from the next frame, or tells why not: whatever is wrong with that one, its turn is
/// still to come.
fn follow_next(world: &World, task: &FrameTask, i: usize, mesh: &mut FrameMesh) -> Result<(), String> {
    let next = task.next.as_ref().ok_or("there is no next frame to take velocities from")?;
    let after = mesh::read(&next.files[i]).map_err(|e| format!("the next frame cannot be followed: {e}"))?;
    let frames = (next.number.millionths() - task.number.millionths()) as f64 / 1e6;
    let fps = world.frames().map_or(24.0, |f| f.fps);
    mesh::follow(&mut mesh.mesh, &after, frames / fps).map_err(|e| e.to_string())
}

/// Adds the time that some work takes.
pub(super) fn timed<T>(seconds: &mut f64, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    *seconds += start.elapsed().as_secs_f64();
    result
}
