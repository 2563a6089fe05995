//! Renders the frames of a simulation while it runs.
//!
//! ```text
//! events, poll -> lookout -> arrivals -> look: read, hash, check -> worker: preview, picture -> ledger, latest.png
//! ```
//! The loop never renders and the workers never look. Only bytes that were read in one go, are a whole mesh and did not
//! change for a while ([`super::ready`], [`super::whole`]) are handed on, with their hash, which goes into the picture: a
//! picture is of exactly those bytes, and a file that is written again later is drawn again. After a restart the hashes in
//! the pictures tell what is still to be done. Whatever is wrong with one frame, the others go on.

mod drawn;
mod frame_files;
mod look;
mod lookout;
mod opening;
mod showcase;
mod status;
mod wake;
mod worker;

use std::path::{Path, PathBuf};
use std::sync::mpsc::Sender;
use std::thread::Scope;
use std::time::Duration;

pub use self::status::{Phase, Rendering, WatchStatus};
pub use super::arrivals::Order;

use self::look::Watch;
use self::lookout::Lookout;
use self::showcase::Showcase;
use self::wake::News;
use self::worker::{Easel, Tagged, Worker};
use super::ahead::Pools;
use super::error::RenderError;
use super::frame_seeds::FrameSeeds;
use super::job::{FrameTask, Job};
use super::render::{Observer, RenderOptions, check_pictures};
use super::session::Session;
use crate::sequence::FrameNumber;

/// What a watch is asked for.
#[derive(Clone, Debug)]
pub struct WatchOptions {
    /// What the pictures are asked for; `frames`, `keep_going` and `resume` have no meaning here.
    pub render: RenderOptions,
    /// Which frame is drawn first when several wait.
    pub order: Order,
    /// Ends when this frame is drawn or bad, and those before it that are there.
    pub until: Option<FrameNumber>,
    /// Ends when all is drawn and nothing has changed for so long.
    pub idle_timeout: Option<Duration>,
    /// Ends when all is drawn and a file of this name is in the folder of the frames.
    pub done_file: Option<String>,
    /// Samples a pixel of previews; 0 for none, `None` for a sixteenth of the picture's and at least 4.
    pub preview_samples: Option<u32>,
    /// How often the folder is looked at even if the system tells of no change.
    pub poll: Duration,
    /// How long a file has to be unchanged ([`super::ready::Rules`]).
    pub quiet: Duration,
}

impl Default for WatchOptions {
    fn default() -> Self {
        Self {
            render: RenderOptions {
                checkpoint_every: Some(Duration::from_secs(300)),
                ..RenderOptions::default()
            },
            order: Order::default(),
            until: None,
            idle_timeout: None,
            done_file: None,
            preview_samples: None,
            poll: Duration::from_secs(2),
            quiet: Duration::from_millis(500),
        }
    }
}

impl WatchOptions {
    /// Whether only something that the simulation does ends the watch.
    fn expects_more(&self) -> bool {
        self.until.is_some() || self.done_file.is_some()
    }
}

/// Why a watch ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The frame that was waited for is drawn.
    Until,
    /// The simulation said that it was done.
    DoneFile,
    /// Nothing changed for as long as was to be waited.
    Idle,
    /// It was asked to stop.
    Interrupted,
}

/// What became of a watch.
#[derive(Debug)]
pub struct WatchReport {
    /// Why it ended.
    pub ended: End,
    /// The frames that have a picture of their file as it is, or as it was before it was removed.
    pub drawn: Vec<FrameNumber>,
    /// The frames that are there but not drawn yet.
    pub pending: Vec<FrameNumber>,
    /// The frames that have no picture, and why.
    pub failures: Vec<(FrameNumber, RenderError)>,
    /// Why frames may have come that were not seen.
    pub trouble: Option<RenderError>,
    /// Whether it was to go on until something happened that has not.
    pub expected_more: bool,
    /// Pictures that were finished, several of a frame that was written again.
    pub finished: usize,
    /// From start to end.
    pub seconds: f64,
    /// Pattern of the pictures' names, and the ledger; `None` when no scene could be opened.
    pub places: Option<(String, PathBuf)>,
}

/// Renders what comes until it is over.
///
/// # Errors
/// When nothing can be rendered at all; what goes wrong with single frames is in the report.
pub fn watch(
    path: &Path,
    options: &WatchOptions,
    observer: &dyn Observer,
) -> Result<WatchReport, RenderError> {
    let start = std::time::Instant::now();
    let mut report = match opening::open(path, options, observer)? {
        Ok((job, lookout)) => with_workers(&job, lookout)?,
        Err((ended, lookout)) => lookout.report(ended),
    };
    report.seconds = start.elapsed().as_secs_f64();
    Ok(report)
}

