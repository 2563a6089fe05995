//! Lobes from even to peaks of a ten-thousandth of a radian, forward and backward.

use glam::Vec3;

use super::pieces::milk_in_white;
use super::{Case, Group, Measurement, Reference};
use crate::optics::phase::{Deflection, HenyeyGreenstein, PhaseFunction};
use crate::study::StudyError;

/// The group.
pub(super) const GROUP: Group = Group {
    name: "asymmetry",
    parameter: "mean cosine",
    about: "Lobes of Henyey and Greenstein up to the narrowest, forward and backward.",
    cases,
};

const COSINES: [f64; 9] = [-0.9999, -0.999, -0.9, -1e-6, 0.0, 0.5, 0.99, 0.999, 0.9999];

fn cases() -> Vec<Case> {
    let sampled = COSINES.map(|g| {
        Case::new(&GROUP, "mean distance of the cosine from the peak's, as drawn", g, move || drawn(g))
            .quick()
    });
    let furnaces = COSINES.map(|g| {
        Case::new(&GROUP, "white furnace of 100 free paths", g, move || furnace(g)).quick_if(g.abs() > 0.9)
    });
    let walks = [-0.999, 0.9, 0.999].map(|g| {
        Case::new(&GROUP, "mean way through a ball: 4 r / 3", g, move || mean_way(g)).quick_if(g > 0.9)
    });
    sampled.into_iter().chain(furnaces).chain(walks).collect()
}

/// The mean of 1 - cos, or of 1 + cos for lobes that point back, over 2^16 even random numbers: 1 - |g|.
///
/// The midpoint rule in n points misses the flank of the lobe, where the angle grows from the width of the peak to a half
/// turn within the last 1 - |g| of the numbers: by less than 1 / (n (1 - |g|)) of the mean. f32 takes 1 - g with an error
/// of 2^-25 of 1.
fn drawn(g: f64) -> Result<Measurement, StudyError> {
    const COUNT: u32 = 1 << 20;
    let phase = PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g: g as f32 });
    let from_end = |i: u32| {
        let u = (f64::from(i) + 0.5) / f64::from(COUNT);
        let wi = phase.sample(Vec3::Z, [u as f32, 0.3]).wi;
        let turned = Deflection::between(Vec3::Z, wi);
        f64::from(if g < 0.0 { turned.one_plus_cos() } else { turned.one_minus_cos() })
    };
    let mean = (0..COUNT).map(from_end).sum::<f64>() / f64::from(COUNT);
    let expected = 1.0 - g.abs();
    let tolerance = 3e-8 + expected * (1e-5 + 1.0 / (f64::from(COUNT) * expected));
    Ok(Measurement::new(Reference::ClosedForm, expected, mean).tolerance(tolerance))
}

/// Keys of a medium with this lobe.
fn lobe(g: f64, coefficients: &str) -> String {
    format!("{coefficients}\nphase = {{ kind = \"henyey-greenstein\", g = {g:e} }}")
}

/// Weights are 1 exactly, but for the roundings of the collisions: 1e-5 of some hundred of them leaves an order of
/// magnitude.
fn furnace(g: f64) -> Result<Measurement, StudyError> {
    let picture = milk_in_white(&lobe(g, "ior = 1.33\nscattering = 100"), 16)?;
    Ok(Measurement::farthest_in(&picture, Reference::ClosedForm, 1.0).tolerance(1e-5))
}

/// What a ball takes that absorbs next to nothing is its mean way, whatever the lobe (`albedo.rs`).
fn mean_way(g: f64) -> Result<Measurement, StudyError> {
    super::albedo::ball_of(1e-4, 100.0 * (1.0 - g), &lobe(g, "absorption = 1e-4\nscattering = 100"))
}
