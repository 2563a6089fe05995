//! The colours of FLIP: opponent ones, in which an eye blurs, and uniform ones, in which it tells apart.
//!
//! White is D65, (X, Y, Z)_n, the sum of each row of the matrix from linear RGB to XYZ:
//!
//! ```text
//! Y_y = 116 Y/Y_n - 16      C_x = 500 (X/X_n - Y/Y_n)      C_z = 200 (Y/Y_n - Z/Z_n)           (1)
//! L* = 116 f(Y/Y_n) - 16    a* = 500 (f(X/X_n) - f(Y/Y_n))  b* = 200 (f(Y/Y_n) - f(Z/Z_n))      (2)
//! f(t) = t^(1/3)  if t > (6/29)^3,  else t / (3 (6/29)^2) + 4/29
//! a_h = 0.01 L* a*          b_h = 0.01 L* b*                                                    (3)
//! HyAB = |dL*| + ((da_h)^2 + (db_h)^2)^(1/2)                                                    (4)
//! e   = HyAB^0.7,    m = that of green and blue                                                 (5)
//! e_c = 0.95 e / (0.4 m)  if e < 0.4 m,  else 0.95 + 0.05 (e - 0.4 m) / (0.6 m)                  (6)
//! ```
//!
//! `[ANDERSSON20 sec. 4.1]`; (2) is CIELAB `[CIE15]`, (3) is Hunt's effect: what is dark has less colour.

use std::sync::LazyLock;

use glam::{Mat3, Vec2, Vec3};

use crate::geometry::elementary::{cbrt, pow};

/// Columns of the matrix from linear Rec. 709 RGB to XYZ, as the authors of FLIP round it.
const TO_XYZ: Mat3 = Mat3::from_cols(
    Vec3::new(10_135_552.0 / 24_577_794.0, 2_613_072.0 / 12_288_897.0, 1_425_312.0 / 73_733_382.0),
    Vec3::new(8_788_810.0 / 24_577_794.0, 8_788_810.0 / 12_288_897.0, 8_788_810.0 / 73_733_382.0),
    Vec3::new(4_435_075.0 / 24_577_794.0, 887_015.0 / 12_288_897.0, 70_074_185.0 / 73_733_382.0),
);

const WHITE: Vec3 = Vec3::new(0.950_428_55, 1.0, 1.088_900_4);

const DELTA: f32 = 6.0 / 29.0;

/// (5) of green and blue.
static GREATEST: LazyLock<f32> = LazyLock::new(|| {
    let [green, blue] = [Vec3::Y, Vec3::Z].map(|rgb| Seen::of_opponent(opponent(rgb)));
    pow(hyab(green, blue), 0.7)
});

static FROM_XYZ: LazyLock<Mat3> = LazyLock::new(|| TO_XYZ.inverse());

/// (1) of linear RGB.
pub fn opponent(rgb: Vec3) -> Vec3 {
    let t = TO_XYZ * rgb / WHITE;
    Vec3::new(116.0 * t.y - 16.0, 500.0 * (t.x - t.y), 200.0 * (t.y - t.z))
}

/// Y/Y_n of (1).
pub fn grey(opponent: Vec3) -> f32 {
    (opponent.x + 16.0) / 116.0
}

/// A colour as it is seen: (L*, a_h, b_h) of (3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen(Vec3);

impl Seen {
    /// (2) and (3) of a colour (1), brought into the cube of linear RGB.
    pub fn of_opponent(colour: Vec3) -> Self {
        let y = grey(colour);
        let xyz = Vec3::new(y + colour.y / 500.0, y, y - colour.z / 200.0) * WHITE;
        let rgb = (*FROM_XYZ * xyz).clamp(Vec3::ZERO, Vec3::ONE);
        let f = (TO_XYZ * rgb / WHITE).map(|t| {
            if t > DELTA * DELTA * DELTA { cbrt(t) } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
        });
        let lightness = 116.0 * f.y - 16.0; // (2)
        let (a, b) = (500.0 * (f.x - f.y), 200.0 * (f.y - f.z));
        Self(Vec3::new(lightness, 0.01 * lightness * a, 0.01 * lightness * b)) // (3)
    }
}

/// (6).
pub fn colour_error(a: Seen, b: Seen) -> f32 {
    let greatest = *GREATEST;
    let (error, knee) = (pow(hyab(a, b), 0.7), 0.4 * greatest); // (5)
    if error < knee { 0.95 * error / knee } else { 0.95 + 0.05 * (error - knee) / (greatest - knee) }
}

/// (4).
fn hyab(Seen(a): Seen, Seen(b): Seen) -> f32 {
    let d = a - b;
    d.x.abs() + Vec2::new(d.y, d.z).length()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(rgb: Vec3) -> Vec3 {
        Seen::of_opponent(opponent(rgb)).0
    }

    #[test]
    fn white_and_black_are_where_they_are_in_cielab() {
        // One hundredth of a unit of the thousand between the ends of a* is rounding of the white point.
        assert!((seen(Vec3::ONE) - Vec3::new(100.0, 0.0, 0.0)).abs().max_element() < 1e-3);
        assert!(seen(Vec3::ZERO).abs().max_element() < 1e-4);
        // Of a grey of 18 % the lightness is 49.496.
        assert!((seen(Vec3::splat(0.18)).x - 49.496).abs() < 1e-3);
    }

    #[test]
    fn the_error_is_continuous_and_reaches_one() {
        let [green, blue] = [Vec3::Y, Vec3::Z].map(|rgb| Seen::of_opponent(opponent(rgb)));
        assert!((colour_error(green, blue) - 1.0).abs() < 1e-6);
        assert_eq!(colour_error(green, green), 0.0);
        // Just below and above the knee.
        let at = |t: f32| colour_error(Seen(Vec3::ZERO), Seen(Vec3::new(t, 0.0, 0.0)));
        let knee = pow(0.4 * *GREATEST, 1.0 / 0.7);
        assert!((at(0.9999 * knee) - 0.95).abs() < 1e-3 && (at(1.0001 * knee) - 0.95).abs() < 1e-3);
        assert!(at(1.1 * knee) > 0.95 && at(0.9 * knee) < 0.95);
    }
}
