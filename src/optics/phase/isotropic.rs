//! Light scattered the same in every direction.
//!
//! ```text
//! p = 1 / (4 pi)
//! ```

/// The isotropic phase function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Isotropic;

impl Isotropic {
    pub(super) fn value(self) -> f32 {
        0.25 * std::f32::consts::FRAC_1_PI
    }

    pub(super) fn sample(self, u: f32) -> f32 {
        2.0 * u
    }
}
