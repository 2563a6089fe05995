//! Comparisons in words and columns, and as JSON.

use std::fmt::Write;

use serde::Serialize;

use super::limits::Verdict;
use super::measure::Comparison;
use super::pairs::Pair;
use crate::sequence::{FrameNumber, format_numbers};

/// A pair and what was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// The pictures.
    pub pair: Pair,
    /// The measures and the verdict, or why there are none.
    pub outcome: Result<(Comparison, Verdict), String>,
}

/// All pairs, and what had no partner.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// By number.
    pub entries: Vec<Entry>,
    /// Frames that A, and that B, does not have.
    pub missing: [Vec<FrameNumber>; 2],
}

impl Report {
    /// Whether any pair differs.
    pub fn differs(&self) -> bool {
        self.entries.iter().any(|entry| matches!(entry.outcome, Ok((_, Verdict::Different(_)))))
    }

    /// All that is known of one pair, or a line a frame.
    pub fn text(&self) -> String {
        let mut text = match &self.entries[..] {
            [Entry { pair: Pair { number: None, .. }, outcome: Ok((found, verdict)) }] => one(found, verdict),
            entries => table(entries),
        };
        for (name, numbers) in ["A", "B"].iter().zip(&self.missing).filter(|(_, numbers)| !numbers.is_empty())
        {
            let _ = writeln!(text, "not in {name}: {}", format_numbers(numbers));
        }
        text
    }

    /// The same for programs, with all digits.
    pub fn json(&self) -> String {
        let [a, b] = self.missing.each_ref().map(|numbers| format_numbers(numbers));
        let frames = self.entries.iter().map(Line::of).collect();
        let whole = Whole { differs: self.differs(), not_in_a: a, not_in_b: b, frames };
        serde_json::to_string_pretty(&whole).unwrap_or_default() + "\n"
    }
}

#[derive(Serialize)]
struct Whole<'a> {
    differs: bool,
    not_in_a: String,
    not_in_b: String,
    frames: Vec<Line<'a>>,
}

/// A pair as JSON.
#[derive(Serialize)]
struct Line<'a> {
    frame: Option<String>,
    a: String,
    b: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<&'a str>,
    #[serde(flatten)]
    verdict: Option<&'a Verdict>,
    #[serde(flatten)]
    found: Option<&'a Comparison>,
}

impl<'a> Line<'a> {
    fn of(entry: &'a Entry) -> Self {
        let outcome = entry.outcome.as_ref();
        Self {
            frame: entry.pair.number.map(|number| number.to_string()),
            a: entry.pair.a.display().to_string(),
            b: entry.pair.b.display().to_string(),
            error: outcome.err().map(String::as_str),
            verdict: outcome.ok().map(|(_, verdict)| verdict),
            found: outcome.ok().map(|(found, _)| found),
        }
    }
}

fn words(verdict: &Verdict) -> String {
    match verdict {
        Verdict::Identical => "identical".into(),
        Verdict::WithinNoise => "within noise".into(),
        Verdict::WithinLimits => "within the limits".into(),
        Verdict::Different(reasons) => format!("different: {}", reasons.join("; ")),
    }
}

fn one(found: &Comparison, verdict: &Verdict) -> String {
    let colour = |c: [f64; 3]| format!("{:.6} {:.6} {:.6}", c[0], c[1], c[2]);
    let [width, height] = found.size;
    let mut lines = vec![
        ("size", format!("{width} x {height} pixels")),
        ("mean of A", colour(found.means[0])),
        ("mean of B", colour(found.means[1])),
        (
            "relMSE",
            format!(
                "{:.4e}, without the worst hundredth {:.4e}, median {:.4e}",
                found.relmse.mean, found.relmse.trimmed, found.relmse.median
            ),
        ),
        ("RMSE", format!("{:.4e}", found.rmse)),
        (
            "difference",
            format!("{:+.3} % of the luminance, mean over pixels", 100.0 * found.relative_difference),
        ),
        ("FLIP", format!("{:.5}", found.flip)),
    ];
    if let Some(greatest) = found.greatest.filter(|_| !found.identical) {
        let [a, b] = [greatest.a, greatest.b].map(|c| colour(c.map(f64::from)));
        lines.push(("greatest", format!("at ({}, {}): {a}, in B {b}", greatest.at[0], greatest.at[1])));
    }
    lines.push(("z-test", test_words(found)));
    let mut text = String::new();
    lines.iter().for_each(|(name, value)| {
        let _ = writeln!(text, "{name:<11}{value}");
    });
    text + &words(verdict) + "\n"
}

fn test_words(found: &Comparison) -> String {
    let Some(test) = &found.z_test else {
        return found.no_test.map_or_else(|| "none".into(), |why| format!("none: {why}"));
    };
    let mut text = format!("p = {:.2e}", test.p);
    if test.detectable.is_finite() {
        text += &format!("; finds a bias of {:.2} % of the whole", 100.0 * test.detectable);
    }
    if test.left_out > 0 {
        text += &format!("; {} pixels left out", test.left_out);
    }
    text
}

fn table(entries: &[Entry]) -> String {
    let heads = ["relMSE", "trimmed", "median", "RMSE", "difference", "FLIP", "p"];
    let mut text = format!("{:<8}", "frame");
    heads.iter().for_each(|head| text += &format!("{head:>11}"));
    text += "  verdict\n";
    for Entry { pair, outcome } in entries {
        let number = pair.number.map_or_else(|| "-".into(), |number| number.to_string());
        text += &format!("{number:<8}");
        text += &match outcome {
            Err(error) => format!("  {error}\n"),
            Ok((found, verdict)) => {
                let columns: String = columns(found).iter().map(|value| format!("{value:>11}")).collect();
                format!("{columns}  {}\n", words(verdict))
            }
        };
    }
    text
}

/// The numbers of a line of the table.
fn columns(found: &Comparison) -> [String; 7] {
    let small = |value: f64| format!("{value:.3e}");
    [
        small(found.relmse.mean),
        small(found.relmse.trimmed),
        small(found.relmse.median),
        small(found.rmse),
        format!("{:+.3} %", 100.0 * found.relative_difference),
        format!("{:.5}", found.flip),
        found.z_test.as_ref().map_or_else(|| "-".into(), |test| small(test.p)),
    ]
}
