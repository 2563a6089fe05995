//! `--progress`: what is told while frames are rendered, to people and to machines.

use serde_json::Value;

use super::{Outcome, boxes, command, floe, frame};

/// The objects on standard error; nothing else is there.
fn events(outcome: &Outcome) -> Vec<Value> {
    let object = |line: &str| serde_json::from_str(line).unwrap_or_else(|e| panic!("{e}: {outcome:#?}"));
    outcome.stderr.lines().map(object).collect()
}

fn named<'a>(events: &'a [Value], name: &str) -> Vec<&'a Value> {
    events.iter().filter(|event| event["event"] == name).collect()
}

#[test]
fn json_tells_every_frame_and_nothing_but_objects() {
    let folder = boxes(3, "");
    folder.write(&frame(2), "ply\n");
    let outcome = floe(&folder, &["render", "boxes", "--keep-going", "--progress", "json"]).ended(65);
    let events = events(&outcome);
    let (first, last) = (&events[0], &events[events.len() - 1]);
    assert_eq!((&first["event"], &first["total"], &first["done"]), (&"started".into(), &3.into(), &0.into()));
    let finished = named(&events, "finished");
    assert_eq!(finished.iter().map(|event| &event["frame"]).collect::<Vec<_>>(), ["1", "3"]);
    let one = finished[0];
    assert_eq!((&one["status"], &one["output"]), (&"complete".into(), &"out/boxes/frame_0001.exr".into()));
    assert_eq!((&one["frame_samples"], &one["samples_per_pixel"]), (&(16 * 9 * 4).into(), &4.0.into()));
    assert!(one["frame_seconds"].is_f64() && one["frame_relative_error"]["estimate"].is_f64(), "{one}");
    let [failed] = named(&events, "failed")[..] else { panic!("{events:#?}") };
    assert!(
        failed["frame"] == "2" && failed["error"].as_str().unwrap().contains("frame_0002.ply"),
        "{failed}"
    );
    assert!(!named(&events, "progress").is_empty(), "{events:#?}");
    let fractions: Vec<f64> = events.iter().filter_map(|event| event["fraction"].as_f64()).collect();
    assert!(fractions.is_sorted() && fractions.last() == Some(&1.0), "{fractions:?}");
    assert_eq!(
        (&last["event"], &last["exit"], &last["failed"]),
        (&"summary".into(), &65.into(), &"2".into())
    );
    assert!(last["complete"] == "1,3" && last["worst"]["frame"].is_string(), "{last}");
    assert_eq!(last["samples"], 2 * 16 * 9 * 4);
    // Results are where they ever are.
    assert!(outcome.stdout.starts_with("2 of 3 frames (1,3) in "), "{outcome:#?}");
    assert!(!outcome.stderr.contains('\x1b'), "{outcome:#?}");
}

#[test]
fn json_has_what_goes_wrong_before_anything_is_rendered() {
    let folder = boxes(1, "");
    folder.write("boxes/scene.toml", "[sky]\nradiance = \n");
    let outcome = floe(&folder, &["render", "boxes", "--progress=json"]).ended(78);
    let events = events(&outcome);
    assert!(events[0]["event"] == "failed" && events[0]["error"].as_str().unwrap().contains("scene.toml"));
    assert_eq!((&events[1]["event"], &events[1]["exit"], events.len()), (&"summary".into(), &78.into(), 2));
}

#[test]
fn a_quiet_run_tells_programs_only_what_is_wrong_and_the_summary() {
    let folder = boxes(2, "");
    folder.write(&frame(2), "ply\n");
    let quiet = ["render", "boxes", "--keep-going", "--quiet", "--progress", "json"];
    let events = events(&floe(&folder, &quiet).ended(65));
    assert_eq!(events.iter().map(|event| &event["event"]).collect::<Vec<_>>(), ["failed", "summary"]);
}

/// What `ActionMonitoringFilter` of `openjd-sessions` takes for directives, of the two streams as one.
fn directives(outcome: &Outcome) -> Vec<(&str, &str)> {
    let lines = outcome.stdout.lines().chain(outcome.stderr.lines());
    lines.filter_map(|line| line.strip_prefix("openjd_")?.split_once(": ")).collect()
}

