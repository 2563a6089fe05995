//! Renders frames one after the other: what a run is asked for, what it tells, and what becomes of it.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::ahead::{Pools, one_ahead};
use super::chosen::{Chosen, chosen, not_there};
use super::error::RenderError;
use super::fingerprint::Fingerprints;
use super::interrupt::Interrupt;
use super::job::Job;
use super::ledger::FrameRecord;
use super::picture::picture_path;
use super::restart::{Restart, RestartNote};
use super::resume::left;
use super::samples_range::SamplesRange;
use super::session::Session;
use super::watch::WatchStatus;
use crate::scene::description::{RenderDescription, SceneDescription};
use crate::sequence::{FrameNumber, FrameSelection, Gap, Shard, check_output_pattern, gaps};

/// What the command line may override.
#[derive(Clone, Debug, Default)]
pub struct RenderOptions {
    /// Only these frames.
    pub frames: Option<FrameSelection>,
    /// Of those only this part.
    pub shard: Option<Shard>,
    /// Pattern of the pictures' names.
    pub output: Option<String>,
    /// Samples a pixel, at most where there is a target.
    pub samples: Option<u32>,
    /// Of these only some, which become partials instead of pictures.
    pub samples_range: Option<SamplesRange>,
    /// Relative error at which a frame stops.
    pub target_error: Option<f64>,
    /// Light transport of a frame, in all runs: what is there then is its picture.
    pub time_budget: Option<Duration>,
    /// Only a look: whatever the scene says, no frame has a target.
    pub look: bool,
    /// Seed.
    pub seed: Option<u64>,
    /// Threads that render, besides one that makes the next frame ready; all cores without it.
    pub threads: Option<usize>,
    /// Renders the other frames after a bad one.
    pub keep_going: bool,
    /// Writes denoised pictures too, even if the scene does not ask for them.
    pub denoise: bool,
    /// Leaves frames alone whose pictures are there, and goes on from checkpoints.
    pub resume: bool,
    /// That a scheduler has started this run again: it gives up when those before it have brought nothing.
    pub restart: Option<Restart>,
    /// How often the frame that is being rendered is saved; only when it is asked for without it.
    pub checkpoint_every: Option<Duration>,
    /// Asks the run to stop, or to save how far it has come.
    pub interrupt: Interrupt,
}

impl RenderOptions {
    /// The settings of a scene with what is overridden.
    pub fn settings(&self, scene: &RenderDescription) -> RenderDescription {
        RenderDescription {
            samples: self.samples.unwrap_or(scene.samples),
            target_error: self.target_error.or(scene.target_error).filter(|_| !self.look),
            seed: self.seed.unwrap_or(scene.seed),
            ..scene.clone()
        }
    }

    /// What is made of a frame: its picture, or the partial of some of its samples.
    pub(super) fn place(&self, pattern: &str, number: FrameNumber) -> PathBuf {
        let picture = picture_path(pattern, number);
        self.samples_range.map_or_else(|| picture.clone(), |range| range.partial_of(&picture))
    }

    /// Whether there are to be pictures without noise.
    pub(super) fn wants_denoised(&self, scene: &SceneDescription) -> bool {
        self.samples_range.is_none() && (self.denoise || scene.output.denoise)
    }
}

/// Hears of what happens while frames are rendered.
pub trait Observer: Sync {
    /// The frames of which it will be told what became of them.
    fn started(&self, _frames: usize) {}
    /// A frame is begun.
    fn frame(&self, _number: FrameNumber) {}
    /// Tiles of the frame that are done, of how many.
    fn tiles(&self, _done: usize, _of: usize) {}
    /// Something that the user should look at.
    fn warning(&self, _text: &str) {}
    /// A frame is done, or has failed.
    fn finished(&self, _record: &FrameRecord) {}
    /// The scene of frames that are waited for is opened; their pictures have names of a pattern.
    fn opened(&self, _job: &Job, _pattern: &str) {}
    /// What is going on while frames are waited for.
    fn watching(&self, _status: &WatchStatus) {}
}

/// Hears nothing.
impl Observer for () {}

/// What became of a job.
#[derive(Debug)]
pub struct RenderReport {
    /// One record a frame, in order.
    pub frames: Vec<FrameRecord>,
    /// The frames whose pictures were there already.
    pub already: Vec<FrameNumber>,
    /// True when it was asked to stop before all was done.
    pub interrupted: bool,
    /// The frames that have no picture, and why.
    pub failures: Vec<(FrameNumber, RenderError)>,
    /// Frames that were not tried because one before them failed, or because the run was to stop.
    pub skipped: usize,
    /// From start to end.
    pub seconds: f64,
    /// Pattern of the pictures' names.
    pub pattern: String,
    /// The ledger.
    pub ledger: PathBuf,
}

