//! `floe optics MEDIUM`

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;

use super::named::{self, Refusal, Request};
use super::wavelengths::{WavelengthList, wavelengths};
use crate::cli::exit::Exit;
use crate::cli::files::write;
use crate::cli::streams::{print, say};
use crate::optics::particles::Cache;
use crate::study::medium::{Comparison, MediumReport, MediumStudy, csv, diagrams, text};

/// The end of the help text.
pub(super) const EXAMPLES: &str = "\
Examples:
  floe optics                                                lists models and presets
  floe optics baltic --output out/baltic                     a table, and diagrams of it
  floe optics baltic --set cdom=0.5 --compare baltic         what dissolved matter changes
  floe optics iceberg --set ice_density=894 --wavelengths 450,550,650 --json --phase
  floe optics my_scene/scene.toml:sea --column 25            a medium of a scene file";

#[derive(Debug, Args)]
pub(super) struct MediumArguments {
    /// A preset or a model by its name, or SCENE:NAME for a medium of a scene file or folder; without it all are listed
    medium: Option<String>,
    /// A key of the model as in a scene file, such as temperature=10; may be given several times
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Wavelengths of the table in nm: 400,550,700 or 400..700:25 [default: 380..780:20]
    #[arg(long, value_name = "LIST", value_parser = wavelengths)]
    wavelengths: Option<WavelengthList>,
    /// Metres of the medium that white light is shown through
    #[arg(long, value_name = "M", default_value_t = 10.0, value_parser = length, allow_hyphen_values = true)]
    column: f64,
    /// A second medium beside it; --set is for the first
    #[arg(long, value_name = "OTHER")]
    compare: Option<String>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// With the phase function, over angles in degrees
    #[arg(long, requires = "json")]
    phase: bool,
    /// Write the table as comma-separated values
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Write everything into a folder: diagrams (svg), tables (csv, json), and a page of them (html)
    #[arg(long, short, value_name = "FOLDER")]
    output: Option<PathBuf>,
}

/// Computes, prints and writes.
pub(super) fn run(arguments: &MediumArguments) -> Exit {
    results(arguments).unwrap_or_else(|Refusal { exit, message }| {
        say(&format!("error: {message}"));
        exit
    })
}

fn results(arguments: &MediumArguments) -> Result<Exit, Refusal> {
    let Some(medium) = &arguments.medium else {
        return Err(Refusal::usage(format!("name a medium. {}", named::list())));
    };
    let first = Request::new(medium, &arguments.set)?;
    let second = arguments.compare.as_ref().map(|other| Request::new(other, &[])).transpose()?;
    let start = Instant::now();
    let cache = Cache::of_user();
    let report = |request: Request| {
        let wavelengths = arguments.wavelengths.clone().unwrap_or_default().0;
        let Request { name, subject, warnings, blame } = request;
        let study = MediumStudy { name, subject, warnings, wavelengths, column: arguments.column };
        study
            .run(&cache)
            .map_err(|error| Refusal { exit: blame, message: format!("{}: {error}", study.name) })
    };
    let found = match (report(first)?, second.map(report).transpose()?) {
        (a, Some(b)) => Found::Two(Box::new(Comparison { a, b })),
        (report, None) => Found::One(Box::new(report)),
    };
    let seconds = start.elapsed().as_secs_f64();
    for report in found.reports() {
        report.warnings.iter().for_each(|warning| say(&format!("warning: {}: {warning}", report.medium)));
    }
    let shown = match arguments.json {
        true => found.json(arguments.phase),
        // The only thing here that is not the same every time.
        false => {
            let kept = found.reports().iter().filter(|report| report.was_kept).count();
            let kept = if kept > 0 { ", with scattering from the cache" } else { "" };
            format!("{}computed in {seconds:.2} s{kept}\n", found.text())
        }
    };
    let files = arguments.csv.as_deref().map_or(Exit::Complete, |file| write(file, &found.csv()));
    let folder = arguments.output.as_deref().map_or(Exit::Complete, |folder| found.write_all(folder));
    Ok(print(&shown).max(files).max(folder))
}

/// One medium or two.
enum Found {
    One(Box<MediumReport>),
    Two(Box<Comparison>),
}

impl Found {
    fn reports(&self) -> Vec<&MediumReport> {
        match self {
            Self::One(report) => vec![report],
            Self::Two(comparison) => vec![&comparison.a, &comparison.b],
        }
    }

    fn text(&self) -> String {
        match self {
            Self::One(report) => text::of(report),
            Self::Two(comparison) => text::of_both(comparison),
        }
    }

    fn json(&self, with_phase: bool) -> String {
        match self {
            Self::One(report) => report.json(with_phase),
            Self::Two(comparison) => comparison.json(with_phase),
        }
    }

    fn csv(&self) -> String {
        match self {
            Self::One(report) => csv::coefficients(report),
            Self::Two(comparison) => csv::both(comparison),
        }
    }

    /// Every form, with phase functions, into a folder.
    fn write_all(&self, folder: &Path) -> Exit {
        let reports = self.reports();
        let diagrams = diagrams::all(&reports);
        let title = reports.iter().map(|report| report.medium.as_str()).collect::<Vec<_>>().join(" and ");
        let mut files = vec![
            ("optics.csv".to_owned(), self.csv()),
            ("optics.json".to_owned(), self.json(true)),
            ("optics.html".to_owned(), diagrams::html(&title, &diagrams, &self.text())),
        ];
        for (report, name) in reports.iter().zip(["phase.csv", "phase_b.csv"]) {
            files.push((name.to_owned(), csv::phase(report)));
        }
        files.extend(diagrams.into_iter().map(|(name, svg)| (format!("{name}.svg"), svg)));
        files.iter().map(|(name, text)| write(&folder.join(name), text)).fold(Exit::Complete, Exit::max)
    }
}

fn length(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|metres| metres.is_finite() && *metres > 0.0);
    number.ok_or_else(|| format!("\"{text}\" is no length: write metres above 0, such as 10"))
}
