//! What `floe status` says of partials.

use std::fs;

use super::command::floe;
use super::{MERGE, part, sunny};

#[test]
fn frames_that_have_only_to_be_merged_are_told() {
    let folder = sunny("path", 8);
    let status = |more: &[&str]| floe(&folder, &[&["status", "boxes"], more].concat());
    part(&folder, "0..5");
    status(&[]).ended(0).prints(&["parts      1\nmissing    2\n", "samples 5..8 of 8 are in no partial"]);
    part(&folder, "5..8");
    let outcome = status(&["--require-complete"]).ended(75);
    outcome.prints(&["unmerged   1\nmissing    2\n", "`floe merge` makes their pictures"]);
    let json: serde_json::Value = serde_json::from_str(&status(&["--json"]).ended(0).stdout).unwrap();
    assert_eq!((&json["unmerged"], &json["parts"], &json["missing"]), (&"1".into(), &"".into(), &"2".into()));
    status(&["--seed", "3"]).ended(0).prints(&["parts      1\n", "another scene"]);
    floe(&folder, &MERGE).ended(0);
    status(&[]).ended(0).prints(&["complete   1\nmissing    2\n"]);
    fs::remove_file(folder.path("out/boxes/frame_0001.exr")).unwrap();
    status(&[]).ended(0).prints(&["unmerged   1\n"]);
}

/// The summary of a run that draws some samples is not that of one that drew nothing.
#[test]
fn programs_are_told_of_partials() {
    let folder = sunny("path", 8);
    let render = ["render", "boxes", "--samples-range", "0..4", "--progress", "json"];
    let outcome = floe(&folder, &render).ended(0);
    let summary: serde_json::Value = serde_json::from_str(outcome.stderr.lines().last().unwrap()).unwrap();
    for (key, told) in [("event", "summary"), ("complete", ""), ("partial", "1,2")] {
        assert_eq!(summary[key], told, "{summary}");
    }
    assert_eq!(summary["samples"], 2 * 16 * 9 * 4);
    assert!(summary["relative_error"].is_f64(), "{summary}");
}
