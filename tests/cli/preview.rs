//! `floe render --preview` and `--denoise`.

use super::*;

#[test]
fn a_preview_is_small_quick_and_nowhere_near_the_pictures() {
    let folder = boxes(2, "[render]\nsamples = 100\n");
    floe(&folder, &["render", "boxes", "--preview"]).ended(0);
    assert_eq!(pictures(&folder), ["out/boxes/preview/frame_0001.exr", "out/boxes/preview/frame_0002.exr"]);
    let png = image::load_from_memory(&folder.read("out/boxes/preview/frame_0001.png")).unwrap();
    // Of 16 x 9.
    assert_eq!((png.width(), png.height()), (4, 2));
    let ledger = folder.ledger("out/boxes/preview/ledger.jsonl");
    assert_eq!(ledger[0]["samples"], 4 * 2 * 16);
    floe(&folder, &["render", "boxes", "--preview", "--samples", "200"]).ended(0);
    assert_eq!(folder.ledger("out/boxes/preview/ledger.jsonl")[2]["samples"], 4 * 2 * 16);
    floe(&folder, &["render", "boxes", "--preview", "-o", "a/b_####.exr", "--samples", "1"]).ended(0);
    assert!(folder.files().contains(&"a/preview/b_0002.exr".to_owned()), "{:?}", folder.files());
}

/// With the feature the library that is named is not there; without it, it would not be looked for.
#[test]
fn what_denoising_lacks_is_told_before_anything_is_rendered() {
    for (tables, flag) in [("", Some("--denoise")), ("[output]\ndenoise = true\n", None)] {
        let folder = boxes(1, tables);
        let arguments: Vec<&str> = ["render", "boxes"].into_iter().chain(flag).collect();
        let output = command(&folder, &arguments).env("FLOE_OIDN", "nowhere.so").output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(70), "{stderr}");
        let cure = if cfg!(feature = "denoise") { "FLOE_OIDN" } else { "--features denoise" };
        assert!(stderr.contains(cure), "{stderr}");
        assert!(!cfg!(feature = "denoise") || stderr.contains("nowhere.so"), "{stderr}");
        assert_eq!(pictures(&folder), [""; 0]);
    }
}
