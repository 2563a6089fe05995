//! Scenes from microns to a million kilometres: with coefficients over the size, the same picture.

use glam::DVec3;

use super::pieces::{camera, dielectric, diffuse, emitter, medium, render};
use super::shapes::{Shape, cuboid, parallelogram};
use super::{Case, Group, Measurement, Picture, Reference, Scene};
use crate::study::StudyError;

/// The group.
pub(super) const GROUP: Group = Group {
    name: "size",
    parameter: "metres",
    about: "A scene from microns to a million kilometres, with coefficients over its size.",
    cases,
};

fn cases() -> Vec<Case> {
    let scales = [1e-6, 1e-3, 10.0, 1e3, 1e5, 1e7, 1e9];
    scales
        .map(|scale| {
            Case::new(&GROUP, "a turbid cube on a floor, over that of 1 m", scale, move || scaled(scale))
                .quick()
        })
        .into()
}

fn still_life(scale: f64, seed: u32) -> Result<Picture, StudyError> {
    let at = |v: [f64; 3]| v.map(|x| x * scale);
    let coefficients = format!("ior = 1.33\nscattering = {:e}\nabsorption = {:e}", 5.0 / scale, 0.5 / scale);
    let text = medium("milk", &coefficients)
        + &dielectric("cube.ply", "air", "milk")
        + &diffuse("floor.ply", 0.5)
        + &emitter("lamp.ply", 5)
        + "[sun]\ndirection = [1, -2, 3]\nirradiance = 1\n[sky]\nradiance = 0.5\n"
        + &camera(at([1.7, -3.1, 2.3]), at([0.0, 0.0, 0.3]), 30.0, [16, 16])
        + &render(64, &format!("seed = {seed}\n"));
    let sized = |mut shape: Shape| {
        shape.positions.iter_mut().for_each(|p| *p *= scale);
        shape
    };
    let cube = cuboid(DVec3::splat(-0.5), DVec3::splat(0.5));
    let floor = parallelogram(DVec3::new(-3.0, -3.0, -0.7), DVec3::X * 6.0, DVec3::Y * 6.0);
    let lamp = parallelogram(DVec3::new(-2.0, 0.0, 2.0), DVec3::Y, DVec3::X);
    let scene = Scene::new().mesh("cube.ply", &sized(cube)).mesh("floor.ply", &sized(floor));
    scene.mesh("lamp.ply", &sized(lamp)).render(&text)
}

/// Of another seed, so that errors are apart.
fn scaled(scale: f64) -> Result<Measurement, StudyError> {
    let (one, other) = (still_life(1.0, 0)?, still_life(scale, 1)?);
    let ((expected, a), (got, b)) = (one.mean(), other.mean());
    Ok(Measurement::new(Reference::Invariance, expected.x, got.x)
        .of(&one)
        .of(&other)
        .standard_error(libm::hypot(a.x, b.x))
        .tolerance(1e-6))
}
