//! What is told while frames are rendered: to people on a terminal or in a log, or to machines.
//!
//! `--progress`, else `FLOE_PROGRESS`, says in which [`Manner`]. A [`Reporter`] hears what happens and tells it.

mod advance;
mod bars;
mod json;
mod openjd;

use clap::{Args, ValueEnum};
use serde_json::Value;

use super::exit::Exit;
use super::streams::{Form, say, speak};
use crate::driver::Observer;
use crate::sequence::Shard;

pub(super) use bars::Bars;
use json::Json;
use openjd::OpenJd;

/// Name of the variable that stands in for the option.
const VARIABLE: &str = "FLOE_PROGRESS";

#[derive(Debug, Args)]
pub struct ProgressArguments {
    /// How it is told how far it is [default: FLOE_PROGRESS, else auto]
    #[arg(long, value_enum, value_name = "HOW")]
    progress: Option<Manner>,
    /// Only warnings, errors and the summary
    #[arg(long, short)]
    quiet: bool,
}

/// How progress is told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Manner {
    /// A bar on a terminal, else plain lines
    #[default]
    Auto,
    /// A JSON object a line on standard error
    Json,
    /// Directives of Open Job Description on standard output
    Openjd,
    /// A line a frame, without colours
    Plain,
    /// Only warnings, errors and the summary
    None,
}

/// Hears what happens and tells it; at the end also what became of it all.
pub trait Reporter: Observer {
    /// Nothing more is rendered, and results are about to be printed.
    fn clear(&self) {}
    /// The results, and how the command ends.
    fn ended(&self, _results: Value, _exit: Exit) {}
}

/// What tells of a run in the manner that is asked for, in which all else is said from now on too; `bars` makes what
/// tells people, quietly or not, with a bar or without.
pub fn reporter(
    asked: &ProgressArguments,
    shard: Option<Shard>,
    bars: impl FnOnce(bool, bool) -> Box<dyn Reporter>,
) -> Box<dyn Reporter> {
    let quiet = asked.quiet;
    match asked.progress.unwrap_or_else(of_environment) {
        Manner::Json => {
            speak(Form::Json);
            Box::new(Json::new(quiet, shard))
        }
        Manner::Openjd => {
            speak(Form::OpenJd);
            Box::new(OpenJd::new(quiet))
        }
        Manner::Auto => bars(quiet, true),
        Manner::Plain => bars(quiet, false),
        Manner::None => bars(true, false),
    }
}

fn of_environment() -> Manner {
    let Some(text) = std::env::var_os(VARIABLE).filter(|text| !text.is_empty()) else { return Manner::Auto };
    Manner::from_str(&text.to_string_lossy(), true).unwrap_or_else(|_| {
        say(&format!(
            "warning: {VARIABLE} = {} is not heeded: write auto, json, openjd, plain or none",
            text.display()
        ));
        Manner::Auto
    })
}
