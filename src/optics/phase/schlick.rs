//! Schlick's rational lobe `[BLASI93]`, which looks like Henyey and Greenstein's without the root.
//!
//! ```text
//! p = (1 - k^2) / (4 pi (1 - k cos)^2),   1 - k cos = (1 - |k|) + |k| (1 -+ cos)
//! mean cosine 1/k + (1 - k^2) / (2 k^2) ln((1 - k) / (1 + k)) = 2 (k / (1 3) + k^3 / (3 5) + k^5 / (5 7) + ...)
//! ```
//! k in (-1, 1); k > 0 scatters forward. The published form has the sign of k the other way round for an angle that is
//! counted the other way round.

use std::f32::consts::FRAC_1_PI;

use super::Lobe;
use super::deflection::Deflection;

/// The Schlick phase function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schlick {
    /// Elongation, in (-1, 1).
    pub k: f32,
}

/// Below this the logarithm's form of the mean cosine loses digits to cancellation.
const SMALL: f64 = 0.1;

impl Lobe for Schlick {
    fn value(&self, deflection: Deflection) -> f32 {
        let from_peak = if self.k >= 0.0 { deflection.one_minus_cos() } else { deflection.one_plus_cos() };
        let k = self.k.abs();
        let base = (1.0 - k) + k * from_peak;
        0.25 * FRAC_1_PI * (1.0 - k) * (1.0 + k) / (base * base)
    }

    /// 1 - cos = 2 (1 - k)(1 - u) / q and 1 + cos = 2 (1 + k) u / q with q = (1 - k)(1 - u) + (1 + k) u.
    fn sample(&self, u: f32) -> Deflection {
        let (ahead, back) = ((1.0 + self.k) * u, (1.0 - self.k) * (1.0 - u));
        let q = ahead + back;
        if back <= ahead {
            Deflection::from_one_minus_cos(2.0 * back / q)
        } else {
            Deflection::from_one_plus_cos(2.0 * ahead / q)
        }
    }

    fn mean_cosine(&self) -> f32 {
        let k = f64::from(self.k);
        let squared = k * k;
        let mean = if k.abs() < SMALL {
            2.0 * k * (1.0 / 3.0 + squared * (1.0 / 15.0 + squared * (1.0 / 35.0 + squared / 63.0)))
        } else {
            1.0 / k + (1.0 - squared) / (2.0 * squared) * libm::log((1.0 - k) / (1.0 + k))
        };
        mean as f32
    }
}
