//! What the lines of each frame tell together.

use std::iter::Sum;
use std::ops::AddAssign;
use std::path::PathBuf;

use serde::Serialize;

use super::Effort;
use crate::driver::ledger::{PerPixel, RelativeError};
use crate::driver::ledgers::LedgerLine;
use crate::driver::{FrameRecord, Status, StoppedBy};
use crate::sequence::FrameNumber;

/// What there is of a frame, by its newest line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum State {
    /// Its picture.
    Complete,
    /// The picture of a frame whose time was up.
    Cut,
    /// No picture, and why is known.
    Failed,
    /// A run that was broken off.
    Interrupted,
    /// A look at it.
    Preview,
    /// No line.
    Missing,
}

/// A frame.
#[derive(Clone, Debug, Serialize)]
pub struct FrameReport {
    /// Its number.
    pub frame: String,
    /// The same, to reckon with.
    #[serde(skip)]
    pub number: FrameNumber,
    /// What there is.
    pub state: State,
    /// Which shard wrote the newest line.
    pub shard: Option<u32>,
    /// The picture.
    pub output: PathBuf,
    /// Why there is none.
    pub error: Option<String>,
    /// What its picture took, in all runs.
    pub effort: Effort,
    /// Reading and checking it, building the hierarchy: mostly while the frame before was rendered.
    pub prepare_seconds: f64,
    /// How long nothing was rendered because it was not ready.
    pub wait_seconds: f64,
    /// Light transport.
    pub render_seconds: f64,
    /// Writing.
    pub write_seconds: f64,
    /// Samples of a pixel.
    pub samples_per_pixel: Option<PerPixel>,
    /// Why there are not more.
    pub stopped_by: Option<StoppedBy>,
    /// Estimated relative error.
    pub relative_error: Option<RelativeError>,
    /// How often it was broken off before its newest line.
    pub restarts: usize,
    /// How often it failed before its newest line.
    pub failures: usize,
    /// Warnings of its newest line.
    pub warnings: usize,
    /// Whether it took much longer than most.
    pub straggler: bool,
    /// When the newest line was written, in seconds since 1970.
    pub ended: Option<f64>,
}

impl State {
    /// All, in the order in which they are told.
    pub const ALL: [Self; 6] =
        [Self::Complete, Self::Cut, Self::Failed, Self::Interrupted, Self::Preview, Self::Missing];

    /// One word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Complete => "complete",
            Self::Cut => "cut",
            Self::Failed => "failed",
            Self::Interrupted => "interrupted",
            Self::Preview => "preview",
            Self::Missing => "missing",
        }
    }

    fn of(record: &FrameRecord) -> Self {
        match record.status {
            Status::Complete if record.stopped_by == Some(StoppedBy::Time) => Self::Cut,
            Status::Complete => Self::Complete,
            Status::Failed => Self::Failed,
            Status::Interrupted => Self::Interrupted,
            Status::Preview => Self::Preview,
            // Some of its samples: its picture is still to be merged.
            Status::Partial => Self::Interrupted,
        }
    }

    /// Whether there is a picture.
    pub fn is_there(self) -> bool {
        matches!(self, Self::Complete | Self::Cut)
    }
}

impl Effort {
    /// What a line took.
    pub fn of(record: &FrameRecord) -> Self {
        let seconds = record.seconds();
        let thread_seconds = seconds * record.threads.max(1) as f64;
        Self {
            lines: 1,
            seconds,
            cpu_seconds: record.cpu_seconds.unwrap_or(thread_seconds),
            thread_seconds,
            samples: record.samples,
        }
    }
}

impl AddAssign for Effort {
    fn add_assign(&mut self, other: Self) {
        self.lines += other.lines;
        self.seconds += other.seconds;
        self.cpu_seconds += other.cpu_seconds;
        self.thread_seconds += other.thread_seconds;
        self.samples += other.samples;
    }
}

impl Sum for Effort {
    fn sum<I: Iterator<Item = Self>>(iter: I) -> Self {
        iter.fold(Self::default(), |mut sum, effort| {
            sum += effort;
            sum
        })
    }
}

/// The frames, in order, and what was drawn before the pictures that count. Lines of a frame follow each other in time.
pub(super) fn of(lines: &[&LedgerLine], expected: &[FrameNumber]) -> (Vec<FrameReport>, Effort) {
    let mut superseded = Effort::default();
    let mut frames: Vec<FrameReport> = Vec::new();
    for lines in lines.chunk_by(|a, b| a.number == b.number) {
        let (before, own) = lines.split_at(first_of_picture(lines));
        superseded += before.iter().map(|line| Effort::of(&line.record)).sum();
        frames.extend(frame(own));
    }
    let is_known = |number: &FrameNumber| frames.binary_search_by_key(number, |frame| frame.number).is_ok();
    let missing: Vec<FrameReport> =
        expected.iter().filter(|number| !is_known(number)).map(|number| absent(*number)).collect();
    frames.extend(missing);
    frames.sort_by_key(|frame| frame.number);
    (frames, superseded)
}

/// The first line that is about the picture of the newest one: that after the last picture that was done.
fn first_of_picture(lines: &[&LedgerLine]) -> usize {
    let earlier = &lines[..lines.len() - 1];
    earlier.iter().rposition(|line| State::of(&line.record) == State::Complete).map_or(0, |at| at + 1)
}

fn frame(lines: &[&LedgerLine]) -> Option<FrameReport> {
    let (newest, before) = lines.split_last()?;
    let record = &newest.record;
    let sum = |seconds: fn(&FrameRecord) -> f64| lines.iter().map(|line| seconds(&line.record)).sum();
    let count = |state: State| before.iter().filter(|line| State::of(&line.record) == state).count();
    let mut effort: Effort = lines.iter().map(|line| Effort::of(&line.record)).sum();
    // Those before a checkpoint are among them.
    effort.samples = record.samples;
    Some(FrameReport {
        frame: newest.number.to_string(),
        number: newest.number,
        state: State::of(record),
        shard: newest.shard,
        output: record.output.clone(),
        error: record.error.clone(),
        effort,
        prepare_seconds: sum(|record| record.read_seconds + record.build_seconds),
        wait_seconds: sum(|record| record.wait_seconds),
        render_seconds: sum(|record| record.render_seconds),
        write_seconds: sum(|record| record.write_seconds),
        samples_per_pixel: record.samples_per_pixel,
        stopped_by: record.stopped_by,
        relative_error: record.relative_error,
        restarts: count(State::Interrupted),
        failures: count(State::Failed),
        warnings: record.warnings.len(),
        straggler: false,
        ended: record.ended,
    })
}

fn absent(number: FrameNumber) -> FrameReport {
    FrameReport {
        frame: number.to_string(),
        number,
        state: State::Missing,
        shard: None,
        output: PathBuf::new(),
        error: None,
        effort: Effort::default(),
        prepare_seconds: 0.0,
        wait_seconds: 0.0,
        render_seconds: 0.0,
        write_seconds: 0.0,
        samples_per_pixel: None,
        stopped_by: None,
        relative_error: None,
        restarts: 0,
        failures: 0,
        warnings: 0,
        straggler: false,
        ended: None,
    }
}
