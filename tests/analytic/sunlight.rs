//! The sun's disc: what it is, what it lights, and what is in between.

use std::f64::consts::PI;

use glam::DVec3;

use super::estimates::{assert_every_pixel, assert_mean};
use crate::common::mesh::{cuboid, parallelogram};
use crate::common::scene::SceneFolder;

fn sun(diameter: f64) -> String {
    // Cosine 0.6 with the vertical.
    format!("[sun]\ndirection = [0.8, 0, 0.6]\nangular_diameter = {diameter}\nirradiance = [2, 1, 0.5]\n")
}

const IRRADIANCE: DVec3 = DVec3::new(2.0, 1.0, 0.5);

fn disc_radiance(diameter: f64) -> DVec3 {
    IRRADIANCE / (PI * (0.5 * diameter).to_radians().sin().powi(2))
}

/// E cos(theta) holds for a disc of any size that is above the horizon: vector irradiance is symmetric about its axis.
#[test]
fn a_floor_reflects_the_suns_irradiance_times_the_cosine() {
    let floor = parallelogram(DVec3::new(-9.0, -9.0, 0.0), DVec3::X * 18.0, DVec3::Y * 18.0);
    let folder = SceneFolder::new().mesh("floor.ply", &floor);
    for diameter in [0.01, 0.53, 20.0, 60.0] {
        let scene = folder.scene(&format!(
            "[[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = [0.5, 0.6, 0.7] }}\n\
             {}[camera]\neye = [0, -1, 2]\ntarget = [0, 0, 0]\nvertical_fov = 20\nresolution = [4, 4]\n",
            sun(diameter)
        ));
        let expected = DVec3::new(0.5, 0.6, 0.7) * IRRADIANCE * 0.6 / PI;
        assert_mean(&format!("floor under {diameter} degrees"), &scene.render(256, 0), expected, 1e-3);
    }
}

#[test]
fn the_disc_is_as_bright_as_its_irradiance_says_directly_and_in_a_mirror() {
    let mirror = parallelogram(DVec3::new(-9.0, -9.0, -1.0), DVec3::X * 18.0, DVec3::Y * 18.0);
    let folder = SceneFolder::new().mesh("mirror.ply", &mirror);
    for diameter in [0.53, 5.0] {
        for (what, target) in [("directly", [0.8, 0.0, 0.6]), ("in a mirror", [0.8, 0.0, -0.6])] {
            let scene = folder.scene(&format!(
                "[[surfaces]]\nmesh = \"mirror.ply\"\nmaterial = {{ kind = \"conductor\", eta = 1e-9, k = 1 }}\n\
                 {}[camera]\neye = [0, 0, 0]\ntarget = {target:?}\nvertical_fov = 0.3\nresolution = [4, 4]\n",
                sun(diameter)
            ));
            let name = format!("{diameter} degrees {what}");
            // The disc's radiance comes from the sine of its angle in f32: 1e-6.
            assert_every_pixel(&name, &scene.render(4, 0), disc_radiance(diameter), 4e-6);
        }
    }
}

/// Where discs lie one over the other, directly and in a mirror, their radiances add up; where one is alone, there is its own.
#[test]
fn discs_that_overlap_add_up() {
    let mirror = parallelogram(DVec3::new(-9.0, -9.0, -1.0), DVec3::X * 18.0, DVec3::Y * 18.0);
    let folder = SceneFolder::new().mesh("mirror.ply", &mirror);
    let suns = format!("{}{}", sun(2.0), sun(8.0)).replace("[sun]", "[[sun]]");
    for side in [1.0, -1.0] {
        // Three degrees up from the middle of both.
        let beside =
            [0.8 - 0.6 * 3_f64.to_radians().tan(), 0.0, side * (0.6 + 0.8 * 3_f64.to_radians().tan())];
        let both = disc_radiance(2.0) + disc_radiance(8.0);
        for (target, expected) in [([0.8, 0.0, side * 0.6], both), (beside, disc_radiance(8.0))] {
            let scene = folder.scene(&format!(
                "[[surfaces]]\nmesh = \"mirror.ply\"\nmaterial = {{ kind = \"conductor\", eta = 1e-9, k = 1 }}\n\
                 {suns}[camera]\neye = [0, 0, 0]\ntarget = {target:?}\nvertical_fov = 0.3\nresolution = [4, 4]\n"
            ));
            // As above.
            assert_every_pixel(&format!("towards {target:?}"), &scene.render(4, 0), expected, 4e-6);
        }
    }
}

/// Its picture holds the irradiance: the edge is where the diameter says.
#[test]
fn the_picture_of_the_disc_integrates_to_the_irradiance() {
    let scene = SceneFolder::new().scene(&format!(
        "{}[camera]\neye = [0, 0, 0]\ntarget = [0.8, 0, 0.6]\nvertical_fov = 8\nresolution = [32, 32]\n",
        sun(5.0)
    ));
    let (mean, _) = scene.render(256, 0).mean();
    // A pixel at the tangents (x, y) from the axis has dw cos = dx dy / (1 + x^2 + y^2)^2, nearly constant here.
    let area = (2.0 * 4_f64.to_radians().tan()).powi(2);
    let disc = PI * 2.5_f64.to_radians().tan().powi(2);
    let expected = disc_radiance(5.0) * disc / area;
    assert!(((mean - expected) / expected).abs().max_element() < 1e-3, "{mean} is not {expected}");
}

/// Through an index-matched window both the disc and what it lights are dimmed by exp(-sigma_a d).
#[test]
fn a_matched_window_dims_the_sun() {
    let folder = SceneFolder::new()
        .mesh("floor.ply", &parallelogram(DVec3::new(-9.0, -9.0, -1.0), DVec3::X * 18.0, DVec3::Y * 18.0))
        .mesh("window.ply", &cuboid(DVec3::new(-30.0, -30.0, 3.0), DVec3::new(30.0, 30.0, 3.5)));
    let scene = |target: [f64; 3], fov: f64| {
        folder.scene(&format!(
            "[media.smoke]\nabsorption = [1, 0.5, 0]\n\
             [[surfaces]]\nmesh = \"window.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"smoke\"\n\
             material = {{ kind = \"null\" }}\n\
             [[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 1 }}\n\
             {}[camera]\neye = [0, 0, 0]\ntarget = {target:?}\nvertical_fov = {fov}\nresolution = [4, 4]\n",
            sun(0.53)
        ))
    };
    // 0.5 m at a cosine of 0.6; the half degree changes that length by 0.6 % and the mean by less than 1e-4.
    let dimmed = DVec3::from_array([1.0, 0.5, 0.0].map(|a: f64| (-a * 0.5 / 0.6).exp()));
    let disc = scene([0.8, 0.0, 0.6], 0.01).render(4, 0);
    let seen = disc.mean().0 / disc_radiance(0.53);
    assert!((seen / dimmed - 1.0).abs().max_element() < 2e-4, "{seen} is not {dimmed}");
    let (floor, se) = scene([0.1, 0.0, -1.0], 20.0).render(256, 0).mean();
    let expected = dimmed * IRRADIANCE * 0.6 / PI;
    println!("floor under a window: {floor} +- {se}, expected {expected}");
    assert!((floor / expected - 1.0).abs().max_element() < 2e-4, "{floor} is not {expected}");
}
