//! Media that are computed from what is in them, on the command line.

use super::*;

const ICE: &str = "[media.berg]\nmodel = 'iceberg'\ntemperature = -40\nalgae = 1e-6\n";

#[test]
fn info_prints_what_is_in_a_medium_and_what_that_does() {
    let info = floe(&boxes(1, ICE), &["info", "boxes"]).ended(0).stdout;
    for words in [
        "model iceberg, with air 2.7000e-2, algae 1.0000e-6 of the volume",
        "450 nm: absorption ",
        "550 nm: absorption 5.",
        "mean cosine 0.85",
        "mean free path 1.09",
        "error of the integrals over radius ",
        "warning: [media.berg] temperature = -40: what ice encloses is known from -30 to 0",
        "four wavelengths of 380 to 780 nm",
    ] {
        assert!(info.contains(words), "no \"{words}\" in\n{info}");
    }
}

#[test]
fn warnings_of_models_are_told_and_kept() {
    let folder = boxes(1, ICE);
    floe(&folder, &["render", "boxes"]).ended(0).says(&["[media.berg] temperature = -40"]);
    let warnings = &folder.ledger("out/boxes/ledger.jsonl")[0]["warnings"];
    assert!(warnings.to_string().contains("[media.berg] temperature = -40"), "{warnings}");
}
