//! How dense a medium is from place to place, relative to its coefficients.
//!
//! Absorption and scattering are both multiplied by the relative density rho, so all that transport needs is
//!
//! ```text
//! length = integral of rho along a ray,   T(lane) = exp(-sigma_t(lane) length)
//! ```
//!
//! and, for the free flight, the distance at which the length has a given value. Both are closed forms here, per layer
//! ([`stratified`]) or per cell of a grid ([`grid`]). Free flights, transmittances and emission therefore carry no noise
//! of their own, no null collisions and no majorants, and the weights over the lanes are those of a homogeneous medium
//! with the length in place of the distance: a density, being the same in every lane, cancels in them.
//!
//! Units: metres; lengths are metres of density 1.

pub mod grid;
pub mod stratified;

use std::sync::Arc;

pub use grid::GridDensity;
pub use stratified::Stratified;

use crate::geometry::Ray;

/// Relative density.
#[derive(Clone, Debug, Default)]
pub enum Density {
    /// 1 everywhere.
    #[default]
    Homogeneous,
    /// Exponential in height.
    Stratified(Stratified),
    /// A dense grid in a box; 0 outside.
    Grid(Arc<GridDensity>),
}

impl Density {
    /// True when it is 1 everywhere.
    pub fn is_homogeneous(&self) -> bool {
        matches!(self, Self::Homogeneous)
    }

    /// Density times distance over a ray up to its `t_max`.
    #[inline]
    pub fn length(&self, ray: &Ray) -> f32 {
        match self {
            Self::Homogeneous => ray.t_max,
            Self::Stratified(density) => density.length(ray),
            Self::Grid(density) => density.length(ray),
        }
    }

    /// The distance along a ray, whatever its `t_max`, at which the length reaches a value; infinite when it never does.
    #[inline]
    pub fn distance(&self, ray: &Ray, length: f32) -> f32 {
        match self {
            Self::Homogeneous => length,
            Self::Stratified(density) => density.distance(ray, length),
            Self::Grid(density) => density.distance(ray, length),
        }
    }
}
