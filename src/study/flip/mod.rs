//! FLIP: how different two pictures look to somebody who flips between them.
//!
//! Of each pixel, from 0, where no difference is seen, to 1, that between black and white or green and blue:
//!
//! ```text
//! C'  = colours as an eye blurs them, of I and R                      [ANDERSSON20 sec. 4.1, filters]
//! e_c = redistributed HyAB(C'_I, C'_R)^0.7                            [ANDERSSON20 sec. 4.1, colours]
//! e_f = (max(| |edges_R| - |edges_I| |, | |points_R| - |points_I| |) / 2^(1/2))^(1/2)
//!                                                                     [ANDERSSON20 sec. 4.2, features]
//! FLIP = e_c^(1 - e_f)                                                (1)  [ANDERSSON20 sec. 4.3]
//! ```
//!
//! [`flip`] is this of displayed colours, linear Rec. 709 RGB from 0 to 1. [`hdr_flip`] takes any radiance: it shows both
//! pictures at several exposures and keeps the greatest error of each pixel `[ANDERSSON21]`, which [`exposures`] says in
//! full. What an eye sees depends on how large a pixel looks; [`PIXELS_PER_DEGREE`] is a screen of 3840 pixels, 0.7 m
//! wide and 0.7 m away. Edges of pictures are continued by their last pixel.
//!
//! Numbers are single precision, as in the authors' own program, `flip-evaluator` 1.7: the unit tests hold what that gives
//! for pictures that are made by a formula, and means agree to 2e-7, pixels to 1.4e-6.

mod colours;
pub mod exposures;
mod filters;

use glam::Vec3;
use rayon::prelude::*;

pub use exposures::hdr_flip;

use crate::geometry::elementary::pow;
use colours::{Seen, colour_error};
use filters::{Features, Plane, blurred, features};

/// Pixels in a degree of the field of view: 3840 pixels on 0.7 m, seen from 0.7 m.
pub const PIXELS_PER_DEGREE: f32 = 67.020_645;

/// The errors (1) of two displayed pictures, row after row: linear RGB, which is clamped to 0 .. 1, of `width` columns.
pub fn flip(picture: &[Vec3], reference: &[Vec3], width: usize, pixels_per_degree: f32) -> Vec<f32> {
    let [picture, reference] = [picture, reference].map(|rgb| seen(rgb, width, pixels_per_degree));
    let error = |p: usize| {
        let colour = colour_error(picture.0[p], reference.0[p]);
        let feature = Features::difference(picture.1[p], reference.1[p]);
        pow(colour, 1.0 - feature) // (1)
    };
    (0..reference.0.len()).into_par_iter().map(error).collect()
}

/// What an eye makes of a picture: colours and features of each pixel.
fn seen(rgb: &[Vec3], width: usize, pixels_per_degree: f32) -> (Vec<Seen>, Vec<Features>) {
    let opponent: Vec<Vec3> =
        rgb.par_iter().map(|c| colours::opponent(c.clamp(Vec3::ZERO, Vec3::ONE))).collect();
    let achromatic = Plane::new(width, opponent.iter().map(|c| colours::grey(*c)).collect());
    let colours = blurred(&opponent, width, pixels_per_degree);
    (colours.into_par_iter().map(Seen::of_opponent).collect(), features(&achromatic, pixels_per_degree))
}

#[cfg(test)]
mod tests;
