//! Targets for the error of frames.

use super::{floe, melt};

/// Whether the file has a text somewhere.
fn has(bytes: &[u8], text: &str) -> bool {
    bytes.windows(text.len()).any(|window| window == text.as_bytes())
}

#[test]
fn a_frame_stops_at_its_target() {
    let folder = melt();
    let scene = String::from_utf8(folder.read("melt/scene.toml")).unwrap();
    folder.write("melt/scene.toml", scene.replace("\"variance\"]", "\"samples\"]"));
    let target = ["--frames", "1", "--samples", "4096", "--target-error"];
    let outcome =
        floe(&folder, &[&["render", "melt", "-o", "a.exr"], &target[..], &["10%"]].concat()).ended(0);
    let line = &folder.ledger("ledger.jsonl")[0];
    assert_eq!((&line["stopped_by"], &line["target_error"]), (&"target".into(), &0.1.into()), "{line}");
    let samples = |key: &str| line["samples_per_pixel"][key].as_f64().unwrap();
    assert!(samples("least") >= 16.0 && samples("least") < samples("mean"), "{line}");
    assert!(samples("mean") < samples("most") && samples("most") <= 4096.0, "{line}");
    assert_eq!((samples("mean") * 32.0 * 18.0).round(), line["samples"].as_f64().unwrap());
    // Each half has stopped below the target; the picture of both is a little beside.
    assert!((0.05..0.12).contains(&line["relative_error"]["estimate"].as_f64().unwrap()), "{line}");
    for words in ["estimated relative error ", " samples a pixel (", "stopped by the target\n"] {
        assert!(outcome.stdout.contains(words), "{outcome:#?}");
    }
    let picture = folder.read("a.exr");
    for words in ["floe:targetError", "floe:stoppedBy", "samples\0"] {
        assert!(has(&picture, words), "{words}");
    }
    floe(&folder, &[&["render", "melt", "-o", "b.exr"], &target[..], &["0.1"]].concat()).ended(0);
    assert_eq!(folder.read("b.exr"), picture);
    // Without a target every pixel has the same samples, and the picture says nothing of stopping.
    let plain = floe(&folder, &["render", "melt", "-o", "c.exr", "--frames", "1"]).ended(0);
    assert!(plain.stdout.contains(" 4 samples a pixel\n"), "{plain:#?}");
    assert!(!has(&folder.read("c.exr"), "floe:stoppedBy"));
}

#[test]
fn a_target_that_is_missed_is_a_warning_with_the_samples_that_it_takes() {
    let folder = melt();
    let options = ["--frames", "1-2", "--samples", "16", "--target-error", "0.01"];
    let outcome = floe(&folder, &[&["render", "melt"], &options[..]].concat()).ended(0);
    let outcome = outcome.says(&["warning: frame 1: ", "above the target of 1.000 %", "samples = "]);
    assert!(outcome.stdout.contains("stopped by the number of samples in 2\n"), "{outcome:#?}");
    let line = &folder.ledger("out/melt/ledger.jsonl")[0];
    assert_eq!(line["stopped_by"], "samples");
    assert!(line["warnings"][0].as_str().unwrap().contains("would do"), "{line}");
}

#[test]
fn what_is_no_target_is_refused_with_a_cure() {
    let folder = melt();
    for error in ["0", "0%", "1.5", "150%", "2 %%", "good", "", "nan"] {
        let option = format!("--target-error={error}");
        for command in ["render", "watch"] {
            floe(&folder, &[command, "melt", &option]).ended(2).says(&["0.02 or 2%"]);
        }
    }
    for time in ["0", "0s", "soon"] {
        let option = format!("--time-budget={time}");
        floe(&folder, &["render", "melt", &option]).ended(2).says(&["30s"]);
    }
}

#[test]
fn info_tells_the_target() {
    let folder = melt();
    let scene = String::from_utf8(folder.read("melt/scene.toml")).unwrap();
    folder.write("melt/scene.toml", scene.replace("[render]", "[render]\ntarget_error = 0.02"));
    let info = floe(&folder, &["info", "melt"]).ended(0).stdout;
    assert!(info.contains("4 samples at most, to an error of 2 % at 95 % confidence"), "{info}");
    // A preview is a look, whatever the scene says.
    floe(&folder, &["render", "melt", "--preview", "--frames", "1"]).ended(0);
    assert!(folder.ledger("out/melt/preview/ledger.jsonl")[0]["target_error"].is_null());
}
