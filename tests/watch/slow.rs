//! What takes minutes: a watch that is killed again and again, and one of a thousand frames.

use std::process::{Command, Stdio};
use std::time::Duration;

use super::simulator::{Manner, Simulation};
use super::small::{Folder, scene};
use super::{QUIET, contents, drawn_of, hash, options, picture, watched};

/// `cargo test --release --test watch -- --ignored --nocapture killed`
#[test]
#[ignore = "takes a minute"]
fn killed_fifty_times_it_draws_everything_in_the_end() {
    const KILLS: u64 = 50;
    let folder = Folder::with_scene(&scene(
        "[camera]\neye = [0.4, -4, 0.9]\ntarget = [0, 0, 0]\nresolution = [160, 90]\n",
    ));
    let simulation = Simulation {
        folder: folder.path("frames"),
        frames: (0..60).map(contents).collect(),
        manner: Manner::Shuffled,
        pause: Duration::from_millis(100),
        stall: Duration::ZERO,
    };
    let command = || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_floe"));
        command
            .args([
                "watch",
                "scene.toml",
                "--output",
                "out/frame_####.exr",
                "--settle",
                "0.05",
                "--done-file",
                "DONE",
            ])
            .current_dir(folder.path(""))
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        command
    };
    let truth = std::thread::scope(|scope| {
        let writing = scope.spawn(|| simulation.run());
        for kill in 0..KILLS {
            let mut child = command().spawn().unwrap();
            // From the first moments on to well within a frame, in no order.
            std::thread::sleep(Duration::from_millis(20 + kill * 379 % 1000));
            child.kill().unwrap();
            child.wait().unwrap();
        }
        writing.join().unwrap()
    });
    assert!(command().status().unwrap().success());
    for (number, bytes) in truth {
        assert_eq!(drawn_of(&picture(&folder, number)), Some(hash(&bytes)), "frame {number}");
    }
    // What was killed while it wrote leaves hidden files at most.
    let shown = folder.files().into_iter().filter(|name| name.starts_with("out/") && !name.contains("/."));
    assert!(
        shown
            .clone()
            .all(|name| name.ends_with(".exr") || name.ends_with(".png") || name.ends_with(".jsonl"))
    );
    println!("{KILLS} kills, {} frames", simulation.frames.len());
}

/// Resident memory in bytes; `None` where the system does not say.
fn resident() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kib| kib * 1024)
}

/// What is kept of a frame is its path, two signatures and a hash: below 1 kB, for which the allocator may take 4. One
/// picture that is kept has 160 x 90 pixels of 100 bytes or more, 1.4 MB; so the bound of 4 kB a frame finds any.
///
/// `cargo test --release --test watch -- --ignored --nocapture thousand`
#[test]
#[ignore = "takes a minute"]
fn a_thousand_frames_take_no_more_memory_than_a_hundred() {
    let folder = Folder::with_scene(
        &(scene("[camera]\neye = [0.4, -4, 0.9]\ntarget = [0, 0, 0]\nresolution = [160, 90]\n")
            .replace("samples = 4", "samples = 2")),
    );
    let write = |numbers: std::ops::Range<usize>| {
        for number in numbers {
            folder.write(&format!("frames/frame_{number:04}.ply"), contents(number % 50));
        }
    };
    let options = floe::driver::WatchOptions {
        quiet: QUIET / 5,
        done_file: None,
        until: Some(floe::sequence::FrameNumber::from(999)),
        preview_samples: Some(1),
        ..options(&folder)
    };
    write(0..100);
    std::thread::scope(|scope| {
        let watching = scope.spawn(|| watched(&folder, &options, &()));
        while !picture(&folder, 99).exists() {
            std::thread::sleep(Duration::from_millis(10));
        }
        let Some(before) = resident() else { return println!("no /proc/self/status: nothing to measure") };
        write(100..1000);
        let report = watching.join().unwrap();
        let after = resident().unwrap_or(before);
        println!("{before} bytes after 100 frames, {after} after 1000");
        assert_eq!(report.drawn.len(), 1000);
        assert!(after < before + 900 * 4096, "{before} bytes after 100 frames, {after} after 1000");
    });
}
