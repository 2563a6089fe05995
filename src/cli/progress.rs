//! What the user sees while frames are rendered: a bar on a terminal, a line a frame elsewhere.

use std::io::IsTerminal;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::streams::say;
use crate::driver::{FrameRecord, Observer, Status};
use crate::sequence::FrameNumber;

/// Progress on standard error.
pub struct Progress {
    bar: ProgressBar,
    terminal: bool,
    quiet: bool,
}

impl Progress {
    /// A bar when standard error is a terminal; with `quiet` only warnings and errors.
    pub fn new(quiet: bool) -> Self {
        let terminal = std::io::stderr().is_terminal() && !quiet;
        let target = if terminal { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(0), target);
        let style =
            ProgressStyle::with_template("{wide_bar:.cyan/blue} {percent:>3} %  {msg}  {elapsed}  eta {eta}")
                .unwrap_or_else(|_| ProgressStyle::default_bar());
        bar.set_style(style);
        Self { bar, terminal, quiet }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }

    fn line(&self, text: &str) {
        if self.terminal {
            self.bar.suspend(|| say(text));
        } else {
            say(text);
        }
    }
}

/// Parts that one frame of the bar is divided into.
const PARTS: u64 = 1000;

impl Observer for Progress {
    fn started(&self, frames: usize) {
        self.bar.set_length(frames as u64 * PARTS);
    }

    fn frame(&self, number: FrameNumber) {
        self.bar.set_message(format!("frame {number}"));
    }

    fn tiles(&self, done: usize, of: usize) {
        // The bar only moves forward: threads may report out of order.
        let frame = self.bar.position() / PARTS * PARTS;
        let position = frame + (done as u64 * (PARTS - 1)) / of as u64;
        if position > self.bar.position() {
            self.bar.set_position(position);
        }
    }

    fn warning(&self, text: &str) {
        self.line(&format!("warning: {text}"));
    }

    fn finished(&self, record: &FrameRecord) {
        self.bar.set_position((self.bar.position() / PARTS + 1) * PARTS);
        if record.status == Status::Interrupted {
            self.line(&format!("frame {:>6}  interrupted", record.frame));
        } else if let Some(error) = &record.error {
            self.line(&format!("error: frame {}: {error}", record.frame));
        } else if !self.quiet && record.status == Status::Complete {
            let error = record
                .relative_error
                .map_or_else(|| "error unknown".into(), |e| format!("error {:.2} %", 100.0 * e.estimate));
            self.line(&format!(
                "frame {:>6}  {:>7.2} s  {error:<14}  {}",
                record.frame,
                record.seconds(),
                record.output.display()
            ));
        }
    }
}
