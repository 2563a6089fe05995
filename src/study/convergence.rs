//! Error against run time: the same frame by several integrators or settings, at several budgets, over and over.
//!
//! I_r is the picture of repeat r of R, each with a seed of its own, R* the reference, V* the variance of its noise; < > is
//! the mean over pixels, |(r, g, b)|^2 = r^2 + g^2 + b^2:
//!
//! ```text
//! rmse       = (mean over r of <|I_r - R*|^2 - V*> / 3)^(1/2)                             (1)
//! relMSE     = mean over r of <(|I_r - R*|^2 - V*) / (|R*|^2 + 0.02^2)>                   (2)
//! variance   = <sum_r |I_r - mean I|^2> / (3 (R - 1))                                     (3)
//! efficiency = 1 / (variance CPU seconds)                                                 (4)
//! cost       = relMSE CPU seconds                                                         (5)
//! ```
//!
//! E |I - R*|^2 = E |I - E R*|^2 + V* where I and R* have independent seeds, so (1) and (2) have the expectation that they
//! would have with an endless reference. Trimmed means and medians have no such correction and hold the reference's
//! noise. FLIP holds it too. (4) and (5) do not depend on the budget where errors fall as (CPU seconds)^(-1/2): they rank
//! settings. rmse^2 is variance plus the square of what bias does to single pixels.
//!
//! * [`reference`](mod@reference) renders the reference, keeps it and takes it again.
//! * [`bias`](mod@bias) tests the mean of all repeats against it.
//! * [`point`] is one budget; [`crate::study::statistics`] makes slopes of several.
//! * [`report`] writes it all down.
//!
//! Runs of all series take turns, so that what else the machine does falls on all alike; CPU seconds are those of the
//! process. Seeds follow each other from [`ConvergenceStudy::seed`] on through all repeats and budgets; those of the
//! reference are 2^32 further. Every number but the times is the same each time.

pub mod bias;
mod frames;
pub mod point;
pub mod reference;
pub mod report;
mod run;
mod variant;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::Serialize;

pub use bias::Bias;
pub use point::BudgetPoint;
pub use reference::{CrossCheck, Reference, ReferenceFacts};
pub use variant::Budgets;

use super::error::StudyError;
use super::statistics::{Estimate, crossing, slope};
use crate::driver::{Interrupt, RenderError};
use crate::integrator::Integrator;
use crate::sequence::FrameNumber;
use frames::Frames;
use point::Tally;
use run::{Run, Watch};
use variant::{Variant, variants};

/// Seeds between those of repeats, of the reference, and of what checks it.
const SEEDS: u64 = 1 << 32;

/// The reference has so many samples for one of the greatest budget: its noise is a quarter or less.
const REFERENCE_FACTOR: u32 = 16;

/// What checks the reference has one sample for so many.
const CHECK_PART: u32 = 8;

/// What is rendered.
#[derive(Clone, Debug)]
pub struct ConvergenceStudy {
    /// A scene file or a folder.
    pub scene: PathBuf,
    /// The frame; the first unless given.
    pub frame: Option<FrameNumber>,
    /// Columns and rows in place of the scene's.
    pub resolution: Option<[u32; 2]>,
    /// Names of integrators; none for that of the scene.
    pub integrators: Vec<String>,
    /// Settings in place of the scene's, each of which makes a series of every integrator.
    pub settings: Vec<String>,
    /// Samples a pixel.
    pub budgets: Budgets,
    /// Pictures of each budget, at least 2.
    pub repeats: u32,
    /// The first seed.
    pub seed: Option<u64>,
    /// When to stop, counted from the start.
    pub time: Option<Duration>,
    /// A picture that is the reference.
    pub reference: Option<PathBuf>,
    /// Samples of a reference of its own.
    pub reference_samples: Option<u32>,
    /// Relative error of which the time is asked.
    pub error: Option<f64>,
    /// Where a reference of its own is kept.
    pub folder: Option<PathBuf>,
    /// A user's wish to stop.
    pub interrupt: Interrupt,
}

