//! Light of the sun beyond an interface, which path tracing leaves out.

use std::f64::consts::PI;

use glam::DVec3;

use crate::common::mesh::parallelogram;
use crate::common::render::Prepared;
use crate::common::scene::SceneFolder;
use crate::seeds::Seeds;

/// Water of depth 1 over a floor far wider than what is seen, the camera in it; `medium` is the water's.
fn pool(medium: &str, render: &str) -> Prepared {
    let sheet = |z: f64| parallelogram(DVec3::new(-6.0, -6.0, z), DVec3::X * 12.0, DVec3::Y * 12.0);
    // Black walls keep paths from leaving between the sheets.
    let wall =
        |x: f64, y: f64, edge: DVec3| parallelogram(DVec3::new(x, y, -0.1), edge * 14.0, DVec3::Z * 1.2);
    let walls = [
        wall(-6.0, -7.0, DVec3::Y),
        wall(6.0, -7.0, DVec3::Y),
        wall(-7.0, -6.0, DVec3::X),
        wall(-7.0, 6.0, DVec3::X),
    ];
    let mut folder = SceneFolder::new().mesh("surface.ply", &sheet(1.0)).mesh("floor.ply", &sheet(0.0));
    let mut text = String::new();
    for (i, wall) in walls.iter().enumerate() {
        folder = folder.mesh(&format!("wall_{i}.ply"), wall);
        text += &format!(
            "[[surfaces]]\nmesh = \"wall_{i}.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 0 }}\n"
        );
    }
    folder.scene(&format!(
        "[media.water]\nior = 1.33\n{medium}\n\
         [[surfaces]]\nmesh = \"surface.ply\"\nfront = \"air\"\nback = \"water\"\nmaterial = {{ kind = \"dielectric\" }}\n\
         [[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 0.5 }}\n\
         [sun]\ndirection = [0.6, 0, 0.8]\nangular_diameter = 0.53\nirradiance = [3, 2, 1]\n\
         [camera]\neye = [0, -0.3, 0.6]\ntarget = [0, 0, 0]\nvertical_fov = 60\nresolution = [16, 16]\n\
         [render]\nintegrator = \"photon\"\nmax_depth = 1\nphotons = {{ count = 100000, {render} }}\n{text}"
    ))
}

/// Cosines above and below the surface and what Fresnel lets in.
fn refracted() -> (f64, f64, f64) {
    let (n, cos_i) = (1.33_f64, 0.8_f64);
    let cos_t = (1.0 - (1.0 - cos_i * cos_i) / (n * n)).sqrt();
    let s = (cos_i - n * cos_t) / (cos_i + n * cos_t);
    let p = (n * cos_i - cos_t) / (n * cos_i + cos_t);
    (cos_i, cos_t, 1.0 - 0.5 * (s * s + p * p))
}

fn assert_close(name: &str, scene: &Prepared, expected: DVec3, samples: u32) {
    let (mean, se) = Seeds::render(scene, samples, 6, [1, 1]).means()[0];
    println!("{name}: {mean:.5} +- {se:.5}, expected {expected:.5}");
    assert!(se.max_element() < 0.004 * expected.max_element(), "{name}: {se} shows too little");
    // Six seeds: Student's t with 5 degrees of freedom exceeds 6.9 with probability 1e-3. The disc of the sun is 0.53
    // degrees wide, which changes neither side by more than 1e-4.
    assert!(
        (mean - expected).abs().cmple(6.9 * se + 1e-4 * expected).all(),
        "{name}: {mean} +- {se} for {expected}"
    );
}

/// E cos_i (1 - R) exp(-sigma_a d / cos_t) falls on the floor; the water between it and the eye is clear enough to
/// be left out, being the same medium, by an absorption that lies far under the other terms: it is taken along exactly
/// for the median distance of 0.67 m.
#[test]
fn the_sun_on_a_floor_under_flat_water() {
    let (cos_i, cos_t, passes) = refracted();
    let expected = DVec3::new(3.0, 2.0, 1.0) * (0.5 / PI * cos_i * passes);
    for gather in ["final_gather = false", "final_gather = true"] {
        assert_close(&format!("clear, {gather}"), &pool("", gather), expected, 16);
    }
    let sigma_a = DVec3::new(1.0, 0.3, 0.0);
    let scene = pool("absorption = [1, 0.3, 0]", "final_gather = false");
    let ways = eye_ways(&scene);
    let dimmed = |sigma: f64| {
        (-sigma / cos_t).exp() * ways.iter().map(|d| (-sigma * d).exp()).sum::<f64>() / ways.len() as f64
    };
    let expected = expected * DVec3::from_array(sigma_a.to_array().map(dimmed));
    assert_close("absorbing", &scene, expected, 16);
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

/// Sunlight scattered once in the water on its way to the eye: with sigma_t along both ways, the integral over the eye's
/// ray of length d with slope c = -direction_z from height h is
///
/// ```text
/// sigma_s p E_w integral exp(-sigma_t ((1 - h + c s) / cos_t + s)) ds,     E_w = E (1 - R) cos_i / cos_t
/// ```
/// `max_depth` 1 lets photons bend once and be left at the first particle; the floor is black to them.
#[test]
fn the_sun_scattered_once_in_flat_water() {
    let (cos_i, cos_t, passes) = refracted();
    let (sigma_s, sigma_a) = (0.3_f64, 0.2_f64);
    let scene = pool("absorption = 0.2\nscattering = 0.3", "volume_radius = 0.03, final_gather = false");
    let sigma_t = sigma_s + sigma_a;
    let beam = passes * cos_i / cos_t * sigma_s / (4.0 * PI);
    let in_water = |d: f64| {
        let c = 0.6 / d;
        let rate = sigma_t * (c / cos_t + 1.0);
        beam * (-sigma_t * 0.4 / cos_t).exp() * (1.0 - (-rate * d).exp()) / rate
    };
    let floor = |d: f64| 0.5 / PI * cos_i * passes * (-sigma_t * (1.0 / cos_t + d)).exp();
    let ways = eye_ways(&scene);
    let mean = ways.iter().map(|&d| in_water(d) + floor(d)).sum::<f64>() / ways.len() as f64;
    assert_close("scattered once", &scene, DVec3::new(3.0, 2.0, 1.0) * mean, 24);
}
