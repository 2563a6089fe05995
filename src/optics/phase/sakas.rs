//! Sakas' symmetric family, as compiled by `[PEREZ03 sec. 2.3]`.
//!
//! ```text
//! p = (1 + n) / (2 + n) (1 + |cos|^n) / (4 pi),   mean cosine 0
//! ```
//! n = 0 is isotropic, n = 2 is Rayleigh's.

use std::f32::consts::FRAC_1_PI;

use super::Lobe;
use super::deflection::Deflection;
use crate::geometry::elementary::pow;

/// Sakas' phase function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sakas {
    /// Exponent, not negative.
    pub n: f32,
}

impl Lobe for Sakas {
    fn value(&self, deflection: Deflection) -> f32 {
        let scale = (1.0 + self.n) / (2.0 + self.n);
        0.25 * FRAC_1_PI * scale * (1.0 + pow(deflection.cosine().abs(), self.n))
    }

    /// (1 + n) / (2 + n) of the light is isotropic; the rest has |cos| = v^(1 / (n + 1)).
    fn sample(&self, u: f32) -> Deflection {
        let even = (1.0 + self.n) / (2.0 + self.n);
        if u < even {
            return Deflection::from_one_minus_cos(2.0 * (u / even).min(1.0));
        }
        let v = 2.0 * ((u - even) / (1.0 - even)).min(1.0) - 1.0;
        let cos = pow(v.abs(), 1.0 / (self.n + 1.0)).min(1.0);
        let ahead = Deflection::from_one_minus_cos(1.0 - cos);
        if v >= 0.0 { ahead } else { ahead.reversed() }
    }

    fn mean_cosine(&self) -> f32 {
        0.0
    }
}
