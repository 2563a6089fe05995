//! Emitting triangles.

use std::f64::consts::PI;

use floe::integrator::Integrator;
use glam::DVec3;

use super::estimates::{assert_mean, polygon_irradiance};
use crate::common::mesh::{TestMesh, cuboid, parallelogram};
use crate::common::scene::SceneFolder;

/// The closed form of a floor point under the corner of a rectangle a x b at height c, as a check on the formula above.
#[test]
fn lamberts_formula_gives_the_form_factor_of_a_parallel_rectangle() {
    let (a, b, c) = (0.7_f64, 1.3_f64, 0.5_f64);
    let corners = [DVec3::ZERO, DVec3::X * a, DVec3::new(a, b, 0.0), DVec3::Y * b].map(|p| p + DVec3::Z * c);
    let (x, y) = (a / c, b / c);
    let term = |x: f64, y: f64| x / (1.0 + x * x).sqrt() * (y / (1.0 + x * x).sqrt()).atan();
    let factor = (term(x, y) + term(y, x)) / (2.0 * PI);
    assert!((polygon_irradiance(DVec3::ZERO, DVec3::Z, &corners) / PI - factor).abs() < 1e-12);
}

/// A lamp over the origin of a floor that the camera looks at narrowly.
fn lit_floor(lamp: &TestMesh) -> (crate::common::render::Prepared, DVec3) {
    let floor = parallelogram(DVec3::new(-9.0, -9.0, 0.0), DVec3::X * 18.0, DVec3::Y * 18.0);
    let scene = SceneFolder::new().mesh("floor.ply", &floor).mesh("lamp.ply", lamp).scene(
        "[[surfaces]]\nmesh = \"floor.ply\"\nmaterial = { kind = \"diffuse\", reflectance = [0.5, 0.6, 0.7] }\n\
         [[surfaces]]\nmesh = \"lamp.ply\"\nnormals = \"flat\"\n\
         material = { kind = \"emitter\", radiance = [4, 2, 1] }\n\
         [camera]\neye = [0, -2, 0.2]\ntarget = [0, 0, 0]\nvertical_fov = 0.01\nresolution = [8, 8]\n",
    );
    (scene, DVec3::new(0.5, 0.6, 0.7) * DVec3::new(4.0, 2.0, 1.0) / PI)
}

/// Faces down at the floor, stands upright on it, hangs askew, and a single triangle.
#[test]
fn rectangles_light_a_floor_as_their_form_factors_say() {
    let v = DVec3::new;
    let cases = [
        ("parallel", v(-0.2, -0.1, 0.5), v(0.0, 0.8, 0.0), v(1.0, 0.0, 0.0)),
        ("far", v(-0.2, -0.1, 6.0), v(0.0, 0.8, 0.0), v(1.0, 0.0, 0.0)),
        ("perpendicular", v(0.4, -0.5, 0.0), v(0.0, 0.0, 1.0), v(0.0, 1.0, 0.0)),
        ("askew", v(0.3, -0.5, 0.2), v(0.3, 0.1, 0.9), v(0.1, 1.0, -0.1)),
    ];
    for (name, corner, edge1, edge2) in cases {
        let lamp = parallelogram(corner, edge1, edge2);
        let (scene, scale) = lit_floor(&lamp);
        let expected = scale * polygon_irradiance(DVec3::ZERO, DVec3::Z, &lamp.positions);
        assert_mean(name, &scene.render(256, 0), expected, 1e-2 * expected.max_element());
        let (dark, _) = lit_floor(&lamp.turned());
        assert_eq!(dark.render(64, 0).mean().0, DVec3::ZERO, "{name}: light from the back of the lamp");
    }
    let triangle = TestMesh {
        positions: vec![v(0.0, 0.0, 1.0), v(0.2, 0.9, 1.1), v(1.0, 0.1, 1.2)],
        triangles: vec![[0, 1, 2]],
    };
    let (scene, scale) = lit_floor(&triangle);
    let expected = scale * polygon_irradiance(DVec3::ZERO, DVec3::Z, &triangle.positions);
    assert_mean("triangle", &scene.render(256, 0), expected, 1e-2 * expected.max_element());
}

