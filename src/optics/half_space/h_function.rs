//! Chandrasekhar's H-function of isotropic scattering, from its closed form.
//!
//! ```text
//! ln H(mu) = -(1 / pi) integral over phi from 0 to pi/2 of ln(s^2 + a (1 - atan(t) / t)),   t = tan(phi) / mu
//! a = 1 - s^2 is the albedo                                                              [CHANDRASEKHAR60 ch. V]
//! ```
//! Where little is absorbed the logarithm has no bound at phi = 0, and where mu is small all that happens does so next to
//! it. So the integral is a sum over even steps of u with phi = (pi / 2) / (1 + exp(-pi sinh u)) `[TAKAHASI74]`, which
//! has points as close to both ends as they are needed.

use std::f64::consts::{FRAC_PI_2, PI};

/// Half of the steps of u: with twice as many, H changes by 1.5e-11 at most (measured, see the test).
const HALF: i32 = 54;
/// Steps of u for each unit. The last phi is within 1e-18 of the end.
const STEPS: f64 = 16.0;
/// Below it 1 - atan(t) / t has no digits left of its own, and its series has all.
const SMALL: f64 = 0.1;

/// The points of the sum: tan(phi), and the weight of phi over pi.
#[derive(Clone, Debug)]
pub struct HFunction {
    points: Vec<[f64; 2]>,
}

impl Default for HFunction {
    fn default() -> Self {
        Self::with_steps(HALF, STEPS)
    }
}

impl HFunction {
    fn with_steps(half: i32, steps: f64) -> Self {
        let point = |i: i32| {
            let u = f64::from(i) / steps;
            let e = libm::exp(-PI * libm::sinh(u.abs()));
            // From the nearer end, which phi has all its digits from.
            let tan = libm::tan(FRAC_PI_2 * e / (1.0 + e));
            let slope = FRAC_PI_2 * PI * libm::cosh(u) * e / ((1.0 + e) * (1.0 + e));
            [if i < 0 { tan } else { 1.0 / tan }, slope / (steps * PI)]
        };
        Self { points: (-half..=half).map(point).collect() }
    }

    /// H at the cosine `mu` with the normal, `s` being sqrt(1 - albedo).
    pub fn at(&self, s: f64, mu: f64) -> f64 {
        if mu <= 0.0 {
            return 1.0;
        }
        let albedo = (1.0 - s) * (1.0 + s);
        let logarithm = |tan: f64| libm::log(s * s + albedo * lack_of_arctangent(tan / mu));
        libm::exp(-self.points.iter().map(|[tan, weight]| weight * logarithm(*tan)).sum::<f64>())
    }
}

/// 1 - atan(t) / t.
fn lack_of_arctangent(t: f64) -> f64 {
    if t > SMALL {
        return 1.0 - libm::atan(t) / t;
    }
    let x = t * t;
    x * (1.0 / 3.0 - x * (1.0 / 5.0 - x * (1.0 / 7.0 - x * (1.0 / 9.0 - x * (1.0 / 11.0 - x / 13.0)))))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twice the steps, and farther towards both ends.
    #[test]
    fn more_points_change_nothing() {
        let (h, finer) = (HFunction::default(), HFunction::with_steps(120, 32.0));
        for s in [0.0, 1e-8, 3e-4, 0.01, 0.3, 0.9, 1.0] {
            for mu in [1e-8, 1e-4, 0.01, 0.3, 1.0] {
                let (value, better) = (h.at(s, mu), finer.at(s, mu));
                assert!((value / better - 1.0).abs() < 2e-11, "s {s}, mu {mu}: {value} {better}");
            }
        }
    }

    #[test]
    fn h_is_1_where_nothing_is_scattered_and_at_the_horizon() {
        let h = HFunction::default();
        assert_eq!([h.at(1.0, 0.7), h.at(0.2, 0.0)], [1.0; 2]);
    }

    /// Both forms of 1 - atan(t) / t where one takes the other's place.
    #[test]
    fn the_series_goes_on_where_the_arctangent_ends() {
        let direct = 1.0 - libm::atan(SMALL) / SMALL;
        assert!((lack_of_arctangent(SMALL) / direct - 1.0).abs() < 1e-12);
    }
}
