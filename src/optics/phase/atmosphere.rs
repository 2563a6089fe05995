//! Hazy and murky air after Nishita, Miyawaki and Nakamae `[NISHITA87]`.
//!
//! ```text
//! p = ((1 - w) + w (n + 1) ((1 + cos) / 2)^n) / (4 pi),   mean cosine w n / (n + 2)
//!
//! hazy     w = 1/2,     n = 8      Nishita's 1 + 9 cos^16(theta / 2), halved
//! murky    w = 50/83,   n = 32     Nishita's 1 + 50 cos^64(theta / 2), times 33/83
//! murky    w = 1/2,     n = 32     1/2 + (33/2) ((1 + cos) / 2)^32: another function, also in use
//! ```
//! Nishita's hazy form has the mean 2; halved it is the normalised one.

use std::f32::consts::FRAC_1_PI;

use super::Lobe;
use super::deflection::Deflection;
use crate::geometry::elementary::pow;

/// The phase function of air with droplets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Atmosphere {
    /// Share of light in the lobe.
    share: f32,
    /// The exponent is two to this power.
    squarings: u32,
}

impl Atmosphere {
    /// Haze; Nishita's form and the normalised one are the same.
    pub const HAZY: Self = Self { share: 0.5, squarings: 3 };
    /// Murky air in Nishita's form.
    pub const MURKY: Self = Self { share: 50.0 / 83.0, squarings: 5 };
    /// Murky air with half of the light in the lobe.
    pub const MURKY_HALVED: Self = Self { share: 0.5, squarings: 5 };

    fn exponent(self) -> f32 {
        (1_u32 << self.squarings) as f32
    }
}

impl Lobe for Atmosphere {
    fn value(&self, deflection: Deflection) -> f32 {
        let mut power = 0.5 * deflection.one_plus_cos();
        for _ in 0..self.squarings {
            power *= power;
        }
        0.25 * FRAC_1_PI * (1.0 - self.share + self.share * (self.exponent() + 1.0) * power)
    }

    fn sample(&self, u: f32) -> Deflection {
        let even = 1.0 - self.share;
        if u < even {
            return Deflection::from_one_minus_cos(2.0 * (u / even).min(1.0));
        }
        let half = pow(((u - even) / self.share).min(1.0), 1.0 / (self.exponent() + 1.0));
        Deflection::from_one_plus_cos(2.0 * half.min(1.0))
    }

    fn mean_cosine(&self) -> f32 {
        self.share * self.exponent() / (self.exponent() + 2.0)
    }
}
