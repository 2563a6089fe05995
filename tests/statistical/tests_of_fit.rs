//! Chi-square over cells whose probabilities are known, and the distribution of chi-square itself.

use crate::common::numbers::{SplitMix, chi_square_p, chi_square_tail};

/// Samples in a test.
pub const SAMPLES: u64 = 400_000;

/// Draws [`SAMPLES`] pairs of random numbers, sorts what `cell` makes of them and compares with `probabilities`.
pub fn assert_fits(name: &str, seed: u64, probabilities: &[f64], mut cell: impl FnMut([f32; 2]) -> usize) {
    let total: f64 = probabilities.iter().sum();
    assert!((total - 1.0).abs() < 1e-6, "{name}: the cells' probabilities sum to {total}");
    let mut random = SplitMix(seed);
    let mut observed = vec![0; probabilities.len()];
    for _ in 0..SAMPLES {
        observed[cell(random.pair())] += 1;
    }
    let expected: Vec<f64> = probabilities.iter().map(|p| p * SAMPLES as f64).collect();
    let p = chi_square_p(&observed, &expected);
    println!("{name}: p = {p:.4} over {} cells", probabilities.len());
    let least = crate::SIGNIFICANCE / crate::TESTS;
    assert!(p > least, "{name}: samples do not follow the density, p = {p:.2e} is below {least:.2e}");
}

/// Index of the cell of `u` in [0, 1] among `count`.
pub fn cell_of(u: f64, count: usize) -> usize {
    ((u * count as f64) as usize).min(count - 1)
}

/// Upper points of the distribution, from tables.
#[test]
fn the_distribution_of_chi_square() {
    for (x, degrees, p) in
        [(3.841_459, 1, 0.05), (18.307_04, 10, 0.05), (140.169_5, 100, 0.005), (67.327_56, 100, 0.995)]
    {
        assert!((chi_square_tail(x, degrees) - p).abs() < 1e-6, "{x} {degrees}");
    }
}

/// A test that could not fail would be none: an error of 3 % in an exponent is refused.
#[test]
fn wrong_densities_are_refused() {
    let mut random = SplitMix(3);
    let mut observed = [0_u64; 10];
    for _ in 0..SAMPLES {
        observed[cell_of(f64::from(random.f32()).powf(1.03), 10)] += 1;
    }
    let expected = [SAMPLES as f64 / 10.0; 10];
    assert!(chi_square_p(&observed, &expected) < 1e-6, "an error of 3 % in the exponent is not seen");
}
