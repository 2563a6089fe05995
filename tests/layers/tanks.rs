//! A tank of glass with water, meshed one over the other, and the same meshed exactly.

use glam::DVec3;

use crate::common::mesh::{TestMesh, cuboid, parallelogram};
use crate::common::render::Prepared;
use crate::common::scene::SceneFolder;
use crate::seeds::{Seeds, assert_agree, with_radius};
use crate::shapes::{Sheets, assert_alike, frame, joined, sides, square, surfaces, turned, with_sheets};

/// Half the widths of the tank and of what it holds, the height of its floor, of the water and of its rim.
const OUTER: f64 = 1.0;
const INNER: f64 = 0.85;
const FLOOR: f64 = 0.15;
const LEVEL: f64 = 0.7;
const RIM: f64 = 1.0;

const EYE: &str = "[0.9, -3.6, 1.7]";
const GRID: [u32; 2] = [4, 3];

/// The tank and the water without any overlap.
fn exact() -> Sheets {
    let dry = [
        sides(OUTER, 0.0, RIM),
        square(OUTER, 0.0).turned(),
        frame(OUTER, INNER, RIM),
        sides(INNER, LEVEL, RIM).turned(),
    ];
    vec![
        (["air", "glass"], joined(dry)),
        (["water", "glass"], joined([sides(INNER, FLOOR, LEVEL).turned(), square(INNER, FLOOR)])),
        (["air", "water"], square(INNER, LEVEL)),
    ]
}

/// The tank as one closed mesh; its inner walls are whole.
fn glass() -> TestMesh {
    joined([
        sides(OUTER, 0.0, RIM),
        square(OUTER, 0.0).turned(),
        frame(OUTER, INNER, RIM),
        sides(INNER, FLOOR, RIM).turned(),
        square(INNER, FLOOR),
    ])
}

/// The water as a closed mesh that reaches so far into the glass.
fn water(into: f64) -> TestMesh {
    let r = INNER + into;
    cuboid(DVec3::new(-r, -r, FLOOR - into), DVec3::new(r, r, LEVEL))
}

/// By photons, which are spread over rays up to the faces and no farther.
const MILKY: &str = "[media.glass]\nior = 1.5\nscattering = 2\n[media.water]\nior = 1.33\nscattering = 1\n\
                     [render]\nintegrator = \"photon\"\nphotons = { count = 5000, radius = 0.1, volume_radius = 0.1 }\n";

/// What is around the tank: a diffuse ball in it, and a lamp over it that is large enough for chance to find.
fn around(media: &str, more: &str) -> String {
    format!(
        "[media.air]\nior = 1\n{media}\n[[surfaces]]\nmesh = \"box.ply\"\nnormals = \"flat\"\n\
         material = {{ kind = \"diffuse\", reflectance = [0.8, 0.6, 0.4] }}\n\
         [[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = {{ kind = \"emitter\", radiance = [2, 1.5, 1] }}\n\
         [sky]\nradiance = [0.5, 0.6, 0.7]\n\
         [camera]\neye = {EYE}\ntarget = [0, 0, 0.45]\nvertical_fov = 34\nresolution = [32, 24]\n{more}"
    )
}

fn folder(into: f64) -> SceneFolder {
    let body = cuboid(DVec3::new(-0.4, -0.3, 0.3), DVec3::new(0.2, 0.3, 0.9));
    let lamp = parallelogram(DVec3::new(-1.2, -1.2, 3.0), DVec3::Y * 2.4, DVec3::X * 2.4);
    let folder = SceneFolder::new()
        .mesh("box.ply", &turned(body))
        .mesh("lamp.ply", &lamp)
        .mesh("glass.ply", &turned(glass()))
        .mesh("water.ply", &turned(water(into)));
    with_sheets(folder, &exact())
}

const OVERLAPPING: &str = "[[meshes]]\npath = \"glass.ply\"\ninside = \"glass\"\nnormals = \"flat\"\npriority = 1\n\
                           [[meshes]]\npath = \"water.ply\"\ninside = \"water\"\nnormals = \"flat\"\n";

