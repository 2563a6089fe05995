//! Interfaces and mirrors at normal incidence, media between them, and the medium that the camera is in.

use glam::DVec3;

use super::estimates::{assert_every_pixel, assert_mean};
use crate::common::mesh::{cuboid, parallelogram};
use crate::common::scene::SceneFolder;

/// Looks along +y, so narrowly that cosines are 1 to 1e-6.
const ALONG_Y: &str =
    "[camera]\neye = [0, -3, 0]\ntarget = [0, 0, 0]\nvertical_fov = 0.1\nresolution = [8, 8]\n";

/// Between its faces of reflectance R = ((n - 1) / (n + 1))^2 a plate passes a = exp(-sigma_a d) at a time:
///
/// ```text
/// T = (1 - R)^2 a / (1 - R^2 a^2)
/// ```
#[test]
fn an_absorbing_plate_transmits_the_sum_of_its_reflections() {
    let lamp = parallelogram(DVec3::new(-5.0, 2.0, -5.0), DVec3::X * 10.0, DVec3::Z * 10.0);
    let folder = SceneFolder::new()
        .mesh("plate.ply", &cuboid(DVec3::new(-9.0, -0.25, -9.0), DVec3::new(9.0, 0.25, 9.0)))
        .mesh("lamp.ply", &lamp);
    for split in [0, 1, 4] {
        let scene = folder.scene(&format!(
            "[media.glass]\nior = 2.5\nabsorption = [2.0, 0.5, 0.0]\n\
             [[surfaces]]\nmesh = \"plate.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"glass\"\n\
             material = {{ kind = \"dielectric\" }}\n[[surfaces]]\nmesh = \"lamp.ply\"\n\
             material = {{ kind = \"emitter\", radiance = 3 }}\n[render]\nsplit = {split}\n{ALONG_Y}"
        ));
        let r = (1.5_f64 / 3.5).powi(2);
        let expected = [2.0_f64, 0.5, 0.0].map(|sigma_a| {
            let a = (-sigma_a * 0.5).exp();
            3.0 * (1.0 - r).powi(2) * a / (1.0 - r * r * a * a)
        });
        let name = format!("plate, split {split}");
        assert_mean(&name, &scene.render(1024, 0), DVec3::from_array(expected), 1e-2);
    }
}

/// Reflected (R), through both faces ((1 - R)^2), through both with a reflection at the far side on the way back.
#[test]
fn a_limit_of_depth_counts_interfaces() {
    let plate = cuboid(DVec3::new(-9.0, -0.25, -9.0), DVec3::new(9.0, 0.25, 9.0));
    let folder = SceneFolder::new().mesh("plate.ply", &plate);
    let r = (1.5_f64 / 3.5).powi(2);
    let sums = [r, r + (1.0 - r).powi(2), r + (1.0 - r).powi(2) * (1.0 + r)];
    for (depth, expected) in (1..).zip(sums) {
        for split in [0, 1, 2] {
            let scene = folder.scene(&format!(
                "[media.glass]\nior = 2.5\n[[surfaces]]\nmesh = \"plate.ply\"\nnormals = \"flat\"\nfront = \"air\"\n\
                 back = \"glass\"\nmaterial = {{ kind = \"dielectric\" }}\n\
                 [render]\nmax_depth = {depth}\nsplit = {split}\n[sky]\nradiance = 1\n{ALONG_Y}"
            ));
            let name = format!("plate, depth {depth}, split {split}");
            assert_mean(&name, &scene.render(1024, 0), DVec3::splat(expected), 1e-2);
        }
    }
}