/// What was found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ConvergenceResults {
    /// Name of the scene.
    pub scene: String,
    /// The frame.
    pub frame: String,
    /// Columns and rows.
    pub resolution: [u32; 2],
    /// The reference's file.
    pub reference_file: PathBuf,
    /// What it is.
    pub reference: ReferenceFacts,
    /// The root mean square of its noise.
    pub reference_noise: f64,
    /// The relative error of which the time was asked.
    pub error: Option<f64>,
    /// Every integrator with every setting.
    pub series: Vec<Series>,
    /// Whether all is there.
    pub end: End,
}

/// Why a study ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// Everything is done.
    Complete,
    /// Time was up.
    Time,
    /// It was asked to stop.
    Interrupted,
}

/// One way to render.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Series {
    /// Integrator and settings.
    pub name: String,
    /// What it leaves out.
    pub left_out: Vec<&'static str>,
    /// The budgets of which there are at least two pictures.
    pub points: Vec<BudgetPoint>,
    /// d ln rmse / d ln CPU seconds; of the budgets that all repeats have.
    pub slope_by_time: Option<Estimate>,
    /// d ln rmse / d ln samples.
    pub slope_by_samples: Option<Estimate>,
    /// CPU seconds to the relative error that was asked about, between the ends of their interval.
    pub seconds_to_error: Option<[f64; 3]>,
}

/// Renders and measures; `tell` hears how far it has come.
///
/// # Errors
/// When the frame cannot be rendered, something asked for makes no sense, or it is broken off before there is a reference.
pub fn study_convergence(
    study: &ConvergenceStudy,
    mut tell: impl FnMut(&str),
) -> Result<ConvergenceResults, StudyError> {
    let deadline = study.time.map(|time| Instant::now() + time);
    let watch = Watch { interrupt: study.interrupt.clone(), deadline };
    let mut frames = Frames::open(study)?;
    let variants = variants(frames.settings(), &frames.base().needs, &study.integrators, &study.settings)?;
    for variant in &variants {
        frames.prepare(&variant.render)?;
    }
    let reference = reference_of(study, &mut frames, &watch, &mut tell)?;
    let mut tallies = vec![vec![Tally::default(); study.budgets.0.len()]; variants.len()];
    let end = measure(study, (&frames, &variants), &reference.1, &watch, &mut tallies, &mut tell)?;
    let (reference_file, reference) = reference;
    let series = variants.iter().zip(&tallies).map(|(variant, tallies)| {
        let needs = &frames.of(&variant.render).map_or_else(Default::default, |frame| frame.needs);
        series(study, variant, Integrator::new(&variant.render).left_out(needs), tallies, &reference)
    });
    Ok(ConvergenceResults {
        scene: frames.name().into(),
        frame: frames.number().to_string(),
        resolution: frames.base().views.opening.resolution(),
        reference_file,
        reference_noise: reference.noise(),
        error: study.error,
        series: series.collect(),
        end,
        reference: reference.facts,
    })
}

/// The reference and its file: what the user gave, what is there from before, or a new one.
fn reference_of(
    study: &ConvergenceStudy,
    frames: &mut Frames,
    watch: &Watch,
    tell: &mut impl FnMut(&str),
) -> Result<(PathBuf, Reference), StudyError> {
    let resolution = frames.base().views.opening.resolution();
    if let Some(file) = &study.reference {
        return Ok((file.clone(), Reference::read(file, resolution)?));
    }
    let folder = study.folder.clone().unwrap_or_else(|| Path::new("out/study").join(frames.name()));
    let file = reference::place(&folder);
    let greatest = study.budgets.0.last().copied().unwrap_or(1);
    let samples = study.reference_samples.unwrap_or_else(|| greatest.saturating_mul(REFERENCE_FACTOR));
    let first = study.seed.unwrap_or(frames.settings().seed);
    let (own, other) = frames.estimators(samples, first.wrapping_add(SEEDS));
    frames.prepare(&own)?;
    let frame = frames.of(&own).unwrap_or(frames.base());
    let identity = frames.identity(&own)?;
    if let Some(reference) = Reference::again(&file, &identity, resolution) {
        tell(&format!("reference: {} from before", file.display()));
        return Ok((file, reference));
    }
    let start = Instant::now();
    let mut part_done = |name: &str, part: u32| {
        let seconds = start.elapsed().as_secs_f64();
        tell(&format!("{name}: {part} of {} parts  {seconds:.1} s", reference::PARTS));
    };
    let rendered = Reference::rendered(frame, &own, watch, |part| part_done("reference", part));
    let broken_off = || if watch.is_late() { StudyError::NoTime } else { RenderError::Interrupted.into() };
    let mut reference = rendered.ok_or_else(broken_off)?;
    if let Some(mut other) = other {
        other.samples = samples / CHECK_PART;
        other.seed = first.wrapping_add(2 * SEEDS);
        let check = reference.checked_by(frame, &other, watch, |part| part_done("check", part));
        reference.facts.check = Some(check.ok_or_else(broken_off)?);
    }
    let write = || reference.write(&file, &identity, frames.metadata());
    watch.interrupt.while_writing(write)?;
    Ok((file, reference))
}

