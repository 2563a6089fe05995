//! Progress for people: a bar on a terminal, a line a frame elsewhere.

use super::Reporter;
use crate::cli::screen::Screen;
use crate::driver::{FrameRecord, Observer, Status};
use crate::sequence::FrameNumber;

/// Progress on standard error.
pub struct Bars {
    screen: Screen,
}

impl Bars {
    /// A bar when that is wanted and standard error is a terminal; with `quiet` only warnings and errors.
    pub fn new(quiet: bool, bar: bool) -> Self {
        let template = "{wide_bar:.cyan/blue} {percent:>3} %  {msg}  {elapsed}  eta {eta}";
        Self { screen: Screen::new(quiet, bar, Some(0), template) }
    }
}

impl Reporter for Bars {
    fn clear(&self) {
        self.screen.finish();
    }
}

/// Parts that one frame of the bar is divided into.
const PARTS: u64 = 1000;

impl Observer for Bars {
    fn started(&self, frames: usize) {
        self.screen.bar.set_length(frames as u64 * PARTS);
    }

    fn frame(&self, number: FrameNumber) {
        self.screen.bar.set_message(format!("frame {number}"));
    }

    fn tiles(&self, done: usize, of: usize) {
        // The bar only moves forward: threads may report out of order.
        let frame = self.screen.bar.position() / PARTS * PARTS;
        let position = frame + (done as u64 * (PARTS - 1)) / of as u64;
        if position > self.screen.bar.position() {
            self.screen.bar.set_position(position);
        }
    }

    fn warning(&self, text: &str) {
        self.screen.line(&format!("warning: {text}"));
    }

    fn finished(&self, record: &FrameRecord) {
        self.screen.bar.set_position((self.screen.bar.position() / PARTS + 1) * PARTS);
        if record.status == Status::Interrupted {
            self.screen.line(&format!("frame {:>6}  interrupted", record.frame));
        } else if let Some(error) = &record.error {
            self.screen.line(&format!("error: frame {}: {error}", record.frame));
        } else if !self.screen.quiet && matches!(record.status, Status::Complete | Status::Partial) {
            let error = record
                .relative_error
                .map_or_else(|| "error unknown".into(), |e| format!("error {:.2} %", 100.0 * e.estimate));
            self.screen.line(&format!(
                "frame {:>6}  {:>7.2} s  {error:<14}  {}",
                record.frame,
                record.seconds(),
                record.output.display()
            ));
        }
    }
}
