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

use serde::{Deserialize, Serialize};

use super::super::lorenz_mie::{Efficiencies, Sphere, efficiencies};
use super::quadrature::Quadrature;
use super::{Host, Mixture, MixtureError, Species};
use crate::spectrum::curve::interpolate;
use crate::spectrum::{LaneMode, Role, Spectrum, Wavelengths};

/// Coefficients of a mixture, each at every wavelength.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
    /// Bound of the relative errors of extinction and scattering, and of the error of g, that come from taking integrals
    /// over radius at some radii: how far the same rule is off with a third of them, at the worst wavelength. What is
    /// absorbed is as exact relative to the extinction; that of spheres which hardly absorb comes from resonances narrower
    /// than any step, and is known to a tenth.
    pub relative_error: f64,
}

/// What one species does, without its host, at every wavelength.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpeciesBulk {
    /// Name of the species.
    pub name: String,
    /// Its share of the whole volume.
    pub volume_fraction: f64,
    /// Extinction in 1/m; may be negative in a host that absorbs.
    pub sigma_t: Vec<f64>,
    /// Scattering in 1/m.
    pub sigma_s: Vec<f64>,
    /// Mean cosine of the angle of scattering.
    pub g: Vec<f64>,
}

impl Bulk {
    /// What it has of all these wavelengths in nm; `None` where it lacks one. The error stays that of all that it has.
    pub fn at(&self, wavelengths: &[f64]) -> Option<Self> {
        let places = wavelengths.iter().map(|w| self.wavelengths.iter().position(|other| other == w));
        let places: Vec<usize> = places.collect::<Option<_>>()?;
        let of = |values: &[f64]| places.iter().map(|i| values[*i]).collect();
        let species = |s: &SpeciesBulk| SpeciesBulk {
            sigma_t: of(&s.sigma_t),
            sigma_s: of(&s.sigma_s),
            g: of(&s.g),
            ..s.clone()
        };
        Some(Self {
            wavelengths: wavelengths.to_vec(),
            n: of(&self.n),
            sigma_a: of(&self.sigma_a),
            sigma_s: of(&self.sigma_s),
            g: of(&self.g),
            species: self.species.iter().map(species).collect(),
            relative_error: self.relative_error,
        })
    }
}

impl Mixture {
    /// What the mixture absorbs and scatters at some wavelengths in nm, in any order.
    ///
    /// # Errors
    /// What is wrong with the mixture, or a wavelength that is none.
    pub fn bulk(&self, wavelengths: &[f64]) -> Result<Bulk, MixtureError> {
        self.validate()?;
        if let Some(&value) = wavelengths.iter().find(|w| !(w.is_finite() && **w > 0.0)) {
            return Err(MixtureError::Wavelength { value });
        }
        let sums: Vec<Vec<[Sums; 2]>> =
            self.species.iter().map(|s| s.sums(&self.host, wavelengths)).collect::<Result<_, _>>()?;
        let mut bulk = Bulk {
            wavelengths: wavelengths.to_vec(),
            n: wavelengths.iter().map(|&lambda| self.host.index.n(lambda)).collect(),
            sigma_a: Vec::new(),
            sigma_s: Vec::new(),
            g: Vec::new(),
            species: self.species.iter().zip(&sums).map(|(s, sums)| s.bulk(sums)).collect(),
            relative_error: 0.0,
        };
        for (i, &lambda) in wavelengths.iter().enumerate() {
            let host = self.host.sums(lambda)?;
            let [whole, coarse] = [0, 1].map(|rule| sums.iter().fold(host, |sum, s| sum.plus(&s[i][rule])));
            bulk.sigma_a.push((whole.extinction - whole.scattering).max(0.0)); // (2)
            bulk.sigma_s.push(whole.scattering); // (1)
            bulk.g.push(whole.g());
            bulk.relative_error = bulk.relative_error.max(whole.error(&coarse));
        }
        Ok(bulk)
    }
}

