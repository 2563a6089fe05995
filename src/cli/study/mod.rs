//! `floe study`: one file a mode. A mode is chosen by its flag, which belongs to the group `mode`; without one it is the
//! study of convergence.
//!
//! Options of one mode stand in its file, in a group that `requires` its flag (those of convergence, which has none,
//! conflict with `mode`); those of several stand here, and what a
//! mode has no use for it `conflicts_with`.

mod convergence;
mod stability;
mod temporal;

use std::path::PathBuf;

use clap::Args;

use super::exit::Exit;
use super::streams::say;
use crate::sequence::FrameNumber;
use crate::study::StudyError;

#[derive(Debug, Args)]
pub struct StudyArguments {
    /// A scene file, or a folder with scene.toml or with frames
    #[arg(required_unless_present = "stability", conflicts_with = "stability")]
    scene: Option<PathBuf>,
    #[command(flatten)]
    shared: Shared,
    #[command(flatten)]
    convergence: convergence::ConvergenceArguments,
    #[command(flatten)]
    temporal: temporal::TemporalArguments,
    #[command(flatten)]
    stability: stability::StabilityArguments,
}

/// What several modes take.
#[derive(Debug, Args)]
struct Shared {
    /// The frame to study [default: the first]
    #[arg(long, value_name = "N", allow_hyphen_values = true, conflicts_with_all = ["temporal", "stability"])]
    frame: Option<FrameNumber>,
    /// The first seed; others follow it [default: render.seed of the scene]
    #[arg(long, value_name = "S", conflicts_with = "stability")]
    seed: Option<u64>,
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
    /// The folder of the results [default: out/study/NAME; with --stability none]; with --temporal a file that ends with
    /// .csv or .json
    #[arg(long, short, value_name = "PATH")]
    output: Option<PathBuf>,
    /// Only errors and the results
    #[arg(long, short)]
    quiet: bool,
}

/// Renders, measures and prints.
pub fn run(arguments: &StudyArguments) -> Exit {
    let StudyArguments { scene, shared, convergence, temporal, stability } = arguments;
    let result = match scene {
        None => Ok(stability::run(shared, stability)),
        Some(scene) if temporal.is_asked_for() => temporal::run(scene, shared, temporal),
        Some(scene) => convergence::run(scene, shared, convergence),
    };
    result.unwrap_or_else(|error| {
        say(&format!("error: {error}"));
        match error {
            StudyError::Render(error) => Exit::from(&error),
            StudyError::Reference { .. } => Exit::BadData,
            _ => Exit::Usage,
        }
    })
}
