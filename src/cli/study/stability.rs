//! `floe study --stability`: whether numbers stay right where a parameter makes a scene hard.

use std::path::Path;

use clap::Args;

use super::Shared;
use crate::cli::exit::Exit;
use crate::cli::files::write;
use crate::cli::streams::{print, say};
use crate::study::stability::{self, GROUPS, Outcome, Row, Selection, diagram, table};

#[derive(Debug, Args)]
#[group(requires = "stability")]
#[command(next_help_heading = "Whether numbers stay right in hard scenes")]
pub(super) struct StabilityArguments {
    /// Whether numbers stay right where a parameter makes a scene hard; scenes of its own
    #[arg(long, group = "mode")]
    stability: bool,
    /// Only this group of cases; several with several --only
    #[arg(long, value_name = "GROUP", conflicts_with = "scene", value_parser = GROUPS.map(|group| group.name))]
    only: Vec<String>,
    /// Only the cases that are quick
    #[arg(long, conflicts_with = "scene")]
    quick: bool,
}

/// Prints each row when it is there; fails when one does.
pub(super) fn run(shared: &Shared, arguments: &StabilityArguments) -> Exit {
    let selection = Selection { only: arguments.only.clone(), quick: arguments.quick };
    let shows_columns = !shared.json;
    let mut printed = if shows_columns { print(&(table::head() + "\n")) } else { Exit::Complete };
    let rows = stability::run(&selection, |row| {
        if shows_columns && (!shared.quiet || row.outcome != Outcome::Pass) {
            printed = printed.max(print(&(table::line(row) + "\n")));
        }
    });
    let results = if shows_columns { table::summary(&rows) + "\n" } else { json(&rows) };
    let written = shared.output.as_deref().map_or(Exit::Complete, |folder| write_all(folder, &rows));
    let failed = rows.iter().any(|row| row.outcome == Outcome::Fail);
    let judged = if failed { Exit::Internal } else { Exit::Complete };
    if failed {
        say("error: cases failed; each says how far it is off");
    }
    printed.max(print(&results)).max(written).max(judged)
}

fn json(rows: &[Row]) -> String {
    serde_json::to_string_pretty(rows).unwrap_or_default() + "\n"
}

/// Every form of the results, in a folder: tables of all, and a diagram a group.
fn write_all(folder: &Path, rows: &[Row]) -> Exit {
    let tables = [("csv", table::csv(rows)), ("json", json(rows)), ("md", table::markdown(rows))];
    let tables = tables.map(|(ending, text)| (format!("stability.{ending}"), text));
    let drawn = GROUPS.iter().filter_map(|group| Some((group, diagram::of(group, rows)?)));
    let diagrams = drawn.map(|(group, plot)| (format!("stability_{}.svg", group.name), plot.svg()));
    let files = tables.into_iter().chain(diagrams);
    files.map(|(name, text)| write(&folder.join(name), &text)).max().unwrap_or(Exit::Complete)
}
