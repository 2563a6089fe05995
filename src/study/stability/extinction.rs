//! Media from nothing to opaque.

use glam::DVec3;

use super::shapes::{cuboid, parallelogram};
use super::{Case, Group, Measurement, Reference, Scene};
use crate::study::StudyError;

/// The group.
pub(super) const GROUP: Group = Group {
    name: "extinction",
    parameter: "extinction times size",
    about: "A medium from nothing to opaque, by random walks.",
    cases,
};

fn cases() -> Vec<Case> {
    let optical_depths = [0.0, 1e-12, 1e-6, 1e-3, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5];
    let absorbed = optical_depths.iter().map(|&depth| {
        Case::new(GROUP.name, "a slab that absorbs: exp(-tau)", depth, move || absorbing_slab(depth)).quick()
    });
    let furnaces = optical_depths.iter().map(|&depth| {
        let case = Case::new(GROUP.name, "white furnace of a cube, albedo 1", depth, move || furnace(depth));
        if depth <= 1e3 { case.quick() } else { case }
    });
    absorbed.chain(furnaces).collect()
}

/// A slab of 1 m between the eye and white surroundings, in all three channels.
///
/// The way through it is the difference of two distances of at most 3 m in f32, each rounded by a few units of 2^-24 of
/// it: the optical depth is off by 1e-6 of itself, and the transmittance by as much of that. What is below the least
/// normal f32 may be 0.
fn absorbing_slab(depth: f64) -> Result<Measurement, StudyError> {
    let slab = parallelogram(DVec3::new(-1.0, 0.0, -1.0), DVec3::X * 2.0, DVec3::Z * 2.0);
    let far = parallelogram(DVec3::new(-1.0, 1.0, -1.0), DVec3::X * 2.0, DVec3::Z * 2.0);
    let text = format!(
        "[media.ink]\nabsorption = {depth:e}\n\
         [[surfaces]]\nmesh = \"near.ply\"\nfront = \"air\"\nback = \"ink\"\nmaterial = {{ kind = \"null\" }}\n\
         [[surfaces]]\nmesh = \"far.ply\"\nfront = \"ink\"\nback = \"air\"\nmaterial = {{ kind = \"null\" }}\n\
         [sky]\nradiance = 1\n[camera]\neye = [0.3, -2, 0.2]\ntarget = [0.3, 0, 0.2]\nvertical_fov = 0.001\n\
         resolution = [4, 4]\n[render]\nsamples = 4\n"
    );
    let picture = Scene::new().mesh("near.ply", &slab).mesh("far.ply", &far).render(&text)?;
    let expected = libm::exp(-depth);
    let tolerance = expected * (1e-6 * depth + 1e-6) + f64::from(f32::MIN_POSITIVE);
    let got = picture.farthest(expected);
    Ok(Measurement::new(Reference::ClosedForm, expected, got).of(&picture).tolerance(tolerance))
}

/// A cube of 1 m in white surroundings, of which nothing may be seen.
fn furnace(depth: f64) -> Result<Measurement, StudyError> {
    let samples = if depth > 1e4 { 4 } else { 16 };
    let text = format!(
        "[media.milk]\nscattering = {depth:e}\n\
         [[surfaces]]\nmesh = \"cube.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"milk\"\n\
         material = {{ kind = \"dielectric\" }}\n[sky]\nradiance = 1\n[camera]\neye = [1.2, -3.5, 0.8]\n\
         target = [0, 0, 0]\nvertical_fov = 16\nresolution = [8, 8]\n[render]\nsamples = {samples}\n"
    );
    let picture =
        Scene::new().mesh("cube.ply", &cuboid(DVec3::splat(-0.5), DVec3::splat(0.5))).render(&text)?;
    let (mean, error) = picture.mean();
    Ok(Measurement::new(Reference::ClosedForm, 1.0, mean.x)
        .of(&picture)
        .standard_error(error.x)
        .tolerance(1e-6))
}
