//! The bytes and the ledger of frames that are merged.

use std::fs;

use super::command::{boxes, floe, pictures};
use super::numbers::Numbers;
use super::small::Folder;
use super::{MERGE, SUN, part, sunny};

/// What the last line of the ledger says of a frame, but for times, and the threads that took them.
fn line(folder: &Folder) -> serde_json::Value {
    let mut line = folder.ledger("out/boxes/ledger.jsonl").pop().unwrap();
    let is_of_time = |key: &str| key.ends_with("_seconds") || ["ended", "threads"].contains(&key);
    let keys: Vec<String> = line.as_object().unwrap().keys().cloned().collect();
    keys.iter().filter(|key| is_of_time(key)).for_each(|key| line[key.as_str()] = 0.into());
    line
}

/// Draws both frames in these ranges, on so many threads each, and compares with a run of all samples.
fn check(integrator: &str, samples: u32, splits: &[&[(u32, u32)]]) {
    let alone = sunny(integrator, samples);
    floe(&alone, &["render", "boxes"]).ended(0);
    for split in splits {
        let folder = sunny(integrator, samples);
        for ((first, end), threads) in split.iter().zip(["2", "1", "3"].iter().cycle()) {
            let range = format!("{first}..{end}");
            let arguments = ["render", "boxes", "--threads", threads, "--samples-range", &range];
            let outcome = floe(&folder, &arguments).ended(0);
            outcome.prints(&["2 of 2 frames (1,2) in ", "partials out/boxes/frame_0001.", "floe merge"]);
            let lines = folder.ledger(&format!("out/boxes/ledger.{first}-{end}.jsonl"));
            assert!(lines.iter().all(|line| line["status"] == "partial"), "{lines:?}");
            assert_eq!(lines[1]["samples"], 16 * 9 * (end - first));
        }
        assert_eq!((pictures(&folder).len(), folder.leftovers()), (0, vec![]));
        floe(&folder, &["merge", "boxes"]).ended(0).prints(&["2 of 2 frames (1,2) in "]);
        assert!(pictures(&folder) == pictures(&alone), "other bytes of {integrator} in {split:?}");
        assert_eq!(line(&folder), line(&alone), "{integrator} in {split:?}");
        // What is there is left alone, whatever is beside it.
        floe(&folder, &["merge", "boxes"]).ended(0).prints(&["2 of 2 frames were there already"]);
    }
}

/// One, two and five ranges, not in their order, that respect neither replicates nor rounds.
fn usual(integrator: &str) {
    check(
        integrator,
        23,
        &[&[(0, 23)], &[(10, 23), (0, 10)], &[(17, 23), (3, 4), (4, 11), (11, 17), (0, 3)]],
    );
}

#[test]
fn paths_in_any_ranges_give_the_bytes_of_one_run() {
    usual("path");
}

#[test]
fn photon_passes_in_any_ranges_give_the_bytes_of_one_run() {
    usual("photon");
}

/// With photons beside them, which are a matter of the frame: what the pilot finds has nothing to do with the range.
#[test]
fn beams_in_any_ranges_give_the_bytes_of_one_run() {
    usual("beams");
    let folder = sunny("beams", 4);
    floe(&folder, &["render", "boxes"]).ended(0);
    assert!(line(&folder)["photons"].as_u64() > Some(0), "no photons beside the beams: {}", line(&folder));
}

#[test]
fn random_splits_give_the_bytes_of_one_run() {
    let mut numbers = Numbers(5);
    for _ in 0..4 {
        let samples = 2 + numbers.below(40) as u32;
        let mut cuts: Vec<u32> =
            (0..numbers.below(5)).map(|_| numbers.below(samples.into()) as u32).collect();
        cuts.extend([0, samples]);
        cuts.sort_unstable();
        cuts.dedup();
        let mut split: Vec<(u32, u32)> = cuts.windows(2).map(|pair| (pair[0], pair[1])).collect();
        let by = numbers.below(split.len() as u64) as usize;
        split.rotate_left(by);
        check("path", samples, &[&split]);
    }
}

/// Another seed and number of samples from the command line, in one pattern of names.
#[test]
fn the_command_line_of_the_parts_is_that_of_the_merge() {
    let folder = boxes(1, SUN);
    let settings = ["--samples", "9", "--seed", "7", "-o", "shot.exr"];
    let run = |more: &[&str]| floe(&folder, &[more, &settings].concat()).ended(0);
    run(&["render", "boxes"]);
    let alone = (folder.read("shot.exr"), folder.read("shot.png"));
    fs::remove_file(folder.path("shot.exr")).unwrap();
    run(&["render", "boxes", "--samples-range", "0..5"]);
    run(&["render", "boxes", "--samples-range", "5..9"]);
    run(&["merge", "boxes"]);
    assert!((folder.read("shot.exr"), folder.read("shot.png")) == alone);
    assert!(folder.files().contains(&"shot.5-9.partial".to_owned()));
}

#[test]
fn partials_go_when_that_is_wanted() {
    let folder = sunny("path", 4);
    part(&folder, "0..1");
    part(&folder, "1..4");
    let partials = |folder: &Folder| folder.files().iter().filter(|name| name.ends_with(".partial")).count();
    assert_eq!(partials(&folder), 2);
    floe(&folder, &["merge", "boxes", "--remove"]).ended(0).prints(&["1 of 1 frame (1) in "]);
    assert_eq!((partials(&folder), pictures(&folder).len()), (0, 2));
    // Those that a merge which was killed has left, but nothing of other pictures.
    part(&folder, "1..4");
    floe(&folder, &["render", "boxes", "--frames", "1", "--seed", "9", "--samples-range", "0..1"]).ended(0);
    floe(&folder, &["merge", "boxes", "--remove"]).ended(0).prints(&["1 of 1 frame was there already"]);
    assert_eq!(partials(&folder), 1);
    assert!(folder.files().contains(&"out/boxes/frame_0001.0-1.partial".to_owned()));
}

/// Making the picture takes next to nothing of so many samples: what is told of it is what the parts took.
#[test]
fn the_line_of_a_merged_frame_has_the_times_of_its_parts() {
    let folder = sunny("path", 4000);
    let parts = ["0..1000", "1000..4000"].map(|range| {
        let render = ["render", "boxes", "--frames", "1", "--threads", "2", "--samples-range", range];
        floe(&folder, &render).ended(0);
        folder.ledger(&format!("out/boxes/ledger.{}.jsonl", range.replace("..", "-"))).remove(0)
    });
    floe(&folder, &[&MERGE[..], &["--threads", "1"]].concat()).ended(0);
    let merged = folder.ledger("out/boxes/ledger.jsonl").remove(0);
    for key in ["render_seconds", "cpu_seconds"] {
        let [one, other, all] = [&parts[0], &parts[1], &merged].map(|line| line[key].as_f64().unwrap());
        assert!(all > 0.8 * (one + other), "{key}: {all} of {one} and {other}");
    }
    assert_eq!(merged["threads"], 2);
}
