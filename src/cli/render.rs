//! `floe render`

use std::time::Duration;

use clap::Args;
use serde_json::Value;

use super::duration::{duration, time};
use super::exit::Exit;
use super::progress::{Bars, ProgressArguments, Reporter, reporter};
use super::settings::Settings;
use super::streams::{print, say};
use super::summary;
use crate::driver::{Job, RenderError, RenderOptions, RenderReport, SamplesRange, preview, render};
use crate::sequence::SequenceError;

#[derive(Debug, Args)]
pub struct RenderArguments {
    #[command(flatten)]
    settings: Settings,
    /// Threads that render; one more makes the next frame ready [default: FLOE_THREADS, else as many as Slurm gives the job,
    /// else all cores that it may use]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Only these of the samples of each pixel (half open), into frame_0001.0-64.partial beside each picture, for `floe merge`
    /// when others have rendered the rest; give all parts the same --samples
    #[arg(long, value_name = "A..B", allow_hyphen_values = true, conflicts_with_all = ["preview", "denoise", "target_error", "time_budget"])]
    samples_range: Option<SamplesRange>,
    /// A quarter of the size, at most 16 samples, into the folder `preview` beside the pictures
    #[arg(long)]
    pub preview: bool,
    /// Write pictures without noise too, as frame_0001.denoised.exr beside each (also output.denoise of the scene)
    #[arg(long)]
    denoise: bool,
    /// Leave frames alone whose pictures are there and up to date, and go on with the one that was interrupted
    #[arg(long)]
    resume: bool,
    /// How often an unfinished frame is saved for --resume: 30s, 5m, 1h, or 0 for only when it is interrupted
    #[arg(long, value_name = "TIME", default_value = "5m", value_parser = duration)]
    checkpoint_every: Duration,
    /// Write what there is of a frame after so much light transport: 30s, 5m, 1h; --resume without it, or with a longer
    /// one, goes on
    #[arg(long, value_name = "TIME", value_parser = time)]
    time_budget: Option<Duration>,
    /// Go on with the other frames when one fails; the exit code still tells
    #[arg(long)]
    keep_going: bool,
    #[command(flatten)]
    progress: ProgressArguments,
}

impl RenderArguments {
    /// What they ask of a run.
    pub fn options(&self) -> RenderOptions {
        RenderOptions {
            threads: self.threads.map(usize::from),
            keep_going: self.keep_going,
            denoise: self.denoise,
            samples_range: self.samples_range,
            resume: self.resume,
            time_budget: self.time_budget,
            checkpoint_every: Some(self.checkpoint_every).filter(|every| !every.is_zero()),
            ..self.settings.options()
        }
    }
}

/// Renders and says what became of it.
pub fn run(arguments: &RenderArguments) -> Exit {
    let options = RenderOptions { restart: super::environment::restart(), ..arguments.options() };
    let options = if arguments.preview { preview::options(options) } else { options };
    let bars = |quiet, bar| Box::new(Bars::new(quiet, bar)) as Box<dyn Reporter>;
    let progress = reporter(&arguments.progress, options.shard, bars);
    #[cfg(unix)]
    super::signals::obey(&options.interrupt);
    let open = if arguments.preview { preview::open } else { Job::open };
    let report = open(&arguments.settings.scene).and_then(|job| {
        if let Some(scene) = &job.written_scene {
            say(&format!("wrote {}: edit it to change camera, light and media", scene.display()));
        }
        render(&job, &options, &*progress)
    });
    ended(&*progress, report, arguments.settings.output.is_some())
}

/// Says what became of frames; whether the pattern of their names is from the command line.
pub(super) fn ended(
    progress: &dyn Reporter,
    report: Result<RenderReport, RenderError>,
    names_output: bool,
) -> Exit {
    progress.clear();
    let (results, exit) = match report {
        Ok(report) => {
            let printed = print(&summary::text(&report));
            (summary::json(&report), exit_of(&report, printed))
        }
        Err(error) => {
            say(&format!("error: {error}"));
            let exit = match error {
                RenderError::Sequence(SequenceError::NoPlace { .. }) if names_output => Exit::Usage,
                RenderError::SamplesRange { .. } => Exit::Usage,
                error => Exit::from(&error),
            };
            (Value::Null, exit)
        }
    };
    progress.ended(results, exit);
    exit
}

/// What is left to do counts before what went wrong: a scheduler starts only what was interrupted again, and what went
/// wrong is told by the run that comes to the end.
fn exit_of(report: &RenderReport, printed: Exit) -> Exit {
    if report.interrupted {
        return Exit::Interrupted;
    }
    report.failures.iter().map(|(_, error)| Exit::from(error)).fold(printed, Exit::max)
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;
    use crate::sequence::FrameNumber;

    #[test]
    fn frames_that_are_left_are_not_lost_to_one_that_is_wrong() {
        let wrong = RenderError::NotUtf8 { path: PathBuf::new() };
        assert_eq!(Exit::from(&wrong), Exit::Configuration);
        let report = |interrupted, failures| RenderReport {
            frames: Vec::new(),
            already: Vec::new(),
            interrupted,
            failures,
            skipped: 1,
            seconds: 0.0,
            pattern: String::new(),
            ledger: PathBuf::new(),
        };
        let failures = vec![(FrameNumber::ONE, wrong)];
        assert_eq!(exit_of(&report(false, Vec::new()), Exit::CannotWrite), Exit::CannotWrite);
        assert_eq!(exit_of(&report(true, Vec::new()), Exit::Complete), Exit::Interrupted);
        assert_eq!(exit_of(&report(true, failures), Exit::Complete), Exit::Interrupted);
        let failures = vec![(FrameNumber::ONE, RenderError::NotUtf8 { path: PathBuf::new() })];
        assert_eq!(exit_of(&report(false, failures), Exit::Complete), Exit::Configuration);
    }
}
