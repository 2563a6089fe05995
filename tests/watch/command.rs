//! `floe watch` as a process: exit codes and signals.

use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use super::small::{Folder, scene};
use super::{contents, drawn_of, hash, picture};

fn start(folder: &Folder, arguments: &[&str]) -> Child {
    let output: &[&str] = if arguments.contains(&"-o") { &[] } else { &["-o", "out/frame_####.exr"] };
    let settle: &[&str] = if arguments.contains(&"--settle") { &[] } else { &["--settle", "0.02"] };
    Command::new(env!("CARGO_BIN_EXE_floe"))
        .args(["watch", "scene.toml"])
        .args([output, settle, arguments].concat())
        .current_dir(folder.path(""))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

fn ended(child: Child, code: i32) -> (String, String) {
    let Output { status, stdout, stderr } = child.wait_with_output().unwrap();
    let texts = (String::from_utf8(stdout).unwrap(), String::from_utf8(stderr).unwrap());
    assert_eq!(status.code(), Some(code), "{texts:#?}");
    texts
}

#[test]
fn a_bad_frame_is_told_and_the_others_are_drawn() {
    let folder = Folder::with_scene(&scene(""));
    for number in 1..4 {
        folder.write(&format!("frames/frame_{number:04}.ply"), contents(number));
    }
    folder.write("frames/frame_0002.ply", &contents(2)[..400]);
    let (out, err) = ended(start(&folder, &["--idle-timeout", "0.5"]), 65);
    assert!(out.starts_with("nothing has changed for a while: 2 pictures finished in "), "{out}");
    assert!(out.contains("drawn: 1,3\nfailed: 2\n"), "{out}");
    assert_eq!(err.matches("error: frame 2: ").count(), 1, "{err}");
    assert!(!err.contains(['\x1b', '\r']), "{err}");
    assert_eq!(drawn_of(&picture(&folder, 3)), Some(hash(&contents(3))));
}

/// What `floe render` refuses is no success because it came later: frame 2 was not seen.
#[test]
fn a_folder_in_disorder_is_told_and_is_no_success() {
    let folder = Folder::with_scene(&scene(""));
    folder.write("frames/frame_0001.ply", contents(1));
    let child = start(&folder, &["--done-file", "DONE", "--idle-timeout", "0.3", "--settle", "0.05"]);
    wait_for(&picture(&folder, 1));
    folder.write("frames/frame_0002.ply", contents(2));
    folder.write("frames/frame_2.ply", contents(2));
    folder.write("frames/DONE", "");
    let (out, err) = ended(child, 65);
    assert!(out.starts_with("nothing has changed for a while: "), "{out}");
    assert_eq!(err.matches("warning: frame 2 is there twice").count(), 1, "{err}");
}

#[test]
fn wrong_options_and_an_output_without_a_place_are_usage() {
    let folder = Folder::with_scene(&scene(""));
    let all = [["--poll", "0"], ["--settle", "x"], ["--until", "one"], ["-o", "still.exr"]];
    for arguments in all {
        ended(start(&folder, &arguments), 2);
    }
}

#[cfg(unix)]
fn signal(child: &Child, name: &str) {
    assert!(Command::new("kill").args([name, &child.id().to_string()]).status().unwrap().success());
}

/// Waits for a file.
fn wait_for(path: &std::path::Path) {
    let start = Instant::now();
    while !path.exists() {
        assert!(start.elapsed() < Duration::from_secs(60), "{}", path.display());
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// With everything drawn and nothing promised, to be stopped is how a watch ends.
#[cfg(unix)]
#[test]
fn stopped_with_nothing_left_is_success() {
    let folder = Folder::with_scene(&scene(""));
    folder.write("frames/frame_0001.ply", contents(1));
    let child = start(&folder, &[]);
    wait_for(&picture(&folder, 1));
    signal(&child, "-INT");
    ended(child, 0);
}

#[cfg(unix)]
#[test]
fn stopped_before_the_last_frame_is_to_be_run_again() {
    let folder = Folder::with_scene(&scene(""));
    folder.write("frames/frame_0001.ply", contents(1));
    let child = start(&folder, &["--until", "9"]);
    wait_for(&picture(&folder, 1));
    signal(&child, "-TERM");
    let (out, _) = ended(child, 75);
    assert!(out.contains("drawn: 1\n"), "{out}");
}

/// The frame is kept as far as it is, and the next watch goes on with it.
#[cfg(unix)]
#[test]
fn stopped_within_a_frame_it_goes_on_there() {
    let folder = Folder::with_scene(&scene("[render]\nsamples = 200000\n"));
    folder.write("frames/frame_0001.ply", contents(1));
    let child = start(&folder, &["--threads", "1", "--preview-samples", "0"]);
    std::thread::sleep(Duration::from_millis(300));
    let start_of_end = Instant::now();
    signal(&child, "-TERM");
    let (out, _) = ended(child, 75);
    assert!(out.is_empty() || out.contains("not drawn yet: 1\n"), "{out}");
    // 2 s are promised to schedulers; the test's machine may be busy.
    assert!(start_of_end.elapsed() < Duration::from_secs(8), "{:?}", start_of_end.elapsed());
    assert!(!picture(&folder, 1).exists());
}
