//! Media that absorb everything, next to nothing, or nothing of what they scatter.
//!
//! In a convex body in even light the mean length of the ways through it is 4 V / S, whatever is scattered there: 4 r / 3
//! of a ball. So of white surroundings a ball takes, averaged over its disc,
//!
//! ```text
//! A = sigma_a 4 r / 3,        less at most sigma_a^2 E(l^2) / 2,   E(l^2) / E(l) = 2 (sigma_s r^2 / 5 + r)
//! ```
//! The second term has the mean length of ways from an even source inside, in the diffusion approximation.

use glam::DVec3;

use super::pieces::{WHITE_SKY, camera, dielectric, medium, milk_in_white, null, render};
use super::shapes::{cuboid, sphere};
use super::{Case, Group, Measurement, Reference, Scene};
use crate::study::StudyError;

/// The group.
pub(super) const GROUP: Group = Group {
    name: "albedo",
    parameter: "1 - albedo",
    about: "Media that absorb all, next to nothing or nothing of what they meet.",
    cases,
};

fn cases() -> Vec<Case> {
    let absorbed = [1e-5, 1e-6, 1e-7, 1e-8].map(|rest| {
        Case::new(&GROUP, "what a ball of 100 free paths takes", rest, move || ball(rest))
            .quick_if(rest == 1e-7)
            .explained(ROUNDED_WEIGHTS, 0.75)
    });
    let given_as_albedo = [1e-5, 1e-6, 1e-7].map(|rest| {
        Case::new(&GROUP, "the same, by `extinction` and `albedo`", rest, move || ball_by_albedo(rest))
    });
    let furnace = Case::new(&GROUP, "white furnace, three lanes of albedo 1", 0.0, white).quick();
    let black = Case::new(&GROUP, "albedo 0, given as such: exp(-tau)", 1.0, black).quick();
    absorbed.into_iter().chain(given_as_albedo).chain([furnace, black]).collect()
}

/// What is left of the roundings of long walks.
const ROUNDED_WEIGHTS: &str = "the weight of a collision is rounded to 6e-8 of 1: of all light, n collisions may lose or \
                               keep n times 3e-8 too much";

fn ball(rest: f64) -> Result<Measurement, StudyError> {
    let sigma_a = 100.0 * rest;
    ball_of(sigma_a, 100.0, &format!("absorption = {sigma_a:e}\nscattering = 100"))
}

fn ball_by_albedo(rest: f64) -> Result<Measurement, StudyError> {
    ball_of(100.0 * rest, 100.0, &format!("extinction = 100\nalbedo = {}", 1.0 - rest))
}

/// What a ball of 1 m takes, over how much of the picture it covers, seen from 30 m: the even light of a disc is even to
/// 1 / 30^2. Of 8192 triangles it is within 1e-3 of a ball; pixels are rounded to 2^-24. `reduced` is sigma_s (1 - g).
pub(super) fn ball_of(sigma_a: f64, reduced: f64, coefficients: &str) -> Result<Measurement, StudyError> {
    let text = medium("milk", coefficients)
        + &dielectric("ball.ply", "air", "milk")
        + &camera([0.0, -30.0, 0.0], [0.0; 3], 4.0, [16, 16])
        + &render(256, "")
        + WHITE_SKY;
    let picture = Scene::new().mesh("ball.ply", &sphere(DVec3::ZERO, 1.0, 5)).render(&text)?;
    let covered: f64 = picture.image.pixels.iter().map(|p| f64::from(p.alpha)).sum();
    let share = covered / picture.image.pixels.len() as f64;
    let (mean, error) = picture.mean();
    let expected = sigma_a * 4.0 / 3.0;
    let second = sigma_a * (reduced / 5.0 + 1.0);
    let tolerance = expected * (2e-3 + second) + 0.6e-7 / share;
    Ok(Measurement::new(Reference::ClosedForm, expected, (1.0 - mean.x) / share)
        .of(&picture)
        .standard_error(error.x / share)
        .tolerance(tolerance))
}

/// Lanes that scatter differently are weighted over all: means are 1 within their noise.
fn white() -> Result<Measurement, StudyError> {
    let picture = milk_in_white("extinction = [3, 30, 10]\nalbedo = 1", 256)?;
    let channels = Measurement::channels_of(&picture, Reference::ClosedForm, [1.0; 3]);
    Ok(Measurement::worst(channels.map(|channel| channel.tolerance(1e-6))))
}

/// The ways through the cube differ from pixel to pixel by less than 1e-8.
fn black() -> Result<Measurement, StudyError> {
    let text = medium("ink", "extinction = [0.5, 5, 50]\nalbedo = 0")
        + &null("cube.ply", "air", "ink")
        + &camera([0.1, -3.0, 0.2], [0.1, 0.0, 0.2], 0.001, [4, 4])
        + &render(16, "")
        + WHITE_SKY;
    let cube = cuboid(DVec3::splat(-0.5), DVec3::splat(0.5));
    let picture = Scene::new().mesh("cube.ply", &cube).render(&text)?;
    let depths = [0.5, 5.0, 50.0];
    let expected = depths.map(|depth| libm::exp(-depth));
    let channels =
        Measurement::channels_of(&picture, Reference::ClosedForm, expected).into_iter().zip(depths);
    Ok(Measurement::worst(channels.map(|(channel, depth)| {
        let tolerance = channel.expected * 1e-6 * (1.0 + depth);
        channel.tolerance(tolerance)
    })))
}
