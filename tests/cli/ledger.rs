//! What the ledger says of each frame.

use super::{floe, melt};

#[test]
fn the_ledger_has_a_line_a_frame_with_the_documented_keys() {
    let folder = melt();
    floe(&folder, &["render", "melt", "--frames", "1,2"]).ended(0);
    let ledger = folder.ledger("out/melt/ledger.jsonl");
    assert_eq!(ledger.iter().map(|line| line["frame"].as_str().unwrap()).collect::<Vec<_>>(), ["1", "2"]);
    let mut keys: Vec<&String> = ledger[0].as_object().unwrap().keys().collect();
    keys.sort();
    let documented = [
        "accel_bytes",
        "accel_bytes_per_triangle",
        "astray_photons",
        "beam_bytes",
        "beam_candidates",
        "beam_queries",
        "beam_roots",
        "beam_seconds",
        "beams",
        "build_seconds",
        "cost_ratio",
        "cpu_seconds",
        "cut",
        "depth_limited",
        "ended",
        "escaped_inside",
        "file",
        "frame",
        "hierarchy",
        "interfaces",
        "label_mismatches",
        "left_out",
        "non_finite",
        "output",
        "photons",
        "rays",
        "read_seconds",
        "refitted",
        "relative_error",
        "render_seconds",
        "samples",
        "samples_dropped",
        "samples_per_pixel",
        "shadow_rays",
        "status",
        "stopped_by",
        "target_error",
        "threads",
        "time_budget",
        "trapped",
        "triangles",
        "untraced",
        "wait_seconds",
        "warnings",
        "write_seconds",
    ];
    assert_eq!(keys, documented);
    assert_eq!(ledger[0]["status"], "complete");
    assert_eq!(ledger[0]["samples"], 32 * 18 * 4);
    assert_eq!(
        ledger[0]["interfaces"].as_object().unwrap().keys().collect::<Vec<_>>(),
        ["0|1", "0|2", "1|2"]
    );
    let error = &ledger[0]["relative_error"];
    let value = |key: &str| error[key].as_f64().unwrap();
    assert!(value("low") < value("estimate") && value("estimate") < value("high"), "{error}");
}
