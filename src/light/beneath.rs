//! Where light comes from beneath a refracting interface.
//!
//! No direction is known to lead from a point under waves to a light above them. But all that do lie in a spot that is
//! little wider than the light and the spread of the normals. The directions in which samples of the lights go on beyond
//! samples of the interface, weighted by the power that they carry, fill cells over the sphere; next-event estimation draws
//! from these, follows the direction through the interface, and sees whether it meets the light.
//!
//! It pays where the spot is small. How small it is tells
//!
//! ```text
//! Omega = 1 / integral of p^2 over the sphere                                       (1)
//! ```
//!
//! which for a density p that is constant over a spot is its solid angle.

use std::f32::consts::{PI, TAU};

use glam::Vec3;

use crate::geometry::elementary::{atan2, sin_cos};
use crate::sampling::Distribution2d;

/// Cells around the z axis and along it: equal solid angles, some 1.4 degrees wide at 45 degrees from it.
const COLUMNS: usize = 256;
const ROWS: usize = 128;

/// Greatest solid angle (1), in sr, that is looked into: some 20 degrees around a direction.
///
/// Under waves of slopes up to 0.25 a disc of 5 degrees fills 0.05 sr, and a twelfth of the time to equal error is left;
/// a smooth sky fills most of a hemisphere's window of 2 sr, where chance is as good and costs less.
const GREATEST: f64 = 0.4;

/// Density of directions in which light arrives from beyond an interface.
#[derive(Clone, Debug)]
pub struct Beneath(Distribution2d);

/// Power that arrives from each cell of directions.
#[derive(Clone, Debug)]
pub struct BeneathCells {
    power: Vec<f64>,
    /// Squares of what was added.
    squares: f64,
}

impl Default for BeneathCells {
    fn default() -> Self {
        Self { power: vec![0.0; COLUMNS * ROWS], squares: 0.0 }
    }
}

impl BeneathCells {
    /// Adds light that comes from a unit direction.
    pub fn add(&mut self, wi: Vec3, power: f64) {
        let [x, y] = square(wi);
        let (column, row) = ((x * COLUMNS as f32) as usize, (y * ROWS as f32) as usize);
        self.power[row * COLUMNS + column] += power;
        self.squares += power * power;
    }

    /// `None` where no light comes, or where it comes from so many directions that chance finds it.
    pub fn finish(&self) -> Option<Beneath> {
        let total: f64 = self.power.iter().sum();
        // Pairs of different samples that share a cell: few samples fill few cells, but not because the spot is small.
        let pairs = self.power.iter().map(|power| power * power).sum::<f64>() - self.squares;
        let cell = 4.0 * std::f64::consts::PI / self.power.len() as f64;
        let solid_angle = cell * total * total / pairs; // (1)
        (pairs > 0.0 && solid_angle < GREATEST)
            .then(|| Distribution2d::new(COLUMNS, &self.power).map(Beneath))?
    }
}

impl Beneath {
    /// A direction and its density per solid angle.
    pub fn sample(&self, u: [f32; 2]) -> (Vec3, f32) {
        let (point, density) = self.0.sample(u);
        let z = 2.0 * point[1] - 1.0;
        let r = (1.0 - z * z).max(0.0).sqrt();
        let (sin, cos) = sin_cos((2.0 * point[0] - 1.0) * PI);
        (Vec3::new(r * cos, r * sin, z).normalize(), density / (2.0 * TAU))
    }

    /// Density per solid angle with which a direction is drawn.
    pub fn pdf_w(&self, wi: Vec3) -> f32 {
        self.0.pdf(square(wi)) / (2.0 * TAU)
    }
}

/// Where a direction lies on the unit square.
fn square(wi: Vec3) -> [f32; 2] {
    let below_one = 1.0 - f32::EPSILON * 0.5;
    [0.5 + 0.5 / PI * atan2(wi.y, wi.x), 0.5 + 0.5 * wi.z].map(|x| x.clamp(0.0, below_one))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A spot whose cells hold different powers: densities of the samples are those asked for, and integrate to 1.
    #[test]
    fn directions_are_drawn_with_the_density_that_is_stated() {
        let mut cells = BeneathCells::default();
        let spot: Vec<Vec3> = (0..40)
            .map(|i| Vec3::new(0.5 + 0.003 * i as f32, 0.01 * (i % 5) as f32, 0.7).normalize())
            .collect();
        for (i, &wi) in spot.iter().enumerate() {
            cells.add(wi, 1.0 + i as f64);
        }
        let beneath = cells.finish().unwrap();
        let mut inverse = 0.0;
        let side = 1024;
        for i in 0..side * side {
            let u = [((i % side) as f32 + 0.5) / side as f32, ((i / side) as f32 + 0.5) / side as f32];
            let (wi, pdf_w) = beneath.sample(u);
            assert!((wi.length() - 1.0).abs() < 1e-6);
            // A sample on the border of two cells may be found in the other.
            let [x, y] = square(wi).map(|x| x.fract());
            let border = [x * COLUMNS as f32, y * ROWS as f32].iter().any(|x| (x - x.round()).abs() < 1e-3);
            assert!(border || (beneath.pdf_w(wi) / pdf_w - 1.0).abs() < 1e-5, "{wi}");
            inverse += 1.0 / f64::from(pdf_w) / f64::from(side * side);
        }
        // The mean of 1 / p is the solid angle of the cells that hold any power; midpoints of 1024 are off by that in a row or column
        // whose share is 1 in 50 by 5 % at most.
        let held =
            cells.power.iter().filter(|p| **p > 0.0).count() as f64 * 4.0 * std::f64::consts::PI / 32768.0;
        assert!((inverse / held - 1.0).abs() < 0.05, "{inverse} and {held}");
    }

    #[test]
    fn light_from_everywhere_is_left_to_chance() {
        let mut cells = BeneathCells::default();
        assert!(cells.finish().is_none());
        for i in 0..10_000 {
            let (sin, cos) = sin_cos(2.399_963_2 * i as f32);
            let z = i as f32 / 10_000.0;
            let r = (1.0 - z * z).sqrt();
            cells.add(Vec3::new(r * cos, r * sin, z), 1.0);
        }
        assert!(cells.finish().is_none());
    }
}
