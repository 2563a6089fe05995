//! Density that is exponential in height.
//!
//! ```text
//! rho(h) = exp((h - surface) / depth)
//! length(t) = rho_0 (exp(a t) - 1) / a,   a = (direction . up) / depth
//! t(length) = ln(1 + a length / rho_0) / a
//! ```
//! A positive depth thins out downwards, a negative one upwards. At `surface` the density is 1; beyond it the
//! exponential goes on, so that waves have no edge in them.

use glam::Vec3;

use crate::geometry::Ray;
use crate::geometry::elementary::{exp, exp_m1, ln, ln_1p};

/// Exponential layers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stratified {
    /// The direction of height, a unit vector.
    pub up: Vec3,
    /// Height at which the density is 1, in metres from the scene's origin.
    pub surface: f32,
    /// 1 / depth in 1/m.
    pub rate: f32,
}

/// Exponents beyond this are cut: e^80 and e^-80 are still in the range of f32.
const GREATEST_EXPONENT: f32 = 80.0;
/// Below this (a t) the exponential is its tangent and half its curvature, to rounding.
const SMALL: f32 = 1e-4;

impl Stratified {
    /// Logarithm of the density where a ray starts, and its change with distance.
    fn exponent(&self, ray: &Ray) -> (f32, f32) {
        let start = self.rate * (ray.origin.dot(self.up) - self.surface);
        (start.clamp(-GREATEST_EXPONENT, GREATEST_EXPONENT), self.rate * ray.direction.dot(self.up))
    }

    /// Density times distance over a ray up to its `t_max`.
    pub fn length(&self, ray: &Ray) -> f32 {
        let (start, a) = self.exponent(ray);
        let t = ray.t_max;
        if t.is_infinite() {
            return if a < 0.0 { exp(start) / -a } else { f32::INFINITY };
        }
        let x = a * t;
        if x.abs() < SMALL {
            exp(start) * t * (1.0 + 0.5 * x)
        } else if x > 1.0 {
            (exp((start + x).min(88.0)) - exp(start)) / a
        } else {
            exp(start) * exp_m1(x) / a
        }
    }

    /// The distance at which the length reaches a value; infinite when it never does.
    pub fn distance(&self, ray: &Ray, length: f32) -> f32 {
        let (start, a) = self.exponent(ray);
        let straight = length / exp(start);
        let y = a * straight;
        if length.is_infinite() || y <= -1.0 {
            f32::INFINITY
        } else if y.abs() < SMALL {
            straight * (1.0 - 0.5 * y)
        } else if y > 1e6 {
            // The same without the quotient, which may leave the range of f32.
            (ln(a * length) - start) / a
        } else {
            ln_1p(y) / a
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn ray(height: f32, slope: f32, t_max: f32) -> Ray {
        let direction = Vec3::new((1.0 - slope * slope).sqrt(), 0.0, slope);
        Ray { t_max, ..Ray::new(Vec3::new(3.0, -2.0, height), direction) }
    }

    fn layers(depth: f32) -> Stratified {
        Stratified { up: Vec3::Z, surface: 0.25, rate: 1.0 / depth }
    }

    #[test]
    fn the_length_is_the_integral_of_the_density() {
        for depth in [0.5, -0.5, 20.0, -1e5] {
            for slope in [-1.0, -0.3, -1e-6, 0.0, 1e-4, 0.7, 1.0] {
                for t in [1e-3, 0.2, 3.0] {
                    let ray = ray(0.1, slope, t);
                    let density = |s: f64| {
                        let height = f64::from(ray.origin.z) + s * f64::from(ray.direction.z);
                        ((height - 0.25) / f64::from(depth)).exp()
                    };
                    // Simpson's rule over 1000 intervals: an error of (3 / (1000 * 0.5))^4, far below rounding.
                    let step = f64::from(t) / 1000.0;
                    let cell = |i: i32| {
                        let s = f64::from(i) * step;
                        step / 6.0 * (density(s) + 4.0 * density(s + 0.5 * step) + density(s + step))
                    };
                    let expected: f64 = (0..1000).map(cell).sum();
                    let got = f64::from(layers(depth).length(&ray));
                    assert!((got / expected - 1.0).abs() < 2e-6, "{depth} {slope} {t}: {got} {expected}");
                }
            }
        }
    }

    #[test]
    fn a_way_into_thin_layers_has_a_finite_length() {
        let down = ray(0.25, -1.0, f32::INFINITY);
        assert_eq!(layers(0.5).length(&down), 0.5);
        assert_eq!(layers(0.5).distance(&down, 0.5), f32::INFINITY);
        assert_eq!(layers(-0.5).length(&down), f32::INFINITY);
        assert_eq!(layers(0.5).length(&ray(0.0, 0.0, f32::INFINITY)), f32::INFINITY);
    }

    proptest! {
        #[test]
        fn distance_and_length_are_each_others_inverse(
            height in -5.0_f32..5.0, slope in -1.0_f32..1.0, depth in 0.1_f32..10.0, up in any::<bool>(), t in 1e-3_f32..20.0
        ) {
            let layers = layers(if up { depth } else { -depth });
            let ray = ray(height, slope, t);
            let length = layers.length(&ray);
            let back = layers.distance(&ray, length);
            // Where the density has fallen by e^-x the length hardly changes any more: its rounding is worth e^x times more.
            let fallen = (-layers.rate * ray.direction.z * t).max(0.0);
            let tolerance = 4e-6 * (1.0 + libm::expf(fallen) / fallen.max(1.0));
            // A density beyond e^88 is cut there, since its integral leaves the range of f32: the ray ends no later.
            if layers.rate * (height - 0.25 + ray.direction.z * t) > 88.0 {
                prop_assert!(back < t, "{} {}", back, t);
                return Ok(());
            }
            prop_assert!(fallen > 10.0 || (back / t - 1.0).abs() < tolerance, "{} {} {}", back, t, length);
        }

        #[test]
        fn nothing_is_not_a_number(height in -1e6_f32..1e6, slope in -1.0_f32..1.0, depth in -3.0_f32..3.0, l in 0.0_f32..1e9) {
            let layers = Stratified { up: Vec3::Z, surface: 0.0, rate: libm::powf(10.0, depth) };
            for t in [0.0, 1e-6, 1.0, 1e9, f32::INFINITY] {
                let length = layers.length(&ray(height, slope, t));
                prop_assert!(length >= 0.0, "length {length}");
            }
            for length in [0.0, l, f32::INFINITY] {
                let distance = layers.distance(&ray(height, slope, 1.0), length);
                prop_assert!(distance >= 0.0, "distance {distance}");
            }
        }
    }
}
