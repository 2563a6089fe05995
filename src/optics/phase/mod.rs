//! Phase functions: where scattered light goes.
//!
//! Each is normalised over the sphere and depends on the angle between the directions of *travel* before and after,
//! given as 1 - cos: near 0, where forward peaks live, the cosine itself has no digits left. One file a function;
//! [`EXAMPLES`] is the list that tests walk.

mod henyey_greenstein;
mod isotropic;

use glam::Vec3;

pub use henyey_greenstein::HenyeyGreenstein;
pub use isotropic::Isotropic;

use crate::geometry::Frame;
use crate::sampling::warp;

/// Any phase function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PhaseFunction {
    /// The same in every direction.
    Isotropic(Isotropic),
    /// One lobe of given mean cosine.
    HenyeyGreenstein(HenyeyGreenstein),
}

/// A sampled direction; `weight` is value / pdf.
#[derive(Clone, Copy, Debug)]
pub struct PhaseSample {
    /// New direction of travel.
    pub wi: Vec3,
    /// Value over density.
    pub weight: f32,
    /// Density per solid angle.
    pub pdf_w: f32,
}

/// One of each kind, and its extremes.
pub const EXAMPLES: &[(&str, PhaseFunction)] = &[
    ("isotropic", PhaseFunction::Isotropic(Isotropic)),
    ("henyey-greenstein 0", PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g: 0.0 })),
    ("henyey-greenstein 0.5", PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g: 0.5 })),
    ("henyey-greenstein -0.7", PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g: -0.7 })),
    ("henyey-greenstein 0.95", PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g: 0.95 })),
    ("henyey-greenstein 0.9999", PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g: 0.9999 })),
];

impl PhaseFunction {
    /// Density of scattered light per solid angle, in 1/sr.
    #[inline]
    pub fn value(&self, one_minus_cos: f32) -> f32 {
        match self {
            Self::Isotropic(p) => p.value(),
            Self::HenyeyGreenstein(p) => p.value(one_minus_cos),
        }
    }

    /// Density with which [`PhaseFunction::sample`] takes that angle, per solid angle.
    #[inline]
    pub fn pdf_w(&self, one_minus_cos: f32) -> f32 {
        self.value(one_minus_cos)
    }

    /// A new direction for light (or an eye path) that travelled along `forward`.
    #[inline]
    pub fn sample(&self, forward: Vec3, u: [f32; 2]) -> PhaseSample {
        let one_minus_cos = match self {
            Self::Isotropic(p) => p.sample(u[0]),
            Self::HenyeyGreenstein(p) => p.sample(u[0]),
        };
        let wi = Frame::around(forward).to_world(warp::around_z(one_minus_cos, u[1])).normalize();
        PhaseSample { wi, weight: 1.0, pdf_w: self.pdf_w(one_minus_cos) }
    }

    /// Mean cosine of the angle of deflection; positive is forward.
    pub fn mean_cosine(&self) -> f32 {
        match self {
            Self::Isotropic(_) => 0.0,
            Self::HenyeyGreenstein(p) => p.g,
        }
    }
}

/// 1 - cos of the angle between two unit vectors, exact for small angles.
#[inline]
pub fn one_minus_cos(a: Vec3, b: Vec3) -> f32 {
    0.5 * (a - b).length_squared()
}
