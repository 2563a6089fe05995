//! Pure ice: refractive index and absorption.
//!
//! ```text
//! sigma_a = 4 pi k / lambda
//! ```
//! n and k of ice Ih at 266 K after Warren and Brandt `[WARREN08]`, at 10 nm steps from 390 to 780 nm and at 350 nm
//! below. Linear in n and in log k between the entries, constant beyond them. From 350 to 390 nm k is so small
//! (2e-11) that its own source calls it an upper bound.

use std::f64::consts::PI;

/// Refractive index.
pub fn refractive_index(lambda_nm: f64) -> f64 {
    let (below, above, t) = neighbours(lambda_nm);
    below[1] + (above[1] - below[1]) * t
}

/// Imaginary part of the index.
pub fn extinction_index(lambda_nm: f64) -> f64 {
    let (below, above, t) = neighbours(lambda_nm);
    below[2] * libm::pow(above[2] / below[2], t)
}

/// Absorption coefficient in 1/m.
pub fn absorption(lambda_nm: f64) -> f64 {
    4.0 * PI * extinction_index(lambda_nm) / (lambda_nm * 1e-9)
}

/// The entries on both sides of a wavelength and the fraction of the way between them.
fn neighbours(lambda_nm: f64) -> ([f64; 3], [f64; 3], f64) {
    let above = NK.partition_point(|entry| entry[0] <= lambda_nm).clamp(1, NK.len() - 1);
    let (below, above) = (NK[above - 1], NK[above]);
    (below, above, ((lambda_nm - below[0]) / (above[0] - below[0])).clamp(0.0, 1.0))
}

/// Wavelength in nm, n, k `[WARREN08]`.
const NK: [[f64; 3]; 41] = [
    [350.0, 1.3249, 2e-11],
    [390.0, 1.3203, 2e-11],
    [400.0, 1.3194, 2.365e-11],
    [410.0, 1.3185, 2.669e-11],
    [420.0, 1.3177, 3.135e-11],
    [430.0, 1.317, 4.14e-11],
    [440.0, 1.3163, 6.268e-11],
    [450.0, 1.3157, 9.239e-11],
    [460.0, 1.3151, 1.325e-10],
    [470.0, 1.3145, 1.956e-10],
    [480.0, 1.314, 2.861e-10],
    [490.0, 1.3135, 4.172e-10],
    [500.0, 1.313, 5.889e-10],
    [510.0, 1.3126, 8.036e-10],
    [520.0, 1.3121, 1.076e-9],
    [530.0, 1.3117, 1.409e-9],
    [540.0, 1.3114, 1.813e-9],
    [550.0, 1.311, 2.289e-9],
    [560.0, 1.3106, 2.839e-9],
    [570.0, 1.3103, 3.461e-9],
    [580.0, 1.31, 4.159e-9],
    [590.0, 1.3097, 4.93e-9],
    [600.0, 1.3094, 5.73e-9],
    [610.0, 1.3091, 6.89e-9],
    [620.0, 1.3088, 8.58e-9],
    [630.0, 1.3085, 1.04e-8],
    [640.0, 1.3083, 1.22e-8],
    [650.0, 1.308, 1.43e-8],
    [660.0, 1.3078, 1.66e-8],
    [670.0, 1.3076, 1.89e-8],
    [680.0, 1.3073, 2.09e-8],
    [690.0, 1.3071, 2.4e-8],
    [700.0, 1.3069, 2.9e-8],
    [710.0, 1.3067, 3.44e-8],
    [720.0, 1.3065, 4.03e-8],
    [730.0, 1.3062, 4.3e-8],
    [740.0, 1.306, 4.92e-8],
    [750.0, 1.3059, 5.87e-8],
    [760.0, 1.3057, 7.08e-8],
    [770.0, 1.3055, 8.58e-8],
    [780.0, 1.3053, 1.02e-7],
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_the_published_ones() {
        for (lambda, n, k) in [(400.0, 1.3194, 2.365e-11), (550.0, 1.3110, 2.289e-9), (700.0, 1.3069, 2.9e-8)]
        {
            assert!((refractive_index(lambda) - n).abs() < 1e-12);
            assert!((extinction_index(lambda) / k - 1.0).abs() < 1e-12);
        }
    }

    /// 4 pi 2.289e-9 / 550 nm = 0.0523 1/m, and ice is clearest in the violet: 4 pi 2e-11 / 390 nm = 6.4e-4 1/m.
    #[test]
    fn absorption_is_worked_out_from_k() {
        assert!((absorption(550.0) - 0.0523).abs() < 1e-5);
        assert!((absorption(390.0) - 6.444e-4).abs() < 1e-7);
    }

    #[test]
    fn k_is_interpolated_in_its_logarithm() {
        let (low, high) = (extinction_index(440.0), extinction_index(450.0));
        assert!((extinction_index(445.0) / (low * high).sqrt() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn beyond_the_table_the_ends_go_on() {
        assert_eq!(refractive_index(800.0), refractive_index(780.0));
        assert_eq!(extinction_index(300.0), 2e-11);
    }
}
