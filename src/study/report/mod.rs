//! What the ledgers of a sequence tell: what is there, what it took, how good it is, and what held it up.
//!
//! Lines of all shards are put together. What counts of a frame is its newest line; what was drawn before towards the
//! same picture (broken off, failed, cut) is in what it took, and what was drawn before that is told apart. So a frame that was
//! interrupted twice takes what all three runs took.

mod csv;
mod diagram;
mod errors;
mod frames;
mod shards;
mod slow;
#[cfg(test)]
mod tests;
mod text;
mod warnings;

use std::path::PathBuf;

use serde::Serialize;

pub use csv::csv;
pub use diagram::diagram;
pub use errors::{ErrorCost, Errors};
pub use frames::{FrameReport, State};
pub use shards::{ShardReport, Shards};
pub use slow::{Slow, threshold};
pub use text::text;
pub use warnings::WarningCount;

use crate::driver::ledgers::{Ledgers, Unusable};
use crate::sequence::FrameNumber;

/// What became of a sequence.
#[derive(Clone, Debug, Serialize)]
pub struct SequenceReport {
    /// The ledgers.
    pub ledgers: Vec<PathBuf>,
    /// The frames, in order.
    pub frames: Vec<FrameReport>,
    /// What all lines together took.
    pub total: Effort,
    /// What of it was for pictures that were drawn again later.
    pub superseded: Effort,
    /// How good the pictures are; `None` where no error is known.
    pub errors: Option<Errors>,
    /// Which frames took long, and what "long" is.
    pub slow: Slow,
    /// The shards, and how evenly they shared.
    pub shards: Shards,
    /// What the user was warned of, the most frequent first.
    pub warnings: Vec<WarningCount>,
    /// What is no line of these pictures.
    pub unusable: Vec<Unusable>,
}

/// What lines took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Effort {
    /// How many lines.
    pub lines: usize,
    /// Waiting, rendering and writing.
    pub seconds: f64,
    /// CPU seconds; of lines that do not tell, seconds times threads.
    pub cpu_seconds: f64,
    /// Seconds times threads: what was held for them.
    pub thread_seconds: f64,
    /// Samples over all pixels, also those before a checkpoint.
    pub samples: u64,
}

impl SequenceReport {
    /// What ledgers tell of the frames that are wanted, and of `expected` ones that they do not know of.
    pub fn new(ledgers: &Ledgers, expected: &[FrameNumber], is_wanted: impl Fn(FrameNumber) -> bool) -> Self {
        let lines: Vec<_> = ledgers.lines.iter().filter(|line| is_wanted(line.number)).collect();
        let (mut frames, superseded) = frames::of(&lines, expected);
        let slow = Slow::of(&frames);
        frames.iter_mut().for_each(|frame| frame.straggler = slow.stragglers.contains(&frame.frame));
        Self {
            ledgers: ledgers.files.clone(),
            total: lines.iter().map(|line| Effort::of(&line.record)).sum(),
            superseded,
            errors: Errors::of(&frames),
            slow,
            shards: Shards::of(&lines, &frames),
            warnings: warnings::of(&lines),
            unusable: ledgers.unusable.clone(),
            frames,
        }
    }
}
