//! `floe study`.

use super::*;

#[test]
fn a_temporal_study_prints_a_table_and_writes_files() {
    let folder = boxes(8, "[render]\nsamples = 2\n");
    let table = floe(&folder, &["study", "boxes", "--temporal", "-q", "-o", "a.csv"]).ended(0);
    assert!(
        table.stderr.is_empty() && table.stdout.starts_with("frames 1-8 (8), 2 samples a pixel"),
        "{table:#?}"
    );
    for word in ["seed_mode", "tcr", "frame ", "sequence ", "static "] {
        assert!(table.stdout.contains(word), "no {word} in {table:#?}");
    }
    let csv = String::from_utf8(folder.read("a.csv")).unwrap();
    assert_eq!(csv.lines().count(), 4, "{csv}");
    // One seed is that of the scene, so that the same question has the same answer.
    let json = floe(&folder, &["study", "boxes", "--temporal", "--json", "-o", "a.json"]).ended(0);
    assert!(json.stderr.contains("frame 8 "), "{json:#?}");
    assert_eq!(json.stdout.as_bytes(), folder.read("a.json"));
    let value: serde_json::Value = serde_json::from_str(&json.stdout).unwrap();
    let rmse = value["modes"][0][1]["rmse"].as_f64().unwrap();
    assert!(csv.contains(&format!("frame,8,2,{rmse},")), "{csv} {rmse}");
}

#[test]
fn frames_that_stand_still_have_no_flicker_with_static_seeds() {
    let folder = boxes(2, "");
    let held =
        ["study", "boxes", "--temporal", "--hold", "2", "--frames", "11-18", "--samples", "1", "-o", "a.csv"];
    floe(&folder, &held).ended(0);
    let csv = String::from_utf8(folder.read("a.csv")).unwrap();
    let line = csv.lines().find(|line| line.starts_with("static,")).unwrap();
    let values: Vec<f64> = line.split(',').skip(3).map(|v| v.parse().unwrap()).collect();
    let [rmse, tcr, lag1, flicker, jitter, _] = values[..] else { panic!("{line}") };
    // Sums of eight equal numbers.
    assert!(rmse > 0.0 && (tcr - f64::sqrt(8.0)).abs() < 1e-6 && (lag1 - 1.0).abs() < 1e-6, "{line}");
    assert!(flicker < 1e-6 && jitter < 1e-9, "{line}");
}

#[test]
fn studies_that_cannot_be_made_say_why() {
    let folder = boxes(3, "");
    let study = ["study", "boxes", "--temporal"];
    floe(&folder, &study).ended(2).says(&["3 frames are too few", "at least 8", "--frames"]);
    floe(&folder, &[&study[..], &["--hold", "9", "--frames", "1-8"]].concat())
        .ended(2)
        .says(&["frame 9", "1-3"]);
    floe(&folder, &[&study[..], &["--hold", "1"]].concat()).ended(2).says(&["--frames 1-16"]);
    floe(&folder, &[&study[..], &["--output", "a.txt"]].concat()).ended(2).says(&[".csv or .json"]);
    floe(&folder, &["study", "boxes"]).ended(2).says(&["--temporal"]);
    floe(&folder, &["study", "nowhere", "--temporal"]).ended(66).says(&["nowhere"]);
}

#[test]
fn options_of_another_mode_are_refused_by_name() {
    let folder = boxes(1, "");
    for (more, words) in [
        (&["--hold", "1"][..], &["--temporal"][..]),
        (&["--temporal", "--frame", "1"], &["--frame <N>", "--temporal"]),
    ] {
        floe(&folder, &[&["study", "boxes"][..], more].concat()).ended(2).says(words);
    }
}

#[test]
fn the_battery_of_stability_prints_rows_and_writes_tables_and_diagrams() {
    let folder = boxes(1, "");
    let only = ["study", "--stability", "--only", "resolution", "--quick"];
    let table = floe(&folder, &[&only[..], &["-o", "results"]].concat()).ended(0);
    assert!(table.stderr.is_empty() && table.stdout.contains("0 fail"), "{table:#?}");
    let text = |name: &str| String::from_utf8(folder.read(name)).unwrap();
    let rows = text("results/stability.csv").lines().count() - 1;
    assert!(rows >= 5 && table.stdout.lines().count() >= rows + 2, "{table:#?}");
    let value: serde_json::Value = serde_json::from_str(&text("results/stability.json")).unwrap();
    assert_eq!(value.as_array().unwrap().len(), rows);
    assert!(text("results/stability.md").contains("### resolution"));
    assert!(text("results/stability_resolution.svg").starts_with("<"));
    let json = floe(&folder, &[&only[..], &["--json"]].concat()).ended(0);
    assert!(serde_json::from_str::<serde_json::Value>(&json.stdout).is_ok(), "{json:#?}");
    floe(&folder, &["study", "--stability", "--only", "moon"]).ended(2).says(&["moon", "resolution"]);
    floe(&folder, &["study", "boxes", "--stability"]).ended(2).says(&["--stability"]);
    floe(&folder, &["study", "boxes", "--quick"]).ended(2).says(&["--quick", "SCENE"]);
    floe(&folder, &["study", "--quick"]).ended(2).says(&["--stability"]);
}
