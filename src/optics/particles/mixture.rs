//! What is in a fluid or in ice: a host and what it carries.

use std::f64::consts::PI;

use super::super::RefractiveIndex;
use super::super::lorenz_mie::{Complex64, Sphere};
use super::{MixtureError, SizeDistribution};
use crate::spectrum::Spectrum;

/// A host and what it carries.
#[derive(Clone, Debug, PartialEq)]
pub struct Mixture {
    /// What everything else lies in.
    pub host: Host,
    /// Particles of several kinds.
    pub species: Vec<Species>,
}

/// What particles lie in.
#[derive(Clone, Debug, PartialEq)]
pub struct Host {
    /// n + ik that waves at the particles have. The absorption that k implies is not added to [`Self::absorption`].
    pub index: RefractiveIndex,
    /// All that the host absorbs, in 1/m, with what is dissolved in it.
    pub absorption: Spectrum,
    /// Scattering by the host's own molecules, in 1/m.
    pub molecular: Option<Spectrum>,
}

/// Particles of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Species {
    /// What messages call them.
    pub name: String,
    /// n + ik of what they are made of.
    pub index: RefractiveIndex,
    /// How many there are of each radius.
    pub sizes: SizeDistribution,
    /// Their share of the whole volume, from 0 to 1.
    pub volume_fraction: f64,
}

impl Mixture {
    /// # Errors
    /// What is wrong with the species, whatever the wavelength.
    pub(super) fn validate(&self) -> Result<(), MixtureError> {
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
    /// Spheres of this matter in a host, one of each radius in m, at a wavelength in nm.
    pub(super) fn spheres(
        &self,
        host: &Host,
        radii: &[f64],
        lambda: f64,
    ) -> Result<Vec<Sphere>, MixtureError> {
        let at = |index: &RefractiveIndex| Complex64::new(index.n(lambda), index.k(lambda));
        let (particle, surroundings) = (at(&self.index), at(&host.index));
        let sphere = |&radius: &f64| {
            Sphere::new(particle, surroundings, 2.0 * PI * radius / (lambda * 1e-9)).map_err(|source| {
                MixtureError::Sphere { species: self.name.clone(), radius, wavelength: lambda, source }
            })
        };
        radii.iter().map(sphere).collect()
    }
}
