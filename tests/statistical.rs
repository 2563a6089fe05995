//! Samplers against their densities: chi-square tests, normalisation, mean cosines, reciprocity, limits.
//!
//! Seeds are fixed. The significance of the whole file is [`SIGNIFICANCE`], shared evenly among its chi-square tests
//! (Bonferroni), so that a sound sampler fails with any one seed with a probability of 1e-4.

// Measured numbers, for `--nocapture`.
#![allow(clippy::print_stdout)]

mod common;

mod statistical {
    mod half_spaces;
    mod lights;
    mod phase_functions;
    mod phase_limits;
    mod spectral_phases;
    mod tests_of_fit;
    mod warps;
}

/// Probability that sound samplers fail.
const SIGNIFICANCE: f64 = 1e-4;

/// Upper bound on the number of chi-square tests.
const TESTS: f64 = 100.0;
