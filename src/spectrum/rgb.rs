//! Smooth spectra of RGB reflectances and coefficients.
//!
//! ```text
//! f(lambda) = scale S(c0 t^2 + c1 t + c2),   S(x) = 1/2 + x / (2 sqrt(1 + x^2)),   t = (lambda - 580) / 200
//! ```
//! The sigmoid of a parabola of Jakob and Hanika `[JAKOB19]`. The coefficients are found for each colour by a
//! damped Gauss-Newton search for the least CIELAB difference under D65, in f64, from the curve of the grey of the
//! same luminance; there is no table.
//!
//! * A reflectance has `scale` 1 and so stays in (0, 1); its components are brought into [0, 1].
//! * A coefficient has no upper bound: `scale` is twice its largest component, and the parabola makes the colour
//!   RGB / scale, at most one half.
//! * Greys are exact in both: S(0) = 1/2, `scale` twice the value.
//!
//! Components nearer than [`GAMUT_MARGIN`] to 0 or 1 are moved to it, since the sigmoid gets there only with infinite
//! coefficients. Round trip over the 9^3 grid of the cube, in CIELAB differences: reflectances 0.0016 in the mean and
//! 0.025 at worst, coefficients 0.0018 and 0.017; a fit takes about 50 us.

use std::sync::LazyLock;

use glam::{DMat3, DVec3};

use super::cie::{self, NANOMETRES};
use super::lab::{lab, lab_jacobian};

/// How far inside the unit cube a colour is fitted.
pub const GAMUT_MARGIN: f64 = 1e-5;

/// Most steps of the search.
const MAX_STEPS: usize = 100;
/// CIELAB difference at which the search ends.
const CLOSE_ENOUGH: f64 = 1e-5;

/// A smooth positive spectrum with a given RGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RgbCurve {
    /// What the sigmoid is multiplied by.
    pub scale: f64,
    /// Coefficients of t^2, t and 1.
    pub coefficients: [f64; 3],
}

impl RgbCurve {
    /// The curve of a reflectance; components are brought into [0, 1].
    pub fn reflectance(rgb: [f32; 3]) -> Self {
        let rgb = rgb.map(|v| v.clamp(0.0, 1.0));
        Self::grey(rgb).unwrap_or_else(|| Self { scale: 1.0, coefficients: fit(as_dvec3(rgb)) })
    }

    /// The curve of a coefficient without upper bound; negative components count as zero.
    pub fn unbounded(rgb: [f32; 3]) -> Self {
        let rgb = rgb.map(|v| v.clamp(0.0, f32::MAX));
        Self::grey(rgb).unwrap_or_else(|| {
            let scale = 2.0 * as_dvec3(rgb).max_element();
            Self { scale, coefficients: fit(as_dvec3(rgb) / scale) }
        })
    }

    /// The curve's value at `lambda` nm.
    pub fn eval(&self, lambda: f64) -> f64 {
        self.scale * sigmoid(parabola(self.coefficients, lambda))
    }

    /// The constant spectrum, when the components are equal.
    fn grey(rgb: [f32; 3]) -> Option<Self> {
        (rgb[0] == rgb[1] && rgb[1] == rgb[2])
            .then(|| Self { scale: 2.0 * f64::from(rgb[0]), coefficients: [0.0; 3] })
    }
}

fn as_dvec3(rgb: [f32; 3]) -> DVec3 {
    DVec3::from_array(rgb.map(f64::from))
}

fn normalised(lambda: f64) -> f64 {
    (lambda - 580.0) / 200.0
}

fn parabola([c0, c1, c2]: [f64; 3], lambda: f64) -> f64 {
    let t = normalised(lambda);
    (c0 * t + c1) * t + c2
}

fn sigmoid(x: f64) -> f64 {
    // 1/2 + x / (2 sqrt(1 + x^2)) without cancellation where x is far below zero.
    let root = (1.0 + x * x).sqrt();
    if x < 0.0 { 0.5 / (root * (root - x)) } else { 0.5 + 0.5 * x / root }
}

fn sigmoid_slope(x: f64) -> f64 {
    let square = 1.0 + x * x;
    0.5 / (square * square.sqrt())
}

/// Weights w_j with XYZ under D65 = sum of w_j f(lambda_j), exact for f that is linear between whole nanometres.
static WEIGHTS: LazyLock<[DVec3; NANOMETRES]> = LazyLock::new(|| {
    let mut weights = [DVec3::ZERO; NANOMETRES];
    for index in 0..NANOMETRES - 1 {
        // Simpson's rule is exact: observer, D65 and f are linear here, their product a cubic.
        for (t, simpson) in [(0.0, 1.0), (0.5, 4.0), (1.0, 1.0)] {
            let lambda = cie::nanometre(index) + t;
            let value = cie::colour_matching(lambda) * cie::d65(lambda) * (simpson / 6.0);
            weights[index] += value * (1.0 - t);
            weights[index + 1] += value * t;
        }
    }
    weights
});

/// A point of the search: CIELAB residual and its derivative by the coefficients.
struct Fit {
    residual: DVec3,
    jacobian: DMat3,
}

