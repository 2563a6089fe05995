//! Suns from a point to half of the sky, of the same irradiance.
//!
//! On a plane whose normal makes the angle theta with the direction of the disc, of half angle alpha and radiance
//! E / (pi sin^2 alpha),
//!
//! ```text
//! irradiance = E cos(theta)                    while the whole disc is above the horizon (theta + alpha <= pi / 2)
//!            = E / (pi sin^2 alpha)  integral over the disc of max(0, cos)       otherwise
//! ```
//! The first follows from the second by the projection of the disc's cap onto the plane: an ellipse of area
//! pi sin^2(alpha) cos(theta).

use std::f64::consts::PI;

use glam::DVec3;

use super::pieces::{camera_along_z, diffuse, render};
use super::shapes::parallelogram;
use super::{Case, Group, Measurement, Reference, Scene};
use crate::study::StudyError;

/// The group.
pub(super) const GROUP: Group = Group {
    name: "sun",
    parameter: "diameter in degrees",
    about: "A sun of one irradiance over a diffuse plane, from a point to half of the sky.",
    cases,
};

const DIAMETERS: [f64; 8] = [0.001, 0.01, 0.53, 5.0, 60.0, 120.0, 179.0, 179.999];

fn cases() -> Vec<Case> {
    let lit = DIAMETERS.into_iter().flat_map(|diameter| {
        [0.0, 40.0, 85.0].map(|angle| {
            let name = format!("a diffuse plane, the sun {angle} degrees from its normal");
            Case::new(&GROUP, name, diameter, move || plane(diameter, angle)).quick()
        })
    });
    let seen = DIAMETERS
        .into_iter()
        .map(|diameter| Case::new(&GROUP, "the disc itself, seen", diameter, move || disc(diameter)).quick());
    lit.chain(seen).collect()
}

fn sun(diameter: f64, direction: [f64; 3]) -> String {
    format!("[sun]\ndirection = {direction:?}\nangular_diameter = {diameter}\nirradiance = 2\n")
}

/// L = irradiance rho / pi of a plane with rho = 0.5. Directions and the sines of half angles are f32: a cosine of
/// 0.087 at 85 degrees is right to 6e-8 / 0.087 of itself, and the quadrature to 1e-6.
fn plane(diameter: f64, angle: f64) -> Result<Measurement, StudyError> {
    let (sin, cos) = libm::sincos(angle.to_radians());
    let text = diffuse("plane.ply", 0.5)
        + &sun(diameter, [sin, 0.0, cos])
        + &camera_along_z([0.3, 0.2, 2.0], [0.3, 0.2, 0.0], 1.0, [8, 8])
        + &render(64, "");
    let plane = parallelogram(DVec3::new(-9.0, -9.0, 0.0), DVec3::X * 18.0, DVec3::Y * 18.0);
    let picture = Scene::new().mesh("plane.ply", &plane).render(&text)?;
    let expected = 2.0 * projected(0.5 * diameter.to_radians(), angle.to_radians()) * 0.5 / PI;
    Ok(Measurement::mean_of(&picture, Reference::ClosedForm, expected).tolerance(4e-6 * expected))
}

/// Irradiance of a plane over that of one which faces the disc.
fn projected(alpha: f64, theta: f64) -> f64 {
    if alpha + theta <= 0.5 * PI {
        return libm::cos(theta);
    }
    // Even in azimuth and in sin^2, so that the cap's own cosine is in the measure: its direction is z, the normal (sin, 0, cos).
    const STEPS: u32 = 2000;
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(STEPS);
    let sine = libm::sin(alpha);
    let ring = |i: u32| {
        let s = sine * at(i).sqrt();
        let z = (1.0 - s * s).sqrt();
        let cosine = |j: u32| s * libm::sin(theta) * libm::cos(PI * at(j)) + z * libm::cos(theta);
        (0..STEPS).map(|j| cosine(j).max(0.0)).sum::<f64>() / f64::from(STEPS) / z
    };
    (0..STEPS).map(ring).sum::<f64>() / f64::from(STEPS)
}

/// The radiance E / (pi sin^2 alpha). The sine of half of the angle, an f32, is squared.
fn disc(diameter: f64) -> Result<Measurement, StudyError> {
    let text = sun(diameter, [0.0, 0.6, 0.8])
        + &camera_along_z([0.0; 3], [0.0, 0.6, 0.8], 0.1 * diameter, [4, 4])
        + &render(4, "");
    let picture = Scene::new().render(&text)?;
    let sine = libm::sin(0.5 * diameter.to_radians());
    let expected = 2.0 / (PI * sine * sine);
    Ok(Measurement::farthest_in(&picture, Reference::ClosedForm, expected).tolerance(1e-6 * expected))
}
