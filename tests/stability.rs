//! The stability battery (`floe study --stability`).
#![allow(clippy::print_stdout)]

use floe::study::stability::{GROUPS, Outcome, Selection, run, table};

/// Prints the rows of a selection and panics if one fails.
fn assert_passes(selection: &Selection) {
    println!("{}", table::head());
    let rows = run(selection, |row| println!("{}", table::line(row)));
    println!("{}", table::summary(&rows));
    let failed: Vec<&str> =
        rows.iter().filter(|row| row.outcome == Outcome::Fail).map(|row| row.name.as_str()).collect();
    assert!(!rows.is_empty() && failed.is_empty(), "{failed:?}");
}

/// What is documented was made by `floe study --stability --output DIR`, and is about all cases.
#[test]
fn the_page_has_a_row_for_every_case_and_none_that_fails() {
    let page = include_str!("../src/study/stability.md");
    let rows = page.lines().filter(|line| line.starts_with("| ") && !line.starts_with("| ---"));
    let cases = GROUPS.iter().flat_map(|group| (group.cases)());
    let mut count = 0;
    for case in cases {
        let beginning = format!("| {} | {} |", table::number(case.parameter), case.name);
        assert!(page.contains(&beginning), "stability.md lacks {beginning}");
        count += 1;
    }
    assert_eq!(rows.count(), count + GROUPS.len(), "rows of cases that are no more");
    assert!(!page.contains("FAIL"));
}

#[test]
fn the_quick_cases_are_as_expected() {
    assert_passes(&Selection { quick: true, ..Selection::default() });
}

/// `FLOE_STABILITY=sun,scale` runs these groups only.
#[test]
#[ignore = "minutes"]
fn every_case_is_as_expected() {
    let only = std::env::var("FLOE_STABILITY").map(|groups| groups.split(',').map(str::to_owned).collect());
    assert_passes(&Selection { only: only.unwrap_or_default(), quick: false });
}
