//! Ice that floats in water whose mesh goes right through it, and the same meshed exactly.

use glam::DVec3;

use crate::common::mesh::{cuboid, parallelogram};
use crate::common::render::Prepared;
use crate::common::scene::SceneFolder;
use crate::shapes::{Sheets, assert_alike, frame, joined, sides, square, surfaces, turned, with_sheets};

/// Half the widths, and the heights of the undersides and tops; the water's is 0.
const SEA: f64 = 1.0;
const FLOE: f64 = 0.5;
const BED: f64 = -0.8;
const KEEL: f64 = -0.4;
const SAIL: f64 = 0.3;

fn exact() -> Sheets {
    let air_and_water = [sides(SEA, BED, 0.0), square(SEA, BED).turned(), frame(SEA, FLOE, 0.0)];
    vec![
        (["air", "water"], joined(air_and_water)),
        (["air", "ice"], joined([sides(FLOE, 0.0, SAIL), square(FLOE, SAIL)])),
        (["water", "ice"], joined([sides(FLOE, KEEL, 0.0), square(FLOE, KEEL).turned()])),
    ]
}

const OVERLAPPING: &str = "[[meshes]]\npath = \"water.ply\"\ninside = \"water\"\nnormals = \"flat\"\n\
                           [[meshes]]\npath = \"ice.ply\"\ninside = \"ice\"\nnormals = \"flat\"\npriority = 1\n";

/// Lit by a lamp that is so far away that light is looked for beneath the surfaces.
fn scenes(media: &str, more: &str) -> [Prepared; 2] {
    let lamp = parallelogram(DVec3::new(-0.6, -0.6, 8.0), DVec3::Y * 1.2, DVec3::X * 1.2);
    let r = DVec3::new(FLOE, FLOE, 0.0);
    let folder = SceneFolder::new()
        .mesh("lamp.ply", &lamp)
        .mesh("water.ply", &turned(cuboid(DVec3::new(-SEA, -SEA, BED), DVec3::new(SEA, SEA, 0.0))))
        .mesh("ice.ply", &turned(cuboid(DVec3::Z * KEEL - r, DVec3::Z * SAIL + r)));
    let folder = with_sheets(folder, &exact());
    [&surfaces(&exact()), OVERLAPPING].map(|meshes| {
        folder.scene(&format!(
            "{media}\n[[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = {{ kind = \"emitter\", radiance = [60, 40, 20] }}\n\
             [sky]\nradiance = [0.3, 0.4, 0.5]\n\
             [camera]\neye = [0.7, -2.6, 0.9]\ntarget = [0, 0, -0.1]\nvertical_fov = 38\nresolution = [32, 24]\n\
             {meshes}{more}"
        ))
    })
}

const WATER: &str =
    "[media.air]\nior = 1\n[media.water]\nior = 1.33\nabsorption = [0.6, 0.2, 0.1]\nscattering = 0.4\n";

#[test]
fn lamps_are_found_beneath_hidden_faces() {
    let media = format!("{WATER}[media.ice]\nior = 1.31\nabsorption = 0.2\nscattering = 2\n");
    let thin = scenes(&media, "");
    for scene in &thin {
        let ice = scene.frame.media.iter().position(|medium| medium.name == "ice").unwrap();
        assert!(scene.frame.beneath[ice].is_some() && scene.frame.needs.direct_light);
    }
    assert_alike("thin ice", &thin, [4, 3], 32);
    assert_alike("forced", &scenes(&media, "[render]\nforced_scattering = 2\n"), [4, 3], 32);
}

/// Ice in which walks take hundreds of steps, many of them through the water's hidden surface: where particles fall next to
/// it, no walk may lose its way.
#[test]
fn walks_in_thick_ice_cross_a_hidden_face() {
    for absorption in ["[0.4, 0.2, 0.1]", "[40, 30, 20]"] {
        let ice = format!("[media.ice]\nior = 1.31\nabsorption = {absorption}\nscattering = 300\n");
        let scenes = scenes(&(WATER.to_owned() + &ice), "");
        assert_alike(&format!("thick ice, absorption {absorption}"), &scenes, [4, 3], 16);
        let counters = scenes[1].render(16, 9).counters;
        println!("{counters:?}");
        assert_eq!((counters.label_mismatches, counters.escaped_inside), (0, 0), "{counters:?}");
    }
}

/// A kernel that reaches over a hidden face takes each photon once, from this side or from that: pictures of kernels as wide
/// as a third of the ice are the same.
#[test]
fn photons_count_once_at_hidden_faces() {
    let media = format!("{WATER}[media.ice]\nior = 1.31\nabsorption = 0.2\nscattering = 2\n");
    let render = "[render]\nintegrator = \"photon\"\n\
                  photons = { count = 20000, radius = 0.15, volume_radius = 0.15, shrink = 1 }\n";
    assert_alike("photons", &scenes(&media, render), [4, 3], 16);
}
