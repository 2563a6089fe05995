//! A clear sky and the sun's beam through the same air.

use std::f64::consts::PI;

use floe::light::ClearAir;
use floe::light::atmosphere::direct_sunlight;
use floe::spectrum::{Role, Spectrum};
use glam::{DVec3, Vec3};

use super::estimates::{assert_every_pixel, assert_mean};
use crate::common::mesh::parallelogram;
use crate::common::scene::SceneFolder;

fn colour(spectrum: &Spectrum) -> DVec3 {
    spectrum.to_rgb(Role::Illuminant).as_dvec3()
}

/// rho / pi (E_sun sin h + integral of L cos theta): the energy that arrives on level ground, by the closed sum of the sky.
#[test]
fn a_floor_reflects_the_light_of_sun_and_sky() {
    let floor = parallelogram(DVec3::new(-9.0, -9.0, 0.0), DVec3::X * 18.0, DVec3::Y * 18.0);
    let folder = SceneFolder::new().mesh("floor.ply", &floor);
    for (turbidity, elevation, azimuth) in [(2.0, 60.0_f64, 30.0), (4.0, 8.0, 250.0)] {
        let scene = folder.scene(&format!(
            "[[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 0.5 }}\n\
             [sun]\nelevation = {elevation}\nazimuth = {azimuth}\n\
             [sky]\nradiance = {{ model = \"hosek-wilkie\", turbidity = {turbidity} }}\n\
             [camera]\neye = [0, -1, 2]\ntarget = [0, 0, 0]\nvertical_fov = 20\nresolution = [16, 16]\n"
        ));
        let height = elevation.to_radians();
        let sun = Vec3::new(height.cos() as f32, 0.0, height.sin() as f32);
        let sky = ClearAir { turbidity, ground_albedo: 0.1 }.light(sun, Vec3::Z).level;
        let direct = colour(&direct_sunlight(turbidity, elevation)) * height.sin();
        let expected = 0.5 / PI * (direct + colour(&sky));
        let name = format!("floor, sun at {elevation} degrees");
        assert_mean(&name, &scene.render(64, 0), expected, 2e-3 * expected.max_element());
    }
}

/// Straight down there is the ground, the same everywhere: albedo / pi times what falls on it.
#[test]
fn the_ground_is_seen_below_the_horizon() {
    let scene = SceneFolder::new().scene(
        "[sun]\nelevation = 40\nazimuth = 0\n[sky]\nradiance = { model = \"hosek-wilkie\", ground_albedo = 0.6 }\n\
         [camera]\neye = [0, 0, 0]\ntarget = [1, 0, -1]\nvertical_fov = 60\nresolution = [4, 4]\n[render]\nsamples = 1024",
    );
    let height = 40.0_f64.to_radians();
    let sun = Vec3::new(0.0, height.cos() as f32, height.sin() as f32);
    let sky = ClearAir { turbidity: 3.0, ground_albedo: 0.6 }.light(sun, Vec3::Z).level;
    let expected = 0.6 / PI * (colour(&direct_sunlight(3.0, 40.0)) * height.sin() + colour(&sky));
    // 1024 stratified wavelengths a pixel of a smooth spectrum.
    assert_every_pixel("ground", &scene.render(1024, 0), expected, 2e-3);
}
