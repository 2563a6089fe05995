//! What is suspended in natural waters: minerals, algae, rock flour.
//!
//! ```text
//! minerals:   n = 1.58,  N(r) ~ r^-3.4,  r from 0.01 to 100 um
//! algae:      n = 1.41,  N(r) ~ r^-3.6,  r from 0.225 to 100 um
//! rock flour: n = 1.55,  N(r) ~ r^-3.4,  r from 0.01 to 4 um
//! ```
//! Minerals and algae are those of `[FRISVAD07]`, at second hand: the figures were read in a program, and their
//! constants of normalisation confirm the radii. k of minerals falls as exp(-0.0123 (lambda - 375)) / lambda does, as
//! that of sediments at sea `[BABIN03]`. The k of algae that was read has 2.53e-2 at 675 nm, between neighbours of
//! 1.0e-4 and 3.9e-5: it is taken as 2.53e-4, which is not confirmed. Beyond 700 nm k of algae is a guess of its
//! source.
//!
//! Rock flour is ours and unverified: what glaciers grind is quartz and feldspar, so its index is lower and its k a tenth of
//! that of sediments, and what stays afloat in lakes is of clay size, 4 um at most `[HODDER07]`.

use super::super::RefractiveIndex;
use super::super::particles::{SizeDistribution, Species};

/// Minerals that take this share of the volume.
pub fn mineral(volume_fraction: f64) -> Species {
    species("minerals", 1.58, MINERAL_K, power_law(3.4, 0.01e-6, 100e-6), volume_fraction)
}

/// Algae that take this share of the volume.
pub fn algae(volume_fraction: f64) -> Species {
    species("algae", 1.41, ALGAE_K, power_law(3.6, 0.225e-6, 100e-6), volume_fraction)
}

/// Rock flour that takes this share of the volume.
pub fn rock_flour(volume_fraction: f64) -> Species {
    let k = MINERAL_K.map(|k| 0.1 * k);
    species("rock flour", 1.55, k, power_law(3.4, 0.01e-6, 4e-6), volume_fraction)
}

fn species(name: &str, n: f32, k: [f32; 17], sizes: SizeDistribution, volume_fraction: f64) -> Species {
    let index = RefractiveIndex::every_25_nm([n; 17], k);
    Species { name: name.to_owned(), index, sizes, volume_fraction }
}

fn power_law(exponent: f64, least: f64, greatest: f64) -> SizeDistribution {
    SizeDistribution::PowerLaw { exponent, least, greatest }
}

/// From 375 nm in steps of 25 nm, as in [`ALGAE_K`] `[FRISVAD07]`.
#[rustfmt::skip]
const MINERAL_K: [f32; 17] = [
    2.12e-3, 1.66e-3, 1.30e-3, 1.01e-3, 7.84e-4, 6.07e-4, 4.59e-4, 3.61e-4, 2.77e-4,
    2.13e-4, 1.63e-4, 1.25e-4, 9.52e-5, 7.26e-5, 5.53e-5, 4.20e-5, 3.19e-5,
];

#[rustfmt::skip]
const ALGAE_K: [f32; 17] = [
    1.84e-4, 1.96e-4, 2.89e-4, 3.11e-4, 2.79e-4, 2.14e-4, 1.26e-4, 8.19e-5, 5.57e-5,
    6.03e-5, 7.86e-5, 1.00e-4, 2.53e-4, 3.91e-5, 3.91e-5, 3.91e-5, 3.91e-5,
];
