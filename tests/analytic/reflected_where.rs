//! Which media are too thick to walk through, and what is walked through all the same.

use glam::DVec3;

use floe::driver::tiles::{Sampling, render_pixels};

use super::half_space::{SLAB, camera, slab};
use crate::common::mesh::sphere;
use crate::common::render::Prepared;
use crate::common::scene::SceneFolder;

const SPRAY: &str =
    "[[surfaces]]\nmesh = \"spray.ply\"\nfront = \"air\"\nback = \"cloud\"\nmaterial = { kind = \"null\" }\n";
const ABOVE: &str = "[camera]\neye = [0, 0, 4]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nvertical_fov = 0.1\nresolution = [4, 4]\n";

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
    let within = ABOVE.replace("eye = [0, 0, 4]", "eye = [0, 0, -0.000004]");
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

/// 2^-23 2e4 z: 0.021 of a free path from 9 m, where walks are good, and 0.076 from 32 m.
#[test]
fn free_paths_that_coordinates_cannot_tell_are_not_walked() {
    let folder = folder();
    for (eye, is_half_space) in [(9, false), (32, true)] {
        let from = ABOVE.replace("eye = [0, 0, 4]", &format!("eye = [0, 0, {eye}]"));
        let scene = folder.scene(&format!(
            "[media.cloud]\nscattering = 2e4\n[media.unused]\nscattering = 1e9\n{SLAB}{from}"
        ));
        let found: Vec<bool> = scene.frame.half_spaces.iter().map(Option::is_some).collect();
        assert_eq!(
            found.iter().filter(|f| **f).count(),
            usize::from(is_half_space),
            "from {eye} m: {found:?}"
        );
    }
}

/// Flights of a tenth of a millimetre, some of which would end beyond the surface by their rounding: paths stay within it, and no
/// frame is refused. Light that goes far in water has no allowance.
#[test]
fn labels_are_not_blamed_for_rounding() {
    let folder = slab(1.0, 20.0);
    let text = |medium: &str| format!("[media.cloud]\n{medium}\n{SLAB}[sky]\nradiance = 1\n{}", camera(1.0));
    let scene = folder.scene(&text("extinction = 1e4\nalbedo = [0.5, 0.9, 0.99]"));
    let sampling = Sampling { samples: 256, ..scene.sampling.clone() };
    let (_, counters) = render_pixels(&scene.frame, &sampling, &|_, _| ());
    assert!(scene.frame.roughness > 0.0 && counters.rays > 100_000, "{} {counters:?}", scene.frame.roughness);
    assert!(!counters.too_many_mismatches(0.0), "{counters:?}");
    assert_eq!(folder.scene(&text("scattering = 0.3")).frame.roughness, 0.0);
}

/// The box around two drops is 21 times as wide as either. A ball is as thick as its box is wide, but for 1 % at 1280 triangles.
#[test]
fn spray_is_as_thick_as_its_drops() {
    let drop = |at: DVec3, radius: f64| sphere(at, radius, 3);
    let mut drops = drop(DVec3::splat(-0.5), 0.025);
    let other = drop(DVec3::splat(0.5), 0.025);
    let count = drops.positions.len() as u32;
    drops.triangles.extend(other.triangles.iter().map(|corners| corners.map(|i| i + count)));
    drops.positions.extend(other.positions);
    let from = ABOVE.replace("eye = [0, 0, 4]", "eye = [0, 0, 1.5]");
    for (mesh, scattering, is_half_space) in [
        (&drops, 2e5, false),
        (&drops, 2.1e6, true),
        (&drop(DVec3::ZERO, 0.5), 1.05e5, true),
        (&drop(DVec3::ZERO, 0.5), 0.95e5, false),
    ] {
        let folder = SceneFolder::new().mesh("spray.ply", mesh);
        let scene = folder.scene(&format!("[media.cloud]\nscattering = {scattering}\n{SPRAY}{from}"));
        assert_eq!(!scene.frame.half_spaces.is_empty(), is_half_space, "{scattering}");
    }
}
