//! CIELAB under D65, the space in which colour differences are judged.
//!
//! ```text
//! L* = 116 f(Y/Yn) - 16,   a* = 500 (f(X/Xn) - f(Y/Yn)),   b* = 200 (f(Y/Yn) - f(Z/Zn))
//! f(t) = t^(1/3) above (6/29)^3, else t / (3 (6/29)^2) + 4/29                                [CIE15]
//! ```
//! White is RGB (1, 1, 1), L* = 100. A difference of 1 (CIE 1976) is about what an eye can tell.

use std::sync::LazyLock;

use glam::{DMat3, DVec3};

use super::cie;

const DELTA: f64 = 6.0 / 29.0;

static WHITE: LazyLock<DVec3> = LazyLock::new(|| cie::rgb_to_xyz(DVec3::ONE));

/// (L*, a*, b*) of X, Y, Z.
pub fn lab(xyz: DVec3) -> DVec3 {
    let t = xyz / *WHITE;
    let f = DVec3::new(compressed(t.x), compressed(t.y), compressed(t.z));
    DVec3::new(116.0 * f.y - 16.0, 500.0 * (f.x - f.y), 200.0 * (f.y - f.z))
}

/// Derivative of [`lab`] by X, Y, Z.
pub(super) fn lab_jacobian(xyz: DVec3) -> DMat3 {
    let t = xyz / *WHITE;
    let d = DVec3::new(compressed_slope(t.x), compressed_slope(t.y), compressed_slope(t.z)) / *WHITE;
    DMat3::from_cols(
        DVec3::new(0.0, 500.0 * d.x, 0.0),
        DVec3::new(116.0 * d.y, -500.0 * d.y, 200.0 * d.y),
        DVec3::new(0.0, 0.0, -200.0 * d.z),
    )
}

/// CIE 1976 difference between two colours in linear Rec. 709.
pub fn delta_e(rgb_a: DVec3, rgb_b: DVec3) -> f64 {
    (lab(cie::rgb_to_xyz(rgb_a)) - lab(cie::rgb_to_xyz(rgb_b))).length()
}

fn compressed(t: f64) -> f64 {
    if t > DELTA * DELTA * DELTA { libm::cbrt(t) } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
}

fn compressed_slope(t: f64) -> f64 {
    if t > DELTA * DELTA * DELTA {
        let root = libm::cbrt(t);
        1.0 / (3.0 * root * root)
    } else {
        1.0 / (3.0 * DELTA * DELTA)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_100_and_the_red_primary_has_its_known_coordinates() {
        assert!((lab(cie::rgb_to_xyz(DVec3::ONE)) - DVec3::new(100.0, 0.0, 0.0)).length() < 1e-10);
        // The sRGB red in CIELAB with D65 is (53.24, 80.09, 67.20).
        let red = lab(cie::rgb_to_xyz(DVec3::X));
        assert!((red - DVec3::new(53.24, 80.09, 67.20)).abs().max_element() < 0.05, "{red}");
    }

    #[test]
    fn the_jacobian_is_the_slope() {
        for xyz in [DVec3::new(0.3, 0.4, 0.2), DVec3::new(0.001, 0.002, 0.0005)] {
            let jacobian = lab_jacobian(xyz);
            for axis in 0..3 {
                let h = DVec3::AXES[axis] * 1e-7;
                let slope = (lab(xyz + h) - lab(xyz - h)) / 2e-7;
                // Central differences of a function of size 100: 1e-5 of slopes up to 3000.
                assert!((slope - jacobian.col(axis)).length() < 1e-3 * slope.length(), "{slope}");
            }
        }
    }
}
