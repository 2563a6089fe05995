//! Frames, and shards, that take much longer than most.
//!
//! ```text
//! longer than max(median + 3.5 MAD / 0.6745, 1.5 median)        [IGLEWICZ93]
//! ```
//! MAD is the median of the distances from the median; over 0.6745 it is the standard deviation where times are normal. A
//! few frames that are much slower move neither, as they would a mean. Times of a sequence may be so alike that 3.5
//! deviations are next to nothing: half as long again is the least that is worth a look.

use serde::Serialize;

use super::FrameReport;

/// Fewer times have no outliers: with four, one of them may be a quarter of what there is.
const LEAST: usize = 5;

/// How many of the slowest frames are told.
const TOLD: usize = 5;

/// The slowest frames.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Slow {
    /// Median of the seconds that pictures took.
    pub median_seconds: Option<f64>,
    /// What took more seconds than this is a straggler; `None` where there are too few pictures.
    pub threshold_seconds: Option<f64>,
    /// Which are.
    pub stragglers: Vec<String>,
    /// The slowest ones, whatever the threshold, and why.
    pub slowest: Vec<SlowFrame>,
}

/// A frame that took long.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SlowFrame {
    /// Its number.
    pub frame: String,
    /// Seconds over those of the median frame.
    pub times_median: f64,
    /// Its samples over those of the median frame.
    pub times_samples: f64,
    /// Its seconds of light transport a sample over those of the median frame.
    pub times_sample_seconds: f64,
    /// What most of the difference is: `wait`, `render` or `write`.
    pub most: &'static str,
}

/// The time above which something took much longer than most.
pub fn threshold(times: &[f64]) -> Option<f64> {
    let middle = median(times.to_vec()).filter(|_| times.len() >= LEAST)?;
    let deviation = median(times.iter().map(|time| (time - middle).abs()).collect())?;
    Some((middle + 3.5 * deviation / 0.6745).max(1.5 * middle))
}

/// The middle value, or the mean of the two.
pub(super) fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => None,
        even if even.is_multiple_of(2) => Some(0.5 * (values[middle - 1] + values[middle])),
        _ => Some(values[middle]),
    }
}

impl Slow {
    /// Of the frames that have pictures.
    pub(super) fn of(frames: &[FrameReport]) -> Self {
        let mut done: Vec<&FrameReport> = frames.iter().filter(|frame| frame.state.is_there()).collect();
        let over = |value: fn(&FrameReport) -> f64| median(done.iter().map(|frame| value(frame)).collect());
        let times: Vec<f64> = done.iter().map(|frame| frame.effort.seconds).collect();
        let threshold_seconds = threshold(&times);
        let typical = Typical {
            seconds: over(|frame| frame.effort.seconds),
            samples: over(|frame| frame.effort.samples as f64),
            sample_seconds: over(sample_seconds),
            parts: [over(|f| f.wait_seconds), over(|f| f.render_seconds), over(|f| f.write_seconds)],
        };
        let is_long = |frame: &&&FrameReport| threshold_seconds.is_some_and(|t| frame.effort.seconds > t);
        let stragglers = done.iter().filter(is_long).map(|frame| frame.frame.clone()).collect();
        done.sort_by(|a, b| b.effort.seconds.total_cmp(&a.effort.seconds));
        let slowest = done.iter().take(TOLD).map(|frame| typical.compare(frame)).collect();
        Self { median_seconds: typical.seconds, threshold_seconds, stragglers, slowest }
    }
}

/// Medians over the frames.
struct Typical {
    seconds: Option<f64>,
    samples: Option<f64>,
    sample_seconds: Option<f64>,
    parts: [Option<f64>; 3],
}

impl Typical {
    fn compare(&self, frame: &FrameReport) -> SlowFrame {
        let over = |value: f64, median: Option<f64>| value / median.unwrap_or(f64::NAN);
        let parts = [frame.wait_seconds, frame.render_seconds, frame.write_seconds];
        let excess = |part: usize| parts[part] - self.parts[part].unwrap_or(0.0);
        let most = (0..3).max_by(|a, b| excess(*a).total_cmp(&excess(*b))).unwrap_or(1);
        SlowFrame {
            frame: frame.frame.clone(),
            times_median: over(frame.effort.seconds, self.seconds),
            times_samples: over(frame.effort.samples as f64, self.samples),
            times_sample_seconds: over(sample_seconds(frame), self.sample_seconds),
            most: ["wait", "render", "write"][most],
        }
    }
}

fn sample_seconds(frame: &FrameReport) -> f64 {
    frame.render_seconds / frame.effort.samples.max(1) as f64
}
