//! Ambient occlusion and limits of depth on diffuse surfaces.

use glam::DVec3;

use super::estimates::{assert_every_pixel, assert_mean, polygon_irradiance};
use crate::common::mesh::{parallelogram, sphere};
use crate::common::scene::SceneFolder;

const FLOOR: &str =
    "[[surfaces]]\nmesh = \"floor.ply\"\nmaterial = { kind = \"diffuse\", reflectance = 0.5 }\n";

/// One reflection on a floor is one interaction, and the light at the end of the path is seen.
#[test]
fn one_interaction_is_direct_light() {
    let floor = parallelogram(DVec3::new(-9.0, -9.0, 0.0), DVec3::X * 18.0, DVec3::Y * 18.0);
    let folder = SceneFolder::new().mesh("floor.ply", &floor);
    let scene = folder.scene(&format!(
        "{FLOOR}[render]\nmax_depth = 1\n[sky]\nradiance = 1\n\
         [camera]\neye = [0, -1, 2]\ntarget = [0, 0, 0]\nvertical_fov = 20\nresolution = [4, 4]\n"
    ));
    assert_mean("depth 1", &scene.render(1024, 0), DVec3::splat(0.5), 1e-2);
}

#[test]
fn nothing_covers_a_convex_body() {
    let folder = SceneFolder::new().mesh("ball.ply", &sphere(DVec3::ZERO, 1.0, 3));
    let scene = folder.scene(
        "[[surfaces]]\nmesh = \"ball.ply\"\nnormals = \"flat\"\nmaterial = { kind = \"diffuse\" }\n\
         [render]\nintegrator = \"ambient-occlusion\"\n\
         [camera]\neye = [3, -3, 1]\ntarget = [0, 0, 0]\nvertical_fov = 30\nresolution = [16, 16]\n",
    );
    assert_every_pixel("convex body", &scene.render(64, 0), DVec3::ONE, 0.0);
}

/// What a wall that stands on the floor covers of the hemisphere is its form factor; a high one covers half.
#[test]
fn a_wall_covers_its_part_of_the_hemisphere() {
    for (height, distance) in [(1.0, 0.5), (0.3, 0.5), (20.0, 0.01)] {
        let wall = parallelogram(DVec3::new(0.0, -20.0, 0.0), DVec3::Y * 40.0, DVec3::Z * height);
        let floor = parallelogram(DVec3::new(-20.0, -20.0, 0.0), DVec3::X * 40.0, DVec3::Y * 40.0);
        let scene = SceneFolder::new().mesh("floor.ply", &floor).mesh("wall.ply", &wall).scene(&format!(
            "{FLOOR}[[surfaces]]\nmesh = \"wall.ply\"\nmaterial = {{ kind = \"diffuse\" }}\n\
             [render]\nintegrator = \"ambient-occlusion\"\n\
             [camera]\neye = [{distance}, 0, 1]\ntarget = [{distance}, 0, 0]\nup = [0, 1, 0]\n\
             vertical_fov = 0.001\nresolution = [4, 4]\n"
        ));
        let covered =
            polygon_irradiance(DVec3::X * distance, DVec3::Z, &wall.positions) / std::f64::consts::PI;
        let name = format!("wall of {height} m");
        assert_mean(&name, &scene.render(1024, 0), DVec3::splat(1.0 - covered), 5e-3);
    }
}