const CLEAR: &str = "[media.glass]\nior = 1.5\nabsorption = [0.4, 0.1, 0.3]\n[media.water]\nior = 1.33\nabsorption = [0.9, 0.3, 0.1]\n";
const TURBID: &str = "[media.glass]\nior = 1.5\nabsorption = [0.4, 0.1, 0.3]\n\
                      [media.water]\nior = 1.33\nabsorption = [0.6, 0.2, 0.1]\nscattering = [0.5, 1, 2]\n";
/// Shadow rays go straight through all of it.
const MATCHED: &str = "[media.glass]\nabsorption = [0.9, 0.3, 0.6]\n\
                       [media.water]\nabsorption = [0.6, 0.2, 0.1]\nscattering = [0.5, 1, 2]\n";

/// The exact meshes and the overlapping ones, seen alike.
fn scenes(into: f64, media: &str, eye: &str) -> [Prepared; 2] {
    let folder = folder(into);
    [&surfaces(&exact()), OVERLAPPING].map(|meshes| folder.scene(&around(media, meshes).replace(EYE, eye)))
}

fn compare(name: &str, media: &str, eye: &str, into: f64, samples: u32) {
    assert_alike(name, &scenes(into, media, eye), GRID, samples);
}

#[test]
fn clear_water_in_glass() {
    compare("clear", CLEAR, EYE, 0.02, 128);
}

#[test]
fn turbid_water_in_glass() {
    compare("turbid", TURBID, EYE, 0.02, 64);
}

#[test]
fn water_and_glass_that_bend_nothing() {
    compare("matched", MATCHED, EYE, 0.02, 32);
}

#[test]
fn an_eye_within_the_water_or_where_both_are() {
    compare("in water", TURBID, "[0.5, -0.2, 0.5]", 0.02, 32);
    compare("in both", TURBID, "[0.39, -0.86, 0.35]", 0.1, 32);
}

/// Faces on each other are crossed at once, so that paths are the same to the last random number. A film of air between
/// them would reflect all that comes obliquely out of the glass. Of the water's face and the glass's, either may be found
/// first, and their points differ by a few roundings: a path of some meetings may take another turn at an edge, so one
/// pixel in a hundred may differ. A photon that does so changes all pixels near it: with seeds 1 to 8, 0 to 44 of 768.
#[test]
fn faces_on_each_other_are_one() {
    let within = "[0.5, -0.2, 0.5]";
    for (media, eye) in [(CLEAR, EYE), (TURBID, EYE), (MATCHED, EYE), (TURBID, within), (MILKY, EYE)] {
        let [expected, found] = scenes(0.0, media, eye).map(|scene| scene.render(16, 1));
        let pixels = expected.image.pixels.iter().zip(&found.image.pixels);
        let differ = pixels.filter(|(a, b)| (a.rgb - b.rgb).abs().max_element() > 1e-4 * a.rgb.max_element());
        let (differ, of) = (differ.count(), found.image.pixels.len());
        println!("{eye}: {differ} of {of} pixels differ");
        let most = if media == MILKY { of / 10 } else { of / 100 };
        assert!(differ <= most, "{differ} of {of} pixels differ");
        assert_eq!(found.counters.label_mismatches, 0);
    }
}

/// Photons go where eye paths go: at radius 0 they find the same light among overlapping meshes.
#[test]
fn photons_and_eye_paths_agree() {
    let folder = folder(0.02);
    let text = around(TURBID, OVERLAPPING);
    let by_paths = Seeds::render(&folder.scene(&text), 128, 4, GRID).means();
    let text = text + "[render]\nintegrator = \"photon\"\nphotons = { count = 20000 }\n";
    let [near, middle, wide] = [1.0, 2.0, 4.0]
        .map(|factor| Seeds::render(&with_radius(folder.scene(&text), factor * 0.03), 8, 4, GRID));
    let by_photons = Seeds::extrapolated(&near, &middle, &wide).means();
    assert_agree("photons", &by_photons, &by_paths, 0.06);
}
