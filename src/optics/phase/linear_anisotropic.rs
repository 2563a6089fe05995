//! The first two terms of any smooth phase function.
//!
//! ```text
//! p = (1 + a cos) / (4 pi),   mean cosine a / 3,   a in [-1, 1]
//! ```

use std::f32::consts::FRAC_1_PI;

use super::Lobe;
use super::deflection::Deflection;

/// The linear-anisotropic phase function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearAnisotropic {
    /// Slope, in [-1, 1]; positive is forward.
    pub a: f32,
}

impl Lobe for LinearAnisotropic {
    fn value(&self, deflection: Deflection) -> f32 {
        0.25 * FRAC_1_PI * (1.0 + self.a * deflection.cosine())
    }

    /// With s = 1 + cos the cumulative distribution is ((1 - a) s + a s^2 / 2) / 2 = u.
    fn sample(&self, u: f32) -> Deflection {
        let b = 1.0 - self.a;
        let root = (b * b + 4.0 * self.a * u).max(0.0).sqrt();
        let s = 4.0 * u / (b + root).max(f32::MIN_POSITIVE);
        Deflection::from_one_plus_cos(s.min(2.0))
    }

    fn mean_cosine(&self) -> f32 {
        self.a / 3.0
    }
}
