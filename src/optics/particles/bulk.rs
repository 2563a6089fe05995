//! What a mixture absorbs and scatters.
//!
//! ```text
//! sigma_s = sigma_m + sum over species of integral C_sca N dr                                         (1)
//! sigma_t = sigma_h + sigma_m + sum over species of integral C_ext N dr,   sigma_a = sigma_t - sigma_s (2)
//! g       = sum over species of integral g C_sca N dr / sigma_s                                       (3)
//! ```
//!
//! sigma_h is the host's absorption, sigma_m the scattering of its molecules, whose g is 0. In a host that absorbs C_ext
//! may be negative, so the sum is what is cut at 0 `[FRISVAD07]`.

use std::f64::consts::PI;

use rayon::prelude::*;

use super::super::lorenz_mie::{Coefficients, Complex64, Efficiencies, Sphere};
use super::{Host, Mixture, MixtureError, Species};
use crate::spectrum::curve::interpolate;
use crate::spectrum::{LaneMode, Role, Spectrum, Wavelengths};

/// Coefficients of a mixture, each at every wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct Bulk {
    /// Wavelengths in nm.
    pub wavelengths: Vec<f64>,
    /// Real refractive index of the host.
    pub n: Vec<f64>,
    /// Absorption in 1/m, with that of the host.
    pub sigma_a: Vec<f64>,
    /// Scattering in 1/m, with that of the host's molecules.
    pub sigma_s: Vec<f64>,
    /// Mean cosine of the angle of scattering.
    pub g: Vec<f64>,
    /// What each species does, in the order of the mixture.
    pub species: Vec<SpeciesBulk>,
    /// Estimate of the greatest relative error of the integrals over radius.
    pub relative_error: f64,
}

/// What one species does, without its host, at every wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct SpeciesBulk {
    /// Name of the species.
    pub name: String,
    /// Extinction in 1/m; may be negative in a host that absorbs.
    pub sigma_t: Vec<f64>,
    /// Scattering in 1/m.
    pub sigma_s: Vec<f64>,
    /// Mean cosine of the angle of scattering.
    pub g: Vec<f64>,
}

const NODES: usize = 400;

impl Mixture {
    /// What the mixture absorbs and scatters at some wavelengths in nm, in any order.
    ///
    /// # Errors
    /// What is wrong with the mixture.
    pub fn bulk(&self, wavelengths: &[f64]) -> Result<Bulk, MixtureError> {
        self.validate()?;
        let species: Vec<SpeciesBulk> =
            self.species.iter().map(|s| s.bulk(&self.host, wavelengths)).collect::<Result<_, _>>()?;
        let mut bulk = Bulk {
            wavelengths: wavelengths.to_vec(),
            n: Vec::new(),
            sigma_a: Vec::new(),
            sigma_s: Vec::new(),
            g: Vec::new(),
            species,
            relative_error: 0.0,
        };
        for (i, &lambda) in wavelengths.iter().enumerate() {
            let host = at(&self.host.absorption, lambda);
            let molecular = self.host.molecular.as_ref().map_or(0.0, |s| at(s, lambda));
            let sum = |f: &dyn Fn(&SpeciesBulk) -> f64| bulk.species.iter().map(f).sum::<f64>();
            let scattered = molecular + sum(&|s| s.sigma_s[i]); // (1)
            let absorbed = (host + sum(&|s| s.sigma_t[i] - s.sigma_s[i])).max(0.0); // (2)
            let ahead = sum(&|s| s.g[i] * s.sigma_s[i]); // (3)
            bulk.n.push(self.host.index.n(lambda));
            bulk.sigma_a.push(absorbed);
            bulk.sigma_s.push(scattered);
            bulk.g.push(if scattered > 0.0 { ahead / scattered } else { 0.0 });
        }
        Ok(bulk)
    }

    fn validate(&self) -> Result<(), MixtureError> {
        for Species { name, volume_fraction, sizes, .. } in &self.species {
            if !(0.0..=1.0).contains(volume_fraction) {
                return Err(MixtureError::VolumeFraction { species: name.clone(), value: *volume_fraction });
            }
            sizes.validate().map_err(|source| MixtureError::Sizes { species: name.clone(), source })?;
        }
        let sum: f64 = self.species.iter().map(|s| s.volume_fraction).sum();
        if sum > 1.0 {
            let names: Vec<&str> = self.species.iter().map(|s| s.name.as_str()).collect();
            return Err(MixtureError::NoRoom { species: names.join(", "), sum });
        }
        Ok(())
    }
}

impl Species {
    fn bulk(&self, host: &Host, wavelengths: &[f64]) -> Result<SpeciesBulk, MixtureError> {
        let sums: Vec<[f64; 3]> =
            wavelengths.par_iter().map(|&lambda| self.at(host, lambda)).collect::<Result<_, _>>()?;
        let g = |s: &[f64; 3]| if s[1] > 0.0 { s[2] / s[1] } else { 0.0 };
        Ok(SpeciesBulk {
            name: self.name.clone(),
            sigma_t: sums.iter().map(|s| s[0]).collect(),
            sigma_s: sums.iter().map(|s| s[1]).collect(),
            g: sums.iter().map(g).collect(),
        })
    }

    fn at(&self, host: &Host, lambda: f64) -> Result<[f64; 3], MixtureError> {
        let index = |i: &super::super::RefractiveIndex| Complex64::new(i.n(lambda), i.k(lambda));
        let (particle, surroundings) = (index(&self.index), index(&host.index));
        let [least, greatest] = self.sizes.range().map(libm::log);
        let mut sums = [0.0; 3];
        let mut volume = 0.0;
        for i in 0..NODES {
            let r = libm::exp(least + (greatest - least) * (i as f64 + 0.5) / NODES as f64);
            let number = self.sizes.number(r) * r;
            volume += 4.0 / 3.0 * PI * r.powi(3) * number;
            let sphere =
                Sphere::new(particle, surroundings, 2.0 * PI * r / (lambda * 1e-9)).map_err(|source| {
                    MixtureError::Sphere { species: self.name.clone(), radius: r, wavelength: lambda, source }
                })?;
            let Efficiencies { extinction, scattering, asymmetry, .. } =
                Coefficients::new(sphere).efficiencies();
            let area = PI * r * r * number;
            sums[0] += extinction * area;
            sums[1] += scattering * area;
            sums[2] += asymmetry * scattering * area;
        }
        Ok(sums.map(|s| s / volume * self.volume_fraction))
    }
}

/// A coefficient at one wavelength.
fn at(spectrum: &Spectrum, lambda: f64) -> f64 {
    match spectrum {
        Spectrum::Constant(value) => f64::from(*value),
        Spectrum::Table { wavelengths, values } => interpolate(wavelengths, values, lambda),
        _ => {
            let path = Wavelengths { lambda: [lambda as f32; 4], pdf: [1.0; 4] };
            f64::from(spectrum.prepare(Role::Coefficient, LaneMode::Spectral).lanes(&path).x)
        }
    }
}
