//! Quantiles of the ratio of two independent estimates of one variance: Fisher's F.
//!
//! ```text
//! a = 1 - 2 / (9 d2)     b = 1 - 2 / (9 d1)     A = 2 / (9 d2)     C = 2 / (9 d1)
//! z = (a w - b) / (A w^2 + C)^(1/2)         with w = F^(1/3)                        (1)
//! ```
//!
//! z is standard normal, nearly: cube roots of chi-squares are (Wilson and Hilferty), so the ratio of two is Paulson's
//! normal number `[PAULSON42]`. d1 and d2 are the degrees of freedom of numerator and denominator. With d2 = 3 d1
//! the root of the upper end of 95 % is off by 5 % at one degree, by 0.1 % from five degrees on.

/// The ends of the interval that holds F with the given probability, equally often below and above.
///
/// The upper one is infinite where (1) has no solution: below a degree or so.
pub fn interval(d1: f64, d2: f64, probability: f64) -> (f64, f64) {
    let z = two_sided_normal_quantile(probability);
    let z2 = z * z;
    let (spread2, spread1) = (2.0 / (9.0 * d2), 2.0 / (9.0 * d1));
    let (a, b) = (1.0 - spread2, 1.0 - spread1);
    // (1) squared: p w^2 - 2 a b w + q = 0.
    let (p, q) = (a * a - z2 * spread2, b * b - z2 * spread1);
    let root = a * b + (a * a * b * b - p * q).max(0.0).sqrt();
    // Not `powi`, whose last bit is the platform's.
    let cube = |w: f64| w * w * w;
    let low = if q > 0.0 && b > 0.0 { cube(q / root) } else { 0.0 };
    let high = if p > 0.0 && a > 0.0 { cube(root / p) } else { f64::INFINITY };
    (low, high)
}

/// z such that a standard normal number lies within +-z with the given probability, by bisection.
///
/// Probabilities are clamped to [0, 1 - 1e-12].
fn two_sided_normal_quantile(probability: f64) -> f64 {
    let outside = 1.0 - probability.clamp(0.0, 1.0 - 1e-12);
    let (mut low, mut high) = (0.0, 10.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if libm::erfc(middle * std::f64::consts::FRAC_1_SQRT_2) > outside {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_the_tables() {
        // Abramowitz and Stegun, table 26.5.
        for (p, z) in [(0.0, 0.0), (0.5, 0.674_489_75), (0.95, 1.959_963_98), (0.99, 2.575_829_30)] {
            assert!((two_sided_normal_quantile(p) - z).abs() < 1e-8, "{p}");
        }
        assert!(two_sided_normal_quantile(1.0).is_finite());
    }

    /// Upper quantiles of 0.975 from tables of F; the first from Student's t of 3 degrees, 4.1765^2.
    #[test]
    fn ratios_are_the_tables() {
        for (d1, d2, high, tolerance) in [
            (1.0, 3.0, 17.44, 0.11),
            (2.0, 6.0, 7.26, 0.02),
            (5.0, 15.0, 3.576, 0.001),
            (20.0, 60.0, 1.944, 0.001),
        ] {
            let found = interval(d1, d2, 0.95).1;
            assert!((found / high - 1.0).abs() < tolerance, "{d1} {d2}: {found} for {high}");
            // F of (d2, d1) is 1 over F of (d1, d2).
            let low = interval(d2, d1, 0.95).0;
            assert!((low * found - 1.0).abs() < 1e-12, "{d1} {d2}: {low}");
        }
    }

    #[test]
    fn many_degrees_are_normal_and_few_are_endless() {
        let (low, high) = interval(1e6, 3e6, 0.95);
        let width = 1.959_964 * (2.0 / 1e6 + 2.0 / 3e6_f64).sqrt();
        assert!((high - 1.0 - width).abs() < 1e-5 && (1.0 - low - width).abs() < 1e-5, "{low} {high}");
        let (low, high) = interval(0.2, 0.6, 0.95);
        assert_eq!((low, high), (0.0, f64::INFINITY));
    }
}
