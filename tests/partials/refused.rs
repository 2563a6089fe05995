//! Partials that are no parts of one frame, and ranges that cannot be.

use std::fs;

use super::command::{edit, floe, pictures, write_box};
use super::small::Folder;
use super::{MERGE, part, sunny};

/// Frame 1 in two partials.
fn parted() -> Folder {
    let folder = sunny("path", 8);
    part(&folder, "0..5");
    part(&folder, "5..8");
    folder
}

const FIRST: &str = "out/boxes/frame_0001.0-5.partial";
const SECOND: &str = "out/boxes/frame_0001.5-8.partial";

fn rename(folder: &Folder, from: &str, to: &str) {
    fs::rename(folder.path(from), folder.path(to)).unwrap();
}

/// Asserts that a merge ends so, says this, and makes no picture.
fn refused(folder: &Folder, code: i32, words: &[&str]) {
    floe(folder, &MERGE).ended(code).says(words);
    assert_eq!(pictures(folder).len(), 0);
}

#[test]
fn gaps_are_named_with_what_fills_them() {
    let folder = parted();
    fs::remove_file(folder.path(FIRST)).unwrap();
    part(&folder, "1..3");
    refused(&folder, 66, &["out/boxes/frame_0001.exr: samples 0..1, 3..5 of 8", "--samples-range 0..1"]);
    fs::remove_dir_all(folder.path("out/boxes")).unwrap();
    refused(&folder, 66, &["frame_0001.exr: samples 0..8 of 8 are in no partial"]);
    floe(&folder, &["merge", "boxes"]).ended(66).says(&["no partials beside out/boxes/frame_####.exr"]);
}

#[test]
fn samples_that_are_there_twice_are_named_with_both_files() {
    let folder = parted();
    part(&folder, "4..6");
    refused(&folder, 65, &["frame_0001.4-6.partial: ", "has samples 4..5, as", FIRST, "remove one"]);
}

#[test]
fn partials_of_something_else_are_named() {
    let folder = parted();
    edit(&folder, "irradiance = 2", "irradiance = 3");
    refused(&folder, 65, &[FIRST, "another scene", "--samples-range 0..5"]);
    let folder = parted();
    write_box(&folder, 1, 0.9);
    refused(&folder, 65, &[FIRST, "another mesh"]);
    let folder = parted();
    floe(&folder, &[&MERGE[..], &["--seed", "4"]].concat()).ended(65).says(&[FIRST, "--seed"]);
    floe(&folder, &[&MERGE[..], &["--samples", "16"]].concat())
        .ended(65)
        .says(&["a part of 8 samples, not of 16", "merge with --samples 8"]);
    edit(&folder, "resolution = [16, 9]", "resolution = [8, 9]");
    refused(&folder, 65, &["has 16 x 9 pixels, and the scene 8 x 9"]);
}

#[test]
fn partials_under_other_names_are_named() {
    let folder = parted();
    rename(&folder, SECOND, "out/boxes/frame_0001.5-7.partial");
    refused(&folder, 65, &["frame_0001.5-7.partial: ", "holds samples 5..8"]);
    let folder = parted();
    for (from, to) in
        [(FIRST, "out/boxes/frame_0002.0-5.partial"), (SECOND, "out/boxes/frame_0002.5-8.partial")]
    {
        rename(&folder, from, to);
    }
    let outcome = floe(&folder, &["merge", "boxes"]).ended(65);
    outcome.says(&["frame_0002.0-5.partial: ", "another frame than 2", "its name"]);
}

#[test]
fn damaged_partials_and_those_of_other_versions_are_named() {
    let folder = parted();
    let whole = folder.read(SECOND);
    for length in [0, 10, whole.len() / 2, whole.len() - 1] {
        folder.write(SECOND, &whole[..length]);
        refused(&folder, 65, &[SECOND, "damaged or cut short", "render it again"]);
    }
    let mut other = whole.clone();
    other["floe partial ".len()] = b'0';
    folder.write(SECOND, &other);
    refused(&folder, 65, &[SECOND, "another version of floe"]);
    fs::remove_file(folder.path(SECOND)).unwrap();
    fs::create_dir(folder.path(SECOND)).unwrap();
    refused(&folder, 65, &[SECOND, "cannot be read", "remove it"]);
    fs::remove_dir(folder.path(SECOND)).unwrap();
    folder.write(SECOND, &other);
    // Only what is at fault is drawn again.
    let again = ["render", "boxes", "--frames", "1", "--resume", "--samples-range"];
    floe(&folder, &[&again[..], &["0..5"]].concat()).ended(0).prints(&["1 of 1 frame was there already"]);
    floe(&folder, &[&again[..], &["5..8"]].concat()).ended(0).says(&[
        SECOND,
        "another version",
        "drawn again",
    ]);
    floe(&folder, &MERGE).ended(0);
}

/// What is wrong with one frame does not cost the others.
#[test]
fn other_frames_are_merged_all_the_same() {
    let folder = parted();
    floe(&folder, &["render", "boxes", "--frames", "2", "--samples-range", "0..8"]).ended(0);
    folder.write(FIRST, "nothing");
    floe(&folder, &["merge", "boxes"]).ended(65).prints(&["failed: 1; 1 after it not tried"]);
    let outcome = floe(&folder, &["merge", "boxes", "--keep-going"]).ended(65).says(&[FIRST]);
    outcome.prints(&["1 of 2 frames (2) in ", "failed: 1"]);
    assert_eq!(pictures(&folder).len(), 2);
}

#[test]
fn ranges_that_cannot_be_are_usage_errors() {
    let folder = sunny("path", 8);
    let render = |more: &[&str]| floe(&folder, &[&["render", "boxes"], more].concat()).ended(2);
    render(&["--samples-range", "0-4"]).says(&["`0-4`", "0..64"]);
    render(&["--samples-range", "4..4"]).says(&["no samples in 4..4"]);
    render(&["--samples-range", "-1..4"]).says(&["`-1..4`"]);
    render(&["--samples-range", "4..9"]).says(&[
        "--samples-range 4..9",
        "there are 8 samples",
        "--samples 9",
    ]);
    render(&["--samples-range", "4..8", "--samples", "7"]).says(&["there are 7 samples"]);
    for more in [&["--target-error", "0.1"][..], &["--time-budget", "5s"], &["--preview"], &["--denoise"]] {
        render(&[&["--samples-range", "0..4"], more].concat()).says(&["cannot be used with", more[0]]);
    }
    edit(&folder, "[render]", "[render]\ntarget_error = 0.1");
    render(&["--samples-range", "0..4"]).says(&["--samples-range 0..4", "target_error", "boxes/scene.toml"]);
    assert_eq!(folder.files().iter().filter(|name| name.contains("out/")).count(), 0);
}
