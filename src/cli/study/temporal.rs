//! `floe study --temporal`: how noise looks in motion.

use std::path::Path;
use std::time::Instant;

use clap::Args;

use super::Shared;
use crate::cli::exit::Exit;
use crate::cli::files::write;
use crate::cli::streams::{print, say};
use crate::driver::Job;
use crate::sequence::{FrameNumber, FrameSelection};
use crate::study::{SeedModeStudy, StudyError, TemporalStudy, study_seed_modes, table};

#[derive(Debug, Args)]
#[group(requires = "temporal")]
#[command(next_help_heading = "How noise looks in motion")]
pub(super) struct TemporalArguments {
    /// How noise looks in motion, with each render.seed_mode
    #[arg(long, group = "mode")]
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
}

impl TemporalArguments {
    pub(super) fn is_asked_for(&self) -> bool {
        self.temporal
    }
}

pub(super) fn run(scene: &Path, shared: &Shared, arguments: &TemporalArguments) -> Result<Exit, StudyError> {
    let file = shared.output.as_deref().map(results_file).transpose()?;
    let job = Job::open(scene)?;
    let study = SeedModeStudy {
        frames: arguments.frames.clone(),
        hold: arguments.hold,
        samples: arguments.samples,
        seed: shared.seed,
    };
    let start = Instant::now();
    let study = study_seed_modes(&job, &study, |number| {
        if !shared.quiet {
            say(&format!("frame {number}  {:.2} s", start.elapsed().as_secs_f64()));
        }
    })?;
    let written = file.map_or(Exit::Complete, |(file, text)| write(file, &text(&study)));
    Ok(print(&if shared.json { json(&study) } else { table::text(&study) }).max(written))
}

fn json(study: &TemporalStudy) -> String {
    serde_json::to_string_pretty(study).unwrap_or_default() + "\n"
}

type Text = fn(&TemporalStudy) -> String;

/// The file, and what is written into a file of this name.
fn results_file(file: &Path) -> Result<(&Path, Text), StudyError> {
    match file.extension().and_then(|e| e.to_str()) {
        Some("csv") => Ok((file, table::csv)),
        Some("json") => Ok((file, json)),
        _ => Err(StudyError::NotATable { file: file.into() }),
    }
}
