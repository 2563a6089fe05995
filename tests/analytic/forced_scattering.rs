//! Forced scattering changes nothing but the noise.

use glam::DVec3;

use super::estimates::assert_mean;
use super::media::{CUBE, DENSITIES, OBLIQUE, folder};
use crate::common::files::sky_picture;
use crate::common::mesh::parallelogram;

/// Sun, sky, a lamp and glow, in chromatic media of any density, with and without refraction.
const LIGHTS: &str = "[sun]\ndirection = [0, 0.6, 0.8]\nirradiance = [3, 2, 1]\nangular_diameter = 3\n\
    [sky]\nradiance = { image = \"sky.exr\" }\n\
    [[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = { kind = \"emitter\", radiance = 5 }\n";

#[test]
fn forced_scattering_gives_what_free_flights_give() {
    let lamp = parallelogram(DVec3::new(-0.4, -0.3, 1.2), DVec3::Y * 0.6, DVec3::X * 0.8);
    let dim = |d: DVec3| DVec3::new(0.5 + 0.4 * d.x, 0.5, 0.7 + 0.5 * d.z);
    let folder = folder().mesh("lamp.ply", &lamp).file("sky.exr", &sky_picture(dim));
    for density in DENSITIES {
        for ior in [1.0, 1.33] {
            let mean = |forced: u64| {
                let scene = folder.scene(&format!(
                    "[media.fluid]\nior = {ior}\nabsorption = [0.5, 0.1, 0]\nscattering = [0.1, 0.5, 2]\nemission = 0.5\n\
                     phase = {{ kind = \"henyey-greenstein\", g = 0.5 }}\n{density}{CUBE}{OBLIQUE}{LIGHTS}\
                     [render]\nforced_scattering = {forced}\n"
                ));
                scene.render(1024, forced).mean()
            };
            let (free, free_se) = mean(0);
            for forced in [1, 3] {
                let (mean, se) = mean(forced);
                let se = DVec3::from_array((se * se + free_se * free_se).to_array().map(f64::sqrt));
                println!("ior {ior}, forced {forced}, {density}: {mean:.5} {free:.5} +- {se:.5}");
                assert!(se.max_element() < 1e-2, "{se}");
                assert!((mean - free).abs().cmple(5.0 * se).all(), "{mean} {free} {se}");
            }
        }
    }
}

#[test]
fn a_turbid_furnace_stays_white_with_forced_scattering() {
    let folder = folder();
    for density in DENSITIES {
        for forced in [1, 4] {
            let scene = folder.scene(&format!(
                "[media.fluid]\nior = 1.33\nscattering = [0.05, 0.5, 5]\n{density}{CUBE}{OBLIQUE}\
                 [sky]\nradiance = 1\n[render]\nforced_scattering = {forced}\n"
            ));
            assert_mean(&format!("forced {forced}, {density}"), &scene.render(256, 0), DVec3::ONE, 1e-2);
        }
    }
}

/// Where a fiftieth of all paths are scattered, a free flight has 49 zeros for each of them: the variance falls by about
/// 50 times, the standard error by 7. A third of that is left to what the lamp's own sampling adds.
#[test]
fn forced_scattering_pays_in_a_thin_medium() {
    let lamp = parallelogram(DVec3::new(-0.2, -0.2, 2.5), DVec3::Y * 0.4, DVec3::X * 0.4);
    let folder = folder().mesh("lamp.ply", &lamp);
    let se = |forced: u32| {
        let scene = folder.scene(&format!(
            "[media.fluid]\nscattering = {}\n{CUBE}{OBLIQUE}[render]\nforced_scattering = {forced}\n\
             [[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = {{ kind = \"emitter\", radiance = 9 }}\n",
            0.02 / 1.4
        ));
        scene.render(256, 0).mean().1.x
    };
    let (free, forced) = (se(0), se(1));
    println!("thin medium: {free:.2e} with free flights, {forced:.2e} forced");
    assert!(forced < 3.0 / 7.0 * free, "{free} {forced}");
}