/// The balance heuristic changes nothing but the noise.
#[test]
fn looking_for_lamps_gives_what_chance_gives_with_less_noise() {
    let v = DVec3::new;
    let lamp = parallelogram(v(-0.5, -0.4, 0.3), v(0.0, 0.8, 0.0), v(1.0, 0.0, 0.0));
    let (mut scene, scale) = lit_floor(&lamp);
    let expected = scale * polygon_irradiance(DVec3::ZERO, DVec3::Z, &lamp.positions);
    let with = scene.render(1024, 0);
    scene.frame.needs.direct_light = false;
    let without = scene.render(1024, 0);
    assert_mean("looked for", &with, expected, 1e-2);
    assert_mean("by chance", &without, expected, 2e-2);
    let ratio = (with.mean().1 / without.mean().1).max_element();
    println!("noise with over without: {ratio:.3}");
    assert!(ratio < 0.9, "looking for the lamp does not pay: {ratio}");
}

/// A shadow ray that an interface is sure to stop is not traced: lamps are looked for in the media before them.
#[test]
fn lamps_are_looked_for_where_they_can_be_seen() {
    let surface = parallelogram(DVec3::new(-5.0, -5.0, 0.0), DVec3::X * 10.0, DVec3::Y * 10.0);
    for (height, seen) in [(2.0, [true, false]), (-2.0, [true, true])] {
        let lamp = parallelogram(DVec3::new(-0.5, -0.5, height), DVec3::Y, DVec3::X);
        let scene = SceneFolder::new().mesh("surface.ply", &surface).mesh("lamp.ply", &lamp).scene(
            "[media.water]\nior = 1.33\nscattering = 1\n\
             [[surfaces]]\nmesh = \"surface.ply\"\nfront = \"air\"\nback = \"water\"\nmaterial = { kind = \"dielectric\" }\n\
             [[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = { kind = \"emitter\", radiance = 1 }\n\
             [camera]\neye = [0, -4, 1]\ntarget = [0, 0, 0]\n",
        );
        assert_eq!(scene.frame.lit, seen, "a lamp at {height} m");
    }
}

/// What is looked for through the faces of a turbid cube changes nothing but the noise: inside it, and on a white block in
/// the middle. The lamp is seen under some 20 degrees.
#[test]
fn looking_through_an_interface_gives_what_chance_gives_with_less_noise() {
    let v = DVec3::new;
    let (water, block) =
        (cuboid(v(-1.0, -1.0, -1.0), v(1.0, 1.0, 0.0)), cuboid(v(-0.5, -0.5, -0.8), v(0.5, 0.5, -0.5)));
    let lamp = parallelogram(v(2.0, -4.0, 20.0), DVec3::Y * 8.0, DVec3::X * 8.0);
    let mut scene =
        SceneFolder::new().mesh("water.ply", &water).mesh("block.ply", &block).mesh("lamp.ply", &lamp).scene(
            "[media.water]\nior = 1.33\nabsorption = [0.1, 0.3, 0.5]\nscattering = 2\n\
             phase = { kind = \"henyey-greenstein\", g = 0.8 }\n\
             [[surfaces]]\nmesh = \"water.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"water\"\n\
             material = { kind = \"dielectric\" }\n\
             [[surfaces]]\nmesh = \"block.ply\"\nnormals = \"flat\"\nmaterial = { kind = \"diffuse\", reflectance = 0.8 }\n\
             [[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = { kind = \"emitter\", radiance = 100 }\n\
             [camera]\neye = [0, -3, 2]\ntarget = [0, 0, -0.6]\nup = [0, 0, 1]\nvertical_fov = 15\nresolution = [16, 16]\n",
        );
    assert!(scene.frame.beneath[1].is_some());
    // From the block two surfaces and a particle or an interface are three interactions.
    let Integrator::Path(path) = &mut scene.sampling.integrator else { panic!("not path traced") };
    path.max_depth = 2;
    assert_eq!(scene.render(64, 0).mean().0, DVec3::ZERO, "interactions beyond max_depth");
    let Integrator::Path(path) = &mut scene.sampling.integrator else { panic!("not path traced") };
    path.max_depth = 0;
    let (with, with_se) = scene.render(1024, 0).mean();
    scene.frame.beneath = vec![None; 2];
    scene.frame.lit = vec![true, false];
    let (without, without_se) = scene.render(4096, 1).mean();
    println!(
        "looking through an interface: {with:.5} +- {with_se:.5}, by chance {without:.5} +- {without_se:.5}"
    );
    // Five standard errors, each below 1 % of the value.
    let se = (with_se * with_se + without_se * without_se).map(f64::sqrt);
    assert!(se.cmplt(0.01 * without).all(), "a standard error of {se} shows too little");
    assert!((with - without).abs().cmplt(5.0 * se).all(), "{with} and {without}, standard error {se}");
    let ratio = 0.5 * with_se.x / without_se.x;
    println!("noise with over without, at as many samples: {ratio:.3}");
    assert!(ratio < 0.5, "looking through the interface does not pay: {ratio}");
}
