//! Flat water, whose light is known.

use std::f64::consts::PI;

use glam::DVec3;

use crate::common::mesh::parallelogram;
use crate::common::render::Prepared;
use crate::common::scene::SceneFolder;
use crate::walled;

const SUN: &str = "[[sun]]\ndirection = [0.6, 0, 0.8]\nangular_diameter = 0.53\nirradiance = [3, 2, 1]\n";

/// Water of depth 1 over a floor of reflectance 0.5, the camera in it, the sky black; a vertex is lit and no more.
fn pool(medium: &str, normals: &str) -> Prepared {
    pool_under(SUN, medium, normals)
}

fn pool_under(suns: &str, medium: &str, normals: &str) -> Prepared {
    let sheet = |z: f64| parallelogram(DVec3::new(-6.0, -6.0, z), DVec3::X * 12.0, DVec3::Y * 12.0);
    let folder = SceneFolder::new().mesh("surface.ply", &sheet(1.0)).mesh("floor.ply", &sheet(0.0));
    let (folder, text) = walled(folder, 5.9, 1.1);
    folder.scene(&format!(
        "[media.water]\nior = 1.33\n{medium}\n\
         [[surfaces]]\nmesh = \"surface.ply\"\nfront = \"air\"\nback = \"water\"\nnormals = \"{normals}\"\n\
         material = {{ kind = \"dielectric\" }}\n\
         [[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 0.5 }}\n\
         [camera]\neye = [0, -0.3, 0.6]\ntarget = [0, 0, 0]\nvertical_fov = 60\nresolution = [16, 16]\n\
         [render]\nintegrator = \"beams\"\nmax_depth = 2\n{text}{suns}"
    ))
}

/// Cosines above and below the surface and what Fresnel lets in.
fn refracted() -> (f64, f64, f64) {
    refracted_at(0.8)
}

fn refracted_at(cos_i: f64) -> (f64, f64, f64) {
    let n = 1.33_f64;
    let cos_t = (1.0 - (1.0 - cos_i * cos_i) / (n * n)).sqrt();
    let s = (cos_i - n * cos_t) / (cos_i + n * cos_t);
    let p = (n * cos_i - cos_t) / (n * cos_i + cos_t);
    (cos_i, cos_t, 1.0 - 0.5 * (s * s + p * p))
}

/// Lengths of the eye's rays to the floor, over a fine grid of the picture.
fn eye_ways(scene: &Prepared) -> Vec<f64> {
    let steps = 160;
    (0..steps * steps)
        .map(|k| {
            let at = |i: u32| (i as f32 + 0.5) * 16.0 / steps as f32;
            let direction = scene.frame.views.opening.ray(at(k % steps), at(k / steps)).direction;
            0.6 / f64::from(-direction.z)
        })
        .collect()
}

/// The standard errors are those that the pixels tell, of independent samples here; a picture differs by more than 4.4 of
/// them with probability 1e-5. Over the disc, 0.53 degrees wide, the mean is off by less than 1e-5.
fn assert_close(name: &str, scene: &Prepared, expected: DVec3, samples: u32) {
    let (mean, se) = scene.render(samples, 1).mean();
    println!("{name}: {mean:.6} +- {se:.6}, expected {expected:.6}");
    assert!(se.max_element() < 0.004 * expected.max_element(), "{name}: {se} shows too little");
    assert!(
        (mean - expected).abs().cmple(4.4 * se + 2e-5 * expected).all(),
        "{name}: {mean} +- {se} for {expected}"
    );
}

