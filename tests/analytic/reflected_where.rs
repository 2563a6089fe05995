//! Which media are too thick to walk through, and what is walked through all the same.

use glam::DVec3;

use super::half_space::{SLAB, slab};
use crate::common::mesh::sphere;
use crate::common::render::Prepared;
use crate::common::scene::SceneFolder;

const ABOVE: &str = "[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nvertical_fov = 0.1\nresolution = [4, 4]\n";

/// A slab of 1 m, and a small lamp in the middle of it.
fn folder() -> SceneFolder {
    slab(1.0, 20.0).mesh("lamp.ply", &sphere(DVec3::new(0.0, 0.0, -0.5), 0.1, 1))
}

fn scene(folder: &SceneFolder, medium: &str, more: &str) -> Prepared {
    folder.scene(&format!("[media.cloud]\n{medium}\n{SLAB}{ABOVE}{more}"))
}

/// The box is 1 m high, so coefficients are optical sizes.
#[test]
fn only_what_is_thick_in_every_lane_and_lets_nothing_through_is_a_half_space() {
    let folder = folder();
    let hg = |scattering: f64, g: f64| {
        format!("scattering = {scattering}\nphase = {{ kind = \"henyey-greenstein\", g = {g} }}")
    };
    let inside = "[[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = { kind = \"emitter\", radiance = 1 }\n";
    let above = format!("{inside}transform = {{ translate = [0, 0, 3] }}\n");
    let photons = "[render]\nintegrator = \"photon\"\n";
    let once = "[render]\nintegrator = \"single-scattering\"\n";
    for (medium, more, is_half_space) in [
        ("scattering = 1.01e5", "", true),
        ("scattering = 0.99e5", "", false),
        ("scattering = 9e4\nabsorption = 2e4", "", true),
        ("scattering = [1e6, 1e6, 9e4]", "", false),
        ("absorption = 1e6", "", false),
        // Of these, 1.7 / 1200, 1.7 / 2000 gets through, and next to nothing.
        (&hg(1.2e5, 0.99), "", false),
        (&hg(2e5, 0.99), "", true),
        (&(hg(1.2e5, 0.99) + "\nabsorption = 100"), "", true),
        ("scattering = 1e6\nabsorption = 1\nemission = 1", "", false),
        ("scattering = 1e6\ndensity = { stratified = 1 }", "", false),
        ("scattering = 1e6", inside, false),
        ("scattering = 1e6", &above, true),
        ("scattering = 1e6", photons, false),
        ("scattering = 1e6", once, false),
    ] {
        let frame = scene(&folder, medium, more).frame;
        let found = frame.half_spaces.iter().flatten().count();
        assert_eq!(
            (found, frame.needs.half_spaces),
            (usize::from(is_half_space), is_half_space),
            "{medium} {more}"
        );
        assert_eq!(frame.half_spaces.is_empty(), !is_half_space, "{medium} {more}");
    }
}

/// A camera within a half space walks out of it, as it would if there were none: the same bits, since no path gets in again.
#[test]
fn a_camera_inside_walks() {
    let within = ABOVE.replace("eye = [0, 0, 9]", "eye = [0, 0, -0.000004]");
    let mut scene = folder().scene(&format!(
        "[media.cloud]\nscattering = 2e5\nabsorption = 1e5\n{SLAB}{within}[sky]\nradiance = 1\n"
    ));
    assert!(!scene.frame.half_spaces.is_empty());
    let picture = scene.render(16, 0);
    scene.frame.half_spaces.clear();
    let walked = scene.render(16, 0);
    let mean = picture.mean().0;
    assert!(mean.x > 0.1 && mean.x < 1.0, "{mean}");
    assert!(picture.image.pixels.iter().zip(&walked.image.pixels).all(|(a, b)| a.rgb == b.rgb));
}
