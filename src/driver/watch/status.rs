//! What is going on, for a line on a terminal or a page.

use std::collections::VecDeque;
use std::time::Duration;

use crate::sequence::FrameNumber;

/// What the loop is doing.
#[derive(Clone, Debug, PartialEq)]
pub enum Phase {
    /// Nothing can be done before something happens; for what.
    Waiting(String),
    /// Reads and checks a frame.
    Reading(FrameNumber),
    /// Renders.
    Rendering(Vec<Rendering>),
}

/// A frame that is being rendered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rendering {
    /// Which.
    pub number: FrameNumber,
    /// Whether it is a preview of few samples.
    pub preview: bool,
    /// The share of its tiles that are done, 0 to 1.
    pub share: f32,
}

/// The state of a watch.
#[derive(Clone, Debug, PartialEq)]
pub struct WatchStatus {
    /// What it is doing.
    pub phase: Phase,
    /// Frames that wait to be drawn, those that are being rendered not among them.
    pub queue: usize,
    /// Frames that have a picture of their file as it was when it was read.
    pub drawn: usize,
    /// Frames whose file is bad.
    pub failed: usize,
    /// Finished pictures an hour, over the last of them; `None` before the second.
    pub frames_per_hour: Option<f64>,
}

/// So many pictures are looked back upon.
const REMEMBERED: usize = 20;

/// The rate of finished pictures.
#[derive(Clone, Debug, Default)]
pub(super) struct Rate(VecDeque<Duration>);

impl Rate {
    /// A picture was finished.
    pub fn count(&mut self, now: Duration) {
        if self.0.len() > REMEMBERED {
            self.0.pop_front();
        }
        self.0.push_back(now);
    }

    /// Pictures an hour.
    pub fn per_hour(&self) -> Option<f64> {
        let (first, last) = (self.0.front()?, self.0.back()?);
        let hours = last.saturating_sub(*first).as_secs_f64() / 3600.0;
        (hours > 0.0).then(|| (self.0.len() - 1) as f64 / hours)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_is_that_of_the_last_pictures() {
        let mut rate = Rate::default();
        assert_eq!(rate.per_hour(), None);
        rate.count(Duration::from_secs(10));
        assert_eq!(rate.per_hour(), None);
        // Slow ones, then one every 36 s.
        for seconds in (1000..).step_by(1000).take(30).chain((40_000..).step_by(36).take(50)) {
            rate.count(Duration::from_secs(seconds));
        }
        assert_eq!(rate.per_hour(), Some(100.0));
    }
}
