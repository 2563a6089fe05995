//! Media so thick that walks through them do not end: which of them are seen as half spaces.
//!
//! ```text
//! sigma_t d > WALKED  or  2^-23 sigma_t x > UNRESOLVED,   sigma_t the least of all lanes
//!                         d the least edge of the box around the medium, or w ([`super::thickness`]), x the coordinate of its next point
//! T = (H(1) / sqrt(3) / tau*) (x / sinh x) <= LOST,   tau* = (sigma_s (1 - g) + sigma_a) d,   x = s tau*
//! ```
//! T bounds what gets through a layer of optical depth tau* after reduction to isotropic scattering, straight on under even
//! light: of albedo 1 it is Milne's but for his constant `[CHANDRASEKHAR60 ch. III]`, and light that is absorbed falls off
//! as exp(-kappa d) with kappa d above s tau*, s being sqrt(1 - albedo). Neither d says anything of
//! single parts that are thin.
//!
//! The second condition is that of walks which the rounding of coordinates spoils even where the medium is nearest to the eye.
//!
//! Media that glow, of varying density, that of region 0, which has no other side, and those with a light inside are walked
//! through however thick they are.

use std::fmt;

use crate::geometry::Bounds;
use crate::optics::half_space::HalfSpace;
use crate::optics::medium::{Medium, MediumId};

/// The optical size, extinction times metres, beyond which walks are given up. Through layers of albedo 1 they take as many
/// collisions in the mean as it says, and the square of it to the other side.
pub const WALKED: f32 = 1e5;
/// The rounding of a coordinate over the free path beyond which walks are given up as well. Where it is 0.01 they are off by 1 to 3 %,
/// and where it is 0.1 by 7 to 22 % (see [`crate::optics::half_space`]): more than half spaces are.
pub const UNRESOLVED: f32 = 1.0 / 16.0;
/// No medium is a half space that lets a greater share of the light through.
pub const LOST: f64 = 1e-3;
/// H(1) / sqrt(3) of albedo 1: Milne's flux through a thick layer, seen straight on.
const STRAIGHT: f64 = 1.6788;

/// A medium that is seen as a half space in a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Reflected {
    /// Its name.
    pub medium: String,
    /// Extinction times metres, the least of all lanes.
    pub optical_size: f32,
    /// The share of light that may get through, which the picture lacks.
    pub lost: f64,
}

impl fmt::Display for Reflected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Upwards: it is a bound.
        let percent = (self.lost * 1e6).ceil() / 1e4;
        write!(
            f,
            "light through \"{}\" (optical size {:.1e}: reflected as by a half space, at most {percent} % gets through)",
            self.medium, self.optical_size
        )
    }
}

/// The media that are half spaces, by [`MediumId`] as the `boxes` around them are, and what is to be said about them; both empty without any.
pub(super) fn half_spaces(
    media: &[Medium],
    boxes: &[Bounds],
    thickness: impl Fn(MediumId, &Bounds) -> f32,
    holds_light: impl Fn(MediumId, &Bounds) -> bool,
) -> (Vec<Option<HalfSpace>>, Vec<Reflected>) {
    let mut reflected = Vec::new();
    let mut found = vec![None; media.len()];
    let ids = (0..).map(MediumId);
    for (((medium, bounds), id), half_space) in media.iter().zip(boxes).zip(ids).zip(&mut found) {
        if id == MediumId(0) || medium.sigma_s.is_zero() || medium.glows() || !medium.density.is_homogeneous()
        {
            continue;
        }
        let edge = bounds.size().min_element();
        if thick(medium, bounds, edge).is_none() {
            continue;
        }
        let Some(of_medium) = thick(medium, bounds, edge.min(thickness(id, bounds))) else { continue };
        if !holds_light(id, bounds) {
            *half_space = Some(HalfSpace::of(medium));
            reflected.push(of_medium);
        }
    }
    if reflected.is_empty() {
        found.clear();
    }
    (found, reflected)
}

/// What there is to say of a medium within a box that is so many metres thick, if that is thick enough.
fn thick(medium: &Medium, bounds: &Bounds, extent: f32) -> Option<Reflected> {
    let extinction = medium.sigma_s.combined(&medium.sigma_a, |s, a| s + a).minimum();
    let optical_size = extinction * extent;
    let nearest = bounds.min.max(-bounds.max).max_element();
    let is_unresolved = optical_size > 0.0 && f32::EPSILON * extinction * nearest > UNRESOLVED;
    let lost = |s: f32, a: f32| transmittance_bound(s, a, extent) as f32;
    let lost = f64::from(medium.reduced_scattering().combined(&medium.sigma_a, lost).maximum());
    ((optical_size > WALKED || is_unresolved) && lost <= LOST).then(|| Reflected {
        medium: medium.name.clone(),
        optical_size,
        lost,
    })
}

/// The bound of the head for reduced coefficients in 1/m; 0 for a lane that there is not.
fn transmittance_bound(sigma_s: f32, sigma_a: f32, extent: f32) -> f64 {
    let sigma_t = f64::from(sigma_s) + f64::from(sigma_a);
    if sigma_t <= 0.0 {
        return 0.0;
    }
    let depth = sigma_t * f64::from(extent);
    let x = (f64::from(sigma_a) / sigma_t).sqrt() * depth;
    let absorbed = if x > 0.0 { x / libm::sinh(x) } else { 1.0 };
    STRAIGHT / depth * absorbed
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What Milne says of slabs that absorb nothing, and what is left of light that is absorbed on 100 diffusion lengths.
    #[test]
    fn the_bound_is_above_what_gets_through() {
        for depth in [1e3_f32, 1e5] {
            let milne = 2.9078 / 3.0_f64.sqrt() / (f64::from(depth) + 1.4209);
            let bound = transmittance_bound(1.0, 0.0, depth);
            assert!(bound > milne && bound < 1.01 * milne, "{bound} {milne}");
        }
        // Albedo 0.5: kappa is 0.9575 of the extinction.
        let bound = transmittance_bound(0.5, 0.5, 100.0);
        assert!(bound > 10.0 * libm::exp(-95.75) && bound < 1e-28, "{bound}");
        assert_eq!(transmittance_bound(1.0, 1.0, 1e6), 0.0);
        assert_eq!(transmittance_bound(0.0, 0.0, 1.0), 0.0);
    }

    #[test]
    fn what_is_lost_is_rounded_up() {
        let milk = Reflected { medium: "milk".into(), optical_size: 3e5, lost: 1.234_56e-4 };
        let text = "light through \"milk\" (optical size 3.0e5: reflected as by a half space, at most 0.0124 % gets through)";
        assert_eq!(milk.to_string(), text);
    }
}
