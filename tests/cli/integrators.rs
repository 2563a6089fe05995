//! What integrators say of themselves.

use super::*;

#[test]
fn an_integrator_tells_what_it_leaves_out() {
    let turbid = "[media.water]\nior = 1.33\nscattering = 1\n";
    for (name, left_out, scattering) in [
        ("path", None, "used      a medium in the frame scatters"),
        (
            "single-scattering",
            Some("light scattered more than once"),
            "used      a medium in the frame scatters",
        ),
        ("fog", Some("all scattered light but an ambient one"), "left out  the integrator does without"),
        (
            "ambient-occlusion",
            Some("all but the openness of the first surface"),
            "left out  the integrator does without",
        ),
    ] {
        let folder = boxes(1, &format!("{turbid}[render]\nsamples = 2\nintegrator = \"{name}\"\n"));
        let info = floe(&folder, &["info", "boxes"]).ended(0).stdout;
        assert!(info.contains(&format!("  integrator {name}\n")), "{info}");
        assert!(info.contains(&format!("  scattering                         {scattering}\n")), "{info}");
        let summary = floe(&folder, &["render", "boxes"]).ended(0).stdout;
        let line = left_out.map(|text| format!("left out: {text}\n"));
        for text in [&info, &summary] {
            assert!(line.as_ref().map_or(!text.contains("left out: "), |line| text.contains(line)), "{text}");
        }
        let ledger = folder.ledger("out/boxes/ledger.jsonl");
        assert_eq!(ledger[0]["left_out"].as_array().unwrap().first(), left_out.map(Into::into).as_ref());
    }
}
