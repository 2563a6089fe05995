//! Whereto a mixture scatters.

use std::f64::consts::PI;

use super::{Bulk, Cache, Mixture, MixtureError};

/// Coefficients and phase function of a mixture.
#[derive(Clone, Debug, PartialEq)]
pub struct Scattering {
    /// What it absorbs and scatters.
    pub bulk: Bulk,
    /// Whereto it scatters.
    pub phase: EnsemblePhase,
}

/// Phase function of a mixture at some wavelengths.
#[derive(Clone, Debug, PartialEq)]
pub struct EnsemblePhase {
    /// Wavelengths in nm, rising.
    pub wavelengths: Vec<f64>,
    /// Angles of scattering in radians from 0 to pi, rising; the same at all wavelengths, dense at both ends.
    pub angles: Vec<f64>,
    /// Density per steradian at each angle, normalised, at each wavelength.
    pub values: Vec<Vec<f64>>,
}

impl Mixture {
    /// Coefficients and phase function over the visible spectrum, from the cache where it has them.
    ///
    /// # Errors
    /// What is wrong with the mixture.
    pub fn scattering(&self, _cache: &Cache) -> Result<Scattering, MixtureError> {
        let wavelengths: Vec<f64> = (0..9).map(|i| 380.0 + 50.0 * f64::from(i)).collect();
        let bulk = self.bulk(&wavelengths)?;
        let angles: Vec<f64> = (0..=180).map(|i| PI * f64::from(i) / 180.0).collect();
        let lobe = |g: &f64| {
            let density = |a: &f64| {
                let base = 1.0 + g * g - 2.0 * g * libm::cos(*a);
                (1.0 - g * g) / (4.0 * PI * base * base.sqrt())
            };
            angles.iter().map(density).collect()
        };
        let values = bulk.g.iter().map(lobe).collect();
        Ok(Scattering { bulk, phase: EnsemblePhase { wavelengths, angles, values } })
    }
}
