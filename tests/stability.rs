//! The stability battery (`floe study --stability`).
#![allow(clippy::print_stdout)]

use floe::study::stability::{Outcome, Selection, run, table};

/// Prints the rows of a selection and panics if one fails.
fn assert_passes(selection: &Selection) {
    println!("{}", table::head());
    let rows = run(selection, |row| println!("{}", table::line(row)));
    println!("{}", table::summary(&rows));
    let failed: Vec<&str> =
        rows.iter().filter(|row| row.outcome == Outcome::Fail).map(|row| row.name.as_str()).collect();
    assert!(!rows.is_empty() && failed.is_empty(), "{failed:?}");
}

#[test]
fn the_quick_cases_are_as_expected() {
    assert_passes(&Selection { quick: true, ..Selection::default() });
}

#[test]
#[ignore = "minutes"]
fn every_case_is_as_expected() {
    let only = std::env::var("FLOE_STABILITY").map(|groups| groups.split(',').map(str::to_owned).collect());
    assert_passes(&Selection { only: only.unwrap_or_default(), quick: false });
}
