//! What the user was warned of, and how often.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::driver::ledgers::LedgerLine;
use crate::sequence::{FrameNumber, format_numbers};

/// Warnings that say the same but for their numbers.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct WarningCount {
    /// The first of them.
    pub text: String,
    /// How many there are.
    pub count: usize,
    /// Of which frames.
    pub frames: String,
}

/// Counts the warnings of all lines, the most frequent first.
pub(super) fn of(lines: &[&LedgerLine]) -> Vec<WarningCount> {
    let mut kinds: BTreeMap<String, (String, usize, Vec<FrameNumber>)> = BTreeMap::new();
    for line in lines {
        for text in &line.record.warnings {
            let text = text.strip_prefix(&format!("frame {}: ", line.record.frame)).unwrap_or(text);
            let (_, count, frames) = kinds.entry(kind(text)).or_insert((text.to_owned(), 0, Vec::new()));
            *count += 1;
            frames.push(line.number);
        }
    }
    let mut counts: Vec<WarningCount> = kinds
        .into_values()
        .map(|(text, count, frames)| WarningCount { text, count, frames: format_numbers(&frames) })
        .collect();
    counts.sort_by_key(|warning| std::cmp::Reverse(warning.count));
    counts
}

/// The text without its numbers.
fn kind(text: &str) -> String {
    let is_number = |c: char| c.is_ascii_digit() || c == '.';
    text.split(is_number).filter(|part| !part.is_empty()).collect::<Vec<_>>().join("#")
}