/// R = ((eta - n)^2 + k^2) / ((eta + n)^2 + k^2) in front of a medium of index n.
#[test]
fn metals_reflect_what_fresnel_says() {
    let mirror = parallelogram(DVec3::new(-9.0, 1.0, -9.0), DVec3::X * 18.0, DVec3::Z * 18.0);
    let folder = SceneFolder::new()
        .mesh("mirror.ply", &mirror)
        .mesh("fluid.ply", &cuboid(DVec3::new(-9.0, -5.0, -9.0), DVec3::new(9.0, 2.0, 9.0)));
    let mirror = |eta: [f64; 3], k: f64| {
        format!(
            "[sky]\nradiance = 1\n{ALONG_Y}\
             [[surfaces]]\nmesh = \"mirror.ply\"\nmaterial = {{ kind = \"conductor\", eta = {eta:?}, k = {k:?} }}\n"
        )
    };
    let reflectance = |eta: [f64; 3], k: f64, n: f64| {
        DVec3::from_array(eta.map(|eta| ((eta - n).powi(2) + k * k) / ((eta + n).powi(2) + k * k)))
    };
    let perfect = folder.scene(&mirror([1e-9; 3], 1.0)).render(16, 0);
    assert_every_pixel("perfect mirror", &perfect, DVec3::ONE, 1e-6);
    // One interaction decides by chance whether the path goes on: noise.
    let gold = [0.2, 0.9, 1.5];
    let picture = folder.scene(&mirror(gold, 3.0)).render(4096, 0);
    assert_mean("metal in air", &picture, reflectance(gold, 3.0, 1.0), 1e-2);
    let immersed = format!(
        "{}[media.dense]\nior = 2\n[[surfaces]]\nmesh = \"fluid.ply\"\nfront = \"air\"\nback = \"dense\"\n\
         normals = \"flat\"\nmaterial = {{ kind = \"dielectric\" }}\n",
        mirror(gold, 3.0)
    );
    // Light arrives as n^2, reflected to and fro between the metal m and the face r of the fluid.
    let (m, r) = (reflectance(gold, 3.0, 2.0), (1.0_f64 / 3.0).powi(2));
    let picture = folder.scene(&immersed).render(4096, 0);
    assert_mean("metal in a fluid", &picture, 4.0 * (1.0 - r) * m / (1.0 - r * m), 2e-2);
}

/// Light from all sides inside nested fluids is n^2, whichever fluid the eye is in.
#[test]
fn the_camera_knows_which_fluid_it_is_in() {
    let folder = SceneFolder::new()
        .mesh("water.ply", &cuboid(DVec3::splat(-2.0), DVec3::splat(2.0)))
        .mesh("ice.ply", &cuboid(DVec3::new(-1.0, -1.0, -1.0), DVec3::ONE))
        .mesh("post.ply", &cuboid(DVec3::new(0.2, -0.1, -0.1), DVec3::new(0.4, 0.1, 0.1)));
    let scene = |eye: &str| {
        folder.scene(&format!(
            "[media.water]\nior = 1.33\n[media.ice]\nior = 1.31\n\
             [[surfaces]]\nmesh = \"water.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"water\"\n\
             material = {{ kind = \"dielectric\" }}\n\
             [[surfaces]]\nmesh = \"ice.ply\"\nnormals = \"flat\"\nfront = \"water\"\nback = \"ice\"\n\
             material = {{ kind = \"dielectric\" }}\n\
             [[surfaces]]\nmesh = \"post.ply\"\nnormals = \"flat\"\nmaterial = {{ kind = \"diffuse\", reflectance = 1 }}\n\
             [sky]\nradiance = 1\n\
             [camera]\neye = {eye}\ntarget = [0, 9, 0]\nvertical_fov = 20\nresolution = [8, 8]\n"
        ))
    };
    for (eye, n) in
        [("[0, 0, 0]", 1.31_f64), ("[0.15, 0, 0]", 1.31), ("[0, 1.5, 0]", 1.33), ("[0, 2.5, 0]", 1.0)]
    {
        let picture = scene(eye).render(32, 0);
        assert_every_pixel(&format!("eye at {eye}"), &picture, DVec3::splat(n * n), 2e-6);
    }
}

/// A dense cloud in an index-matched box hides the sky as fog around the eye does: alpha is 1, depth that of the particles.
#[test]
fn a_cloud_behind_a_null_boundary_covers_the_sky() {
    let scene = SceneFolder::new().mesh("box.ply", &cuboid(DVec3::splat(-1.0), DVec3::ONE)).scene(
        "[media.cloud]\nscattering = 100\n[[surfaces]]\nmesh = \"box.ply\"\nfront = \"air\"\nback = \"cloud\"\n\
         material = { kind = \"null\" }\n[sky]\nradiance = 1\n\
         [camera]\neye = [0, -5, 0]\ntarget = [0, 0, 0]\nvertical_fov = 1\nresolution = [4, 4]\n",
    );
    for pixel in scene.render(16, 0).image.pixels {
        assert_eq!(pixel.alpha, 1.0);
        assert!((4.0..4.2).contains(&pixel.depth), "{}", pixel.depth);
    }
}
