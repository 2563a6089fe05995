//! A lobe that falls like a Gaussian of the angle, as compiled by `[PEREZ03 sec. 2.3]`.
//!
//! ```text
//! p = exp(-gamma theta^2) / (2 pi integral over [0, pi] of exp(-gamma theta^2) sin theta dtheta)
//! ```
//! gamma is in rad^-2; the lobe is about 1 / sqrt(2 gamma) rad wide, and isotropic at gamma = 0.

use std::sync::Arc;

use super::Lobe;
use super::angle_table::{AngleTable, moments};
use super::deflection::Deflection;
use crate::geometry::elementary::exp;

/// The Gaussian phase function.
#[derive(Clone, Debug, PartialEq)]
pub struct Gaussian {
    gamma: f32,
    /// One over the integral of the exponential over the sphere.
    scale: f32,
    mean_cosine: f32,
    table: Arc<AngleTable>,
}

impl Gaussian {
    /// Greatest gamma: a lobe 7e-5 rad wide.
    pub const GREATEST_GAMMA: f32 = 1e8;

    /// With gamma from 0 to [`Gaussian::GREATEST_GAMMA`]; `None` outside.
    pub fn new(gamma: f32) -> Option<Self> {
        if !(0.0..=Self::GREATEST_GAMMA).contains(&gamma) {
            return None;
        }
        let fall = |d| f64::from(fall(gamma, d));
        let table = AngleTable::of(fall)?;
        let (whole, mean) = moments(fall);
        Some(Self { gamma, scale: (1.0 / whole) as f32, mean_cosine: mean as f32, table: Arc::new(table) })
    }
}

impl Lobe for Gaussian {
    fn value(&self, deflection: Deflection) -> f32 {
        self.scale * fall(self.gamma, deflection)
    }

    fn table(&self) -> Option<&AngleTable> {
        Some(&self.table)
    }

    fn sample(&self, u: f32) -> Deflection {
        self.table.sample(u)
    }

    fn mean_cosine(&self) -> f32 {
        self.mean_cosine
    }
}

fn fall(gamma: f32, deflection: Deflection) -> f32 {
    let theta = deflection.angle();
    exp(-gamma * theta * theta)
}
