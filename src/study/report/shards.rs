//! How evenly shards shared the work.
//!
//! ```text
//! imbalance = seconds of the longest shard / mean over the shards                        (1)
//! ```
//! A run is over when its last shard is: with (1) at 1.25 it takes a quarter longer than it need. Seconds are those that
//! the lines of a shard took, so a worker that waited for a node counts for what it did.

use serde::Serialize;

use super::{Effort, FrameReport, threshold};
use crate::driver::FrameRecord;
use crate::driver::ledgers::LedgerLine;

/// The shards.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Shards {
    /// In order; the ledger of whole runs first.
    pub shards: Vec<ShardReport>,
    /// (1) of those that have a number; `None` with fewer than two.
    pub imbalance: Option<f64>,
    /// Seconds from the beginning of the first line to the end of the last one, by the clocks of the machines.
    pub elapsed_seconds: Option<f64>,
}

/// A shard.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShardReport {
    /// Its number; `None` of runs that were none.
    pub shard: Option<u32>,
    /// Pictures whose newest line it wrote.
    pub pictures: usize,
    /// What its lines took.
    pub effort: Effort,
    /// When its first line was begun, in seconds after that of all.
    pub begins: Option<f64>,
    /// When its last line was written, likewise.
    pub ends: Option<f64>,
    /// Whether it took much longer than most.
    pub straggler: bool,
}

impl Shards {
    pub(super) fn of(lines: &[&LedgerLine], frames: &[FrameReport]) -> Self {
        let first = lines.iter().filter_map(|line| begun(&line.record)).reduce(f64::min);
        let last = lines.iter().filter_map(|line| line.record.ended).reduce(f64::max);
        let mut numbers: Vec<Option<u32>> = lines.iter().map(|line| line.shard).collect();
        numbers.sort_unstable();
        numbers.dedup();
        let shard = |number: &Option<u32>| {
            let own = || lines.iter().filter(|line| line.shard == *number).map(|line| &line.record);
            let since = |time: Option<f64>| Some(time? - first?);
            let is_own = |frame: &&FrameReport| frame.state.is_there() && frame.shard == *number;
            ShardReport {
                shard: *number,
                pictures: frames.iter().filter(is_own).count(),
                effort: own().map(Effort::of).sum(),
                begins: since(own().filter_map(begun).reduce(f64::min)),
                ends: since(own().filter_map(|record| record.ended).reduce(f64::max)),
                straggler: false,
            }
        };
        let mut shards: Vec<ShardReport> = numbers.iter().map(shard).collect();
        let times: Vec<f64> =
            shards.iter().filter(|shard| shard.shard.is_some()).map(|shard| shard.effort.seconds).collect();
        let limit = threshold(&times).unwrap_or(f64::INFINITY);
        shards.iter_mut().for_each(|shard| shard.straggler = shard.effort.seconds > limit);
        let elapsed_seconds = first.zip(last).map(|(first, last)| last - first);
        Self { shards, imbalance: imbalance(&times), elapsed_seconds }
    }
}

fn begun(record: &FrameRecord) -> Option<f64> {
    Some(record.ended? - record.seconds())
}

/// (1).
fn imbalance(times: &[f64]) -> Option<f64> {
    let mean = times.iter().sum::<f64>() / times.len() as f64;
    let longest = times.iter().copied().fold(0.0, f64::max);
    (times.len() > 1 && mean > 0.0).then(|| longest / mean)
}
