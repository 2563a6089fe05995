//! The command as a user meets it: run as a process, in folders of its own.
#![allow(clippy::unwrap_used)]

mod compare;
mod convergence;
mod encode;
mod environment;
mod folders;
mod half_spaces;
mod integrators;
mod ledger;
mod meshes;
mod models;
mod optics;
mod preview;
mod progress;
mod report;
mod selection;
mod shards;
mod similarity;
#[path = "../small/mod.rs"]
mod small;
mod stopping;
mod study;

use std::path::Path;
use std::process::{Command, Stdio};

use small::{Folder, cube, labelled, scene, shipped_frame, shipped_scene};

/// What a run of the command left behind.
#[derive(Debug)]
struct Outcome {
    code: i32,
    stdout: String,
    stderr: String,
}

impl Outcome {
    /// Asserts how it ended.
    fn ended(self, code: i32) -> Self {
        assert_eq!(self.code, code, "{self:#?}");
        self
    }

    /// Asserts that standard error names all of these.
    fn says(self, words: &[&str]) -> Self {
        for word in words {
            assert!(self.stderr.contains(word), "no \"{word}\" in {self:#?}");
        }
        self
    }
}

fn command(folder: &Folder, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_floe"));
    command.args(arguments).current_dir(folder.path(""));
    command
}

