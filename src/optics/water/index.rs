//! The refractive index of pure and sea water.
//!
//! ```text
//! n = 1.31405 + (1.779e-4 - 1.05e-6 T + 1.6e-8 T^2) S - 2.02e-6 T^2
//!     + (15.868 + 0.01155 S - 0.00423 T) / lambda - 4382 / lambda^2 + 1.1455e6 / lambda^3        [QUAN95]
//! ```
//! T in degrees Celsius, S in parts per thousand, lambda in nm. The index is relative to *air*, which is what a scene
//! whose air has index 1 needs. The coefficient of S is 1.779e-4; some programs have 1.799e-4, which is 7e-5 too much
//! at S = 35. The fit was made for [`TEMPERATURE_RANGE`], [`SALINITY_RANGE`] and [`FITTED_WAVELENGTHS`]; from 380 to
//! 400 and from 700 to 780 nm it is an extrapolation.

/// Temperatures in degrees Celsius for which the index was fitted.
pub const TEMPERATURE_RANGE: [f32; 2] = [0.0, 30.0];
/// Salinities in parts per thousand for which the index was fitted.
pub const SALINITY_RANGE: [f32; 2] = [0.0, 35.0];
/// Wavelengths in nm for which the index was fitted.
pub const FITTED_WAVELENGTHS: [f32; 2] = [400.0, 700.0];

/// Refractive index relative to air.
pub fn refractive_index(lambda_nm: f64, temperature: f64, salinity: f64) -> f64 {
    let (l, t, s) = (lambda_nm, temperature, salinity);
    1.31405 + (1.779e-4 - 1.05e-6 * t + 1.6e-8 * t * t) * s - 2.02e-6 * t * t
        + (15.868 + 0.01155 * s - 0.00423 * t) / l
        - 4382.0 / (l * l)
        + 1.1455e6 / (l * l * l)
}

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
}
