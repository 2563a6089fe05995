//! Natural waters, ice and milk against reference numbers that other programs worked out, and against measurements.
//!
//! `tests/data/models/README.md` says where the numbers come from.

// Measured numbers, for `--nocapture`.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

mod common;

mod models {
    mod ice;
    mod milk;
    mod natural_waters;
    mod scenes;
}

use floe::optics::particles::{Bulk, Mixture};

/// Greatest relative deviation from reference numbers whose own quadrature is off by up to 5e-4.
const REFERENCE: f64 = 2e-3;

/// The rows of a table of `tests/data/models`, without its head.
fn rows<const N: usize>(text: &str) -> impl Iterator<Item = [&str; N]> {
    text.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>().try_into().unwrap())
}

fn number(field: &str) -> f64 {
    field.parse().unwrap()
}

fn bulk(mixture: &Mixture, wavelengths: &[f64]) -> Bulk {
    mixture.bulk(wavelengths).unwrap()
}

/// The relative deviation; not a number is worst of all.
fn deviation(found: f64, expected: f64) -> f64 {
    let deviation = (found / expected - 1.0).abs();
    if deviation.is_nan() { f64::INFINITY } else { deviation }
}
