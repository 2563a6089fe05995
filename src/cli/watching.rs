//! What the user sees while frames are waited for: a line that changes on a terminal, a line an event elsewhere.

use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use super::progress::Reporter;
use super::screen::Screen;
use crate::driver::watch::Phase;
use crate::driver::{FrameRecord, Job, Observer, Status, WatchStatus};

/// The state of a watch on standard error.
pub struct Watching {
    screen: Screen,
    /// What was waited for when that was told last.
    waiting: Mutex<Option<String>>,
}

impl Watching {
    /// A changing line when that is wanted and standard error is a terminal; with `quiet` only warnings and errors.
    pub fn new(quiet: bool, bar: bool) -> Self {
        let screen = Screen::new(quiet, bar, None, "{spinner} {wide_msg}");
        if screen.terminal {
            screen.bar.enable_steady_tick(Duration::from_millis(250));
        }
        Self { screen, waiting: Mutex::new(None) }
    }

    /// Says what is waited for, each time that the waiting begins.
    fn tell_waiting(&self, status: &WatchStatus) {
        let mut known = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        let waiting = match &status.phase {
            Phase::Waiting(what) => Some(what.clone()),
            Phase::Reading(_) => return,
            Phase::Rendering(_) => None,
        };
        if *known != waiting {
            if let (Some(what), false) = (&waiting, self.screen.quiet) {
                self.screen.line(&format!("waiting for {what}"));
            }
            *known = waiting;
        }
    }
}

impl Reporter for Watching {
    fn clear(&self) {
        self.screen.finish();
    }
}

impl Observer for Watching {
    fn opened(&self, job: &Job, _: &str) {
        if let Some(scene) = &job.written_scene {
            self.screen
                .line(&format!("wrote {}: edit it to change camera, light and media", scene.display()));
        }
    }

    fn watching(&self, status: &WatchStatus) {
        if self.screen.terminal {
            self.screen.bar.set_message(describe(status));
        } else {
            self.tell_waiting(status);
        }
    }

    fn warning(&self, text: &str) {
        self.screen.line(&format!("warning: {text}"));
    }

    fn finished(&self, record: &FrameRecord) {
        let kind = match record.status {
            Status::Failed => {
                let error = record.error.as_deref().unwrap_or("unknown");
                return self.screen.line(&format!("error: frame {}: {error}", record.frame));
            }
            _ if self.screen.quiet => return,
            Status::Interrupted => {
                return self.screen.line(&format!("frame {} is not done yet", record.frame));
            }
            Status::Preview => "preview",
            Status::Complete | Status::Partial => "frame",
        };
        let error =
            record.relative_error.map_or_else(String::new, |e| format!("error {:.2} %", 100.0 * e.estimate));
        let seconds = record.seconds();
        let picture = match record.status {
            Status::Preview => record.output.with_extension("png"),
            _ => record.output.clone(),
        };
        self.screen.line(&format!(
            "{kind:<7} {:>6}  {seconds:>7.2} s  {error:<14}  {}",
            record.frame,
            picture.display()
        ));
    }
}

/// The state in one line.
pub fn describe(status: &WatchStatus) -> String {
    let phase = match &status.phase {
        Phase::Waiting(what) => format!("waiting for {what}"),
        Phase::Reading(number) => format!("reading frame {number}"),
        Phase::Rendering(all) => {
            let one = |r: &crate::driver::watch::Rendering| {
                let what = if r.preview { "preview of frame" } else { "frame" };
                format!("{what} {} {:.0} %", r.number, 100.0 * r.share)
            };
            format!("rendering {}", all.iter().map(one).collect::<Vec<_>>().join(", "))
        }
    };
    let mut text = format!("{phase}; {} drawn, {} waiting", status.drawn, status.queue);
    if status.failed > 0 {
        text += &format!(", {} failed", status.failed);
    }
    if let Some(rate) = status.frames_per_hour {
        text += &format!(", {rate:.0} frames an hour");
    }
    text
}
