//! How far a run has come, for those who are told in numbers.

use std::time::{Duration, Instant};

use serde_json::{Map, Value, json};

use crate::driver::{FrameRecord, Status};
use crate::sequence::FrameNumber;

/// Least time between two tellings of how far a frame is.
const EVERY: Duration = Duration::from_secs(1);

/// How far a run has come. It never goes back.
#[derive(Debug)]
pub struct Advance {
    start: Instant,
    /// When it was told last.
    told: Option<Instant>,
    total: Option<usize>,
    /// Frames of which it is known what became of them.
    done: usize,
    /// The frame that is rendered, and the share of it that is done.
    frame: Option<FrameNumber>,
    share: f64,
    /// Samples of the frames that are done.
    samples: u64,
    /// Sum of the squares of their errors, and how many are known.
    squares: f64,
    known: usize,
}

impl Advance {
    /// Nothing is done.
    pub fn new() -> Self {
        Self {
            start: Instant::now(),
            told: None,
            total: None,
            done: 0,
            frame: None,
            share: 0.0,
            samples: 0,
            squares: 0.0,
            known: 0,
        }
    }

    /// So many frames are asked for.
    pub fn started(&mut self, frames: usize) {
        self.total = Some(frames);
    }

    /// A frame is begun.
    pub fn frame(&mut self, number: FrameNumber) {
        (self.frame, self.share) = (Some(number), 0.0);
    }

    /// So much of it is done; true when it is time to tell it. What only waits for frames is told otherwise.
    pub fn tiles(&mut self, done: usize, of: usize) -> bool {
        // Threads may report out of order.
        self.share = self.share.max(done as f64 / of.max(1) as f64).min(1.0);
        self.total.is_some() && self.is_time()
    }

    /// Whether it has not been told for a while; then it counts as told.
    pub fn is_time(&mut self) -> bool {
        let now = Instant::now();
        let is_time = self.told.is_none_or(|told| now.duration_since(told) >= EVERY);
        if is_time {
            self.told = Some(now);
        }
        is_time
    }

    /// A frame is done, or has failed.
    pub fn finished(&mut self, record: &FrameRecord) {
        self.frame = None;
        // One that was broken off is still to be done, and as far as it has come.
        if matches!(record.status, Status::Interrupted | Status::Preview) {
            return;
        }
        self.share = 0.0;
        self.done += 1;
        self.samples += record.samples;
        if let Some(error) = record.relative_error {
            self.squares += error.estimate * error.estimate;
            self.known += 1;
        }
    }

    /// The share of the run that is done, 0 to 1; `None` where nobody knows how many frames there will be.
    pub fn fraction(&self) -> Option<f64> {
        let total = self.total.filter(|total| *total > 0)? as f64;
        Some(((self.done as f64 + self.share) / total).min(1.0))
    }

    /// Seconds until it is done, if frames go on as they have.
    pub fn eta_seconds(&self) -> Option<f64> {
        let fraction = self.fraction().filter(|fraction| *fraction > 0.0)?;
        Some(self.start.elapsed().as_secs_f64() * (1.0 - fraction) / fraction)
    }

    /// Root of the mean of the squared errors of the frames that are done.
    pub fn relative_error(&self) -> Option<f64> {
        (self.known > 0).then(|| (self.squares / self.known as f64).sqrt())
    }

    /// How far it is, in words.
    pub fn describe(&self) -> String {
        let mut text = match (self.frame, self.total) {
            (Some(frame), Some(total)) => format!("frame {frame}, {} of {total} done", self.done),
            (None, Some(total)) => format!("{} of {total} frames done", self.done),
            (_, None) => format!("{} frames done", self.done),
        };
        if let Some(error) = self.relative_error() {
            text += &format!(", error {:.2} %", 100.0 * error);
        }
        text
    }

    /// An event with all of this.
    pub fn event(&self, event: &str) -> Map<String, Value> {
        let frame = self.frame.map(|frame| frame.to_string());
        let Value::Object(object) = json!({
            "event": event,
            "frame": frame,
            "done": self.done,
            "total": self.total,
            "fraction": self.fraction().map(rounded),
            "samples": self.samples,
            "seconds": rounded(self.start.elapsed().as_secs_f64()),
            "eta_seconds": self.eta_seconds().map(rounded),
            "relative_error": self.relative_error(),
        }) else {
            return Map::new();
        };
        object
    }
}

/// Three decimals are enough of a time or a share.
fn rounded(value: f64) -> f64 {
    (1000.0 * value).round() / 1000.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::driver::ledger::RelativeError;

    fn record(status: Status, error: f64) -> FrameRecord {
        let estimate = RelativeError { estimate: error, low: 0.0, high: 1.0, confidence: 0.95 };
        FrameRecord {
            status,
            samples: 100,
            relative_error: Some(estimate),
            ..FrameRecord::failed("1".into(), None, "a.exr".into())
        }
    }

    #[test]
    fn a_run_never_goes_back() {
        let mut advance = Advance::new();
        assert_eq!((advance.fraction(), advance.eta_seconds()), (None, None));
        advance.started(4);
        advance.frame(FrameNumber::ONE);
        let mut last = 0.0;
        for done in [1, 5, 3, 10, 9] {
            advance.tiles(done, 10);
            assert!(advance.fraction() >= Some(last));
            last = advance.fraction().unwrap();
        }
        assert_eq!(last, 0.25);
        advance.finished(&record(Status::Complete, 0.03));
        assert_eq!(advance.fraction(), Some(0.25));
        advance.finished(&record(Status::Failed, 0.04));
        assert_eq!(advance.describe(), "2 of 4 frames done, error 3.54 %");
        // What was broken off is not done, but in part.
        advance.frame(FrameNumber::ONE);
        advance.tiles(5, 10);
        advance.finished(&record(Status::Interrupted, 0.0));
        assert_eq!((advance.fraction(), advance.done), (Some(0.625), 2));
        let event = advance.event("progress");
        assert_eq!((&event["done"], &event["samples"]), (&2.into(), &200.into()));
    }

    #[test]
    fn it_is_told_at_once_and_then_seldom() {
        let mut advance = Advance::new();
        advance.started(1);
        let told = (0..1000).filter(|done| advance.tiles(*done, 1000)).count();
        let most = 2 + advance.start.elapsed().as_secs() as usize;
        assert!((1..=most).contains(&told), "{told}");
    }
}
