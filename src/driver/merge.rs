//! Makes pictures of frames whose samples several machines have drawn.
//!
//! Sums are exact, so the picture and its line in the ledger are those of a run that draws all samples itself; only that
//! line's times are of the machines, light transport being that of all of them.

use std::time::Instant;

use super::ahead::{Pools, one_ahead};
use super::chosen::{Chosen, chosen, not_there};
use super::error::RenderError;
use super::fingerprint::Fingerprints;
use super::job::Job;
use super::partial::Wanted;
use super::parts::{among, folder_of, names_in, remove_partials};
use super::picture::picture_path;
use super::render::{Observer, RenderOptions, RenderReport, check_pictures};
use super::resume::left;
use super::session::Session;

/// Merges the partials of the frames that are asked for, or of all that have any. Frames whose pictures are there are left
/// alone; with `remove` partials go when the picture of theirs is there.
///
/// # Errors
/// When there is nothing to merge at all; what goes wrong with single frames is in the report.
pub fn merge(
    job: &Job,
    options: &RenderOptions,
    remove: bool,
    observer: &dyn Observer,
) -> Result<RenderReport, RenderError> {
    let Chosen { mut tasks, absent, shared } = chosen(job, options)?;
    let pattern = options.output.clone().unwrap_or_else(|| job.output_pattern());
    check_pictures(&pattern, shared)?;
    let pools = Pools::new(options.threads)?;
    let start = Instant::now();
    let fingerprints = Fingerprints::new(&job.world, &options.settings(&job.world.description.render));
    if options.frames.is_none() {
        let names = tasks.first().map(|task| names_in(folder_of(&picture_path(&pattern, task.number))));
        let names = names.unwrap_or_default();
        tasks.retain(|task| !among(&picture_path(&pattern, task.number), &names).is_empty());
        if tasks.is_empty() {
            return Err(RenderError::NothingToMerge { pictures: pattern });
        }
    }
    let mut session = Session::new(job, options, observer, &pattern, &tasks)?;
    let asked = tasks.len() + absent.len();
    let all = tasks.clone();
    let left = pools.render.install(|| left(job, &fingerprints, &pattern, tasks, options, observer));
    session.report.already = left.already;
    if remove {
        // A merge that was killed may have left them.
        for task in all.iter().filter(|task| session.report.already.contains(&task.number)) {
            if let Ok(wanted) = Wanted::read(job, &fingerprints, options, task) {
                remove_partials(&wanted, &picture_path(&pattern, task.number));
            }
        }
    }
    observer.started(left.tasks.len());
    for number in absent {
        session.absent(number, not_there(job, number));
    }
    let stop = &options.interrupt;
    one_ahead(&job.world, &fingerprints, &pools, &left.tasks, |task, prepared, preparation| {
        if stop.is_requested() {
            return false;
        }
        observer.frame(task.number);
        let is_done = pools.render.install(|| session.merge_turn(task, prepared, preparation, remove));
        (is_done || options.keep_going) && !stop.is_requested()
    });
    session.report.skipped = asked - session.report.already.len() - session.report.frames.len();
    session.report.interrupted |= stop.is_requested() && session.report.skipped > 0;
    session.report.seconds = start.elapsed().as_secs_f64();
    Ok(session.report)
}
