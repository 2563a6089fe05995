//! Henyey and Greenstein's lobe `[HENYEY41 eq. 2]`.
//!
//! ```text
//! p = (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^(3/2)),   1 + g^2 - 2 g cos = (1 - g)^2 + 2 g (1 - cos)
//! ```
//! g in (-1, 1) is the mean cosine. The right-hand form and a sampling written in 1 - cos keep the forward peak of
//! g = 0.9999 (6e8 times the isotropic value) in single precision.

use std::f32::consts::FRAC_1_PI;

/// The Henyey-Greenstein phase function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HenyeyGreenstein {
    /// Mean cosine, in (-1, 1).
    pub g: f32,
}

impl HenyeyGreenstein {
    pub(super) fn value(self, one_minus_cos: f32) -> f32 {
        let g = self.g;
        let squared = (1.0 - g) * (1.0 - g) + 2.0 * g * one_minus_cos;
        // For g < 0 the sum cancels towards (1 + g)^2 at the backward peak.
        let squared = squared.max((1.0 - g.abs()) * (1.0 - g.abs()));
        0.25 * FRAC_1_PI * (1.0 - g) * (1.0 + g) / (squared * squared.sqrt())
    }

    /// 1 - cos at the fraction `u` of the cumulative distribution, counted from the backward end.
    ///
    /// With q = (1 - g)(1 - u) + (1 + g) u and s = (1 - g^2) / q, cos = (1 + g^2 - s^2) / 2g, so
    /// 1 - cos = (1 - g)(1 - u)(s + 1 - g) / q: no difference of like numbers, no branch at g = 0.
    pub(super) fn sample(self, u: f32) -> f32 {
        let (back, forth) = (1.0 - self.g, 1.0 + self.g);
        let q = back * (1.0 - u) + forth * u;
        let s = back * forth / q;
        (back * (1.0 - u) * (s + back) / q).clamp(0.0, 2.0)
    }
}
