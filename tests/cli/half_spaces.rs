//! What a medium that is too thick to walk through is reported as.

use super::*;

#[test]
fn a_half_space_is_reported_everywhere() {
    for (scattering, integrator, reported) in
        [(2e4, "path", false), (2e6, "path", true), (2e6, "single-scattering", false)]
    {
        let medium = format!("[media.sea]\nscattering = {scattering}\nabsorption = 10\n");
        let folder = boxes(1, &format!("{medium}[sky]\nradiance = 1\n"));
        let file = "boxes/scene.toml";
        let scene = String::from_utf8(folder.read(file)).unwrap();
        assert!(scene.contains("[render]\n") && scene.contains("1 = \"water\""), "{scene}");
        let render = format!("[render]\nintegrator = \"{integrator}\"\n");
        folder.write(file, scene.replace("[render]\n", &render).replace("1 = \"water\"", "1 = \"sea\""));
        let words = "light through \"sea\" (optical size ";
        let info = floe(&folder, &["info", "boxes"]).ended(0).stdout;
        assert_eq!(info.contains(words), reported, "{info}");
        let state = if reported { "used" } else { "left out" };
        assert!(info.contains(&format!("half-space reflection (biased)     {state}")), "{info}");
        let summary = floe(&folder, &["render", "boxes", "--samples", "1"]).ended(0).stdout;
        assert_eq!(summary.contains(words), reported, "{summary}");
        let ledger = folder.ledger("out/boxes/ledger.jsonl");
        assert_eq!(ledger[0]["left_out"].to_string().contains("gets through"), reported, "{ledger:?}");
    }
}
