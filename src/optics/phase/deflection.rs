//! The angle by which light is turned, exact at both of its ends.
//!
//! ```text
//! 1 - cos = |a - b|^2 / 2,   1 + cos = |a + b|^2 / 2      of unit vectors a, b
//! ```
//! Lobes as narrow as 1e-4 rad live where 1 - cos, or at the backward end 1 + cos, is 1e-8: in single precision the
//! cosine has no digits left there, and neither end can be found from the other.

use glam::Vec3;

use crate::geometry::elementary::{atan2, sin_cos_of_turn};

/// The angle between the directions of travel before and after; 0 is straight on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deflection {
    one_minus_cos: f32,
    one_plus_cos: f32,
}

impl Deflection {
    /// Straight on.
    pub const FORWARD: Self = Self { one_minus_cos: 0.0, one_plus_cos: 2.0 };
    /// Straight back.
    pub const BACKWARD: Self = Self { one_minus_cos: 2.0, one_plus_cos: 0.0 };

    /// Between two unit vectors, both in the sense of travel.
    #[inline]
    pub fn between(a: Vec3, b: Vec3) -> Self {
        Self { one_minus_cos: 0.5 * (a - b).length_squared(), one_plus_cos: 0.5 * (a + b).length_squared() }
    }

    /// At 1 - cos in [0, 2], where that is the smaller of the two.
    #[inline]
    pub fn from_one_minus_cos(one_minus_cos: f32) -> Self {
        Self { one_minus_cos, one_plus_cos: 2.0 - one_minus_cos }
    }

    /// At 1 + cos in [0, 2], where that is the smaller of the two.
    #[inline]
    pub fn from_one_plus_cos(one_plus_cos: f32) -> Self {
        Self { one_minus_cos: 2.0 - one_plus_cos, one_plus_cos }
    }

    /// The angle's supplement: forward and backward change places.
    #[inline]
    pub fn reversed(self) -> Self {
        Self { one_minus_cos: self.one_plus_cos, one_plus_cos: self.one_minus_cos }
    }

    /// 1 - cos.
    #[inline]
    pub fn one_minus_cos(self) -> f32 {
        self.one_minus_cos
    }

    /// 1 + cos.
    #[inline]
    pub fn one_plus_cos(self) -> f32 {
        self.one_plus_cos
    }

    /// The cosine, to 6e-8 absolute.
    #[inline]
    pub fn cosine(self) -> f32 {
        if self.one_minus_cos <= self.one_plus_cos {
            1.0 - self.one_minus_cos
        } else {
            self.one_plus_cos - 1.0
        }
    }

    /// The sine, right to its last digits at both ends.
    #[inline]
    pub fn sine(self) -> f32 {
        (self.one_minus_cos * self.one_plus_cos).max(0.0).sqrt()
    }

    /// The angle in radians, in [0, pi].
    #[inline]
    pub fn angle(self) -> f32 {
        atan2(self.sine(), self.cosine())
    }

    /// The direction turned from +z by this angle, at the fraction `u` of a turn around it.
    #[inline]
    pub fn around_z(self, u: f32) -> Vec3 {
        let (sin, cos) = sin_cos_of_turn(u);
        Vec3::new(self.sine() * cos, self.sine() * sin, self.cosine())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::PI;

    #[test]
    fn both_ends_keep_their_digits() {
        for angle in [1e-5_f64, 1e-3, 0.4, 1.6] {
            let turned = Vec3::new(angle.sin() as f32, 0.0, angle.cos() as f32);
            let exact = 2.0 * (0.5 * angle).sin().powi(2);
            let ahead = Deflection::between(Vec3::Z, turned);
            let back = Deflection::between(-Vec3::Z, turned);
            for small in [ahead.one_minus_cos(), back.one_plus_cos()] {
                // The components are rounded to 6e-8.
                let tolerance = 1e-6 + 1.2e-7 / angle;
                assert!((f64::from(small) / exact - 1.0).abs() < tolerance, "{small} {exact}");
            }
            assert_eq!(back.reversed(), ahead);
            assert!((f64::from(ahead.angle()) - angle).abs() < 3e-7 * angle.max(0.2), "{}", ahead.angle());
        }
        assert_eq!(Deflection::between(Vec3::X, Vec3::X), Deflection::FORWARD);
        assert_eq!(Deflection::between(Vec3::X, -Vec3::X), Deflection::BACKWARD);
        assert_eq!(Deflection::FORWARD.angle(), 0.0);
        assert_eq!(Deflection::BACKWARD.angle(), PI);
        assert_eq!(Deflection::BACKWARD.around_z(0.3), -Vec3::Z);
    }
}