fn with_workers(job: &Job, lookout: Lookout<'_>) -> Result<WatchReport, RenderError> {
    let (options, observer) = (lookout.options, lookout.observer);
    let pattern = options.render.output.clone().unwrap_or_else(|| job.output_pattern());
    check_pictures(&pattern, 2)?;
    observer.opened(job, &pattern);
    if job.world.follows_vertices() {
        observer.warning(
            "what comes next is not known yet, so nothing moves while the shutter is open; \
             draw the pictures again with `floe render --resume` when all frames are there",
        );
    }
    let scene = &job.world.description.render;
    let settings = options.render.settings(scene);
    // A session tells it of several frames, and does not know yet that there will be.
    if let Some(text) = FrameSeeds::new(scene, settings.seed, settings.samples).overlap() {
        observer.warning(&text);
    }
    let samples = settings.samples;
    let previews = preview_samples(options.preview_samples, samples, settings.target_error.is_some());
    let finished_options = RenderOptions { samples: Some(samples), resume: true, ..options.render.clone() };
    let preview_options =
        RenderOptions { samples: previews, look: true, time_budget: None, ..options.render.clone() };
    let showcase = Showcase::default();
    let workshop = Workshop { job, pattern: &pattern, showcase: &showcase };
    let finishing = Tagged::new(observer, false);
    let previewing = Tagged::new(observer, true);
    std::thread::scope(|scope| {
        let picture = workshop.worker(scope, &finished_options, &finishing, lookout.sender())?;
        let preview = match previews {
            Some(_) => Some(workshop.worker(scope, &preview_options, &previewing, lookout.sender())?),
            None => None,
        };
        let desk = workshop.session(&finished_options, observer)?;
        Watch::new(job, lookout, &pattern, desk, [(Some(picture), &finishing), (preview, &previewing)]).run()
    })
}

/// A folder as a message names it: from where the user is.
fn shown(folder: &Path) -> String {
    let whole = folder.canonicalize().unwrap_or_else(|_| folder.into());
    let here = std::env::current_dir().and_then(|here| here.canonicalize()).unwrap_or_default();
    whole.strip_prefix(&here).unwrap_or(&whole).display().to_string()
}

/// Samples of previews; none where they would not come much sooner than the picture, which may have the fewest that a
/// target allows.
fn preview_samples(asked: Option<u32>, samples: u32, has_target: bool) -> Option<u32> {
    let most = if has_target { 4 } else { u32::MAX };
    let preview = asked.unwrap_or_else(|| (samples / 16).max(4).min(most));
    (preview > 0 && preview <= samples / 2).then_some(preview)
}

/// What workers are made of.
struct Workshop<'a> {
    job: &'a Job,
    pattern: &'a str,
    showcase: &'a Showcase,
}

impl<'a> Workshop<'a> {
    fn session(
        &self,
        options: &'a RenderOptions,
        observer: &'a dyn Observer,
    ) -> Result<Session<'a>, RenderError> {
        let first = FrameTask { number: FrameNumber::ONE, files: Vec::new(), next: None };
        Session::new(self.job, options, observer, self.pattern, &[first])
    }

    fn worker<'scope>(
        &self,
        scope: &'scope Scope<'scope, '_>,
        options: &'a RenderOptions,
        observer: &'a Tagged<'a>,
        news: Sender<News>,
    ) -> Result<Worker, RenderError>
    where
        'a: 'scope,
    {
        let session = self.session(options, observer)?;
        let pool = Pools::render_only(options.threads)?;
        Ok(Worker::start(
            scope,
            Easel { job: self.job, session, pattern: self.pattern, showcase: self.showcase, pool, observer },
            news,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn previews_come_much_sooner_or_not_at_all() {
        for (asked, samples, preview) in [
            (None, 512, Some(32)),
            (None, 64, Some(4)),
            (None, 8, Some(4)),
            (None, 7, None),
            (Some(0), 64, None),
            (Some(2), 4, Some(2)),
            (Some(40), 64, None),
        ] {
            assert_eq!(preview_samples(asked, samples, false), preview, "{asked:?} of {samples}");
        }
        assert_eq!(preview_samples(None, 4096, true), Some(4));
        assert_eq!(preview_samples(Some(64), 4096, true), Some(64));
    }
}
