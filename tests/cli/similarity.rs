//! What `render.similarity` is reported as.

use super::*;

#[test]
fn a_biased_reduction_is_reported_everywhere() {
    let medium = "[media.sea]\nscattering = 5000\nphase = { kind = \"henyey-greenstein\", g = 0.9 }\n";
    for (order, reported) in [(0, false), (2, true)] {
        let folder = boxes(1, &format!("{medium}[sky]\nradiance = 1\n"));
        let file = "boxes/scene.toml";
        let scene = String::from_utf8(folder.read(file)).unwrap();
        assert!(scene.contains("[render]\n") && scene.contains("1 = \"water\""), "{scene}");
        folder.write(
            file,
            scene
                .replace("[render]\n", &format!("[render]\nsimilarity = {order}\n"))
                .replace("1 = \"water\"", "1 = \"sea\""),
        );
        let info = floe(&folder, &["info", "boxes"]).ended(0).stdout;
        assert_eq!(info.contains("similarity of order 2, biased"), reported, "{info}");
        let state = if reported { "used" } else { "left out" };
        assert!(info.contains(&format!("similarity reduction (biased)      {state}")), "{info}");
        let summary = floe(&folder, &["render", "boxes", "--samples", "1"]).ended(0).stdout;
        let words = "exact scattering in \"sea\" (similarity 2, biased)";
        assert_eq!(summary.contains(words), reported, "{summary}");
        let ledger = folder.ledger("out/boxes/ledger.jsonl");
        assert_eq!(ledger[0]["left_out"] == serde_json::json!([words]), reported, "{ledger:?}");
        let picture = folder.read("out/boxes/frame_0001.exr");
        let attribute = [&b"floe:similarity\0string\0\x01\0\0\0"[..], order.to_string().as_bytes()].concat();
        assert!(picture.windows(attribute.len()).any(|bytes| bytes == attribute));
    }
}
