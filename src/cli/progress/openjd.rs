//! Progress for Open Job Description, which reads it from standard output.
//!
//! ```text
//! openjd_progress: 0 to 100      openjd_status: text      openjd_fail: text
//! ```
//! 100 is told when all is there, and never before. What else is said goes to standard error as plain lines, and a session
//! takes these into its log. Errors are told there as well as by `openjd_fail`.

use std::sync::{Mutex, PoisonError};

use serde_json::Value;

use super::Reporter;
use super::advance::Advance;
use crate::cli::exit::Exit;
use crate::cli::streams::{direct, say};
use crate::cli::watching::describe;
use crate::driver::{FrameRecord, Job, Observer, Status, WatchStatus};
use crate::sequence::FrameNumber;

/// Directives on standard output.
pub struct OpenJd {
    quiet: bool,
    state: Mutex<State>,
}

struct State {
    advance: Advance,
    /// What was told last, in tenths of a per cent.
    tenths: Option<u32>,
    status: String,
}

impl OpenJd {
    /// With `quiet` only of errors.
    pub fn new(quiet: bool) -> Self {
        let state = State { advance: Advance::new(), tenths: None, status: String::new() };
        Self { quiet, state: Mutex::new(state) }
    }

    /// Changes what is known, and tells it if the change is one that is to be told.
    fn on(&self, change: impl FnOnce(&mut Advance) -> bool) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if change(&mut state.advance) && !self.quiet {
            let status = state.advance.describe();
            state.tell(&status);
        }
    }
}

impl State {
    /// Tells what is new.
    fn tell(&mut self, status: &str) {
        if let Some(tenths) = self.advance.fraction().map(tenths)
            && Some(tenths) > self.tenths
        {
            self.tenths = Some(tenths);
            direct("progress", &format!("{}.{}", tenths / 10, tenths % 10));
        }
        if self.status != status {
            direct("status", status);
            self.status = status.into();
        }
    }
}

/// Of what is not at its end.
fn tenths(fraction: f64) -> u32 {
    ((1000.0 * fraction) as u32).min(999)
}

impl Observer for OpenJd {
    fn started(&self, frames: usize) {
        self.on(|advance| {
            advance.started(frames);
            true
        });
    }

    fn frame(&self, number: FrameNumber) {
        self.on(|advance| {
            advance.frame(number);
            advance.is_time()
        });
    }

    fn tiles(&self, done: usize, of: usize) {
        self.on(|advance| advance.tiles(done, of));
    }

    fn warning(&self, text: &str) {
        say(&format!("warning: {text}"));
    }

    fn finished(&self, record: &FrameRecord) {
        if record.status == Status::Failed {
            say(&format!("error: frame {}: {}", record.frame, record.error.as_deref().unwrap_or("unknown")));
        }
        self.on(|advance| {
            advance.finished(record);
            true
        });
    }

    fn opened(&self, job: &Job, _: &str) {
        if let Some(scene) = &job.written_scene {
            say(&format!("wrote {}: edit it to change camera, light and media", scene.display()));
        }
    }

    fn watching(&self, status: &WatchStatus) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if state.advance.is_time() && !self.quiet {
            state.tell(&describe(status));
        }
    }
}

impl Reporter for OpenJd {
    fn ended(&self, _: Value, exit: Exit) {
        match exit {
            Exit::Complete if !self.quiet => direct("progress", "100"),
            Exit::Interrupted => {
                direct("fail", "interrupted: the same command goes on (render: with --resume)")
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_is_not_told_before_it_is_reached() {
        let told = [0.0, 0.0004, 0.5, 0.9999, 1.0].map(tenths);
        assert_eq!(told, [0, 0, 500, 999, 999]);
    }
}
