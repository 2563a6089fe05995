//! The sphere of directions as a rectangle of latitude and longitude, from which directions are drawn by cells.
//!
//! The top edge is straight up, columns run once around: with z up the left edge is the direction -x, a quarter of the
//! width is -y, the middle is +x and three quarters is +y.

use std::f32::consts::{FRAC_1_PI, PI};

use glam::Vec3;

use crate::geometry::elementary::{atan2, sin_cos};
use crate::sampling::Distribution2d;

/// Directions and how often they are drawn.
#[derive(Clone, Debug)]
pub(super) struct SphereMap {
    /// The axes that play x, y, z of the module's description.
    axes: [Vec3; 3],
    distribution: Option<Distribution2d>,
}

impl SphereMap {
    /// With the unit vector `up` (a coordinate axis) on top. Cells have weights row by row, `width` a row, each the integral of
    /// brightness over the cell's solid angle in any unit.
    pub fn new(up: Vec3, width: usize, weights: &[f64]) -> Self {
        // A cyclic permutation keeps pictures from being mirrored; z up leaves the axes alone.
        let x = Vec3::new(up.z.abs(), up.x.abs(), up.y.abs());
        Self { axes: [x, up.cross(x), up], distribution: Distribution2d::new(width, weights) }
    }

    /// False where all weights are 0.
    pub fn is_sampled(&self) -> bool {
        self.distribution.is_some()
    }

    /// The direction of a point, both coordinates in [0, 1], and the sine of its polar angle.
    pub fn direction(&self, point: [f32; 2]) -> (Vec3, f32) {
        let (sin, cos) = sin_cos(point[1] * PI);
        let (sin_phi, cos_phi) = sin_cos((2.0 * point[0] - 1.0) * PI);
        let [x, y, z] = self.axes;
        ((x * (sin * cos_phi) + y * (sin * sin_phi) + z * cos).normalize(), sin)
    }

    /// A direction and its density per solid angle.
    pub fn sample(&self, u: [f32; 2]) -> Option<(Vec3, f32)> {
        let (point, density) = self.distribution.as_ref()?.sample(u);
        let (wi, sin) = self.direction(point);
        Some((wi, solid_angle_density(density, sin)?))
    }

    /// Density per solid angle of [`SphereMap::sample`].
    pub fn pdf_w(&self, direction: Vec3) -> f32 {
        let Some(distribution) = &self.distribution else { return 0.0 };
        let density = distribution.pdf(self.square(direction));
        solid_angle_density(density, self.polar(direction)[0]).unwrap_or(0.0)
    }

    /// Where a direction lies on the rectangle, both in [0, 1).
    pub fn square(&self, direction: Vec3) -> [f32; 2] {
        let [x, y] = [0, 1].map(|axis| direction.dot(self.axes[axis]));
        let [sin, cos] = self.polar(direction);
        let below_one = 1.0 - f32::EPSILON * 0.5;
        [
            (0.5 + 0.5 * FRAC_1_PI * atan2(y, x)).clamp(0.0, below_one),
            (atan2(sin, cos) * FRAC_1_PI).min(below_one),
        ]
    }

    /// Sine and cosine of the polar angle; the sine from the other two axes, since near the poles the cosine has no
    /// digits of it.
    fn polar(&self, direction: Vec3) -> [f32; 2] {
        let [x, y, z] = self.axes.map(|axis| direction.dot(axis));
        [(x * x + y * y).sqrt(), z]
    }
}

/// The map from the unit square spreads it over 2 pi^2 sin(theta) steradians per unit of area.
fn solid_angle_density(density: f32, sin: f32) -> Option<f32> {
    (sin > 0.0 && density > 0.0).then(|| density / (2.0 * PI * PI * sin))
}

/// The mean square of a brightness over the sphere, over the square of the mean; 0 where all is black.
pub(super) fn contrast_of(width: usize, brightness: &[f64]) -> f64 {
    let height = brightness.len() / width;
    let (mut weight, mut mean, mut square) = (0.0, 0.0, 0.0);
    for (j, row) in brightness.chunks(width).enumerate() {
        let sine = libm::sin(std::f64::consts::PI * (j as f64 + 0.5) / height as f64);
        for brightness in row {
            weight += sine;
            mean += sine * brightness;
            square += sine * brightness * brightness;
        }
    }
    if mean > 0.0 { square * weight / (mean * mean) } else { 0.0 }
}
