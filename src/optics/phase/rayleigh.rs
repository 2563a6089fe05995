//! Particles much smaller than the wavelength `[BOHREN83 sec. 5.2]`.
//!
//! ```text
//! p = 3 (1 + cos^2) / (16 pi)
//! ```

use std::f32::consts::FRAC_1_PI;

use super::Lobe;
use super::deflection::Deflection;
use crate::geometry::elementary::cbrt;

/// The Rayleigh phase function of unpolarised light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rayleigh;

impl Lobe for Rayleigh {
    fn value(&self, deflection: Deflection) -> f32 {
        let cos = deflection.cosine();
        0.1875 * FRAC_1_PI * (1.0 + cos * cos)
    }

    /// cos^3 + 3 cos = 2 c with c = 4 u - 2, which Cardano's formula solves.
    fn sample(&self, u: f32) -> Deflection {
        let c = 4.0 * u - 2.0;
        let root = cbrt(c.abs() + (c * c + 1.0).sqrt());
        let cos = (root - 1.0 / root).min(1.0).copysign(c);
        Deflection::from_one_minus_cos(1.0 - cos)
    }

    fn mean_cosine(&self) -> f32 {
        0.0
    }
}
