//! The fog of an ambient radiance: nothing is scattered, and nothing in it is left to chance.
//!
//! ```text
//! L = T L0 + (1 - T) (sigma_a Le + sigma_s L_ambient) / sigma_t,   L_ambient = L_sky + E_sun / (4 pi)
//! ```

use std::f64::consts::PI;

use glam::DVec3;

use super::estimates::{assert_every_pixel, assert_mean};
use super::media::{CUBE, DENSITIES, OBLIQUE, STRAIGHT, folder};
use crate::common::files::npy;
use crate::common::mesh::{cuboid, parallelogram};

const FOG: &str = "[render]\nintegrator = \"fog\"\n";
const SUN_AND_SKY: &str =
    "[sun]\ndirection = [0, 0.6, 0.8]\nirradiance = [6, 4, 2]\n[sky]\nradiance = [1, 2, 3]\n";
/// The cube is 1.4 m across.
const SIDE: f64 = 1.4;

fn ambient() -> DVec3 {
    DVec3::new(1.0, 2.0, 3.0) + DVec3::new(6.0, 4.0, 2.0) / (4.0 * PI)
}

/// Through `length` metres of density 1, in front of the sky.
fn through(length: f64, sigma_a: [f64; 3], sigma_s: [f64; 3], emission: f64) -> DVec3 {
    let radiance = |i: usize| {
        let sigma_t = sigma_a[i] + sigma_s[i];
        let source = (sigma_a[i] * emission + sigma_s[i] * ambient()[i]) / sigma_t;
        let transmittance = libm::exp(-sigma_t * length);
        let behind = [1.0, 2.0, 3.0][i];
        transmittance * behind + (1.0 - transmittance) * source
    };
    DVec3::from_array([0, 1, 2].map(radiance))
}

/// The rays are y-parallel at a height of 0.03: both layers have one density along them; that of the grid is linear
/// between the centres of its cells.
#[test]
fn fog_before_a_sky_follows_its_formula_in_every_density() {
    let column = npy([1, 3, 1], |i| [0.5, 2.0, 0.25][i]);
    let folder = folder().file("column.npy", &column);
    for (density, length) in [
        ("", SIDE),
        ("density = { stratified = 0.4, surface = 0.7 }\n", SIDE * libm::exp((0.03 - 0.7) / 0.4)),
        ("density = { stratified = -0.3 }\n", SIDE * libm::exp(-0.03 / 0.3)),
        (
            "density = { grid = \"column.npy\", box = [[-0.7, -0.5, -0.7], [0.7, 0.4, 0.7]] }\n",
            0.9 * (0.5 + 2.0 + 0.25) / 3.0,
        ),
    ] {
        for emission in [0.0, 5.0] {
            let scene = folder.scene(&format!(
                "[media.fluid]\nabsorption = [0.5, 2, 0.25]\nscattering = [1, 0.5, 3]\nemission = {emission}\n\
                 phase = {{ kind = \"henyey-greenstein\", g = 0.7 }}\n{density}{CUBE}{STRAIGHT}{SUN_AND_SKY}{FOG}"
            ));
            let expected = through(length, [0.5, 2.0, 0.25], [1.0, 0.5, 3.0], emission);
            // Heights of the rays are off by 3e-5 m: 1e-4 of the scale heights.
            assert_every_pixel(&format!("fog, {density}"), &scene.render(4, 0), expected, 1e-4);
        }
    }
}

/// Rays down through the layers: the length is H (1 - exp(-1.4 / H)) for a density of 1 at the top.
#[test]
fn fog_looked_down_into_follows_its_formula() {
    let scene = folder().scene(&format!(
        "[media.fluid]\nabsorption = [0.5, 0, 0.25]\nscattering = [1, 0.5, 3]\n\
         density = {{ stratified = 0.4, surface = 0.7 }}\n{CUBE}{SUN_AND_SKY}{FOG}\
         [camera]\neye = [0.05, 0.03, 3.5]\ntarget = [0.05, 0.03, 0]\nup = [0, 1, 0]\nvertical_fov = 0.001\n\
         resolution = [4, 4]\n"
    ));
    let length = -0.4 * libm::expm1(-SIDE / 0.4);
    let expected = through(length, [0.5, 0.0, 0.25], [1.0, 0.5, 3.0], 0.0);
    assert_every_pixel("fog from above", &scene.render(4, 0), expected, 4e-6);
}

