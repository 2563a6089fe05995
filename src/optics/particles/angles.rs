//! The angles at which the phase function of a mixture is tabulated.
//!
//! ```text
//! first = 1 / (2 x),   next = 2^(1/16) times, up to a greatest step                                   (1)
//! ```
//!
//! x is the size parameter of the largest sphere, whose peak ahead is 1 - (x angle)^2 / 4 `[BOHREN83 section 4.4]`: up to
//! (1) linear in the cosine. The angles are even in the logarithm from there, as rings are wide in proportion to their
//! angle once spheres of many sizes have mixed them. The same angles are counted from the way back, where the glory has
//! the width of the peak. Where all spheres are nearly of one size their rings remain, pi / x wide at any angle.

use std::f64::consts::{FRAC_PI_2, PI};

use super::{Mixture, Species};

/// Angles an octave near the poles.
const OCTAVE: f64 = 16.0;
/// Greatest step, in radians: half a degree.
const WIDEST: f64 = PI / 360.0;
/// Least step away from the poles, however large spheres of one size are: a tenth of a degree.
const FINEST: f64 = PI / 1800.0;
/// Ratio of the greatest to the least radius up to which rings remain.
const ONE_SIZE: f64 = 1.7;

/// Angles from the way ahead to 90 degrees, rising from 0; the same are counted from the way back.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Angles {
    hemisphere: Vec<f64>,
}

impl Angles {
    /// Those that the particles of a mixture need.
    pub fn of(mixture: &Mixture, wavelengths: &[f64]) -> Self {
        let (mut largest, mut widest) = (1.0_f64, WIDEST);
        for species in &mixture.species {
            let [_, greatest] = species.sizes.range();
            let size = |lambda: &f64| 2.0 * PI * greatest * mixture.host.index.n(*lambda) / (lambda * 1e-9);
            let size = wavelengths.iter().map(size).fold(0.0, f64::max);
            largest = largest.max(size);
            if species.has_rings() {
                widest = widest.min((PI / (4.0 * size)).max(FINEST));
            }
        }
        Self { hemisphere: hemisphere(0.5 / largest, widest) }
    }

    /// Cosines up to 90 degrees.
    pub fn cosines(&self) -> Vec<f64> {
        let cosine = |angle: &f64| {
            let half = libm::sin(0.5 * angle);
            1.0 - 2.0 * half * half
        };
        self.hemisphere.iter().map(cosine).collect()
    }

    /// All angles, rising from 0 to pi.
    pub fn radians(&self) -> Vec<f64> {
        let back = self.hemisphere.iter().rev().skip(1).map(|angle| PI - angle);
        self.hemisphere.iter().copied().chain(back).collect()
    }

    /// Values from the way ahead, and those from the way back, in one row and normalised; even where there are none.
    pub fn normalised(&self, [ahead, back]: [Vec<f64>; 2]) -> Vec<f64> {
        let total: f64 = self.integral(&ahead) + self.integral(&back);
        let values = ahead.iter().copied().chain(back.iter().rev().skip(1).copied());
        values.map(|value| if total > 0.0 { value / total } else { 0.25 / PI }).collect()
    }

    /// Over the solid angle of a hemisphere, of values linear in the cosine in between.
    fn integral(&self, values: &[f64]) -> f64 {
        let cell = |i: usize| {
            let (a, b) = (0.5 * self.hemisphere[i - 1], 0.5 * self.hemisphere[i]);
            // cos 2a - cos 2b.
            PI * (values[i - 1] + values[i]) * 2.0 * libm::sin(b - a) * libm::sin(b + a)
        };
        (1..values.len()).map(cell).sum()
    }
}

impl Mixture {
    /// True when spheres of nearly one size are among the particles: what they scatter varies fast with angle and
    /// wavelength.
    pub(super) fn has_rings(&self) -> bool {
        self.species.iter().any(Species::has_rings)
    }
}

impl Species {
    fn has_rings(&self) -> bool {
        let [least, greatest] = self.sizes.range();
        greatest <= ONE_SIZE * least && self.volume_fraction > 0.0
    }
}

/// (1)
fn hemisphere(first: f64, widest: f64) -> Vec<f64> {
    let ratio = libm::exp2(1.0 / OCTAVE);
    let mut angles = vec![0.0];
    let mut angle = first;
    while angle * (ratio - 1.0) < widest && angle < FRAC_PI_2 {
        angles.push(angle);
        angle *= ratio;
    }
    let start = angles[angles.len() - 1];
    let count = ((FRAC_PI_2 - start) / widest).ceil();
    angles.extend((1..=count as u32).map(|i| start + (FRAC_PI_2 - start) * f64::from(i) / count));
    angles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_rise_from_the_way_ahead_to_the_way_back() {
        for (first, widest) in [(0.5, WIDEST), (1e-4, WIDEST), (1e-6, FINEST)] {
            let radians = Angles { hemisphere: hemisphere(first, widest) }.radians();
            assert_eq!((radians[0], radians[radians.len() - 1]), (0.0, PI));
            assert!(radians.windows(2).all(|w| w[0] < w[1] && w[1] - w[0] < 1.01 * widest.max(first)));
        }
    }

    #[test]
    fn one_plus_cos_squared_is_normalised() {
        let angles = Angles { hemisphere: hemisphere(1e-3, WIDEST) };
        let values: Vec<f64> = angles.cosines().iter().map(|c| 1.0 + c * c).collect();
        let found = angles.normalised([values.clone(), values])[0];
        // Linear in the cosine, over cells of less than 0.0088: off by some 0.0088^2 / 6 of it.
        assert!((found * 8.0 * PI / 3.0 - 1.0).abs() < 2e-5, "{found}");
        assert_eq!(angles.normalised([vec![0.0; 9], vec![0.0; 9]])[0], 0.25 / PI);
    }
}
