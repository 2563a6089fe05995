//! Light scattered the same in every direction.
//!
//! ```text
//! p = 1 / (4 pi)
//! ```

use super::Lobe;
use super::deflection::Deflection;

/// The isotropic phase function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Isotropic;

impl Lobe for Isotropic {
    #[inline]
    fn value(&self, _: Deflection) -> f32 {
        0.25 * std::f32::consts::FRAC_1_PI
    }

    #[inline]
    fn sample(&self, u: f32) -> Deflection {
        Deflection::from_one_minus_cos(2.0 * u)
    }

    fn mean_cosine(&self) -> f32 {
        0.0
    }
}
