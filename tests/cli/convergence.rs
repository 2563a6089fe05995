//! `floe study`: error against run time.

use std::io::{BufRead, BufReader, Read};

use super::*;

/// A box of water and a few samples: 8 x 8 pixels.
const FEW: [&str; 8] = ["study", "boxes", "--resolution", "8x8", "--budgets", "4-16", "--repeats", "3"];

const FILES: [&str; 5] = [
    "out/study/boxes/reference.exr",
    "out/study/boxes/study.csv",
    "out/study/boxes/study.html",
    "out/study/boxes/study.json",
    "out/study/boxes/study.svg",
];

fn results(folder: &Folder) -> Vec<String> {
    folder.files().into_iter().filter(|name| name.starts_with("out/study/boxes/")).collect()
}

/// The columns of a table of values that are no times.
fn timeless(csv: &[u8]) -> Vec<Vec<String>> {
    let text = String::from_utf8(csv.to_vec()).unwrap();
    let heads: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let is_time = |head: &str| head.contains("seconds") || head == "efficiency" || head.starts_with("cost");
    let keep: Vec<usize> = (0..heads.len()).filter(|i| !is_time(heads[*i])).collect();
    let row = |line: &str| -> Vec<String> {
        // Names with commas are not asked for.
        let values: Vec<&str> = line.split(',').collect();
        keep.iter().map(|i| values[*i].to_owned()).collect()
    };
    text.lines().map(row).collect()
}

#[test]
fn a_study_writes_tables_a_diagram_and_its_reference() {
    let folder = boxes(2, "[render]\nsamples = 2\n");
    let outcome = floe(&folder, &[&FEW[..], &["--frame", "2", "--error", "0.05"]].concat()).ended(0);
    assert_eq!(results(&folder), FILES);
    outcome.stderr.lines().next().filter(|line| line.starts_with("reference: 1 of 8 parts")).unwrap();
    for words in
        ["boxes, frame 2, 8 x 8 pixels", "(path, 256 samples)", "\npath\n", "estimated", " to the power "]
    {
        assert!(outcome.stdout.contains(words), "no {words} in {outcome:#?}");
    }
    let csv = folder.read(FILES[1]);
    let rows = timeless(&csv);
    assert_eq!(rows.iter().map(|row| row[1].as_str()).collect::<Vec<_>>(), ["samples", "4", "8", "16"]);
    let value: serde_json::Value = serde_json::from_slice(&folder.read(FILES[3])).unwrap();
    assert_eq!((&value["frame"], &value["end"]), (&"2".into(), &"complete".into()));
    assert_eq!(value["series"][0]["points"].as_array().unwrap().len(), 3);
    assert!(String::from_utf8(folder.read(FILES[4])).unwrap().starts_with("<svg"));
    // Once more it is all the same, but for the times; the reference is not rendered again.
    let reference = folder.read(FILES[0]);
    let again = floe(&folder, &[&FEW[..], &["--frame", "2", "--json"]].concat()).ended(0);
    assert!(again.stderr.starts_with("reference: ") && again.stderr.contains("from before"), "{again:#?}");
    assert_eq!(again.stdout.as_bytes(), folder.read(FILES[3]));
    assert_eq!(timeless(&folder.read(FILES[1])), rows);
    assert_eq!(folder.read(FILES[0]), reference);
    // One of other samples is.
    let more = [&FEW[..], &["--frame", "2", "--reference-samples", "64", "-q"]].concat();
    assert!(floe(&folder, &more).ended(0).stdout.contains("(path, 64 samples)"));
    assert_ne!(folder.read(FILES[0]), reference);
}

/// The sun lights the floor of a tank through its surface: paths find nothing of it, and the test says so.
#[test]
fn a_target_of_the_scene_shortens_no_budget() {
    let table = |target: &str| {
        let folder = boxes(1, &format!("[render]\nsamples = 2\n{target}"));
        floe(&folder, &FEW).ended(0);
        timeless(&folder.read(FILES[1]))
    };
    assert_eq!(table("target_error = 0.9\n"), table(""));
}

