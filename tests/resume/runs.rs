//! `floe render --resume`: what is there and up to date is left alone, all else is drawn.

use std::fs;

use super::command::{boxes, edit, floe, pictures, write_box};
use super::small::Folder;

const RESUME: [&str; 3] = ["render", "boxes", "--resume"];

/// Three frames, rendered.
fn rendered() -> Folder {
    let folder = boxes(3, "");
    floe(&folder, &["render", "boxes"]).ended(0);
    folder
}

/// Resumes, and returns the frames that were drawn.
fn drawn(folder: &Folder, more: &[&str], says: &[&str]) -> Vec<String> {
    let before = folder.ledger("out/boxes/ledger.jsonl").len();
    floe(folder, &[&RESUME, more].concat()).ended(0).says(says);
    assert_eq!(folder.leftovers(), [""; 0]);
    let lines = folder.ledger("out/boxes/ledger.jsonl");
    lines[before..].iter().map(|line| line["frame"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn what_is_there_is_left_alone() {
    let folder = rendered();
    let before = pictures(&folder);
    let date = |name: &str| fs::metadata(folder.path(name)).unwrap().modified().unwrap();
    let dates: Vec<_> = before.keys().map(|name| date(name)).collect();
    let outcome = floe(&folder, &RESUME).ended(0);
    assert_eq!(
        outcome.stdout,
        "3 of 3 frames were there already (1-3)\npictures out/boxes/frame_####.exr; ledger out/boxes/ledger.jsonl\n"
    );
    assert_eq!(outcome.stderr, "");
    assert_eq!(pictures(&folder), before);
    assert_eq!(before.keys().map(|name| date(name)).collect::<Vec<_>>(), dates);
    // Without --resume all are drawn, whatever is there.
    floe(&folder, &["render", "boxes"]).ended(0).prints(&["3 of 3 frames (1-3) in "]);
    assert_eq!(pictures(&folder), before);
}

#[test]
fn what_is_missing_is_drawn() {
    let folder = rendered();
    let before = pictures(&folder);
    fs::remove_file(folder.path("out/boxes/frame_0002.exr")).unwrap();
    floe(&folder, &RESUME)
        .ended(0)
        .prints(&["2 of 3 frames were there already (1,3)\n", "1 of 1 frame (2) in "]);
    assert_eq!(pictures(&folder), before);
}

#[test]
fn a_mesh_that_changed_is_drawn_again() {
    let folder = rendered();
    write_box(&folder, 2, 0.9);
    assert_eq!(drawn(&folder, &[], &["warning: ", "drawn again", "changed: 2"]), ["2"]);
    assert_eq!(drawn(&folder, &[], &[]), [""; 0]);
    // The same bytes under another date are the same mesh.
    write_box(&folder, 2, 0.9);
    assert_eq!(drawn(&folder, &[], &[]), [""; 0]);
}

#[test]
fn a_scene_that_changed_is_drawn_again() {
    let folder = rendered();
    edit(&folder, "[0.6, 0.7, 0.8]", "[0.6, 0.7, 0.9]");
    assert_eq!(drawn(&folder, &[], &["changed: 1-3"]), ["1", "2", "3"]);
    edit(&folder, "[render]", "# The end.\n[render]");
    assert_eq!(drawn(&folder, &[], &[]), [""; 0]);
}

#[test]
fn other_samples_and_another_seed_are_drawn_again() {
    let folder = rendered();
    assert_eq!(drawn(&folder, &["--samples", "4", "--seed", "0"], &[]), [""; 0]);
    assert_eq!(drawn(&folder, &["--samples", "5", "--frames", "1"], &["changed: 1"]), ["1"]);
    assert_eq!(drawn(&folder, &["--seed", "5", "--frames", "2-3"], &["changed: 2,3"]), ["2", "3"]);
    assert_eq!(drawn(&folder, &[], &["changed: 1-3"]), ["1", "2", "3"]);
}

#[test]
fn damaged_pictures_are_named_and_drawn_again() {
    let folder = rendered();
    let before = pictures(&folder);
    let whole = &before["out/boxes/frame_0002.exr"];
    let header = whole.windows(10).position(|w| w == b"worldToNDC").unwrap();
    for length in [0, 4, 100, header, header + 200, whole.len() / 2 + header / 2, whole.len() - 1] {
        folder.write("out/boxes/frame_0002.exr", &whole[..length]);
        assert_eq!(drawn(&folder, &[], &["frame_0002.exr: ", "it is drawn again"]), ["2"], "{length} bytes");
        assert_eq!(pictures(&folder), before);
    }
    for garbage in [&b"not a picture"[..], &[0x76; 3000], &[&whole[..header], &[255; 3000]].concat()] {
        folder.write("out/boxes/frame_0002.exr", garbage);
        assert_eq!(drawn(&folder, &[], &["frame_0002.exr: ", "it is drawn again"]), ["2"]);
        assert_eq!(pictures(&folder), before);
    }
}

#[test]
fn the_picture_of_another_frame_is_not_taken_for_this_one() {
    let folder = rendered();
    let before = pictures(&folder);
    folder.write("out/boxes/frame_0002.exr", &before["out/boxes/frame_0001.exr"]);
    assert_eq!(drawn(&folder, &[], &["changed: 2"]), ["2"]);
    assert_eq!(pictures(&folder), before);
}

/// The exposure changes no picture, but its PNG.
#[test]
fn a_png_of_another_exposure_is_made_anew_of_the_picture() {
    let folder = rendered();
    edit(&folder, "[render]", "[output]\nexposure = 1\n[render]");
    assert_eq!(drawn(&folder, &[], &[]), [""; 0]);
    let resumed = pictures(&folder);
    floe(&folder, &["render", "boxes"]).ended(0);
    assert_eq!(pictures(&folder), resumed);
}

/// A run that is killed between a picture and the removal of its checkpoint leaves both.
#[test]
fn the_checkpoint_of_a_picture_that_is_whole_is_removed() {
    let folder = rendered();
    folder.write("out/boxes/.frame_0002.checkpoint", "whatever");
    assert_eq!(drawn(&folder, &[], &[]), [""; 0]);
}

#[test]
fn a_png_that_is_missing_is_made_of_the_picture() {
    let folder = rendered();
    let before = pictures(&folder);
    fs::remove_file(folder.path("out/boxes/frame_0001.png")).unwrap();
    assert_eq!(drawn(&folder, &[], &[]), [""; 0]);
    assert_eq!(pictures(&folder), before);
    edit(&folder, "[render]", "[output]\npng = false\n[render]");
    fs::remove_file(folder.path("out/boxes/frame_0001.png")).unwrap();
    assert_eq!(drawn(&folder, &[], &[]), [""; 0]);
    assert!(!folder.path("out/boxes/frame_0001.png").exists());
}

#[test]
fn frames_that_cannot_be_read_are_told_as_ever() {
    let folder = rendered();
    folder.write("boxes/frames/frame_0002.ply", "ply\n");
    let outcome = floe(&folder, &[&RESUME[..], &["--keep-going"]].concat()).ended(65);
    outcome.says(&["frame 2: ", "frame_0002.ply"]).prints(&["2 of 3 frames were there already (1,3)\n"]);
}

/// Their names say who writes them; what nobody does was left by the dead.
#[test]
fn files_of_dead_runs_are_removed() {
    let folder = rendered();
    folder.write("out/boxes/.floe-dead.tmp", "half a picture");
    floe(&folder, &["render", "boxes", "--frames", "1"]).ended(0);
    assert_eq!(folder.leftovers(), [""; 0]);
}

#[test]
fn checkpoints_that_are_of_no_use_are_named_and_removed() {
    let folder = rendered();
    let before = pictures(&folder);
    fs::remove_file(folder.path("out/boxes/frame_0003.exr")).unwrap();
    for contents in ["", "floe checkpoint", "anything else"] {
        folder.write("out/boxes/.frame_0003.checkpoint", contents);
        assert_eq!(drawn(&folder, &[], &[".frame_0003.checkpoint", "damaged", "begins anew"]), ["3"]);
        assert_eq!(pictures(&folder), before);
        fs::remove_file(folder.path("out/boxes/frame_0003.exr")).unwrap();
    }
}