/// What scatters all and is as bright as its surroundings cannot be seen: in each sample where nothing bends, on average
/// where roulette takes part.
#[test]
fn fog_vanishes_in_white_surroundings() {
    let folder = folder();
    for density in DENSITIES {
        for ior in [1.0, 1.33] {
            let scene = folder.scene(&format!(
                "[media.fluid]\nior = {ior}\nscattering = [0.5, 2, 8]\n{density}{CUBE}{OBLIQUE}\
                 [sky]\nradiance = 1\n{FOG}"
            ));
            let name = format!("fog furnace, ior {ior}, {density}");
            if ior == 1.0 {
                assert_every_pixel(&name, &scene.render(16, 0), DVec3::ONE, 2e-6);
            } else {
                assert_mean(&name, &scene.render(256, 0), DVec3::ONE, 2e-3);
            }
        }
    }
}

/// Over wavelength, with the same wavelengths in both pictures.
#[test]
fn spectral_fog_vanishes_in_white_surroundings() {
    let folder = folder();
    let render = |fluid: &str| {
        let scene = folder
            .scene(&format!("[media.fluid]\n{fluid}\n{CUBE}{OBLIQUE}{FOG}[sky]\nradiance = [1, 2, 3]\n"));
        scene.render(16, 0).mean().0
    };
    let turbid = render("scattering = { wavelength = [400, 700], value = [0.2, 5] }");
    let clear = render("absorption = { wavelength = [400, 700], value = [0, 0] }");
    println!("{turbid:.6} {clear:.6}");
    assert!(((turbid - clear) / clear).abs().max_element() < 2e-5);
}

/// A floor under a slab of fog: sunlight is dimmed on its way down and up, and the fog itself lights the floor with
///
/// ```text
/// pi (1 - 2 E3(tau)) albedo L_ambient,   E3(tau) = integral of mu exp(-tau / mu) over mu from 0 to 1
/// ```
#[test]
fn a_floor_in_fog_is_lit_through_it() {
    let floor = parallelogram(DVec3::new(-5.0, -5.0, 0.0), DVec3::X * 10.0, DVec3::Y * 10.0);
    let slab = cuboid(DVec3::new(-1e3, -1e3, -1.0), DVec3::new(1e3, 1e3, 0.5));
    let scene = folder().mesh("floor.ply", &floor).mesh("cube.ply", &slab).scene(&format!(
        "[media.fluid]\nabsorption = [0.2, 0, 0]\nscattering = [0.3, 1, 0]\n{CUBE}{FOG}max_depth = 1\n\
         [[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 0.5 }}\n\
         [sun]\ndirection = [0, 0.6, 0.8]\nirradiance = 10\nangular_diameter = 0.05\n\
         [camera]\neye = [0.1, 0.2, 2]\ntarget = [0.1, 0.2, 0]\nup = [0, 1, 0]\nvertical_fov = 0.001\n\
         resolution = [4, 4]\n"
    ));
    let ambient = 10.0 / (4.0 * PI);
    let expected = [(0.5, 0.6), (1.0, 1.0), (0.0, 0.0)].map(|(sigma_t, albedo): (f64, f64)| {
        let depth = sigma_t * 0.5;
        let sunlight = 10.0 * 0.8 * libm::exp(-depth / 0.8);
        let e3 = (0..1000).map(|i| (f64::from(i) + 0.5) * 1e-3).map(|mu| 1e-3 * mu * libm::exp(-depth / mu));
        let fog_light = PI * (1.0 - 2.0 * e3.sum::<f64>()) * albedo * ambient;
        let up = libm::exp(-depth);
        up * 0.5 * (sunlight + fog_light) / PI + (1.0 - up) * albedo * ambient
    });
    assert_mean("floor in fog", &scene.render(1024, 0), DVec3::from_array(expected), 1e-3);
}