#[test]
fn light_that_an_integrator_leaves_out_is_a_bias() {
    let floor = "[[surfaces]]\nmesh = \"floor.ply\"\nmaterial = { kind = \"diffuse\", reflectance = 0.5 }\n";
    let sun = "[sun]\ndirection = [0.1, 0.2, 1]\nangular_diameter = 10\nirradiance = 3\n";
    let folder = boxes(1, &format!("{sun}{floor}"));
    let low = small::cuboid(glam::DVec3::new(-2.0, -2.0, -1.2), glam::DVec3::new(2.0, 2.0, -1.1));
    folder.write("boxes/floor.ply", small::ply(&low));
    let both = ["--integrators", "path,photon", "-o", "here"];
    let outcome = floe(&folder, &[&FEW[..], &both].concat()).ended(0);
    assert!(
        outcome.stdout.contains("(beams, ") && outcome.stdout.contains("(leaves out sunlight"),
        "{outcome:#?}"
    );
    let value: serde_json::Value = serde_json::from_slice(&folder.read("here/study.json")).unwrap();
    let bias = |series: usize| value["series"][series]["points"][2]["bias"]["p"].as_f64().unwrap();
    assert_eq!(
        (&value["series"][0]["name"], &value["series"][1]["name"]),
        (&"path".into(), &"photon".into())
    );
    assert!(bias(0) < 1e-3, "{value:#}");
}

#[test]
fn a_picture_that_is_given_is_the_reference() {
    let folder = boxes(1, "[render]\nsamples = 64\n");
    floe(&folder, &["render", "boxes", "-o", "whole.exr", "--seed", "9"]).ended(0);
    let study = ["study", "boxes", "--budgets", "4,8", "--repeats", "2", "--reference"];
    let outcome = floe(&folder, &[&study[..], &["whole.exr", "--settings", "split = 2"]].concat()).ended(0);
    let known = "reference whole.exr (path, 64 samples), which says nothing of its noise\n";
    assert!(outcome.stdout.contains(known), "{outcome:#?}");
    assert!(outcome.stdout.contains("\npath, split = 2\n"), "{outcome:#?}");
    assert!(!results(&folder).contains(&FILES[0].to_owned()));
    for (more, code, words) in [
        (
            &["whole.exr", "--resolution", "8x8"][..],
            65,
            &["whole.exr", "16 x 9", "8 x 8", "--resolution"][..],
        ),
        (&["nowhere.exr"], 65, &["nowhere.exr"]),
        (&["boxes/scene.toml"], 65, &["scene.toml"]),
        (&["whole.exr", "--reference-samples", "4"], 2, &["--reference-samples"]),
        (&["whole.exr", "--integrators", "paths"], 78, &["--integrators", "path"]),
        (&["whole.exr", "--settings", "splitt = 2"], 78, &["--settings {splitt = 2}:1:2", "`split`"]),
        (&["whole.exr", "--settings", "seed = 2"], 2, &["seed = 2", "--seed"]),
        (&["whole.exr", "--frame", "7"], 66, &["`7`"]),
    ] {
        floe(&folder, &[&study[..], more].concat()).ended(code).says(words);
    }
}

#[test]
fn a_study_that_runs_out_of_time_has_what_is_there() {
    let folder = boxes(1, "");
    let long = ["study", "boxes", "--budgets", "4,1000000", "--repeats", "2", "--reference-samples", "4"];
    let outcome = floe(&folder, &[&long[..], &["--time", "3s"]].concat()).ended(0);
    assert!(outcome.stdout.contains("time was up"), "{outcome:#?}");
    assert_eq!(timeless(&folder.read(FILES[1])).len(), 2);
    floe(&folder, &["study", "boxes", "--time", "0"]).ended(2).says(&["--time", "--reference"]);
}

#[cfg(unix)]
#[test]
fn an_interrupted_study_writes_what_is_there() {
    let folder = boxes(1, "");
    let long = ["study", "boxes", "--budgets", "4,1000000", "--repeats", "2", "--reference-samples", "4"];
    let mut child = command(&folder, &long).stderr(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines().map(|line| line.unwrap());
    lines.find(|line| line.starts_with("path: 4 samples")).unwrap();
    let id = child.id().to_string();
    Command::new("sh").args(["-c", "kill -INT $0", &id]).status().unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(75));
    let mut stdout = String::new();
    child.stdout.take().unwrap().read_to_string(&mut stdout).unwrap();
    assert!(stdout.contains("interrupted: some pictures are missing"), "{stdout}");
    assert_eq!(results(&folder), FILES);
    assert_eq!(timeless(&folder.read(FILES[1])).len(), 2);
    assert_eq!(folder.leftovers(), [""; 0]);
}
