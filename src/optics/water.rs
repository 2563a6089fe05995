//! Pure and sea water: refractive index and absorption.
//!
//! ```text
//! n = 1.31405 + (1.779e-4 - 1.05e-6 T + 1.6e-8 T^2) S - 2.02e-6 T^2
//!     + (15.868 + 0.01155 S - 0.00423 T) / lambda - 4382 / lambda^2 + 1.1455e6 / lambda^3        [QUAN95]
//! ```
//! T in degrees Celsius, S in parts per thousand, lambda in nm. The index is relative to *air*, which is what a scene
//! whose air has index 1 needs. The coefficient of S is 1.779e-4; some programs have 1.799e-4, which is 7e-4 too much
//! at S = 35. The fit was made for [`TEMPERATURE_RANGE`], [`SALINITY_RANGE`] and [`FITTED_WAVELENGTHS`]; from 380 to
//! 400 and from 700 to 780 nm it is an extrapolation.
//!
//! Absorption is that of pure water at 22 degrees: Pope and Fry `[POPE97]` from 380 to 725 nm, and from 730 nm Kou et al.
//! `[KOU93]` as compiled in `[IOCCG18]`. Below 420 nm later measurements are lower (0.0046 1/m at 400 nm). What is left
//! out, from the same compilation: at 35 parts per thousand salt adds 30 % at 400 nm, 5 % at 460 nm and about 1 %
//! above 500 nm; ten degrees add up to 4 % below 725 nm and 6 % near 740 nm.

/// Temperatures in degrees Celsius for which the index was fitted.
pub const TEMPERATURE_RANGE: [f32; 2] = [0.0, 30.0];
/// Salinities in parts per thousand for which the index was fitted.
pub const SALINITY_RANGE: [f32; 2] = [0.0, 35.0];
/// Wavelengths in nm for which the index was fitted.
pub const FITTED_WAVELENGTHS: [f32; 2] = [400.0, 700.0];

const FIRST: f64 = 380.0;
const STEP: f64 = 5.0;

/// Refractive index relative to air.
pub fn refractive_index(lambda_nm: f64, temperature: f64, salinity: f64) -> f64 {
    let (l, t, s) = (lambda_nm, temperature, salinity);
    1.31405 + (1.779e-4 - 1.05e-6 * t + 1.6e-8 * t * t) * s - 2.02e-6 * t * t
        + (15.868 + 0.01155 * s - 0.00423 * t) / l
        - 4382.0 / (l * l)
        + 1.1455e6 / (l * l * l)
}

/// Absorption coefficient of pure water in 1/m, linear between 5 nm steps, constant beyond 380 and 780 nm.
pub fn absorption(lambda_nm: f64) -> f64 {
    let last = ABSORPTION.len() - 1;
    let position = ((lambda_nm - FIRST) / STEP).clamp(0.0, last as f64);
    let index = (position as usize).min(last - 1);
    ABSORPTION[index] + (ABSORPTION[index + 1] - ABSORPTION[index]) * (position - index as f64)
}

/// 1/m from 380 nm in steps of 5 nm: `[POPE97]` to 725 nm, `[KOU93]` from 730 nm.
#[rustfmt::skip]
const ABSORPTION: [f64; 81] = [
    0.01137, 0.00941, 0.00851, 0.00813, 0.00663, 0.00530, 0.00473, 0.00444, 0.00454,
    0.00478, 0.00495, 0.00530, 0.00635, 0.00751, 0.00922, 0.00962, 0.00979, 0.01011,
    0.0106, 0.0114, 0.0127, 0.0136, 0.0150, 0.0173, 0.0204, 0.0256, 0.0325,
    0.0396, 0.0409, 0.0417, 0.0434, 0.0452, 0.0474, 0.0511, 0.0565, 0.0596,
    0.0619, 0.0642, 0.0695, 0.0772, 0.0896, 0.1100, 0.1351, 0.1672, 0.2224,
    0.2577, 0.2644, 0.2678, 0.2755, 0.2834, 0.2916, 0.3012, 0.3108, 0.325,
    0.340, 0.371, 0.410, 0.429, 0.439, 0.448, 0.465, 0.486, 0.516,
    0.559, 0.624, 0.704, 0.827, 1.007, 1.231, 1.489, 1.97, 2.51,
    2.78, 2.83, 2.85, 2.88, 2.86, 2.86, 2.82, 2.76, 2.69,
];

#[cfg(test)]
mod tests {
    use super::*;

    /// Water at 20 degrees and 589.3 nm has 1.33299 relative to air (1.33336 absolute, IAPWS); the fit's stated
    /// deviation is 1.5e-5 and more towards fresh water.
    #[test]
    fn pure_water_has_the_index_of_the_handbooks() {
        assert!((refractive_index(589.3, 20.0, 0.0) - 1.33299).abs() < 1e-4);
    }

    /// The formula worked out by hand for T = 20, S = 35 at 500 nm:
    /// 1.31405 + (1.779e-4 - 2.1e-5 + 6.4e-6) 35 - 8.08e-4 + (15.868 + 0.40425 - 0.0846) / 500 - 0.017528 + 0.009164
    /// = 1.31405 + 0.0057155 - 0.000808 + 0.0323753 - 0.017528 + 0.009164.
    #[test]
    fn sea_water_is_what_the_formula_says() {
        assert!((refractive_index(500.0, 20.0, 35.0) - 1.342_968_8).abs() < 1e-7);
    }

    #[test]
    fn the_index_falls_with_wavelength_and_temperature_and_rises_with_salt() {
        for lambda in (380..780).map(f64::from) {
            assert!(refractive_index(lambda + 1.0, 10.0, 20.0) < refractive_index(lambda, 10.0, 20.0));
            assert!(refractive_index(lambda, 25.0, 20.0) < refractive_index(lambda, 10.0, 20.0));
            assert!(refractive_index(lambda, 10.0, 35.0) > refractive_index(lambda, 10.0, 20.0));
        }
    }

    #[test]
    fn absorption_is_the_published_one() {
        for (lambda, published) in [
            (380.0, 0.01137),
            (420.0, 0.00454),
            (500.0, 0.0204),
            (550.0, 0.0565),
            (600.0, 0.2224),
            (650.0, 0.340),
            (700.0, 0.624),
            (725.0, 1.489),
            (760.0, 2.86),
            (780.0, 2.69),
        ] {
            assert_eq!(absorption(lambda), published, "{lambda} nm");
        }
        // Pope and Fry also measured between: 417.5 nm 0.00442, 652.5 nm lies between 0.340 and 0.371.
        assert!((absorption(417.5) - 0.00442).abs() < 1e-4);
        assert_eq!(absorption(300.0), 0.01137);
        assert_eq!(absorption(900.0), 2.69);
    }
}
