//! SIGTERM and SIGINT save the frame and end the run; a second one ends it at once. SIGUSR1 saves the frame.

use std::thread;
use std::time::{Duration, Instant};

use signal_hook::consts::{SIGINT, SIGTERM, SIGUSR1};
use signal_hook::iterator::Signals;

use super::exit::Exit;
use super::streams::say;
use crate::driver::Interrupt;

/// Schedulers wait little before they kill. What has not ended by then (a mesh being read, a hierarchy being built) has
/// nothing to save.
const PATIENCE: Duration = Duration::from_millis(1500);

/// What comes so soon after the first is the same request: `timeout`, and shells that pass on what they get, signal the
/// process and its group.
const ECHO: Duration = Duration::from_millis(100);

/// Turns signals into requests to a run from now on.
pub fn obey(interrupt: &Interrupt) {
    let interrupt = interrupt.clone();
    match Signals::new([SIGTERM, SIGINT, SIGUSR1]) {
        Ok(mut signals) => drop(thread::spawn(move || {
            let mut first: Option<Instant> = None;
            for signal in signals.forever() {
                match (signal, first) {
                    (SIGUSR1, _) => interrupt.request_save(),
                    (_, Some(first)) if first.elapsed() >= ECHO => end(),
                    (_, Some(_)) => {}
                    (_, None) => {
                        first = Some(Instant::now());
                        stop(&interrupt);
                    }
                }
            }
        })),
        Err(error) => say(&format!("warning: signals cannot be caught ({error}): they end the run unsaved")),
    }
}

fn stop(interrupt: &Interrupt) {
    interrupt.request();
    say("stopping; once more stops at once");
    let interrupt = interrupt.clone();
    thread::spawn(move || {
        thread::sleep(PATIENCE);
        while interrupt.is_writing() {
            thread::sleep(Duration::from_millis(10));
        }
        end();
    });
}

/// Files appear in one step, so there is no moment at which this does harm.
#[expect(
    clippy::exit,
    reason = "the threads that render may be busy for long with what is of no use any more"
)]
fn end() {
    std::process::exit(Exit::Interrupted as i32);
}
