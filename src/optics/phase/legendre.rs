//! Legendre polynomials, and the moments of any phase function over them.
//!
//! ```text
//! 1 - g_k = 2 pi (integral of p (1 - P_k(cos)) over cos),   Q_k = 1 - P_k,   t = 1 - cos
//! (k + 1) Q_{k+1} = (2 k + 1) (Q_k + t (1 - Q_k)) - k Q_{k-1},   Q_0 = 0,   Q_1 = t
//! ```
//! What a moment lacks of 1 is integrated itself, in steps that are even in log t: of a peak a million times the mean the
//! moment is 1 but for its last digits, and these are what transport depends on.

use super::PhaseFunction;
use super::angle_table::integral;
use super::deflection::Deflection;

impl PhaseFunction {
    /// 1 - g_k for k = 1 up to `order`; the first is 1 less the mean cosine.
    pub fn lacks_of_moments(&self, order: usize) -> Vec<f64> {
        let ahead = |t: f64| f64::from(self.value(Deflection::from_one_minus_cos(t as f32)));
        let back = |t: f64| f64::from(self.value(Deflection::from_one_plus_cos(t as f32)));
        let whole = integral(ahead) + integral(back);
        let lack = |k: usize| {
            let sum = integral(|t| ahead(t) * lack_of_legendre(k, t))
                + integral(|t| back(t) * lack_of_legendre(k, 2.0 - t));
            sum / whole
        };
        (1..=order).map(lack).collect()
    }
}

/// 1 - P_k at 1 - cos = t.
fn lack_of_legendre(k: usize, t: f64) -> f64 {
    let (mut before, mut lack) = (0.0, t);
    for j in 1..k {
        let n = j as f64;
        (before, lack) = (lack, ((2.0 * n + 1.0) * (lack + t * (1.0 - lack)) - n * before) / (n + 1.0));
    }
    if k == 0 { 0.0 } else { lack }
}

/// The Legendre polynomial P_k at a cosine.
pub fn legendre(k: usize, cos: f64) -> f64 {
    1.0 - lack_of_legendre(k, 1.0 - cos)
}

#[cfg(test)]
mod tests {
    use super::super::{EXAMPLES, HenyeyGreenstein, Rayleigh};
    use super::*;

    /// The mean cosine is kept in single precision, of which 6e-8 is half a digit. Kinks between the nodes of Simpson's
    /// rule, as that at the critical angle of bubbles, cost up to 3.2e-4 of the lack.
    #[test]
    fn the_first_moment_is_the_mean_cosine() {
        for (name, phase) in EXAMPLES.iter() {
            let lack = phase.lacks_of_moments(1)[0];
            let expected = 1.0 - f64::from(phase.mean_cosine());
            assert!((lack - expected).abs() < 5e-4 * expected + 1.2e-7, "{name}: {lack} {expected}");
        }
    }

    #[test]
    fn moments_of_closed_forms() {
        for g in [0.3_f32, 0.86, -0.5, 0.999, 0.9999] {
            let lacks = PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g }).lacks_of_moments(4);
            for (lack, k) in lacks.iter().zip(1..) {
                let expected = 1.0 - f64::from(g).powi(k);
                assert!((lack / expected - 1.0).abs() < 2e-5, "g {g}, k {k}: {lack} {expected}");
            }
        }
        let rayleigh = PhaseFunction::Rayleigh(Rayleigh).lacks_of_moments(4);
        for (lack, expected) in rayleigh.iter().zip([1.0, 0.9, 1.0, 1.0]) {
            assert!((lack - expected).abs() < 1e-6, "{rayleigh:?}");
        }
    }

    #[test]
    fn polynomials_in_closed_form() {
        for i in 0..=20 {
            let c = f64::from(i) / 10.0 - 1.0;
            let expected = [1.0, c, 1.5 * c * c - 0.5, 2.5 * c * c * c - 1.5 * c];
            for (k, value) in expected.into_iter().enumerate() {
                assert!((legendre(k, c) - value).abs() < 1e-14, "{k} {c}");
            }
        }
    }
}
