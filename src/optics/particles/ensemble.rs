//! Whereto a mixture scatters.
//!
//! ```text
//! p = (sigma_m p_m + sum over species of sigma_s p_s) / sigma_s                                       (1)
//! p_m = 3 / (4 pi (3 + p90)) (1 + p90 cos^2),   p90 = 0.835                                           (2)
//! ```
//!
//! p_s is the mean over the spheres of a species, each counting as much as it scatters; (2) is of the molecules of water
//! `[MOREL74]`. Between angles p is linear in the cosine, as tabulated phase functions take it, and between
//! wavelengths linear as well; both were chosen by what that leaves (`tests/particles`).

use std::f64::consts::PI;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::super::lorenz_mie::Pattern;
use super::angles::Angles;
use super::quadrature::Quadrature;
use super::{Bulk, Cache, Mixture, MixtureError};
use crate::spectrum::cie::{LAMBDA_MAX, LAMBDA_MIN};

/// Depolarised part of what molecules scatter, (2).
const P90: f64 = 0.835;

/// Steps of the coefficients from the first wavelength to the last.
const STEPS: u32 = 40;
/// Steps of the phase functions: of spheres of many sizes, which vary slowly, and of such as have rings. Both divide the
/// steps of the coefficients.
const PHASE_STEPS: [u32; 2] = [10, 20];

/// Coefficients and phase function of a mixture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scattering {
    /// What it absorbs and scatters.
    pub bulk: Bulk,
    /// Whereto it scatters.
    pub phase: EnsemblePhase,
}

/// Phase function of a mixture at some wavelengths.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
    pub fn scattering(&self, cache: &Cache) -> Result<Scattering, MixtureError> {
        self.scattering_kept(cache).map(|(scattering, _)| scattering)
    }

    /// The same, and whether the cache had it.
    ///
    /// # Errors
    /// What is wrong with the mixture.
    pub fn scattering_kept(&self, cache: &Cache) -> Result<(Scattering, bool), MixtureError> {
        self.validate()?;
        let mut was_kept = true;
        let coefficients = evenly(STEPS);
        let phases = evenly(PHASE_STEPS[usize::from(self.has_rings())]);
        let scattering = cache.remembered(&self.key(&coefficients, &phases), || {
            was_kept = false;
            let bulk = self.bulk(&coefficients)?;
            let phase = self.phase_of(&bulk, &phases)?;
            Ok(Scattering { bulk, phase })
        })?;
        Ok((scattering, was_kept))
    }

    /// Phase functions at some wavelengths in nm, rising.
    ///
    /// # Errors
    /// What is wrong with the mixture.
    pub fn phase(&self, wavelengths: &[f64]) -> Result<EnsemblePhase, MixtureError> {
        self.phase_of(&self.bulk(wavelengths)?, wavelengths)
    }

    /// Phase functions at some of the wavelengths of a bulk.
    fn phase_of(&self, bulk: &Bulk, wavelengths: &[f64]) -> Result<EnsemblePhase, MixtureError> {
        let angles = Angles::of(self, &bulk.wavelengths);
        let is_asked_for = |i: &usize| wavelengths.contains(&bulk.wavelengths[*i]);
        let chosen: Vec<usize> = (0..bulk.wavelengths.len()).filter(is_asked_for).collect();
        let values = chosen.into_par_iter().map(|i| self.phase_at(bulk, i, &angles));
        let values = values.collect::<Result<_, _>>()?;
        Ok(EnsemblePhase { wavelengths: wavelengths.to_vec(), values, angles: angles.radians() })
    }

    /// (1) at one wavelength.
    fn phase_at(&self, bulk: &Bulk, index: usize, angles: &Angles) -> Result<Vec<f64>, MixtureError> {
        let lambda = bulk.wavelengths[index];
        let cosines = angles.cosines();
        let [_, molecular] = self.host.coefficients_at(lambda);
        let of_molecules = |cos: &f64| molecular * 3.0 / (4.0 * PI * (3.0 + P90)) * (1.0 + P90 * cos * cos); // (2)
        let ahead: Vec<f64> = cosines.iter().map(of_molecules).collect();
        let mut ways = [ahead.clone(), ahead];
        for (species, found) in self.species.iter().zip(&bulk.species) {
            let scattered = found.sigma_s[index];
            if scattered > 0.0 {
                let (radii, numbers) = Quadrature::new(&species.sizes).coarse();
                let spheres = species.spheres(&self.host, &radii, lambda)?;
                let found = Pattern::new(&spheres, &numbers).both_ways(&cosines);
                for (sums, values) in ways.iter_mut().zip(found) {
                    sums.iter_mut().zip(values).for_each(|(sum, p)| *sum += scattered * p);
                }
            }
        }
        Ok(angles.normalised(ways))
    }
}

/// Wavelengths in nm.
fn evenly(steps: u32) -> Vec<f64> {
    (0..=steps).map(|i| LAMBDA_MIN + (LAMBDA_MAX - LAMBDA_MIN) * f64::from(i) / f64::from(steps)).collect()
}
