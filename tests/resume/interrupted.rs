//! Runs that are killed or asked to stop at any moment, and go on.

use std::collections::BTreeMap;
use std::fs;
use std::process::{Child, Command};
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::command::{boxes, command, floe, pictures};
use super::numbers::Numbers;
use super::small::Folder;

/// Checkpoints are so frequent that a run which is killed soon leaves some.
const OFTEN: [&str; 4] = ["render", "boxes", "--checkpoint-every", "0.02"];

/// Three frames that take some tenths of a second each.
pub fn lengthy(integrator: &str, samples: u32, more: &str) -> Folder {
    let camera =
        "[camera]\neye = [0.4, -4, 0.9]\ntarget = [0, 0, 0]\nvertical_fov = 40\nresolution = [40, 30]\n";
    let render = format!(
        "[render]\nsamples = {samples}\nintegrator = \"{integrator}\"\nphotons = {{ count = 4000 }}\n{more}\n"
    );
    boxes(3, &format!("{camera}{render}[sun]\ndirection = [0.3, -0.2, 0.9]\nirradiance = 2\n"))
}

/// What the ledger counts of each frame, in its last line.
fn counts(folder: &Folder) -> BTreeMap<String, String> {
    let lines = folder.ledger("out/boxes/ledger.jsonl");
    let keys = [
        "status",
        "rays",
        "shadow_rays",
        "photons",
        "untraced",
        "samples",
        "samples_dropped",
        "stopped_by",
        "relative_error",
    ];
    let counts = |line: &serde_json::Value| keys.map(|key| format!("{key} {}", line[key])).join(", ");
    lines.iter().map(|line| (line["frame"].as_str().unwrap().to_owned(), counts(line))).collect()
}

fn send(child: &Child, signal: &str) {
    let id = child.id().to_string();
    // It may have ended by itself meanwhile.
    let _ = Command::new("sh").args(["-c", "kill -$0 $1 2>/dev/null", signal, &id]).status().unwrap();
}

/// Breaks runs off until one has come to its end, then compares everything with a run that was left alone, and begins
/// anew, so many times in all. Returns how many of the runs left a checkpoint.
fn broken_off(integrator: &str, samples: u32, more: &str, times: u32, seed: u64) -> u32 {
    let alone = lengthy(integrator, samples, more);
    let start = Instant::now();
    floe(&alone, &["render", "boxes"]).ended(0);
    let whole = start.elapsed().as_millis() as u64;
    let (mut numbers, mut broken, mut kept) = (Numbers(seed), 0, 0);
    while broken < times {
        let folder = lengthy(integrator, samples, more);
        while broken < times {
            let threads = ["1", "2"][numbers.below(2) as usize];
            let mut child = command(&folder, &[&OFTEN[..], &["--resume", "--threads", threads]].concat())
                .spawn()
                .unwrap();
            sleep(Duration::from_millis(numbers.below(whole / 2 + 1)));
            let signal = ["KILL", "KILL", "TERM", "INT"][numbers.below(4) as usize];
            if numbers.below(4) == 0 {
                send(&child, "USR1");
            }
            send(&child, signal);
            let code = child.wait().unwrap().code();
            if code == Some(0) {
                break;
            }
            // Signals that come before they are caught end a run as a kill does.
            assert!(code.is_none() || code == Some(75), "{signal}: {code:?}");
            broken += 1;
            kept += u32::from(folder.leftovers().iter().any(|name| name.ends_with(".checkpoint")));
        }
        floe(&folder, &[&OFTEN[..], &["--resume"]].concat()).ended(0);
        assert!(pictures(&folder) == pictures(&alone), "other bytes after {broken} of seed {seed}");
        assert_eq!(folder.leftovers(), [""; 0]);
        let (counts, expected) = (counts(&folder), counts(&alone));
        for (frame, counted) in counts {
            // A run that is killed between a picture and its line leaves the picture.
            assert!(counted == expected[&frame] || !counted.contains("complete"), "{frame}: {counted}");
        }
    }
    kept
}

#[test]
fn frames_that_were_broken_off_end_as_the_same_bytes() {
    broken_off("path", 64, "", 8, 1);
}

#[test]
fn photon_passes_that_were_broken_off_end_as_the_same_bytes() {
    broken_off("photon", 24, "", 8, 2);
}

#[test]
fn frames_with_a_target_that_were_broken_off_end_as_the_same_bytes() {
    broken_off("path", 256, "target_error = 0.004", 8, 3);
    broken_off("photon", 48, "target_error = 0.032", 4, 4);
}

