//! How much brine and air are in ice, from its temperature, salinity and density.
//!
//! ```text
//! v_brine = rho S / F1(T)                                                                              (1)
//! v_air   = 1 - rho / rho_i + rho S F2(T) / F1(T)                                                      (2)
//! rho_i   = 0.917 - 1.403e-4 T                                                                         (3)
//! ```
//! `[COX83]`, rho in g/cm^3 here, T in degrees Celsius, S in parts per thousand; salts that crystallise take room as well.
//! F1 and F2 are polynomials that change where salts do, at -22.9 degrees; above -2 degrees they are those of
//! `[LEPPARANTA88]`. The coefficients are the same in six programs and were not read in the papers. Some programs
//! exchange the two sides of -22.9 degrees.
//!
//! Valid for [`TEMPERATURE_RANGE`]. Next to 0 degrees F1 goes to 0: ice with salt in it melts.

use std::fmt;

use super::super::particles::SizesError;

/// Temperatures in degrees Celsius for which brine and air are known.
pub const TEMPERATURE_RANGE: [f64; 2] = [-30.0, 0.0];

/// What is left of 1 by ice without air is off by some bits of 1.
const ROUNDING: f64 = 1e-12;

/// Shares of the volume of ice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IceContents {
    /// v_brine, (1).
    pub brine: f64,
    /// v_air, (2).
    pub air: f64,
}

/// Ice that cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum IceError {
    /// Denser than ice and brine without any air.
    #[error(
        "ice of {density} kg/m^3 at {temperature} degrees and {salinity} parts per thousand would have less than no air \
         ({air:.3e} of its volume): it has none at {densest:.3} kg/m^3; write at most that"
    )]
    TooDense {
        /// kg/m^3.
        density: f64,
        /// Degrees Celsius.
        temperature: f64,
        /// Parts per thousand.
        salinity: f64,
        /// v_air.
        air: f64,
        /// The density in kg/m^3 of such ice without air.
        densest: f64,
    },
    /// More brine than there is room for.
    #[error(
        "ice of {salinity} parts per thousand and {density:.1} kg/m^3 at {temperature} degrees would be brine and air \
         altogether: nothing of it is frozen; write a lower temperature or salinity"
    )]
    Melted {
        /// Parts per thousand.
        salinity: f64,
        /// kg/m^3.
        density: f64,
        /// Degrees Celsius.
        temperature: f64,
    },
    /// Sizes of inclusions that cannot be.
    #[error(transparent)]
    Sizes(#[from] SizesError),
}

/// Brine and air in ice of a temperature in degrees Celsius within [`TEMPERATURE_RANGE`], a salinity in parts per
/// thousand and a density in kg/m^3.
///
/// # Errors
/// Ice of this salinity and density cannot be at this temperature.
pub fn contents(temperature: f64, salinity: f64, density: f64) -> Result<IceContents, IceError> {
    let (rho, pure) = (density * 1e-3, pure_ice_density(temperature));
    let Factors { f1, f2 } = factors(temperature);
    // Pure ice has no brine even where F1 is 0.
    let of_salt = if salinity == 0.0 { 0.0 } else { salinity / f1 };
    let brine = rho * of_salt; // (1)
    let air = 1.0 - rho / pure + brine * f2; // (2)
    if !(brine >= 0.0 && brine + air.max(0.0) < 1.0) {
        return Err(IceError::Melted { salinity, density, temperature });
    }
    if air < -ROUNDING {
        let densest = self::density(temperature, salinity, 0.0);
        return Err(IceError::TooDense { density, temperature, salinity, air, densest });
    }
    Ok(IceContents { brine, air: if air < ROUNDING { 0.0 } else { air } })
}

/// The density in kg/m^3 of ice with a share of air, by (2) the other way round; infinite where nothing of it is frozen.
pub fn density(temperature: f64, salinity: f64, air: f64) -> f64 {
    let pure = pure_ice_density(temperature);
    let Factors { f1, f2 } = factors(temperature);
    let of_salt = if salinity == 0.0 { 0.0 } else { salinity / f1 };
    1e3 * (1.0 - air) * pure / (1.0 - pure * of_salt * f2)
}

/// rho_i in g/cm^3, (3).
fn pure_ice_density(temperature: f64) -> f64 {
    0.917 - 1.403e-4 * temperature
}

struct Factors {
    f1: f64,
    f2: f64,
}

fn factors(t: f64) -> Factors {
    let cubic = |[c0, c1, c2, c3]: [f64; 4]| c0 + t * (c1 + t * (c2 + t * c3));
    let [f1, f2] = if t > -2.0 {
        [[-4.1221e-2, -18.407, 0.58402, 0.21454], [9.0312e-2, -1.6111e-2, 1.2291e-4, 1.3603e-4]]
    } else if t >= -22.9 {
        [[-4.732, -22.45, -0.6397, -0.01074], [8.903e-2, -1.763e-2, -5.330e-4, -8.801e-6]]
    } else {
        [[9899.0, 1309.0, 55.27, 0.7160], [8.547, 1.089, 4.518e-2, 5.819e-4]]
    };
    Factors { f1: cubic(f1), f2: cubic(f2) }
}

impl fmt::Display for IceContents {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.3} % brine, {:.3} % air", 100.0 * self.brine, 100.0 * self.air)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Frankenstein and Garner's formula for the same, v_brine = 1e-3 S (-49.185 / T + 0.532), is a fit with an error of
    /// some per cent, made for -0.5 to -22.9 degrees. Measured here: 0.9 to 9.7 %, most at -20 degrees.
    #[test]
    fn brine_is_near_to_another_formula() {
        for temperature in [-20.0, -15.0, -10.0, -5.0, -2.5] {
            let found = contents(temperature, 5.0, 900.0).unwrap().brine;
            let other = 5e-3 * (-49.185 / temperature + 0.532);
            assert!((found / other - 1.0).abs() < 0.1, "{temperature}: {found} {other}");
        }
    }

    #[test]
    fn pieces_of_the_polynomials_meet() {
        for (at, most) in [(-2.0, 0.02), (-22.9, 0.02)] {
            let [below, above] = [at - 1e-9, at + 1e-9].map(factors);
            assert!((below.f1 / above.f1 - 1.0).abs() < most, "{at}: {} {}", below.f1, above.f1);
            assert!((below.f2 / above.f2 - 1.0).abs() < most, "{at}: {} {}", below.f2, above.f2);
        }
    }

    #[test]
    fn the_densest_ice_that_is_named_is_the_densest() {
        for (temperature, salinity) in [(-5.0, 5.0), (-25.0, 3.0), (-1.0, 1.0), (-15.0, 0.0)] {
            let Err(IceError::TooDense { densest, .. }) = contents(temperature, salinity, 1000.0) else {
                panic!()
            };
            assert!(contents(temperature, salinity, densest).unwrap().air < 1e-9);
            assert!(contents(temperature, salinity, densest + 0.01).is_err());
        }
    }

    #[test]
    fn pure_ice_has_no_brine_and_salt_ice_melts_before_0_degrees() {
        assert_eq!(contents(0.0, 0.0, 917.0).unwrap(), IceContents { brine: 0.0, air: 0.0 });
        for temperature in [0.0, -0.001, -0.002, -0.05] {
            let error = contents(temperature, 5.0, 900.0).unwrap_err();
            assert!(matches!(error, IceError::Melted { .. }), "{error}");
        }
        assert!(contents(f64::NAN, 5.0, 900.0).is_err());
    }
}
