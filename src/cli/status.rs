//! `floe status`

use std::fmt::Write;
use std::time::Duration;

use clap::Args;
use serde_json::json;

use super::duration::time;
use super::exit::Exit;
use super::settings::Settings;
use super::streams::{print, say};
use crate::driver::{FrameState, Job, survey};
use crate::sequence::{FrameNumber, format_numbers};

#[derive(Debug, Args)]
pub struct StatusArguments {
    #[command(flatten)]
    settings: Settings,
    /// End with 75 unless every frame is there
    #[arg(long)]
    require_complete: bool,
    /// How many frames there are to be for --require-complete, since ranges of --frames take what there is
    #[arg(long, value_name = "N", requires = "require_complete")]
    expect: Option<usize>,
    /// Take frames that were cut after so much light transport, or more, for complete: 30s, 5m, 1h, as in render
    #[arg(long, value_name = "TIME", value_parser = time)]
    time_budget: Option<Duration>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

type States = [(FrameNumber, FrameState)];

/// Prints which frames are there and which are not, as ranges that `--frames` takes.
pub fn run(arguments: &StatusArguments) -> Exit {
    let found =
        Job::open(&arguments.settings.scene).and_then(|job| survey(&job, &arguments.settings.options()));
    let (states, pattern) = match found {
        Ok(found) => found,
        Err(error) => {
            say(&format!("error: {error}"));
            return Exit::from(&error);
        }
    };
    let printed = print(&if arguments.json { as_json(&states, &pattern) } else { as_text(&states) });
    if let Some(expected) = arguments.expect.filter(|expected| *expected > states.len()) {
        say(&format!("{} of {expected} frames are there", states.len()));
    }
    let is_complete = arguments.expect.is_none_or(|expected| states.len() >= expected)
        && states.iter().all(|(_, state)| state.is_enough(arguments.time_budget));
    if arguments.require_complete && !is_complete { printed.max(Exit::Interrupted) } else { printed }
}

fn name(state: &FrameState) -> &'static str {
    match state {
        FrameState::Complete => "complete",
        FrameState::Cut(_) => "cut",
        FrameState::Unmerged => "unmerged",
        FrameState::Parts(_) => "parts",
        FrameState::Partial => "partial",
        FrameState::Missing => "missing",
        FrameState::Stale => "stale",
        FrameState::Corrupt(_) => "corrupt",
        FrameState::Unreadable(_) => "unreadable",
    }
}

const NAMES: [&str; 9] =
    ["complete", "cut", "unmerged", "parts", "partial", "missing", "stale", "corrupt", "unreadable"];

fn numbers(states: &States, wanted: &str) -> Vec<FrameNumber> {
    states.iter().filter(|(_, state)| name(state) == wanted).map(|(number, _)| *number).collect()
}

fn problem(state: &FrameState) -> Option<&str> {
    match state {
        FrameState::Parts(reason) | FrameState::Corrupt(reason) | FrameState::Unreadable(reason) => {
            Some(reason)
        }
        _ => None,
    }
}

/// A line for each state that there is, then one for each problem.
fn as_text(states: &States) -> String {
    let mut text = String::new();
    for wanted in NAMES {
        let numbers = numbers(states, wanted);
        if !numbers.is_empty() {
            let _ = writeln!(text, "{wanted:<10} {}", format_numbers(&numbers));
        }
    }
    if states.iter().any(|(_, state)| *state == FrameState::Unmerged) {
        text += "unmerged frames have partials of all their samples: `floe merge` makes their pictures\n";
    }
    for (number, state) in states {
        if let Some(problem) = problem(state) {
            let _ = writeln!(text, "frame {number}: {problem}");
        }
    }
    text
}

fn as_json(states: &States, pattern: &str) -> String {
    let problems: Vec<_> = states
        .iter()
        .filter_map(|(number, state)| {
            Some(json!({ "frame": number.to_string(), "problem": problem(state)? }))
        })
        .collect();
    let mut all = json!({ "frames": states.len(), "pictures": pattern, "problems": problems });
    for wanted in NAMES {
        all[wanted] = format_numbers(&numbers(states, wanted)).into();
    }
    format!("{all}\n")
}