#[test]
fn openjd_hears_a_share_that_never_falls_and_ends_at_100() {
    let folder = boxes(3, "");
    let outcome = floe(&folder, &["render", "boxes", "--progress", "openjd"]).ended(0);
    let told = directives(&outcome);
    let shares = told.iter().filter(|(what, _)| *what == "progress");
    let shares: Vec<f64> = shares.map(|(_, text)| text.parse().unwrap()).collect();
    assert!(shares.is_sorted() && shares.len() >= 3, "{shares:?}");
    assert!(shares[..shares.len() - 1].iter().all(|share| *share < 100.0), "{shares:?}");
    assert_eq!(shares.last(), Some(&100.0));
    assert!(told.contains(&("status", "0 of 3 frames done")), "{told:?}");
    assert!(
        told.iter().any(|(what, text)| *what == "status" && text.starts_with("3 of 3 frames done, error "))
    );
    assert!(told.iter().all(|(what, _)| *what == "progress" || *what == "status"), "{told:?}");
    assert!(outcome.stdout.contains("\n3 of 3 frames (1-3) in "), "{outcome:#?}");
    assert_eq!(outcome.stderr, "");
    // All is there already.
    let again = floe(&folder, &["render", "boxes", "--resume", "--progress", "openjd"]).ended(0);
    assert_eq!(directives(&again).last(), Some(&("progress", "100")), "{again:#?}");
}

#[test]
fn openjd_hears_of_failures_and_never_of_100_then() {
    let folder = boxes(2, "");
    folder.write(&frame(1), "ply\n");
    let outcome = floe(&folder, &["render", "boxes", "--keep-going", "--progress", "openjd"]).ended(65);
    let told = directives(&outcome);
    let failed: Vec<_> = told.iter().filter(|(what, _)| *what == "fail").collect();
    assert!(failed.len() == 1 && failed[0].1.starts_with("frame 1: "), "{told:?}");
    assert!(outcome.stderr.starts_with("error: frame 1: "), "{outcome:#?}");
    assert!(told.iter().all(|(what, text)| *what != "progress" || text.parse::<f64>().unwrap() < 100.0));
    // A scene file is quoted in the message, and what stands in it is no directive.
    folder.write("boxes/scene.toml", "openjd_env: A=B\n");
    let outcome = floe(&folder, &["render", "boxes", "--progress", "openjd"]).ended(78);
    assert!(directives(&outcome).iter().all(|(what, _)| *what == "fail"), "{outcome:#?}");
}

#[test]
fn plain_and_none_are_lines_and_nothing() {
    let folder = boxes(2, "");
    let plain = floe(&folder, &["render", "boxes", "--progress", "plain"]).ended(0);
    assert_eq!(plain.stderr.lines().filter(|line| line.starts_with("frame ")).count(), 2, "{plain:#?}");
    for silent in [["--progress", "none"], ["--progress=auto", "-q"]] {
        assert_eq!(floe(&folder, &[&["render", "boxes"], &silent[..]].concat()).ended(0).stderr, "");
    }
    floe(&folder, &["render", "boxes", "--progress", "loud"]).ended(2).says(&["openjd", "plain"]);
}

#[test]
fn a_variable_stands_in_for_the_option() {
    let folder = boxes(1, "");
    let run = |value: &str, more: &[&str]| {
        let mut command = command(&folder, &[&["render", "boxes"], more].concat());
        String::from_utf8(command.env("FLOE_PROGRESS", value).output().unwrap().stderr).unwrap()
    };
    assert!(run("json", &[]).starts_with("{\""));
    assert!(run("json", &["--progress", "plain"]).starts_with("frame "));
    assert_eq!(run("none", &[]), "");
    assert!(run("loud", &[]).starts_with("warning: FLOE_PROGRESS = loud is not heeded: write auto, json, "));
}

#[test]
fn a_watch_is_told_in_the_same_ways() {
    let folder = boxes(2, "");
    let watch =
        ["watch", "boxes", "--idle-timeout", "0.2", "--settle", "0.02", "--poll", "0.05", "--progress"];
    let outcome = floe(&folder, &[&watch[..], &["json"]].concat()).ended(0);
    let events = events(&outcome);
    let complete = named(&events, "finished").into_iter().filter(|event| event["status"] == "complete");
    assert_eq!(complete.count(), 2, "{events:#?}");
    let progress = named(&events, "progress");
    assert!(
        progress.iter().all(|event| event["text"].is_string() && event["total"].is_null()),
        "{progress:?}"
    );
    let last = &events[events.len() - 1];
    assert_eq!(
        (&last["event"], &last["complete"], &last["exit"]),
        (&"summary".into(), &"1,2".into(), &0.into())
    );
    let outcome = floe(&folder, &[&watch[..], &["openjd"]].concat()).ended(0);
    assert_eq!(directives(&outcome).last(), Some(&("progress", "100")), "{outcome:#?}");
}
