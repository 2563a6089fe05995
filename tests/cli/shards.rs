//! `--shard I/N`: parts of a sequence for several machines, each frame of one part.

use super::small::Folder;
use super::{boxes, floe, frame, pictures};

/// The frames that a shard draws, as its ledger has them.
fn drawn(folder: &Folder, shard: &str, more: &[&str]) -> Vec<String> {
    let name = format!("out/boxes/ledger.{}.jsonl", shard.split('/').next().unwrap());
    let before = if folder.path(&name).exists() { folder.ledger(&name).len() } else { 0 };
    floe(folder, &[&["render", "boxes", "--shard", shard], more].concat()).ended(0);
    folder.ledger(&name)[before..].iter().map(|line| line["frame"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn shards_draw_each_frame_once_and_as_a_whole_run_does() {
    let [whole, parts] = [(); 2].map(|()| boxes(5, ""));
    floe(&whole, &["render", "boxes"]).ended(0);
    let shards = ["1/2", "2/2"].map(|shard| drawn(&parts, shard, &[]));
    assert_eq!(shards, [vec!["1", "3", "5"], vec!["2", "4"]]);
    assert_eq!(pictures(&parts), pictures(&whole));
    for picture in pictures(&whole) {
        assert!(parts.read(&picture) == whole.read(&picture), "{picture}");
    }
    assert!(!parts.path("out/boxes/ledger.jsonl").exists());
    let blocks = ["1/2", "2/2"].map(|shard| drawn(&parts, shard, &["--shard-by", "blocks"]));
    assert_eq!(blocks, [vec!["1", "2", "3"], vec!["4", "5"]]);
    let turns = drawn(&parts, "2/2", &["--shard-by", "round-robin", "--frames", "1-5x2"]);
    assert_eq!(turns, ["3"]);
}

/// The place in `--frames` decides, so that what is still to come has its shard already.
#[test]
fn what_comes_later_is_of_the_shard_that_waits_for_it() {
    let folder = boxes(6, "");
    let late = folder.read(&frame(2));
    std::fs::remove_file(folder.path(&frame(2))).unwrap();
    let all = ["--frames", "1-6", "--resume"];
    assert_eq!(drawn(&folder, "1/3", &all), ["1", "4"]);
    folder.write(&frame(2), late);
    assert_eq!(drawn(&folder, "2/3", &all), ["2", "5"]);
    assert_eq!(drawn(&folder, "3/3", &all), ["3", "6"]);
    assert_eq!(drawn(&folder, "1/3", &all), [""; 0]);
    floe(&folder, &["status", "boxes", "--require-complete"]).ended(0);
}

#[test]
fn a_frame_that_is_missed_is_missed_by_its_shard_alone() {
    let folder = boxes(3, "");
    let chunk = ["--frames", "3,1,9"];
    assert_eq!(drawn(&folder, "2/3", &chunk), ["1"]);
    assert_eq!(drawn(&folder, "1/3", &chunk), ["3"]);
    let third = ["render", "boxes", "--shard", "3/3"];
    floe(&folder, &[&third[..], &chunk].concat()).ended(66).says(&["frame 9", "1-3"]);
}

#[test]
fn status_tells_of_a_shard() {
    let folder = boxes(5, "");
    drawn(&folder, "2/2", &[]);
    let status = |shard: &str, code: i32| {
        floe(&folder, &["status", "boxes", "--require-complete", "--shard", shard]).ended(code).stdout
    };
    assert_eq!(status("2/2", 0), "complete   2,4\n");
    assert_eq!(status("1/2", 75), "missing    1-5x2\n");
}

#[test]
fn a_shard_without_frames_has_nothing_to_do() {
    let folder = boxes(2, "");
    let outcome = floe(&folder, &["render", "boxes", "--shard", "3/3"]).ended(0).says(&["shard 3/3"]);
    assert!(outcome.stdout.starts_with("no pictures; ledger out/boxes/ledger.3.jsonl"), "{outcome:#?}");
    assert_eq!(pictures(&folder), [""; 0]);
}

/// Each shard of three has one frame, and all would have one name.
#[test]
fn shards_of_several_frames_need_a_pattern() {
    let folder = boxes(3, "");
    for more in [&[][..], &["--frames", "1-3"]] {
        let render = ["render", "boxes", "--shard", "1/3", "-o", "still.exr"];
        floe(&folder, &[&render[..], more].concat()).ended(2).says(&["3 frames", "still_####.exr"]);
    }
}

#[test]
fn shards_that_cannot_be_are_usage_errors() {
    let folder = boxes(1, "");
    for (arguments, cure) in [
        (&["render", "boxes", "--shard", "0/8"][..], "1/8 to 8/8"),
        (&["render", "boxes", "--shard", "9/8"], "1/8 to 8/8"),
        (&["render", "boxes", "--shard", "-1/8"], "3/8"),
        (&["status", "boxes", "--shard", "3"], "3/8"),
        (&["render", "boxes", "--shard-by", "blocks"], "--shard <I/N>"),
        (&["render", "boxes", "--shard", "1/2", "--shard-by", "size"], "round-robin, blocks"),
        (&["watch", "boxes", "--shard", "1/2"], "floe render --resume --shard I/N"),
    ] {
        floe(&folder, arguments).ended(2).says(&[cure]);
    }
    assert_eq!(pictures(&folder), [""; 0]);
}

/// As Open Job Description and Slurm send them, verbatim.
#[test]
fn frames_of_schedulers_are_taken_as_they_come() {
    let folder = boxes(0, "");
    for (number, name) in [(-5, "-5"), (-3, "-3"), (-1, "-1"), (7, "7"), (9, "9"), (20, "20")] {
        let size = 0.5 + 0.01 * f64::from(number);
        let cube = super::small::cuboid(glam::DVec3::splat(-size), glam::DVec3::splat(size));
        let mesh = super::small::labelled(cube, 0, 1);
        folder.write(&format!("boxes/frames/frame_{name}.ply"), super::small::ply(&mesh));
    }
    for (arguments, frames) in [
        (&["--frames", "7,9,20"][..], "7,9,20"),
        (&["--frames", "-5--1"], "-5--1x2"),
        (&["--frames=-5--1:2"], "-5--1x2"),
        (&["--frames", "-3,7"], "-3,7"),
        (&["--frames", "-5"], "-5"),
        (&["--frames", "1-100x2"], "7,9"),
        (&["--frames", "1-100:2,20"], "7,9,20"),
    ] {
        let outcome = floe(&folder, &[&["render", "boxes"], arguments].concat()).ended(0);
        assert!(outcome.stdout.contains(&format!(" ({frames}) in ")), "{arguments:?} {outcome:#?}");
    }
}
