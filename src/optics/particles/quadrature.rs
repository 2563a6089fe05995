//! The radii at which integrals over a distribution of sizes are taken.
//!
//! ```text
//! integral of f(r) N(r) dr = v sum over i of f(r_i) w_i,   w_i = N(r_i) r_i / (sum of 4/3 pi r_i^4 N(r_i))  (1)
//! ```
//!
//! The r_i lie in the middles of steps that are even in ln r; v is the volume fraction, and the denominator makes v of the
//! particles' volume. What a sphere scatters oscillates with its size, faster than any number of steps can follow where
//! spheres are large, so rules of a higher order have no advantage: on particles of sea water, ice, milk and fog Gauss'
//! rule of four points was as far off as this one with as many radii. A finer step at the large end was no better either.
//!
//! The middle one of every three steps makes the same rule with a third of the radii. How far that is off tells the error.

use std::f64::consts::PI;

use super::SizeDistribution;

/// Steps; three times an odd number, and three times as many as angles are computed for.
const STEPS: usize = 3 * 333;

/// Radii and their weights.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Quadrature {
    /// Rising, in m.
    pub radii: Vec<f64>,
    /// Spheres of each in 1/m^3 where the volume fraction is 1, in the whole and in the coarser rule.
    pub numbers: Vec<[f64; 2]>,
}

impl Quadrature {
    /// Of a valid distribution.
    pub fn new(sizes: &SizeDistribution) -> Self {
        Self::with_steps(sizes, STEPS)
    }

    fn with_steps(sizes: &SizeDistribution, steps: usize) -> Self {
        let [least, greatest] = sizes.range();
        if least == greatest {
            let number = 1.0 / volume(least);
            return Self { radii: vec![least], numbers: vec![[number; 2]] };
        }
        let (from, to) = (libm::log(least), libm::log(greatest));
        let middle = |i: usize| libm::exp(from + (to - from) * ((i as f64 + 0.5) / steps as f64));
        let radii: Vec<f64> = (0..steps).map(middle).collect();
        let shares: Vec<f64> = radii.iter().map(|&r| sizes.number(r) * r).collect();
        let total = |first: usize, step: usize| -> f64 {
            (first..steps).step_by(step).map(|i| shares[i] * volume(radii[i])).sum()
        };
        let (whole, coarse) = (total(0, 1), total(1, 3));
        let numbers = shares.iter().enumerate().map(|(i, share)| {
            let is_coarse = i % 3 == 1 && coarse > 0.0;
            [share / whole, if is_coarse { share / coarse } else { 0.0 }] // (1)
        });
        Self { numbers: numbers.collect(), radii }
    }

    /// The radii of the coarser rule and their numbers; all where it has none.
    pub fn coarse(&self) -> (Vec<f64>, Vec<f64>) {
        let rule = usize::from(self.numbers.iter().any(|n| n[1] > 0.0));
        let pairs = self.radii.iter().zip(&self.numbers).map(|(r, n)| (*r, n[rule]));
        pairs.filter(|(_, number)| *number > 0.0).unzip()
    }
}

fn volume(r: f64) -> f64 {
    4.0 / 3.0 * PI * r * r * r
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moment(rule: &Quadrature, power: i32) -> f64 {
        rule.radii.iter().zip(&rule.numbers).map(|(r, n)| r.powi(power) * n[0]).sum()
    }

    /// Where nothing oscillates the error falls with the square of the step.
    #[test]
    fn the_number_of_spheres_converges_with_the_square_of_the_step() {
        let (least, greatest, exponent) = (1e-8, 1e-4, 3.4_f64);
        let sizes = SizeDistribution::PowerLaw { exponent, least, greatest };
        let integral = |power: f64| (greatest.powf(power) - least.powf(power)) / power;
        let exact = integral(3.0 - exponent) / (4.0 / 3.0 * PI * integral(4.0 - exponent));
        let error = |steps| moment(&Quadrature::with_steps(&sizes, steps), 2) / exact - 1.0;
        let (coarse, fine) = (error(333), error(999));
        // The next order is the square of the step of 0.03, times a few.
        assert!((coarse / fine - 9.0).abs() < 0.01, "{coarse:e} {fine:e}");
        assert!(fine.abs() < 1e-5, "{fine:e}");
    }

    #[test]
    fn the_volume_is_the_volume_fraction_in_both_rules() {
        for sizes in [
            SizeDistribution::PowerLaw { exponent: 3.4, least: 1e-8, greatest: 1e-4 },
            SizeDistribution::LogNormal { median: 1e-6, deviation: 0.4 },
            SizeDistribution::Table { radii: vec![1e-6, 2e-6, 5e-6], number: vec![0.0, 3.0, 1.0] },
            SizeDistribution::Table { radii: vec![1e-5], number: vec![2.0] },
        ] {
            let rule = Quadrature::new(&sizes);
            assert!((moment(&rule, 3) * 4.0 / 3.0 * PI - 1.0).abs() < 1e-13, "{sizes:?}");
            let (radii, numbers) = rule.coarse();
            let sum: f64 = radii.iter().zip(numbers).map(|(r, n)| volume(*r) * n).sum();
            assert!((sum - 1.0).abs() < 1e-13, "{sizes:?}");
        }
    }
}
