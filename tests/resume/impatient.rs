//! Signals to a run that is busy with what cannot be broken off: reading a file that does not end.

use std::fs;
use std::process::{Child, Command};
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::command::{boxes, command};
use super::small::Folder;

/// A run that reads a sky which does not come, and the other end of that.
fn waiting_for_its_sky() -> (Folder, Child, fs::File) {
    let folder = boxes(1, "[sky]\nradiance = { image = \"sky.exr\" }\n");
    let pipe = folder.path("boxes/sky.exr");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let child = command(&folder, &["render", "boxes"]).spawn().unwrap();
    // Opening the pipe for writing waits until it is read from, which is after signals are caught.
    let writer = fs::OpenOptions::new().write(true).open(&pipe).unwrap();
    (folder, child, writer)
}

/// How long a run that waits for its sky takes to end after signals with some time after each.
fn ends_after(signals: &[&str], apart: Duration) -> Duration {
    let (folder, mut child, writer) = waiting_for_its_sky();
    let start = Instant::now();
    for signal in signals {
        let kill = Command::new("sh").args(["-c", "kill -$0 $1", signal, &child.id().to_string()]).status();
        assert!(kill.unwrap().success());
        sleep(apart);
    }
    assert_eq!(child.wait().unwrap().code(), Some(75), "{signals:?}");
    let time = start.elapsed();
    drop(writer);
    assert_eq!(folder.leftovers(), [""; 0]);
    time
}

/// One that is busy ends 1.5 s after the first signal, and at once after a second, which is sent 0.15 s later: 0.9 s is
/// well below the former and leaves room for a machine with other things to do.
#[test]
fn a_second_signal_ends_a_busy_run_at_once() {
    let apart = Duration::from_millis(150);
    for signals in [["TERM", "TERM"], ["INT", "TERM"]] {
        let once = ends_after(&signals[..1], apart);
        assert!(once > Duration::from_millis(1400) && once < Duration::from_secs(2), "{once:?}");
        let twice = ends_after(&signals, apart);
        assert!(twice < Duration::from_millis(900), "{twice:?}");
    }
}

/// As `timeout` does it, to the process and to its group.
#[test]
fn a_signal_that_arrives_twice_is_one() {
    let (folder, mut child, writer) = waiting_for_its_sky();
    let start = Instant::now();
    let id = child.id().to_string();
    assert!(
        Command::new("sh")
            .args(["-c", "kill -TERM $0; sleep 0.01; kill -TERM $0", &id])
            .status()
            .unwrap()
            .success()
    );
    assert_eq!(child.wait().unwrap().code(), Some(75));
    assert!(start.elapsed() > Duration::from_millis(1400), "{:?}", start.elapsed());
    drop(writer);
    assert_eq!(folder.leftovers(), [""; 0]);
}