/// E cos_i (1 - R) exp(-sigma_a / cos_t) falls on the floor, exp(-sigma_a d) of it comes to the eye.
#[test]
fn the_sun_on_a_floor_under_flat_water() {
    let (cos_i, cos_t, passes) = refracted();
    let light = DVec3::new(3.0, 2.0, 1.0) * (0.5 / PI * cos_i * passes);
    for normals in ["flat", "smooth"] {
        assert_close(&format!("clear, {normals}"), &pool("", normals), light, 16);
    }
    let scene = pool("absorption = [1, 0.3, 0]", "flat");
    let ways = eye_ways(&scene);
    let dimmed = |sigma: f64| {
        (-sigma / cos_t).exp() * ways.iter().map(|d| (-sigma * d).exp()).sum::<f64>() / ways.len() as f64
    };
    assert_close("absorbing", &scene, light * DVec3::new(dimmed(1.0), dimmed(0.3), 1.0), 64);
    // So little of it comes to the eye that the sun is looked for now and then only.
    let scene = pool("absorption = 6", "flat");
    assert_close("nearly opaque", &scene, light * dimmed(6.0), 2000);
}

/// Each of two suns falls on the floor as it would alone, dimmed along its own way.
#[test]
fn two_suns_on_a_floor_under_flat_water() {
    let other = "[[sun]]\ndirection = [0, -0.8, 0.6]\nangular_diameter = 0.2\nirradiance = [1, 2, 6]\n";
    let scene = pool_under(&format!("{SUN}{other}"), "absorption = [1, 0.3, 0]", "flat");
    let ways = eye_ways(&scene);
    let on_floor = |cos: f64, irradiance: DVec3| {
        let (cos_i, cos_t, passes) = refracted_at(cos);
        let dimmed = DVec3::new(1.0, 0.3, 0.0).map(|sigma| (-sigma / cos_t).exp());
        irradiance * dimmed * (0.5 / PI * cos_i * passes)
    };
    let light = on_floor(0.8, DVec3::new(3.0, 2.0, 1.0)) + on_floor(0.6, DVec3::new(1.0, 2.0, 6.0));
    let left = DVec3::new(1.0, 0.3, 0.0)
        .map(|sigma| ways.iter().map(|d| (-sigma * d).exp()).sum::<f64>() / ways.len() as f64);
    assert_close("two suns", &scene, light * left, 64);
}

/// Sunlight scattered once in the water on its way to the eye: with sigma_t along both ways, the integral over the eye's
/// ray of length d with slope c = -direction_z from height h is
///
/// ```text
/// sigma_s p E_w integral exp(-sigma_t ((1 - h + c s) / cos_t + s)) ds,     E_w = E (1 - R) cos_i / cos_t
/// ```
#[test]
fn the_sun_scattered_once_in_flat_water() {
    let (cos_i, cos_t, passes) = refracted();
    let (sigma_s, sigma_t) = (0.3_f64, 0.5_f64);
    let scene = pool("absorption = 0.2\nscattering = 0.3", "flat");
    let beam = passes * cos_i / cos_t * sigma_s / (4.0 * PI);
    let in_water = |d: f64| {
        let c = 0.6 / d;
        let rate = sigma_t * (c / cos_t + 1.0);
        beam * (-sigma_t * 0.4 / cos_t).exp() * (1.0 - (-rate * d).exp()) / rate
    };
    let floor = |d: f64| 0.5 / PI * cos_i * passes * (-sigma_t * (1.0 / cos_t + d)).exp();
    let ways = eye_ways(&scene);
    let mean = ways.iter().map(|&d| in_water(d) + floor(d)).sum::<f64>() / ways.len() as f64;
    assert_close("scattered once", &scene, DVec3::new(3.0, 2.0, 1.0) * mean, 1024);
}

/// Nothing is left out, and the ledger counts what was looked for; of flat water all light is found without photons, since
/// what it mirrors falls on black walls.
#[test]
fn what_was_looked_for_is_counted() {
    let scene = pool("absorption = 0.2\nscattering = 0.3", "flat");
    assert!(scene.sampling.integrator.left_out(&scene.frame.needs).is_empty());
    let counters = scene.render(4, 1).counters;
    assert!(counters.beam_roots > 500 && counters.beam_candidates >= counters.beam_roots, "{counters:?}");
    assert!(
        counters.beam_queries >= counters.beam_roots,
        "flat water bends light to a point once: {counters:?}"
    );
    assert_eq!(counters.photons, 0, "passes of photons that bring nothing");
}