impl Species {
    /// The integrals at each wavelength, by all radii and by a third of them.
    fn sums(&self, host: &Host, wavelengths: &[f64]) -> Result<Vec<[Sums; 2]>, MixtureError> {
        if self.volume_fraction == 0.0 {
            return Ok(vec![[Sums::default(); 2]; wavelengths.len()]);
        }
        let Quadrature { radii, numbers } = Quadrature::new(&self.sizes);
        let at = |&lambda: &f64| self.spheres(host, &radii, lambda);
        let spheres: Vec<Vec<Sphere>> = wavelengths.iter().map(at).collect::<Result<_, _>>()?;
        let found = efficiencies(&spheres.concat());
        let of_one = |found: &[Efficiencies]| {
            let mut sums = [Sums::default(); 2];
            for ((e, r), numbers) in found.iter().zip(&radii).zip(&numbers) {
                for (sum, number) in sums.iter_mut().zip(numbers) {
                    sum.add(e, PI * r * r * number * self.volume_fraction);
                }
            }
            sums
        };
        Ok(found.chunks(radii.len()).map(of_one).collect())
    }

    fn bulk(&self, sums: &[[Sums; 2]]) -> SpeciesBulk {
        SpeciesBulk {
            name: self.name.clone(),
            volume_fraction: self.volume_fraction,
            sigma_t: sums.iter().map(|s| s[0].extinction).collect(),
            sigma_s: sums.iter().map(|s| s[0].scattering).collect(),
            g: sums.iter().map(|s| s[0].g()).collect(),
        }
    }
}

impl Host {
    /// What the host itself does.
    fn sums(&self, lambda: f64) -> Result<Sums, MixtureError> {
        let [absorption, scattering] = self.coefficients_at(lambda);
        for (coefficient, value) in [("absorption", absorption), ("molecular scattering", scattering)] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(MixtureError::Host { coefficient, wavelength: lambda, value });
            }
        }
        Ok(Sums { extinction: absorption + scattering, scattering, forward: 0.0 })
    }

    /// Absorption, and scattering of the molecules, in 1/m.
    pub(super) fn coefficients_at(&self, lambda: f64) -> [f64; 2] {
        let molecular = self.molecular.as_ref().map_or(0.0, |spectrum| at(spectrum, lambda));
        [at(&self.absorption, lambda), molecular]
    }
}

/// Coefficients at one wavelength, in 1/m.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    extinction: f64,
    scattering: f64,
    /// g times the scattering.
    forward: f64,
}

impl Sums {
    /// Adds spheres of a shadow, in 1/m.
    fn add(&mut self, e: &Efficiencies, shadow: f64) {
        self.extinction += e.extinction * shadow;
        self.scattering += e.scattering * shadow;
        // A sphere that scatters nothing has no g.
        self.forward += if e.scattering > 0.0 { e.asymmetry * e.scattering * shadow } else { 0.0 };
    }

    fn plus(&self, other: &Self) -> Self {
        Self {
            extinction: self.extinction + other.extinction,
            scattering: self.scattering + other.scattering,
            forward: self.forward + other.forward,
        }
    }

    fn g(&self) -> f64 {
        if self.scattering > 0.0 { self.forward / self.scattering } else { 0.0 } // (3)
    }

    /// How far another rule is off.
    fn error(&self, other: &Self) -> f64 {
        let relative = |a: f64, b: f64| if a == b { 0.0 } else { (b / a - 1.0).abs() };
        relative(self.extinction, other.extinction)
            .max(relative(self.scattering, other.scattering))
            .max((self.g() - other.g()).abs())
    }
}

/// A coefficient at one wavelength.
fn at(spectrum: &Spectrum, lambda: f64) -> f64 {
    match spectrum {
        Spectrum::Constant(value) => f64::from(*value),
        Spectrum::Table { wavelengths, values } => interpolate(wavelengths, values, lambda),
        _ => {
            let curve = spectrum.prepare(Role::Coefficient, LaneMode::Spectral);
            f64::from(curve.lanes(&Wavelengths::single(lambda as f32)).x)
        }
    }
}
