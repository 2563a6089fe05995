//! Several meshes a frame.

use glam::DVec3;
use small::{cuboid, ply};

use super::*;

const SCENE: &str = "[media.sea]\nior = 1.33\nabsorption = 0.5\n[media.ice]\nior = 1.31\n[media.glass]\nior = 1.5\n\
                     [sky]\nradiance = 1\n[camera]\neye = [0.4, -4, 0.9]\ntarget = [0, 0, 0]\nresolution = [16, 9]\n\
                     [render]\nsamples = 4\n\
                     [[meshes]]\npath = \"water_####.ply\"\ninside = \"sea\"\n\
                     [[meshes]]\npath = \"ice_*.ply\"\ninside = \"ice\"\npriority = 1\n\
                     [[meshes]]\npath = \"tank.ply\"\ninside = \"glass\"\npriority = 2\n";

/// Frames 1 to 3 of water and of ice that drifts out of it, and a post of glass.
fn tank() -> Folder {
    let folder = Folder::new();
    let box_at = |x: f64, r: f64| ply(&cuboid(DVec3::new(x - r, -r, -r), DVec3::new(x + r, r, r)));
    folder.write("tank/scene.toml", SCENE).write("tank/tank.ply", box_at(-0.8, 0.1));
    for number in 1..=3 {
        folder.write(&format!("tank/water_{number:04}.ply"), box_at(0.0, 0.8));
        folder.write(&format!("tank/ice_{number}.ply"), box_at(0.5 * f64::from(number), 0.3));
    }
    folder
}

#[test]
fn two_patterns_and_a_still_mesh_are_rendered() {
    let folder = tank();
    floe(&folder, &["render", "tank"]).ended(0);
    let ledger = folder.ledger("out/tank/ledger.jsonl");
    assert_eq!(ledger.len(), 3);
    for line in &ledger {
        assert_eq!((&line["triangles"], &line["label_mismatches"]), (&36.into(), &0.into()), "{line}");
    }
    assert_eq!(ledger[1]["hierarchy"], "refitted");
    let info = floe(&folder, &["info", "tank", "--frames", "1,3"]).ended(0).stdout;
    for words in [
        "frames    3 (1-3)",
        "water_####.ply: sea inside, priority 0, 3 files",
        "ice_*.ply: ice inside, priority 1, 3 files",
        "tank.ply: glass inside, priority 2, still",
        "between 0 and 1: 36",
        "priorities of meshes               used      meshes overlap",
    ] {
        assert!(info.contains(words), "no \"{words}\" in\n{info}");
    }
}

#[test]
fn meshes_apart_need_no_priorities() {
    let folder = tank();
    let (scene, _tank) = SCENE.rsplit_once("[[meshes]]").unwrap();
    folder.write("tank/scene.toml", scene.to_owned() + "transform = { translate = [5, 0, 0] }\n");
    let info = floe(&folder, &["info", "tank"]).ended(0).stdout;
    assert!(
        info.contains("priorities of meshes               left out  no two meshes are in the same"),
        "{info}"
    );
}

/// The frame of the missing file fails alone.
#[test]
fn a_number_that_one_mesh_lacks_fails_its_frame() {
    for (lacks, file) in [("water_0002.ply", "tank/water_0002.ply"), ("ice_2.ply", "tank/ice_*.ply")] {
        let folder = tank();
        std::fs::remove_file(folder.path("tank").join(lacks)).unwrap();
        let said = [file, "no such file of frame 2", "leave the frame out with --frames"];
        floe(&folder, &["render", "tank", "--keep-going"]).ended(66).says(&said);
        assert_eq!(pictures(&folder), ["out/tank/frame_0001.exr", "out/tank/frame_0003.exr"]);
        floe(&folder, &["render", "tank", "--frames", "1,3"]).ended(0);
    }
}
