//! Quantile and tail of the distribution that tests of pictures need.
//!
//! They are those of `statrs`, checked against published tables. Degrees of freedom need not be whole; below the least
//! that has a meaning, or where a number is none, a result is NaN.

use statrs::distribution::{ContinuousCDF, StudentsT};

/// x such that Student's t is less with the given probability.
pub fn student_quantile(probability: f64, degrees_of_freedom: f64) -> f64 {
    match StudentsT::new(0.0, 1.0, degrees_of_freedom) {
        Ok(t) if is_probability(probability) => t.inverse_cdf(probability),
        _ => f64::NAN,
    }
}

/// Probability that Student's t is further from 0 than x.
pub fn student_two_sided(x: f64, degrees_of_freedom: f64) -> f64 {
    // The lower tail has its digits however small it is.
    StudentsT::new(0.0, 1.0, degrees_of_freedom).map_or(f64::NAN, |t| 2.0 * t.cdf(-x.abs()))
}

fn is_probability(probability: f64) -> bool {
    (0.0..=1.0).contains(&probability)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(got: f64, want: f64, digits: i32) {
        // Tables are rounded to their last digit.
        assert!((got / want - 1.0).abs() <= 0.51 * f64::powi(10.0, 1 - digits), "{got} {want}");
    }

    /// Abramowitz and Stegun, table 26.10; the far tails from closed forms: for two degrees of freedom
    /// P(|t| > x) = 1 - x / (2 + x^2)^(1/2), and for one 2 / pi atan(1 / x).
    #[test]
    fn quantiles_are_the_tables() {
        for (p, degrees, t) in [
            (0.975, 1.0, 12.706),
            (0.975, 3.0, 3.1824),
            (0.995, 3.0, 5.8409),
            (0.9995, 6.0, 5.9588),
            (0.975, 30.0, 2.0423),
            (0.025, 120.0, -1.9799),
        ] {
            close(student_quantile(p, degrees), t, 5);
            close(student_two_sided(student_quantile(p, degrees), degrees), 2.0 * p.min(1.0 - p), 8);
        }
    }

    #[test]
    fn far_tails_keep_their_digits() {
        for x in [10.0_f64, 1e3, 1e5] {
            // 1 - x / (2 + x^2)^(1/2) without its cancellation.
            let root = (2.0 + x * x).sqrt();
            close(student_two_sided(-x, 2.0), 2.0 / (root * (root + x)), 8);
            close(student_two_sided(x, 1.0), 2.0 / std::f64::consts::PI * (1.0 / x).atan(), 8);
        }
        // Many degrees of freedom are the normal distribution, but for x^4 / (4 f).
        let normal = libm::erfc(6.0 / f64::sqrt(2.0));
        assert!((student_two_sided(6.0, 1e7) / normal - 1.0).abs() < 1e-4);
    }

    #[test]
    fn what_has_no_answer_is_not_a_number() {
        assert!(student_quantile(0.5, 0.0).is_nan() && student_two_sided(1.0, -1.0).is_nan());
        assert!(student_quantile(1.5, 3.0).is_nan() && student_quantile(f64::NAN, 3.0).is_nan());
        assert!(student_quantile(0.5, f64::NAN).is_nan());
    }
}
