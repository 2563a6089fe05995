//! Which frames a run is asked for: a selection of those that are there, and its shard of them.

use super::error::RenderError;
use super::job::{FrameTask, Job};
use super::render::RenderOptions;
use crate::sequence::{FrameNumber, SequenceError, format_numbers};

/// What a run is asked for.
pub(super) struct Chosen {
    /// Frames that are there.
    pub tasks: Vec<FrameTask>,
    /// Those that were asked for by their number but are not there.
    pub absent: Vec<FrameNumber>,
    /// How many frames share one pattern of names: those of all shards.
    pub shared: usize,
}

/// The frames to be rendered.
///
/// # Errors
/// When the selection leaves no frame, or, unless other frames are to go on, names one that is not there. That a shard
/// has none is no error.
pub(super) fn chosen(job: &Job, options: &RenderOptions) -> Result<Chosen, RenderError> {
    let (tasks, absent) = match &options.frames {
        Some(selection) => (job.select(selection)?, selection.absent(&numbers(job))),
        None => (job.tasks(), Vec::new()),
    };
    let shared = tasks.len();
    let chosen = sharded(Chosen { tasks, absent, shared }, options);
    match chosen.absent.first() {
        Some(&number) if !options.keep_going => Err(not_there(job, number)),
        _ => Ok(chosen),
    }
}

/// The part that is this shard's: by the place in the selection, or else in the sequence.
fn sharded(mut chosen: Chosen, options: &RenderOptions) -> Chosen {
    match (options.shard, &options.frames) {
        (None, _) => {}
        (Some(shard), Some(selection)) => {
            let of = selection.positions();
            let holds = |number| selection.position(number).is_some_and(|place| shard.holds(place, of));
            chosen.tasks.retain(|task| holds(task.number));
            chosen.absent.retain(|&number| holds(number));
            chosen.shared = usize::try_from(of).unwrap_or(usize::MAX);
        }
        (Some(shard), None) => {
            let of = chosen.tasks.len() as u128;
            let places = (0..).zip(std::mem::take(&mut chosen.tasks));
            chosen.tasks =
                places.filter(|&(place, _)| shard.holds(place, of)).map(|(_, task)| task).collect();
        }
    }
    chosen
}

fn numbers(job: &Job) -> Vec<FrameNumber> {
    job.tasks().iter().map(|task| task.number).collect()
}

pub(super) fn not_there(job: &Job, number: FrameNumber) -> RenderError {
    SequenceError::NotThere { number, available: format_numbers(&numbers(job)) }.into()
}
