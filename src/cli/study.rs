//! `floe study`

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;

use super::exit::Exit;
use super::streams::{print, say};
use crate::driver::{Job, RenderError};
use crate::film::write::write_atomically;
use crate::sequence::{FrameNumber, FrameSelection};
use crate::study::{SeedModeStudy, StudyError, TemporalStudy, study_seed_modes, table};

#[derive(Debug, Args)]
pub struct StudyArguments {
    /// A scene file, or a folder with scene.toml or with frames
    scene: PathBuf,
    /// How noise looks in motion, with each render.seed_mode
    #[arg(long, required = true)]
    temporal: bool,
    /// Only these frames, at least 8 [default: all]; of a still, the numbers that it is rendered with
    #[arg(long, value_name = "RANGE", value_parser = FrameSelection::parse, allow_hyphen_values = true)]
    frames: Option<FrameSelection>,
    /// Show this frame's mesh in all frames, as if nothing moved
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    hold: Option<FrameNumber>,
    /// Samples a pixel [default: render.samples of the scene]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    samples: Option<u32>,
    /// The first of two seeds that follow each other [default: render.seed of the scene]
    #[arg(long, value_name = "S")]
    seed: Option<u64>,
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
    /// Write the results here too: .csv or .json
    #[arg(long, short, value_name = "FILE", value_parser = results_file)]
    output: Option<PathBuf>,
    /// Only errors and the results
    #[arg(long, short)]
    quiet: bool,
}

/// Renders, measures and prints.
pub fn run(arguments: &StudyArguments) -> Exit {
    match study(arguments) {
        Ok(study) => {
            let written = arguments.output.as_ref().map_or(Exit::Complete, |file| write(file, &study));
            print(&if arguments.json { json(&study) } else { table::text(&study) }).max(written)
        }
        Err(error) => {
            say(&format!("error: {error}"));
            match error {
                StudyError::Render(error) => Exit::from(&error),
                _ => Exit::Usage,
            }
        }
    }
}

fn study(arguments: &StudyArguments) -> Result<TemporalStudy, StudyError> {
    let job = Job::open(&arguments.scene)?;
    let study = SeedModeStudy {
        frames: arguments.frames.clone(),
        hold: arguments.hold,
        samples: arguments.samples,
        seed: arguments.seed,
    };
    let start = Instant::now();
    study_seed_modes(&job, &study, |number| {
        if !arguments.quiet {
            say(&format!("frame {number}  {:.2} s", start.elapsed().as_secs_f64()));
        }
    })
}

fn json(study: &TemporalStudy) -> String {
    serde_json::to_string_pretty(study).unwrap_or_default() + "\n"
}

fn write(file: &std::path::Path, study: &TemporalStudy) -> Exit {
    let is_json = file.extension().is_some_and(|e| e == "json");
    let text = if is_json { json(study) } else { table::csv(study) };
    match write_atomically(file, text.as_bytes()) {
        Ok(()) => Exit::Complete,
        Err(error) => {
            say(&format!("error: {error}"));
            Exit::from(&RenderError::from(error))
        }
    }
}

fn results_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension().and_then(|e| e.to_str()) {
        Some("csv" | "json") => Ok(path),
        _ => Err(format!("write a name that ends with .csv or .json, such as {text}.csv")),
    }
}
