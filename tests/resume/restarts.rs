//! Restarts by a scheduler: those that bring nothing new come to an end.

use std::process::Command;
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::command::{Outcome, command, pictures};
use super::interrupted::lengthy;
use super::small::Folder;

const NOTE: &str = "out/boxes/.restart.77.frame_0001.json";

/// The command as job 77 that was started again so often.
fn restarted(folder: &Folder, count: u32, more: &[&str]) -> Command {
    let mut command = command(folder, &[&["render", "boxes"], more].concat());
    command.env("SLURM_JOB_ID", "77").env("SLURM_RESTART_COUNT", count.to_string());
    command
}

/// Runs it to its end; what renders after a minute has not given up.
fn ended(mut command: Command) -> Outcome {
    let mut child = command.spawn().unwrap();
    let start = Instant::now();
    while child.try_wait().unwrap().is_none() && start.elapsed() < Duration::from_secs(60) {
        sleep(Duration::from_millis(5));
    }
    let _ = child.kill();
    let output = child.wait_with_output().unwrap();
    let [stdout, stderr] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
    Outcome { code: output.status.code(), stdout, stderr }
}

/// Kills a run, as want of memory does, once there is a file that has some text in it.
fn killed(mut command: Command, folder: &Folder, file: &str, text: &str) {
    let mut child = command.spawn().unwrap();
    let start = Instant::now();
    let is_there =
        || std::fs::read(folder.path(file)).is_ok_and(|b| String::from_utf8_lossy(&b).contains(text));
    while !is_there() && child.try_wait().unwrap().is_none() && start.elapsed() < Duration::from_secs(60) {
        sleep(Duration::from_millis(5));
    }
    let _ = child.kill();
    let code = child.wait().unwrap().code();
    assert!(is_there() && code.is_none(), "ended with {code:?}, or no {text} in {file}");
}

/// Three frames of which each takes for ever.
fn endless() -> Folder {
    lengthy("path", 1_000_000, "")
}

/// A restart that is killed before it has saved anything.
fn fruitless(folder: &Folder, count: u32, more: &[&str]) {
    killed(restarted(folder, count, more), folder, NOTE, &format!("\"restart\":{count}"));
}

#[test]
fn the_third_restart_after_two_that_brought_nothing_gives_up() {
    let folder = endless();
    let resume = ["--resume", "--checkpoint-every", "0"];
    fruitless(&folder, 1, &resume);
    fruitless(&folder, 2, &resume);
    ended(restarted(&folder, 3, &resume)).ended(70).says(&[
        "error: out/boxes/.restart.77.frame_0001.json",
        "restart 3 of job 77 finds frame 1",
        "memory",
        "--checkpoint-every 30s",
        "remove this file",
    ]);
    assert!(pictures(&folder).is_empty());
    // What is not a restart is not judged, nor are the restarts of other jobs.
    let first = restarted(&folder, 0, &["--resume", "--checkpoint-every", "0.1"]);
    killed(first, &folder, "out/boxes/.frame_0001.checkpoint", "");
    let mut other = restarted(&folder, 9, &resume);
    other.env("SLURM_JOB_ID", "78");
    killed(other, &folder, "out/boxes/.restart.78.frame_0001.json", "\"restart\":9");
    // One that comes to its end leaves nothing.
    std::fs::remove_file(folder.path(NOTE)).unwrap();
    std::fs::remove_file(folder.path("out/boxes/.restart.78.frame_0001.json")).unwrap();
    ended(restarted(&folder, 4, &["--resume", "--samples", "1"])).ended(0);
    assert_eq!(folder.leftovers(), [""; 0]);
}

#[test]
fn restarts_that_bring_samples_or_pictures_go_on() {
    let folder = endless();
    let saving = ["--resume", "--checkpoint-every", "0.1"];
    let checkpoint = "out/boxes/.frame_0001.checkpoint";
    fruitless(&folder, 1, &["--resume", "--checkpoint-every", "0"]);
    killed(restarted(&folder, 2, &saving), &folder, checkpoint, "floe checkpoint");
    fruitless(&folder, 3, &["--resume", "--checkpoint-every", "0"]);
    fruitless(&folder, 4, &["--resume", "--checkpoint-every", "0"]);
    ended(restarted(&folder, 5, &saving)).ended(70);
    // A frame that another worker has finished is new too.
    let one = ["--resume", "--samples", "1", "--frames", "1"];
    ended(command(&folder, &[&["render", "boxes"], &one[..]].concat())).ended(0);
    ended(restarted(&folder, 6, &["--resume", "--samples", "1"])).ended(0);
}

/// Without --resume only pictures count, as nothing goes on.
#[test]
fn restarts_that_begin_anew_are_told_to_resume() {
    let folder = endless();
    fruitless(&folder, 1, &[]);
    killed(
        restarted(&folder, 2, &["--checkpoint-every", "0.1"]),
        &folder,
        "out/boxes/.frame_0001.checkpoint",
        "",
    );
    ended(restarted(&folder, 3, &[])).ended(70).says(&["frame 1", "add --resume"]);
}

/// One job may draw several parts of a frame: none of them takes what another has found for its own.
#[test]
fn parts_of_a_frame_are_given_up_each_for_itself() {
    let folder = endless();
    let parts = ["0..500000", "500000..1000000"];
    let part = |count, range| {
        restarted(&folder, count, &["--resume", "--checkpoint-every", "0", "--samples-range", range])
    };
    for count in [1, 2] {
        for range in parts {
            let note = format!("out/boxes/.restart.77.frame_0001.{}.json", range.replace("..", "-"));
            killed(part(count, range), &folder, &note, &format!("\"restart\":{count}"));
        }
    }
    for range in parts {
        ended(part(3, range)).ended(70).says(&["restart 3 of job 77 finds frame 1"]);
    }
}