#[test]
#[ignore = "takes minutes: a hundred runs that are killed"]
fn a_hundred_runs_that_were_broken_off_end_as_the_same_bytes() {
    for (integrator, samples, seed) in [("path", 96, 11), ("photon", 32, 12)] {
        let start = Instant::now();
        let kept = broken_off(integrator, samples, "", 50, seed);
        println!("{integrator}: 50 runs, {kept} left a checkpoint, {:.1} s", start.elapsed().as_secs_f64());
        assert!(kept >= 10, "too few went on in the middle of a frame");
    }
}

/// Runs a frame of a hundred thousand samples, waits until it is well begun, and ends it by a signal.
fn ended_by(signal: &str, integrator: &str) -> (Folder, Duration) {
    let folder = lengthy(integrator, 100_000, "");
    let mut child = command(&folder, &["render", "boxes", "--frames", "2"]).spawn().unwrap();
    // The ledger is made before anything is rendered.
    while !folder.path("out/boxes/ledger.jsonl").exists() {
        sleep(Duration::from_millis(5));
    }
    sleep(Duration::from_millis(300));
    let start = Instant::now();
    send(&child, signal);
    let code = child.wait().unwrap().code();
    assert_eq!(code, Some(75), "{signal}");
    (folder, start.elapsed())
}

#[test]
fn a_signal_saves_the_frame_and_ends_the_run_with_75_within_two_seconds() {
    for (signal, integrator) in [("TERM", "path"), ("INT", "path"), ("TERM", "photon")] {
        let (folder, time) = ended_by(signal, integrator);
        assert!(time < Duration::from_secs(2), "{signal}: {time:?}");
        assert_eq!(folder.leftovers(), ["out/boxes/.frame_0002.checkpoint"]);
        let line = &folder.ledger("out/boxes/ledger.jsonl")[0];
        assert_eq!((&line["frame"], &line["status"]), (&"2".into(), &"interrupted".into()));
        let status = floe(&folder, &["status", "boxes"]).ended(0);
        assert_eq!(status.stdout, "partial    2\nmissing    1,3\n");
        floe(&folder, &["status", "boxes", "--samples", "9"]).prints(&["missing    1-3\n"]);
    }
}

/// A checkpoint of other settings is neither used nor left.
#[test]
fn a_checkpoint_of_other_settings_is_named_and_removed() {
    let (folder, _) = ended_by("TERM", "path");
    let few = ["render", "boxes", "--samples", "2", "--frames", "2"];
    floe(&folder, &[&few[..], &["--resume"]].concat()).ended(0).says(&[
        ".frame_0002.checkpoint",
        "another scene, mesh or frame",
        "begins anew",
    ]);
    assert_eq!(folder.leftovers(), [""; 0]);
    let resumed = pictures(&folder);
    floe(&folder, &few).ended(0);
    assert_eq!(pictures(&folder), resumed);
}

#[test]
fn usr1_saves_and_goes_on() {
    let folder = lengthy("path", 2000, "");
    let mut child = command(&folder, &["render", "boxes", "--frames", "1"]).spawn().unwrap();
    let checkpoint = folder.path("out/boxes/.frame_0001.checkpoint");
    while !checkpoint.exists() {
        // Before it is caught the signal would end the run.
        if folder.path("out/boxes/ledger.jsonl").exists() {
            send(&child, "USR1");
        }
        assert!(child.try_wait().unwrap().is_none(), "it ended without a checkpoint");
        sleep(Duration::from_millis(20));
    }
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert!(!checkpoint.exists());
    let saved = pictures(&folder);
    floe(&folder, &["render", "boxes", "--frames", "1"]).ended(0);
    assert_eq!(pictures(&folder), saved);
}

#[test]
fn two_workers_on_one_folder_do_no_harm() {
    let alone = lengthy("path", 32, "");
    floe(&alone, &["render", "boxes"]).ended(0);
    let folder = lengthy("path", 32, "");
    let workers = [(); 2].map(|()| command(&folder, &[&OFTEN[..], &["--resume"]].concat()).spawn().unwrap());
    for worker in workers {
        let output = worker.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{output:?}");
    }
    assert!(pictures(&folder) == pictures(&alone));
    assert_eq!(folder.leftovers(), [""; 0]);
    fs::remove_dir_all(folder.path("out")).unwrap();
}
