//! When a frame is done: at its last sample, at its target, or when its time is up.

use serde::{Deserialize, Serialize};

/// How good a frame is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Relative error that the upper end of the confidence interval is to be at or below.
    pub error: f64,
    /// Confidence of the interval.
    pub confidence: f64,
}

/// Why a frame has no more samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum StoppedBy {
    /// There are as many as were asked for.
    Samples,
    /// Its error is as small as was asked for.
    Target,
    /// Its time was up.
    Time,
}

impl StoppedBy {
    /// Its name in pictures, ledger and summary.
    pub fn name(self) -> &'static str {
        match self {
            Self::Samples => "samples",
            Self::Target => "target",
            Self::Time => "time",
        }
    }
}

/// Tells whether another round fits into the time that is left, by what those before it have taken.
///
/// A round is begun when at least half of it fits, so that a frame ends at the whole round that is nearest to the end of
/// its time. How long samples take is shared by all pixels, and so has hardly to do with what a single one of them
/// brings; but it has, so a picture that is cut is not unbiased to the last digit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pace {
    /// Seconds that were left, and what was drawn, when the pace was first taken; `None` without end.
    start: Option<(f64, u64)>,
}

impl Pace {
    /// The pace of a frame of which so much is drawn.
    pub fn new(seconds_left: Option<f64>, drawn: u64) -> Self {
        Self { start: seconds_left.map(|left| (left, drawn)) }
    }

    /// Whether time may run out at all.
    pub fn is_limited(&self) -> bool {
        self.start.is_some()
    }

    /// Whether it is worth while to draw `next` more.
    pub fn allows(&self, seconds_left: Option<f64>, drawn: u64, next: u64) -> bool {
        let (Some((before, drawn_before)), Some(left)) = (self.start, seconds_left) else { return true };
        let each = match drawn.saturating_sub(drawn_before) {
            0 => 0.0,
            measured => (before - left).max(0.0) / measured as f64,
        };
        left > 0.0 && 0.5 * each * next as f64 <= left
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_round_is_begun_when_half_of_it_fits() {
        let pace = Pace::new(Some(10.0), 100);
        // 200 have taken 4 seconds: 600 take 12, of which 6 are left; 601 are too many.
        assert!(pace.allows(Some(6.0), 300, 600) && !pace.allows(Some(6.0), 300, 601));
        assert!(!pace.allows(Some(0.0), 300, 1) && !pace.allows(Some(-1.0), 300, 1));
        // Nothing is known of a frame that has just gone on from a checkpoint.
        assert!(pace.allows(Some(9.0), 100, 1 << 40));
        assert!(!Pace::new(None, 0).is_limited() && Pace::new(None, 0).allows(None, 5, 1 << 40));
    }
}
