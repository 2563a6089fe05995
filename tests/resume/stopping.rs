//! Frames whose time was up, and what becomes of them.

use super::command::{floe, pictures};
use super::interrupted::lengthy;

/// A frame is cut after its first rounds, left alone by a run with the same budget, refined by one with a longer one, and
/// ends as the bytes that a run without any writes.
fn cut(integrator: &str, samples: u32, more: &str) {
    let alone = lengthy(integrator, samples, more);
    let one = ["render", "boxes", "--frames", "1"];
    floe(&alone, &one).ended(0);
    let folder = lengthy(integrator, samples, more);
    let with = |more: &[&str]| floe(&folder, &[&one[..], more].concat()).ended(0);
    let outcome = with(&["--time-budget", "0.01"]).prints(&["stopped by the time budget\n", "cut when"]);
    let line = &folder.ledger("out/boxes/ledger.jsonl")[0];
    assert_eq!((&line["status"], &line["stopped_by"]), (&"complete".into(), &"time".into()), "{outcome:?}");
    let few = line["samples_per_pixel"]["least"].as_u64().unwrap();
    assert!(few >= 4 && few < u64::from(samples), "{line}");
    assert_eq!(folder.leftovers(), ["out/boxes/.frame_0001.checkpoint"]);
    assert_eq!(floe(&folder, &["status", "boxes"]).stdout, "cut        1\nmissing    2,3\n");
    for (budget, code) in [(&[][..], 75), (&["--time-budget", "0.01"], 0), (&["--time-budget", "0.02"], 75)] {
        let status = ["status", "boxes", "--frames", "1", "--require-complete"];
        floe(&folder, &[&status[..], budget].concat()).ended(code).prints(&["cut        1\n"]);
    }
    let first = pictures(&folder);
    with(&["--resume", "--time-budget", "0.01"]).prints(&["1 of 1 frame was there already (1)\n"]);
    assert!(pictures(&folder) == first);
    with(&["--resume", "--time-budget", "0.2"]);
    let line = &folder.ledger("out/boxes/ledger.jsonl")[1];
    assert!(line["samples_per_pixel"]["least"].as_u64().unwrap() >= few, "{line}");
    with(&["--resume"]);
    assert!(pictures(&folder) == pictures(&alone), "{integrator} {more}");
    assert_eq!(folder.leftovers(), [""; 0]);
    assert!(floe(&folder, &["status", "boxes"]).stdout.starts_with("complete   1\n"));
}

#[test]
fn a_frame_that_was_cut_goes_on() {
    cut("path", 400, "");
}

#[test]
fn a_frame_with_a_target_that_was_cut_goes_on() {
    cut("path", 400, "target_error = 0.001");
}

#[test]
fn photon_passes_that_were_cut_go_on() {
    cut("photon", 40, "");
}