/// Runs the command in a folder; whatever happens, no temporary file is left there.
fn floe(folder: &Folder, arguments: &[&str]) -> Outcome {
    let output = command(folder, arguments).output().unwrap();
    assert_eq!(folder.leftovers(), [""; 0], "{arguments:?}");
    Outcome {
        code: output.status.code().unwrap(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// `melt/scene.toml` with frames 0, 1 and 2 of the shipped sequence in a picture of 32 x 18 pixels.
fn melt() -> Folder {
    let folder = Folder::new();
    folder.write("melt/scene.toml", shipped_scene(4));
    for number in 0..3 {
        let bytes = std::fs::read(shipped_frame(number)).unwrap();
        folder.write(&format!("melt/frames/frame_{number:04}.ply"), bytes);
    }
    folder
}

/// `boxes/scene.toml` with boxes of water as frames 1 to `frames`.
fn boxes(frames: u32, tables: &str) -> Folder {
    let folder = Folder::new();
    folder.write("boxes/scene.toml", scene(tables));
    for number in 1..=frames {
        folder.write(&frame(number), small::ply(&labelled(cube(), 0, 1)));
    }
    folder
}

fn frame(number: u32) -> String {
    format!("boxes/frames/frame_{number:04}.ply")
}

fn pictures(folder: &Folder) -> Vec<String> {
    folder.files().into_iter().filter(|name| name.ends_with(".exr")).collect()
}

#[test]
fn render_writes_pictures_a_ledger_and_a_summary() {
    let folder = melt();
    let outcome = floe(&folder, &["render", "melt"]).ended(0);
    for number in 0..3 {
        let picture = folder.read(&format!("out/melt/frame_000{number}.exr"));
        assert!(picture.starts_with(&[0x76, 0x2f, 0x31, 0x01]));
        assert!(folder.read(&format!("out/melt/frame_000{number}.png")).starts_with(b"\x89PNG"));
    }
    let summary: Vec<&str> = outcome.stdout.lines().collect();
    assert!(
        summary[0].starts_with("3 of 3 frames (0-2) in ") && summary[0].ends_with(" s a frame"),
        "{summary:?}"
    );
    assert!(
        summary[1].starts_with("estimated relative error ") && summary[1].contains("worst"),
        "{summary:?}"
    );
    assert!(summary.contains(&"hierarchy: 3 built"), "{summary:?}");
    assert_eq!(*summary.last().unwrap(), "pictures out/melt/frame_####.exr; ledger out/melt/ledger.jsonl");
    // No terminal: one plain line a frame.
    assert_eq!(outcome.stderr.lines().filter(|line| line.starts_with("frame ")).count(), 3, "{outcome:#?}");
    assert!(!outcome.stderr.contains(['\x1b', '\r']), "{outcome:#?}");
}

#[test]
fn a_ledger_grows_and_the_same_frame_is_the_same_picture() {
    let folder = melt();
    floe(&folder, &["render", "melt", "--frames", "1"]).ended(0);
    let first = folder.read("out/melt/frame_0001.exr");
    floe(&folder, &["render", "melt", "--frames", "1"]).ended(0);
    assert_eq!(folder.read("out/melt/frame_0001.exr"), first);
    assert_eq!(folder.ledger("out/melt/ledger.jsonl").len(), 2);
}

#[test]
fn samples_and_seed_are_taken_from_the_command_line() {
    let folder = boxes(1, "");
    let render = |output: &str, more: &[&str]| {
        floe(&folder, &[&["render", "boxes", "-o", output], more].concat()).ended(0);
        folder.read(output)
    };
    let usual = render("a.exr", &[]);
    assert_eq!(render("b.exr", &["--samples", "4", "--seed", "0"]), usual);
    assert_ne!(render("c.exr", &["--seed", "1"]), usual);
    assert_ne!(render("d.exr", &["--samples", "8"]), usual);
    assert_eq!(render("e.exr", &["--threads", "1"]), usual);
    let ledger = folder.ledger("ledger.jsonl");
    assert_eq!(ledger[3]["samples"], 16 * 9 * 8);
}

#[test]
fn quiet_leaves_the_summary_and_the_warnings() {
    let folder = boxes(1, "");
    let outcome = floe(&folder, &["render", "boxes", "-q"]).ended(0);
    assert_eq!(outcome.stderr, "");
    assert!(outcome.stdout.starts_with("1 of 1 frame (1) in "), "{outcome:#?}");
    let mut open = labelled(cube(), 0, 1);
    open.triangles.pop();
    open.interfaces.as_mut().unwrap().pop();
    folder.write(&frame(1), small::ply(&open));
    floe(&folder, &["render", "boxes", "-q"]).says(&["warning: ", "frame_0001.ply", "open"]);
}

#[test]
fn outputs_go_where_they_are_told() {
    let folder = melt();
    floe(&folder, &["render", "melt", "--frames", "0-1", "-o", "new/deep/shot.%04d.exr"]).ended(0);
    assert_eq!(pictures(&folder), ["new/deep/shot.0000.exr", "new/deep/shot.0001.exr"]);
    let outcome = floe(&folder, &["render", "melt", "--frames", "2", "--output", "still.exr"]).ended(0);
    assert!(outcome.stdout.ends_with("pictures still.exr; ledger ledger.jsonl\n"), "{outcome:#?}");
    floe(&folder, &["render", "melt", "--frames", "2", "--output", "größe/水_####.EXR"]).ended(0);
    assert!(folder.files().contains(&"größe/水_0002.png".to_owned()), "{:?}", folder.files());
}

#[test]
fn outputs_that_cannot_be_are_usage_errors() {
    let folder = melt();
    for (output, words) in [
        ("still.exr", ["no place for the number of 3 frames", "still_####.exr"]),
        ("shot_####.png", ["does not end with .exr", "shot_####.exr"]),
        ("shot_####", ["does not end with .exr", "shot_####.exr"]),
        ("folder/", ["names a folder", "frame_####.exr"]),
        ("#_#.exr", ["two places", "#_#.exr"]),
        ("", ["file name", "frame_####.exr"]),
    ] {
        floe(&folder, &["render", "melt", "-o", output]).ended(2).says(&words);
    }
    assert!(!Path::new(&folder.path("ledger.jsonl")).exists());
    let folder = boxes(1, "[output]\npath = \"shot.jpg\"\n");
    floe(&folder, &["render", "boxes"]).ended(78).says(&["shot.jpg", "shot.exr"]);
}

/// A still: no `[frames]`, one surface.
fn still() -> Folder {
    let text = scene("[frames]\n").replace("[frames]\n", "");
    let folder = Folder::new();
    folder.write(
        "scene.toml",
        text + "[[surfaces]]\nmesh = \"box.ply\"\nmaterial = { kind = \"diffuse\", reflectance = 0.5 }\n",
    );
    folder.write("box.ply", small::ply(&cube()));
    folder
}

#[test]
fn a_scene_without_frames_is_one_still() {
    let folder = still();
    let outcome = floe(&folder, &["render", "scene.toml", "-o", "box.exr"]).ended(0);
    assert!(outcome.stdout.starts_with("1 of 1 frame (1) in "), "{outcome:#?}");
    let ledger = folder.ledger("ledger.jsonl");
    assert_eq!((&ledger[0]["frame"], &ledger[0]["triangles"]), (&"1".into(), &12.into()));
    assert!(ledger[0].get("file").is_none());
    let info = floe(&folder, &["info", "scene.toml"]).ended(0).stdout;
    assert!(info.contains("one still"), "{info}");
    floe(&folder, &["render", "scene.toml", "--frames", "2"]).ended(66).says(&["`2`", "which has 1"]);
}

#[test]
fn info_prints_media_labels_needs_and_how_the_sun_is_found() {
    let folder = melt();
    let info = floe(&folder, &["info", "melt"]).ended(0).stdout;
    for words in [
        "frames    3 (0-2)",
        "32 x 18, 4 samples",
        "sea (label 1): index 1.3400",
        "ice (label 2)",
        "between 1 and 2: ",
        "camera in air",
        "scattering                         used",
        "no sun shines on a refracting interface",
    ] {
        assert!(info.contains(words), "no \"{words}\" in\n{info}");
    }
    let folder = boxes(1, "[sun]\ndirection = [0, 0, 1]\nirradiance = 3\n");
    let info = floe(&folder, &["info", "boxes"]).ended(0).stdout;
    assert!(info.contains("integrator beams\n") && info.contains("all ways of it through one"), "{info}");
    let summary = floe(&folder, &["render", "boxes"]).ended(0).stdout;
    assert!(!summary.contains("left out: "), "{summary}");
    let frame = &folder.ledger("out/boxes/ledger.jsonl")[0];
    assert!(frame["left_out"] == serde_json::json!([]) && frame["beams"].as_u64() > Some(0), "{frame}");
}

#[test]
fn info_tells_what_it_knows_before_a_bad_frame() {
    let folder = boxes(4, "");
    folder.write(&frame(2), "ply\n");
    let outcome = floe(&folder, &["info", "boxes", "--frames", "1-2"]).ended(65).says(&["frame_0002.ply"]);
    assert!(
        outcome.stdout.contains("frame 1\n") && outcome.stdout.contains("frames    4 (1-4)"),
        "{outcome:#?}"
    );
    floe(&folder, &["info", "boxes", "--frames", "9"]).ended(66).says(&["`9`", "1-4"]);
    std::fs::remove_file(folder.path(&frame(2))).unwrap();
    let info = floe(&folder, &["info", "boxes"]).ended(0).stdout;
    assert!(info.contains("missing   2\n"), "{info}");
}

#[test]
fn usage_errors_end_with_2() {
    let folder = boxes(1, "");
    for arguments in [
        vec![],
        vec!["paint"],
        vec!["render"],
        vec!["render", "boxes", "--frames", "5-1"],
        vec!["render", "boxes", "--frames", "a"],
        vec!["render", "boxes", "--samples", "0"],
        vec!["render", "boxes", "--samples", "many"],
        vec!["render", "boxes", "--threads", "0"],
        vec!["render", "boxes", "--seed", "-1"],
        vec!["render", "boxes", "--colour"],
    ] {
        let outcome = floe(&folder, &arguments).ended(2);
        assert!(outcome.stdout.is_empty() && !outcome.stderr.is_empty(), "{outcome:#?}");
    }
    assert_eq!(pictures(&folder), [""; 0]);
}

#[test]
fn help_and_version_go_to_standard_output() {
    let folder = Folder::new();
    for arguments in [vec!["--help"], vec!["render", "--help"], vec!["info", "-h"], vec!["--version"]] {
        let outcome = floe(&folder, &arguments).ended(0);
        assert!(outcome.stderr.is_empty() && outcome.stdout.contains("floe"), "{outcome:#?}");
    }
    assert!(floe(&folder, &["--help"]).stdout.contains("Exit codes: 0 "));
}

#[test]
fn bad_data_ends_with_65_and_is_named() {
    let folder = boxes(1, "");
    let text = small::ply(&labelled(cube(), 0, 1));
    folder.write(&frame(1), text.replace("3 0 2 3 0 1", "3 0 2 300 0 1"));
    floe(&folder, &["render", "boxes"]).ended(65).says(&[
        "frame 1: ",
        "frame_0001.ply",
        "face 0",
        "300",
        ";",
    ]);
    assert_eq!(folder.ledger("out/boxes/ledger.jsonl")[0]["status"], "failed");
    assert_eq!(pictures(&folder), [""; 0]);
}

#[test]
fn missing_inputs_end_with_66_and_are_named() {
    let folder = boxes(1, "[[surfaces]]\nmesh = \"bottom.ply\"\nmaterial = { kind = \"diffuse\" }\n");
    floe(&folder, &["render", "boxes"]).ended(66).says(&["bottom.ply", "check that"]);
    floe(&folder, &["render", "nowhere"]).ended(66).says(&["nowhere", "give a scene file or a folder"]);
    let folder = boxes(1, "[sky]\nradiance = { image = \"clouds.hdr\" }\n");
    floe(&folder, &["render", "boxes"]).ended(66).says(&["clouds.hdr"]);
    let folder = boxes(0, "");
    floe(&folder, &["render", "boxes"]).ended(66).says(&["boxes/frames", "check that it exists"]);
    folder.write("boxes/frames/notes.txt", "none yet");
    floe(&folder, &["render", "boxes"]).ended(66).says(&["no frames in", "frame_####.ply"]);
    std::fs::create_dir(folder.path("empty")).unwrap();
    floe(&folder, &["render", "empty"]).ended(66).says(&["no frames in", "empty"]);
    let folder = melt();
    floe(&folder, &["render", "melt", "--frames", "7"]).ended(66).says(&["`7`", "0-2"]);
}

#[test]
fn bad_scenes_end_with_78_and_name_file_line_value_and_cure() {
    let folder = boxes(1, "[render]\nsampels = 4\n");
    floe(&folder, &["render", "boxes"]).ended(78).says(&[
        "boxes/scene.toml:",
        ":1: ",
        "`sampels`",
        "samples",
    ]);
    let folder = boxes(1, "[media.ice]\nior = -1\n");
    floe(&folder, &["info", "boxes"]).ended(78).says(&["boxes/scene.toml:", "media.ice.ior", "-1"]);
    let folder = boxes(1, "[media.ice\n");
    floe(&folder, &["info", "boxes"]).ended(78).says(&["boxes/scene.toml:", "not TOML"]);
    let folder = boxes(1, "[regions]\n0 = \"air\"\n");
    floe(&folder, &["render", "boxes"]).ended(78).says(&[
        "frame_0001.ply",
        "label 1",
        "[regions]",
        "scene.toml",
    ]);
}

#[test]
fn outputs_that_cannot_be_made_end_with_73_before_anything_is_rendered() {
    let folder = melt();
    folder.write("file", "");
    let outcome = floe(&folder, &["render", "melt", "-o", "file/shot_####.exr"]).ended(73).says(&["file/"]);
    assert!(!outcome.stderr.contains("frame "), "{outcome:#?}");
    folder.write("drops/drop.1.ply", small::ply(&labelled(cube(), 0, 1)));
    folder.write("out", "");
    floe(&folder, &["render", "drops"]).ended(73).says(&["out/drops", "cannot create"]);
}

#[test]
fn outputs_that_cannot_be_written_end_with_74() {
    let folder = boxes(1, "");
    std::fs::create_dir(folder.path("shot.exr")).unwrap();
    floe(&folder, &["render", "boxes", "-o", "shot.exr"]).ended(74).says(&["shot.exr", "cannot write"]);
}

#[test]
fn a_bad_frame_ends_the_run_and_the_rest_is_said_to_be_skipped() {
    let folder = boxes(4, "");
    folder.write(&frame(2), "not a mesh");
    let outcome = floe(&folder, &["render", "boxes"]).ended(65).says(&["error: frame 2: ", "frame_0002.ply"]);
    assert!(outcome.stdout.starts_with("1 of 4 frames (1) in "), "{outcome:#?}");
    assert!(
        outcome.stdout.contains("failed: 2; 2 after it not tried (--keep-going renders them)"),
        "{outcome:#?}"
    );
    assert_eq!(pictures(&folder), ["out/boxes/frame_0001.exr"]);
}

#[test]
fn keep_going_renders_the_rest_and_ends_with_the_worst_code() {
    let folder = boxes(4, "");
    folder.write(&frame(2), "not a mesh");
    let other = labelled(cube(), 0, 5);
    folder.write(&frame(3), small::ply(&other));
    let outcome =
        floe(&folder, &["render", "boxes", "--keep-going"]).ended(78).says(&["frame 2: ", "label 5"]);
    assert!(outcome.stdout.contains("failed: 2,3\n"), "{outcome:#?}");
    assert_eq!(pictures(&folder), ["out/boxes/frame_0001.exr", "out/boxes/frame_0004.exr"]);
    let states: Vec<_> = folder
        .ledger("out/boxes/ledger.jsonl")
        .iter()
        .map(|l| l["status"].as_str().unwrap().to_owned())
        .collect();
    assert_eq!(states, ["complete", "failed", "failed", "complete"]);
}

#[test]
fn a_gap_in_the_sequence_is_said() {
    let folder = boxes(4, "");
    std::fs::remove_file(folder.path(&frame(3))).unwrap();
    floe(&folder, &["render", "boxes"]).ended(0).says(&["warning: ", "frame 3 is missing"]);
    floe(&folder, &["render", "boxes", "--frames", "1,3"]).ended(66).says(&["frame 3", "1,2,4"]);
    let kept = floe(&folder, &["render", "boxes", "--frames", "1,3", "--keep-going"]).ended(66);
    assert!(kept.stdout.starts_with("1 of 2 frames (1) in "), "{kept:#?}");
}

#[cfg(unix)]
#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let folder = boxes(1, "");
    for arguments in [vec!["info", "boxes"], vec!["render", "boxes"], vec!["--help"]] {
        let mut child =
            command(&folder, &arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        drop(child.stderr.take());
        assert_eq!(child.wait().unwrap().code(), Some(0), "{arguments:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_under_standard_output_is_one() {
    let folder = boxes(1, "");
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let status = command(&folder, &["info", "boxes"]).stdout(full).stderr(Stdio::null()).status().unwrap();
    assert_eq!(status.code(), Some(74));
}
