//! `floe status`: ranges that `--frames` takes.

use std::fs;

use super::command::{boxes, edit, floe, write_box};

#[test]
fn every_state_is_listed() {
    let folder = boxes(8, "");
    let status = |more: &[&str]| floe(&folder, &[&["status", "boxes"], more].concat());
    assert_eq!(status(&[]).ended(0).stdout, "missing    1-8\n");
    status(&["--require-complete"]).ended(75);
    assert!(!folder.path("out").exists(), "looking writes nothing");
    floe(&folder, &["render", "boxes", "--frames", "1-6"]).ended(0);
    write_box(&folder, 2, 0.9);
    write_box(&folder, 4, 0.95);
    folder.write("out/boxes/frame_0005.exr", "nothing");
    fs::remove_file(folder.path("boxes/frames/frame_0006.ply")).unwrap();
    let text = status(&["--frames", "1-5,6,7-8"]).ended(0).stdout;
    let lines: Vec<&str> = text.lines().collect();
    let listed = ["complete   1,3", "missing    7,8", "stale      2,4", "corrupt    5", "unreadable 6"];
    assert_eq!(lines[..5], listed);
    assert_eq!(lines[5], "frame 5: it is not an OpenEXR file");
    assert!(lines[6].starts_with("frame 6: ") && lines.len() == 7, "{text}");
    status(&["--frames", "1,3", "--require-complete"]).ended(0);
    status(&["--require-complete"]).ended(75);
    // What is asked of a render is asked of the status.
    assert!(status(&["--samples", "9", "--frames", "1-3"]).stdout.starts_with("stale      1-3\n"));
    assert!(status(&["--output", "else_####.exr", "--frames", "1-3"]).stdout.starts_with("missing    1-3\n"));
    edit(&folder, "[0.6, 0.7, 0.8]", "[0.6, 0.7, 0.9]");
    assert!(status(&[]).stdout.starts_with("missing    7,8\nstale      1-4\n"));
}

#[test]
fn json_has_the_same() {
    let folder = boxes(3, "");
    floe(&folder, &["render", "boxes", "--frames", "1,2"]).ended(0);
    folder.write("out/boxes/frame_0002.exr", "nothing");
    let text = floe(&folder, &["status", "boxes", "--json"]).ended(0).stdout;
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    let expected = serde_json::json!({
        "frames": 3, "pictures": "out/boxes/frame_####.exr",
        "complete": "1", "cut": "", "unmerged": "", "parts": "", "partial": "", "missing": "3", "stale": "",
        "corrupt": "2", "unreadable": "",
        "problems": [{ "frame": "2", "problem": "it is not an OpenEXR file" }],
    });
    assert_eq!(json, expected);
}

#[test]
fn a_scene_that_is_not_there_is_an_error() {
    floe(&boxes(0, ""), &["status", "nowhere"]).ended(66).says(&["nowhere"]);
}
