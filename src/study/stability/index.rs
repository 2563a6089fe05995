//! Index ratios from half to four, and next to one.
//!
//! A slab of optical depth tau along the refracted ray, in even light of radiance 1, shows
//!
//! ```text
//! L = R + (1 - R)^2 T / (1 - R T),       T = exp(-tau)
//! ```
//! the sum of what its two faces send to and fro, R being their reflectance `[BORN99 sec. 1.5.2]`.

use glam::DVec3;

use super::pieces::{WHITE_SKY, camera_along_z, dielectric, emitter, medium, milk_in_white, render};
use super::shapes::{Shape, cuboid, parallelogram};
use super::{Case, Group, Measurement, Reference, Scene};
use crate::study::StudyError;

/// The group.
pub(super) const GROUP: Group = Group {
    name: "index",
    parameter: "index ratio",
    about: "Refraction from half to four times the index outside, and next to one.",
    cases,
};

const INDICES: [f64; 6] = [0.5, 1.0 - 1e-6, 1.0, 1.0 + 1e-6, 1.33, 4.0];

fn cases() -> Vec<Case> {
    let slabs = INDICES.into_iter().flat_map(|n| {
        [0.0, 20.0].map(|angle| {
            let name = format!("an absorbing slab in even light, {angle} degrees");
            Case::new(&GROUP, name, n, move || slab(n, angle)).quick()
        })
    });
    let shifts = INDICES.into_iter().map(|n| {
        Case::new(&GROUP, "how far a slab of 1 m shifts an edge, 20 degrees", n, move || shift(n)).quick()
    });
    let furnaces = INDICES
        .into_iter()
        .map(|n| Case::new(&GROUP, "white furnace of 10 free paths", n, move || furnace(n)).quick());
    slabs.chain(shifts).chain(furnaces).collect()
}

/// Reflectance of unpolarised light and cosine of the refracted ray, in the form of the textbooks.
pub(super) fn fresnel(cos_i: f64, n: f64) -> (f64, f64) {
    let sin_t = ((1.0 - cos_i) * (1.0 + cos_i)).sqrt() / n;
    let cos_t = ((1.0 - sin_t) * (1.0 + sin_t)).sqrt();
    let s = (cos_i - n * cos_t) / (cos_i + n * cos_t);
    let p = (n * cos_i - cos_t) / (n * cos_i + cos_t);
    (0.5 * (s * s + p * p), cos_t)
}

/// A view of the origin from 3 m, this many degrees from the vertical, of a slab between z = -1 and 0.
fn view(angle: f64, fov: f64, resolution: [u32; 2]) -> String {
    let (sin, cos) = libm::sincos(angle.to_radians());
    camera_along_z([3.0 * sin, 0.0, 3.0 * cos], [0.0; 3], fov, resolution)
}

fn plate() -> Shape {
    cuboid(DVec3::new(-4.0, -4.0, -1.0), DVec3::new(4.0, 4.0, 0.0))
}

/// The index is that of f32. Cosines are off by a few 2^-24, the optical depth of 0.7 by 1e-6 of itself; at the first 16
/// interfaces both ways are followed, and what is left, R^16, is played for.
fn slab(n: f64, angle: f64) -> Result<Measurement, StudyError> {
    const ABSORPTION: f64 = 0.7;
    let text = medium("glass", &format!("ior = {n}\nabsorption = {ABSORPTION}"))
        + &dielectric("slab.ply", "air", "glass")
        + &view(angle, 0.001, [4, 4])
        + &render(16, "split = 16\n")
        + WHITE_SKY;
    let picture = Scene::new().mesh("slab.ply", &plate()).render(&text)?;
    let (r, cos_t) = fresnel(libm::cos(angle.to_radians()), f64::from(n as f32));
    let t = libm::exp(-ABSORPTION / cos_t);
    let expected = r + (1.0 - r) * (1.0 - r) * t / (1.0 - r * t);
    Ok(Measurement::mean_of(&picture, Reference::ClosedForm, expected).tolerance(3e-6))
}

/// A plate with parallel faces shifts a ray by
///
/// ```text
/// D = d (tan(theta_i) - tan(theta_t))
/// ```
/// along its faces (Snell). The edge of a lamp below it is seen by half of a picture that looks at where the edge appears;
/// of what is reflected to and fro in the plate everything falls on the lamp. So the picture shows
/// 1 - R of what meets it: (1 - R)^2 (1/2 + R^2 / (1 - R^2)).
///
/// 128 columns over 1 mm, of 64 samples each: edges are found to 1e-3 / 128 / 64, but for the roundings of coordinates of
/// up to 8 m in f32, 8 units of 2^-24 of them. Where a ray meets the lamp changes with its angle by
///
/// ```text
/// dx / dtheta = 3 / cos(theta_i) + cos(theta_i) / (n cos^3(theta_t)) + 1 / cos^2(theta_i)
/// ```
fn shift(n: f64) -> Result<Measurement, StudyError> {
    const WIDTH: f64 = 1e-3;
    let (sin, cos) = libm::sincos(20_f64.to_radians());
    let (r, cos_t) = fresnel(cos, f64::from(n as f32));
    let tan_t = (1.0 - cos_t * cos_t).sqrt() / cos_t;
    let expected = sin / cos - tan_t;
    // Eye paths come from +x and go on towards -x; below the plate they go on as before it.
    let edge = -tan_t - sin / cos;
    let lamp = parallelogram(DVec3::new(edge, 4.0, -2.0), DVec3::X * -8.0, DVec3::Y * -8.0);
    let slope = 3.0 / cos + cos / (f64::from(n as f32) * cos_t * cos_t * cos_t) + 1.0 / (cos * cos);
    let fov = (WIDTH / 128.0 / slope).to_degrees();
    let text = medium("glass", &format!("ior = {n}"))
        + &dielectric("slab.ply", "air", "glass")
        + &emitter("lamp.ply", 1)
        + &view(20.0, fov, [128, 1])
        + &render(64, "split = 16\n");
    let picture = Scene::new().mesh("slab.ply", &plate()).mesh("lamp.ply", &lamp).render(&text)?;
    let (mean, _) = picture.mean();
    let share = mean.x / ((1.0 - r) * (1.0 - r)) - r * r / (1.0 - r * r);
    Ok(Measurement::new(Reference::ClosedForm, expected, expected - (share - 0.5) * WIDTH)
        .of(&picture)
        .tolerance(WIDTH / 8192.0 + 8.0 * 8.0 * 6e-8)
        .note(format!("{share:.4} of the picture is lamp")))
}

/// Reflections within end in the roulette after 1024 of them.
fn furnace(n: f64) -> Result<Measurement, StudyError> {
    let picture = milk_in_white(&format!("ior = {n}\nscattering = 10"), 16)?;
    Ok(Measurement::farthest_in(&picture, Reference::ClosedForm, 1.0).tolerance(1e-5))
}
