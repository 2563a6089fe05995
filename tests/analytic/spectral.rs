//! The same scenes on four wavelengths a path as on RGB.

use floe::spectrum::LaneMode;
use floe::spectrum::cie::rgb_to_xyz;
use floe::spectrum::lab::lab;
use glam::DVec3;

use crate::common::mesh::{cuboid, parallelogram};
use crate::common::render::Prepared;
use crate::common::scene::SceneFolder;

/// A lamp, a floor and a cube of clear fluid; `extra` makes it spectral.
fn scene(extra: &str) -> Prepared {
    let floor = parallelogram(DVec3::new(-9.0, -9.0, -0.6), DVec3::X * 18.0, DVec3::Y * 18.0);
    let lamp = parallelogram(DVec3::new(-1.0, -1.0, 2.0), DVec3::Y * 2.0, DVec3::X * 2.0);
    SceneFolder::new()
        .mesh("floor.ply", &floor)
        .mesh("lamp.ply", &lamp)
        .mesh("cube.ply", &cuboid(DVec3::splat(-0.5), DVec3::splat(0.5)))
        .scene(&format!(
            "[media.fluid]\nior = 1.33\n{extra}[[surfaces]]\nmesh = \"floor.ply\"\n\
             material = {{ kind = \"diffuse\", reflectance = [0.7, 0.4, 0.2] }}\n\
             [[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = {{ kind = \"emitter\", radiance = 2 }}\n\
             [[surfaces]]\nmesh = \"cube.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"fluid\"\n\
             material = {{ kind = \"dielectric\" }}\n[sky]\nradiance = 0.6\n\
             [camera]\neye = [2, -3, 1]\ntarget = [0, 0, 0]\nvertical_fov = 40\nresolution = [24, 18]\n"
        ))
}

/// A medium that is nowhere, given over wavelength.
const SPECTRAL: &str = "[media.unused]\nabsorption = { wavelength = [400, 700], value = [1, 1] }\n";

fn delta_e(a: DVec3, b: DVec3) -> f64 {
    (lab(rgb_to_xyz(a)) - lab(rgb_to_xyz(b))).length()
}

#[test]
fn a_grey_furnace_is_white_on_wavelengths() {
    let folder = SceneFolder::new().mesh("cube.ply", &cuboid(DVec3::splat(-0.5), DVec3::splat(0.5)));
    let scene = folder.scene(&format!(
        "[media.fluid]\nior = 1.33\nscattering = 3\n{SPECTRAL}\
         [[surfaces]]\nmesh = \"cube.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"fluid\"\n\
         material = {{ kind = \"dielectric\" }}\n[sky]\nradiance = 1\n\
         [camera]\neye = [2, -3, 1]\ntarget = [0, 0, 0]\nvertical_fov = 20\nresolution = [16, 12]\n"
    ));
    assert_eq!(scene.frame.mode, LaneMode::Spectral);
    let (mean, se) = scene.render(1024, 0).mean();
    let difference = delta_e(mean, DVec3::ONE);
    println!("grey furnace on wavelengths: {mean:.5} +- {se:.5}, Delta E {difference:.3}");
    assert!(difference < 0.5, "{mean} is off by Delta E {difference}");
}

/// White lights on a coloured floor: one reflection has the floor's colour on wavelengths too, to the Delta E of 0.025 of
/// upsampling. Two multiply spectra and not colours, but only what the cube sends back to the floor is reflected twice:
/// 3 parts in 1000 allow for it.
#[test]
fn coloured_surfaces_look_the_same_on_wavelengths() {
    let rgb = scene("");
    let spectral = scene(SPECTRAL);
    assert_eq!((rgb.frame.mode, spectral.frame.mode), (LaneMode::Rgb, LaneMode::Spectral));
    let ((a, se_a), (b, se_b)) = (rgb.render(512, 0).mean(), spectral.render(2048, 1).mean());
    println!("RGB {a:.5} +- {se_a:.5}, wavelengths {b:.5} +- {se_b:.5}, Delta E {:.3}", delta_e(a, b));
    let allowed = 5.0 * (se_a * se_a + se_b * se_b).powf(0.5) + 0.003 * a;
    assert!((a - b).abs().cmple(allowed).all(), "{a} became {b}");
}

/// What is grey has no colour to be upsampled: the same within noise.
#[test]
fn a_grey_turbid_fluid_is_the_same_on_wavelengths() {
    let fluid = "absorption = 0.5\nscattering = 2\nphase = { kind = \"henyey-greenstein\", g = 0.8 }\n";
    let folder = SceneFolder::new().mesh("cube.ply", &cuboid(DVec3::splat(-0.5), DVec3::splat(0.5)));
    let render = |extra: &str, samples| {
        let scene = folder.scene(&format!(
            "[media.fluid]\nior = 1.33\n{fluid}{extra}\
             [[surfaces]]\nmesh = \"cube.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"fluid\"\n\
             material = {{ kind = \"dielectric\" }}\n[sky]\nradiance = 1\n\
             [camera]\neye = [2, -3, 1]\ntarget = [0, 0, 0]\nvertical_fov = 15\nresolution = [16, 12]\n"
        ));
        scene.render(samples, 5).mean()
    };
    let ((a, se_a), (b, se_b)) = (render("", 1024), render(SPECTRAL, 2048));
    println!("grey: RGB {a:.5} +- {se_a:.5}, wavelengths {b:.5} +- {se_b:.5}");
    let z = (a - b) / (se_a * se_a + se_b * se_b).powf(0.5);
    assert!(z.abs().max_element() < 5.0, "{a} became {b}: {z}");
}