/// Renders budget after budget, in each repeat after repeat, in each all series.
fn measure(
    study: &ConvergenceStudy,
    (frames, variants): (&Frames, &[Variant]),
    reference: &Reference,
    watch: &Watch,
    tallies: &mut [Vec<Tally>],
    tell: &mut impl FnMut(&str),
) -> Result<End, StudyError> {
    let noise = reference.corrections();
    let mut seed = study.seed.unwrap_or(frames.settings().seed);
    let start = Instant::now();
    for (b, samples) in study.budgets.0.iter().enumerate() {
        for _ in 0..study.repeats {
            for (variant, tallies) in variants.iter().zip(&mut *tallies) {
                let Some(frame) = frames.of(&variant.render) else { continue };
                match Run::of(frame, &variant.render, (*samples, seed), watch) {
                    Some(run) => tallies[b].add(&run, reference, &noise),
                    None if watch.interrupt.is_requested() => return Ok(End::Interrupted),
                    None => return Ok(End::Time),
                }
            }
            seed = seed.wrapping_add(1);
        }
        for (variant, tallies) in variants.iter().zip(&*tallies) {
            if let Some(point) = tallies[b].point(*samples, reference) {
                let seconds = start.elapsed().as_secs_f64();
                let (cpu, rmse) = (point.cpu_seconds.value, point.rmse.value);
                tell(&format!(
                    "{}: {samples} samples  {cpu:.3} s CPU  rmse {rmse:.3e}  {seconds:.1} s",
                    variant.name
                ));
            }
        }
    }
    Ok(End::Complete)
}

fn series(
    study: &ConvergenceStudy,
    variant: &Variant,
    left_out: Vec<&'static str>,
    tallies: &[Tally],
    reference: &Reference,
) -> Series {
    let budgets = || study.budgets.0.iter().zip(tallies);
    // Of each repeat, the points (ln samples, ln CPU seconds, ln rmse, ln error) of the budgets that are whole.
    let mut repeats: Vec<Vec<[f64; 4]>> = vec![Vec::new(); study.repeats as usize];
    for (samples, tally) in budgets().filter(|(_, tally)| tally.repeats() == study.repeats as usize) {
        for (repeat, [cpu, rmse, error]) in repeats.iter_mut().zip(tally.logarithms().unwrap_or_default()) {
            repeat.push([libm::log(f64::from(*samples)), cpu, rmse, error]);
        }
    }
    let points = |x: usize, y: usize| -> Vec<Vec<[f64; 2]>> {
        repeats.iter().map(|repeat| repeat.iter().map(|p| [p[x], p[y]]).collect()).collect()
    };
    let error = study.error.map(libm::log);
    Series {
        name: variant.name.clone(),
        left_out,
        points: budgets().filter_map(|(samples, tally)| tally.point(*samples, reference)).collect(),
        slope_by_time: slope(&points(1, 2)),
        slope_by_samples: slope(&points(0, 2)),
        seconds_to_error: error.and_then(|error| crossing(&points(1, 3), error)),
    }
}
