//! What all frames will cost, by a trial of a few.

use super::Refusal;
use super::common::Common;
use super::work::Work;
use crate::cli::exit::Exit;
use crate::cli::streams::say;
use crate::driver::RenderOptions;
use crate::study::{CostEstimate, StudyError, estimate_cost};

/// Renders the trial and says what it tells of so many tasks.
pub fn run(common: &Common, work: &Work, tasks: usize) -> Result<(), Refusal> {
    let options = RenderOptions { threads: common.cpus.map(usize::from), ..common.settings.options() };
    let numbers: Vec<_> = work.numbers.iter().copied().filter(|number| work.there.contains(number)).collect();
    if numbers.is_empty() {
        return Err("no frame is there yet that a trial could render: leave --trial out".to_owned().into());
    }
    let mut estimate =
        estimate_cost(&work.job, &options, &numbers, |number| say(&format!("# trial: frame {number}")))
            .map_err(refusal)?;
    // Those to come are taken to be like those that are there.
    estimate.frames = work.numbers.len();
    let has_target = options.settings(&work.job.world.description.render).target_error.is_some();
    for line in told(&estimate, tasks, common.cpus.unwrap_or(1), has_target) {
        say(&format!("# {line}"));
    }
    Ok(())
}

fn refusal(error: StudyError) -> Refusal {
    match error {
        StudyError::Render(error) => error.into(),
        error => Refusal { exit: Exit::Internal, text: error.to_string() },
    }
}

fn told(estimate: &CostEstimate, tasks: usize, cpus: u16, has_target: bool) -> [String; 3] {
    let (total, margin) = (estimate.total_seconds(), estimate.total_margin());
    let digits = if total < 3600.0 { 4 } else { 1 };
    let hours = |seconds: f64| format!("{:.digits$}", seconds.max(0.0) / 3600.0);
    let [few, more] = estimate.tried_samples;
    let longest = estimate.frames.div_ceil(tasks) as f64 * estimate.seconds_per_frame() / f64::from(cpus);
    let at_most = if has_target { "at most " } else { "" };
    [
        format!(
            "the trial, of {} renderings with {few} and {more} samples a pixel, took {:.1} CPU seconds",
            estimate.trials.len(),
            estimate.trial_seconds
        ),
        format!(
            "{} frames with {} samples a pixel: {at_most}{} core hours (95 %: {} to {}); a frame {:.2} CPU seconds, {:.2} of \
             them whatever its samples",
            estimate.frames,
            estimate.samples,
            hours(total),
            hours(total - margin),
            hours(total + margin),
            estimate.seconds_per_frame(),
            estimate.fixed_seconds()
        ),
        format!(
            "a task of {tasks}, with {cpus} processors: some {:.0} s, and what starting it takes",
            longest.ceil()
        ),
    ]
}
