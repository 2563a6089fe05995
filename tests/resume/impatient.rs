//! Signals to a run that is busy with what cannot be broken off: reading a file that does not end.

use std::fs;
use std::process::Command;
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::command::{boxes, command};

/// How long a run that waits for its sky takes to end after so many signals.
fn ends_after(signals: &[&str]) -> Duration {
    let folder = boxes(1, "[sky]\nradiance = { image = \"sky.exr\" }\n");
    let pipe = folder.path("boxes/sky.exr");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let mut child = command(&folder, &["render", "boxes"]).spawn().unwrap();
    // Opening the pipe for writing waits until it is read from, which is after signals are caught.
    let writer = fs::OpenOptions::new().write(true).open(&pipe).unwrap();
    let start = Instant::now();
    for signal in signals {
        let kill = Command::new("sh").args(["-c", "kill -$0 $1", signal, &child.id().to_string()]).status();
        assert!(kill.unwrap().success());
        sleep(Duration::from_millis(50));
    }
    assert_eq!(child.wait().unwrap().code(), Some(75), "{signals:?}");
    let time = start.elapsed();
    drop(writer);
    assert_eq!(folder.leftovers(), [""; 0]);
    time
}

/// One that is busy ends 1.5 s after the first signal, and at once after the second, which is sent 0.05 s later: 0.7 s is
/// less than half of the former and leaves room for a machine with other things to do.
#[test]
fn a_second_signal_ends_a_busy_run_at_once() {
    for signals in [["TERM", "TERM"], ["INT", "TERM"]] {
        let once = ends_after(&signals[..1]);
        assert!(once > Duration::from_millis(1400) && once < Duration::from_secs(2), "{once:?}");
        let twice = ends_after(&signals);
        assert!(twice < Duration::from_millis(700), "{twice:?}");
    }
}