/// Renders the frames of a job.
///
/// # Errors
/// When nothing can be rendered at all; what goes wrong with single frames is in the report.
pub fn render(
    job: &Job,
    options: &RenderOptions,
    observer: &dyn Observer,
) -> Result<RenderReport, RenderError> {
    if let Some(range) = options.samples_range {
        check_range(range, job, options)?;
    }
    let Chosen { tasks, absent, shared } = chosen(job, options)?;
    let pattern = options.output.clone().unwrap_or_else(|| job.output_pattern());
    check_pictures(&pattern, shared)?;
    let pools = Pools::new(options.threads)?;
    let start = Instant::now();
    let fingerprints = Fingerprints::new(&job.world, &options.settings(&job.world.description.render));
    let mut session = Session::new(job, options, observer, &pattern, &tasks)?;
    let asked = tasks.len() + absent.len();
    let note = options.restart.zip(tasks.first());
    let note = note.map(|(restart, first)| RestartNote::of(restart, &options.place(&pattern, first.number)));
    let tasks = if options.resume {
        let left = pools.render.install(|| left(job, &fingerprints, &pattern, tasks, options, observer));
        session.report.already = left.already;
        left.tasks
    } else {
        tasks
    };
    if let Some(note) = &note {
        note.compare((job, &fingerprints, &pattern), &tasks, options, observer)?;
    }
    if let Some(shard) = options.shard.filter(|_| asked == 0) {
        observer.warning(&format!(
            "shard {shard} has no frame: there are fewer frames than shards, or its own are to come"
        ));
    }
    observer.started(tasks.len() + absent.len());
    if options.frames.is_none() {
        gaps(&job.files).iter().for_each(|gap| observer.warning(&missing(gap)));
    }
    for number in absent {
        session.absent(number, not_there(job, number));
    }
    let stop = &options.interrupt;
    one_ahead(&job.world, &fingerprints, &pools, &tasks, |task, prepared, preparation| {
        if stop.is_requested() {
            return false;
        }
        observer.frame(task.number);
        let is_done = pools.render.install(|| session.turn(task, prepared, preparation)).is_some();
        (is_done || options.keep_going) && !stop.is_requested()
    });
    session.report.skipped = asked - session.report.already.len() - session.report.frames.len();
    session.report.interrupted |= stop.is_requested() && session.report.skipped > 0;
    session.report.seconds = start.elapsed().as_secs_f64();
    // Whoever starts it again after it ended by itself has a reason.
    if let Some(note) = note.filter(|_| !session.report.interrupted) {
        note.remove();
    }
    Ok(session.report)
}

/// Checks that a range is of samples whose number is known beforehand.
fn check_range(range: SamplesRange, job: &Job, options: &RenderOptions) -> Result<(), RenderError> {
    let scene = &job.world.description;
    let settings = options.settings(&scene.render);
    let SamplesRange { first, end } = range;
    let problem = if settings.target_error.is_some() {
        format!(
            "how many samples a frame with a target has is not known beforehand; leave --target-error out, and \
             target_error out of [render] of {}",
            scene.file.display()
        )
    } else if options.time_budget.is_some() {
        "samples that time decides on cannot be parted; leave --time-budget out".into()
    } else if end > settings.samples {
        format!(
            "there are {0} samples; end at {0}, or give all parts and the merge --samples {end}",
            settings.samples
        )
    } else if first >= end {
        "there is no sample in it; write 0..64 for the first 64".into()
    } else {
        return Ok(());
    };
    Err(RenderError::SamplesRange { range, problem })
}

fn missing(gap: &Gap) -> String {
    if gap.first == gap.last {
        format!("frame {gap} is missing in the sequence")
    } else {
        format!("frames {gap} are missing in the sequence")
    }
}

/// Checks that a pattern can name the pictures of some frames.
///
/// # Errors
/// [`RenderError::NotExr`] and those of [`check_output_pattern`].
pub fn check_pictures(pattern: &str, frames: usize) -> Result<(), RenderError> {
    check_output_pattern(pattern, frames)?;
    let extension = Path::new(pattern).extension();
    if extension.is_some_and(|e| e.eq_ignore_ascii_case("exr")) {
        return Ok(());
    }
    let example = Path::new(pattern).with_extension("exr").to_string_lossy().into_owned();
    Err(RenderError::NotExr { pattern: pattern.into(), example })
}
