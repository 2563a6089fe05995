//! `floe study`: error against run time.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;

use super::Shared;
use crate::cli::duration::duration;
use crate::cli::exit::Exit;
use crate::cli::files::write;
#[cfg(unix)]
use crate::cli::signals;
use crate::cli::streams::{print, say};
use crate::driver::Interrupt;
use crate::study::convergence::{Budgets, ConvergenceResults, End, report};
use crate::study::{ConvergenceStudy, StudyError, study_convergence};

#[derive(Debug, Args)]
#[group(conflicts_with = "mode")]
#[command(next_help_heading = "Error against run time")]
pub(super) struct ConvergenceArguments {
    /// Integrators to compare [default: that of the scene; if that is `auto`, path, and photon where the sun needs it]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    integrators: Vec<String>,
    /// Settings in place of those of `[render]`, for a series of each integrator: "split = 2, forced_scattering = 1"; may
    /// be given several times, also as "" for none
    #[arg(long, value_name = "SETTINGS")]
    settings: Vec<String>,
    /// Samples a pixel: 4-256, which doubles in between, or 4,12,36
    #[arg(long, value_name = "N", default_value = "4-256")]
    budgets: Budgets,
    /// Pictures of each budget, with seeds that follow each other
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(2..=10_000))]
    repeats: u32,
    /// Columns and rows of the pictures, such as 160x90 [default: camera.resolution]
    #[arg(long, value_name = "SIZE", value_parser = resolution)]
    resolution: Option<[u32; 2]>,
    /// A picture to measure against, with its variance if it has one [default: one is rendered and kept]
    #[arg(long, value_name = "FILE", conflicts_with = "reference_samples")]
    reference: Option<PathBuf>,
    /// Samples of the reference that is rendered [default: 16 times the greatest budget]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1 << 30))]
    reference_samples: Option<u32>,
    /// Tell how long this relative error takes, such as 0.05
    #[arg(long, value_name = "E", value_parser = positive)]
    error: Option<f64>,
    /// Stop after so long, such as 5m, with what is there by then
    #[arg(long, value_name = "TIME", value_parser = duration)]
    time: Option<Duration>,
}

pub(super) fn run(
    scene: &Path,
    shared: &Shared,
    arguments: &ConvergenceArguments,
) -> Result<Exit, StudyError> {
    let interrupt = Interrupt::default();
    #[cfg(unix)]
    signals::obey(&interrupt);
    let study = ConvergenceStudy {
        scene: scene.into(),
        frame: shared.frame,
        resolution: arguments.resolution,
        integrators: arguments.integrators.clone(),
        settings: arguments.settings.clone(),
        budgets: arguments.budgets.clone(),
        repeats: arguments.repeats,
        seed: shared.seed,
        time: arguments.time,
        reference: arguments.reference.clone(),
        reference_samples: arguments.reference_samples,
        error: arguments.error,
        folder: shared.output.clone(),
        interrupt: interrupt.clone(),
    };
    let results = study_convergence(&study, |progress| {
        if !shared.quiet {
            say(progress);
        }
    })?;
    let folder = shared.output.clone().unwrap_or_else(|| Path::new("out/study").join(&results.scene));
    let written = interrupt.while_writing(|| write_all(&folder, &results));
    let text = if shared.json { report::json(&results) } else { report::text(&results) };
    let ended = if results.end == End::Interrupted { Exit::Interrupted } else { Exit::Complete };
    Ok(print(&text).max(written).max(ended))
}

fn write_all(folder: &Path, results: &ConvergenceResults) -> Exit {
    let files = [
        ("study.csv", report::csv(results)),
        ("study.json", report::json(results)),
        ("study.svg", report::plot(results).svg()),
        ("study.html", report::html(results)),
    ];
    files.iter().map(|(name, text)| write(&folder.join(name), text)).fold(Exit::Complete, Exit::max)
}

fn resolution(text: &str) -> Result<[u32; 2], String> {
    let number = |text: &str| text.trim().parse().ok().filter(|n| (1..=16_384).contains(n));
    let pair = text.split_once('x').and_then(|(width, height)| Some([number(width)?, number(height)?]));
    pair.ok_or_else(|| "write columns and rows such as 160x90".into())
}

fn positive(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.parse().ok().filter(|n: &f64| n.is_finite() && *n > 0.0);
    number.ok_or_else(|| "write a number above 0, such as 0.05".into())
}