impl Fit {
    fn at(c: DVec3, target: DVec3) -> Self {
        let mut xyz = DVec3::ZERO;
        let mut xyz_by_c = DMat3::ZERO;
        for (index, weight) in WEIGHTS.iter().enumerate() {
            let lambda = cie::nanometre(index);
            let t = normalised(lambda);
            let x = parabola(c.to_array(), lambda);
            xyz += *weight * sigmoid(x);
            let slope = *weight * sigmoid_slope(x);
            xyz_by_c += DMat3::from_cols(slope * (t * t), slope * t, slope);
        }
        Self { residual: lab(xyz) - target, jacobian: lab_jacobian(xyz) * xyz_by_c }
    }

    /// The Levenberg-Marquardt step of this damping.
    fn step(&self, damping: f64) -> DVec3 {
        let transposed = self.jacobian.transpose();
        let normal = transposed * self.jacobian;
        let diagonal = DVec3::new(normal.x_axis.x, normal.y_axis.y, normal.z_axis.z);
        let damped = normal + DMat3::from_diagonal(diagonal * damping + DVec3::splat(1e-12));
        -(damped.inverse() * (transposed * self.residual))
    }
}

/// Coefficients of the sigmoid curve nearest to `rgb` (components in [0, 1]).
fn fit(rgb: DVec3) -> [f64; 3] {
    let rgb = rgb.clamp(DVec3::splat(GAMUT_MARGIN), DVec3::splat(1.0 - GAMUT_MARGIN));
    let xyz = cie::rgb_to_xyz(rgb);
    let target = lab(xyz);
    let grey = xyz.y.clamp(0.01, 0.99);
    let mut c = DVec3::new(0.0, 0.0, (grey - 0.5) / (grey * (1.0 - grey)).sqrt());
    let mut here = Fit::at(c, target);
    let mut damping = 1e-3;
    for _ in 0..MAX_STEPS {
        if here.residual.length() < CLOSE_ENOUGH || damping > 1e12 {
            break;
        }
        let candidate = c + here.step(damping);
        let there = Fit::at(candidate, target);
        if candidate.is_finite() && there.residual.length_squared() < here.residual.length_squared() {
            (c, here) = (candidate, there);
            damping = (damping * 0.2).max(1e-9);
        } else {
            damping *= 5.0;
        }
    }
    c.to_array()
}

#[cfg(test)]
mod tests {
    use super::super::lab::delta_e;
    use super::*;
    use proptest::prelude::*;

    fn round_trip(curve: &RgbCurve) -> DVec3 {
        cie::rgb(|lambda| curve.eval(lambda) * cie::d65(lambda))
    }

    /// Mean and worst CIELAB difference of colours over the cube from what `back` makes of them.
    fn mean_and_worst(back: impl Fn([f32; 3]) -> DVec3) -> (f64, f64) {
        let (mut sum, mut worst) = (0.0, 0.0_f64);
        for i in 0..729 {
            let rgb = [i % 9, i / 9 % 9, i / 81].map(|step| step as f32 / 8.0);
            let error = delta_e(back(rgb), as_dvec3(rgb));
            sum += error;
            worst = worst.max(error);
        }
        (sum / 729.0, worst)
    }

    /// Bounds are about twice the measured values in the module's head.
    #[test]
    fn reflectances_come_back_over_the_cube() {
        let (mean, worst) = mean_and_worst(|rgb| round_trip(&RgbCurve::reflectance(rgb)));
        assert!(mean < 0.004 && worst < 0.05, "mean {mean} worst {worst}");
    }

    #[test]
    fn coefficients_come_back_over_the_cube() {
        let (mean, worst) =
            mean_and_worst(|rgb| round_trip(&RgbCurve::unbounded(rgb.map(|v| v * 40.0))) / 40.0);
        assert!(mean < 0.004 && worst < 0.05, "mean {mean} worst {worst}");
    }

    /// Nearly black saturated colours are the hardest: the worst of 20,000 random ones was 0.024.
    #[test]
    fn dark_saturated_colours_come_back() {
        for rgb in
            [[0.028, 0.0, 0.033], [0.009, 0.0, 0.027], [0.0, 0.0, 0.01], [1e-3, 0.0, 0.0], [1.0, 1.0, 0.999]]
        {
            let error = delta_e(round_trip(&RgbCurve::reflectance(rgb)), as_dvec3(rgb));
            assert!(error < 0.05, "{rgb:?}: {error}");
        }
    }

    #[test]
    fn greys_are_constant_and_exact() {
        for value in [0.0, 1e-6, 0.18, 0.5, 0.999, 1.0] {
            for curve in [RgbCurve::reflectance([value; 3]), RgbCurve::unbounded([value; 3])] {
                for lambda in [380.0, 451.3, 780.0] {
                    assert_eq!(curve.eval(lambda), f64::from(value));
                }
            }
        }
        assert_eq!(RgbCurve::unbounded([250.0; 3]).eval(500.0), 250.0);
        assert_eq!(RgbCurve::reflectance([7.0; 3]).eval(500.0), 1.0);
    }

    proptest! {
        #[test]
        fn any_colour_gives_a_finite_curve_in_range(r in -0.5_f32..1.5, g in -0.5_f32..1.5, b in -0.5_f32..1.5) {
            let curve = RgbCurve::reflectance([r, g, b]);
            let unbounded = RgbCurve::unbounded([r, g, b]);
            for index in 0..cie::NANOMETRES {
                let value = curve.eval(cie::nanometre(index));
                prop_assert!((0.0..=1.0).contains(&value), "{value}");
                let value = unbounded.eval(cie::nanometre(index));
                prop_assert!(value >= 0.0 && value.is_finite(), "{value}");
            }
        }
    }
}
