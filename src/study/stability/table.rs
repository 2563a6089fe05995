//! The results of the battery as text in columns, as comma-separated values and as a page of Markdown.

use std::fmt::Write;

use super::{GROUPS, Outcome, Row};

/// Text columns: width of the name of a case.
const NAME: usize = 52;

/// The head of the columns.
pub fn head() -> String {
    format!(
        "{:<14}{:<NAME$}{:>10}{:>13}{:>13}{:>9}{:>9}{:>9}{:>8}  {}",
        "group", "case", "parameter", "expected", "got", "error", "allowed", "flights", "s", "outcome"
    )
}

/// One row in columns; what there is to say about it is on lines of its own.
pub fn line(row: &Row) -> String {
    let mut text = format!(
        "{:<14}{:<NAME$}{:>10}{:>13.6e}{:>13.6e}{:>9.1e}{:>9.1e}{:>9.1e}{:>8.2}  {}",
        row.group,
        row.name,
        number(row.parameter),
        row.expected,
        row.got,
        (row.got - row.expected).abs(),
        row.allowed,
        row.flights,
        row.seconds,
        name(row.outcome),
    );
    for said in [&row.lost, &row.note].into_iter().filter(|said| !said.is_empty()) {
        let _ = write!(text, "\n{:14}{said}", "");
    }
    text
}

/// How many rows ended how.
pub fn summary(rows: &[Row]) -> String {
    let count = |outcome| rows.iter().filter(|row| row.outcome == outcome).count();
    let seconds: f64 = rows.iter().map(|row| row.seconds).sum();
    format!(
        "{} cases in {seconds:.0} s: {} pass, {} explained, {} fail",
        rows.len(),
        count(Outcome::Pass),
        count(Outcome::Explained),
        count(Outcome::Fail)
    )
}

/// A line of heads and a line a row; numbers have all their digits.
pub fn csv(rows: &[Row]) -> String {
    let mut text = "group,case,parameter,reference,expected,got,standard_error,allowed,error,flights,seconds,outcome,lost,note\n"
        .to_owned();
    for row in rows {
        let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
        let reference = format!("{:?}", row.reference);
        let numbers =
            [row.expected, row.got, row.standard_error, row.allowed, row.error, row.flights, row.seconds]
                .map(|x| format!("{x:e}"));
        let _ = writeln!(
            text,
            "{},{},{:e},{reference},{},{},{},{}",
            row.group,
            quoted(&row.name),
            row.parameter,
            numbers.join(","),
            name(row.outcome),
            quoted(&row.lost),
            quoted(&row.note)
        );
    }
    text
}

/// The beginning of the page.
const HEAD: &str = "# Stability\n\n\
    What is off by how much where a parameter makes a scene hard, and how much it may be: 4.5 standard errors, and what the case\n\
    derives. Flights are those of a sample, traced or not. What was lost is what was counted.\n";

/// A page with a table a group.
pub fn markdown(rows: &[Row]) -> String {
    let mut text = HEAD.to_owned();
    for group in GROUPS {
        let own: Vec<&Row> = rows.iter().filter(|row| row.group == group.name).collect();
        if own.is_empty() {
            continue;
        }
        let _ = write!(
            text,
            "\n### {}\n{}\n\n| {} | case | expected | got | off by | allowed | flights | outcome |\n\
             |---|---|---|---|---|---|---|---|\n",
            group.name, group.about, group.parameter
        );
        for row in own {
            let said: Vec<&str> =
                [row.lost.as_str(), &row.note].into_iter().filter(|t| !t.is_empty()).collect();
            let said = if said.is_empty() { String::new() } else { format!(": {}", said.join("; ")) };
            let _ = writeln!(
                text,
                "| {} | {} | {:.6e} | {:.6e} | {:.1e} | {:.1e} | {} | {}{said} |",
                number(row.parameter),
                row.name,
                row.expected,
                row.got,
                (row.got - row.expected).abs(),
                row.allowed,
                number(row.flights),
                name(row.outcome),
            );
        }
    }
    text
}

/// The name of an outcome.
pub fn name(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Pass => "pass",
        Outcome::Explained => "explained",
        Outcome::Fail => "FAIL",
    }
}

/// A parameter, short.
pub fn number(x: f64) -> String {
    if x == 0.0 || (1e-3..1e5).contains(&x.abs()) {
        format!("{x:.6}").trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{x:e}")
    }
}
