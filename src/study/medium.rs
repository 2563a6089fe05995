//! What a medium does to light, as numbers and diagrams: `floe optics`.
//!
//! A [`MediumStudy`] names the medium and the wavelengths; [`MediumStudy::run`] computes a [`MediumReport`]. That is
//! shown as text ([`text`]), comma-separated values ([`csv`]), JSON ([`MediumReport::json`]) and diagrams ([`diagrams`]);
//! two of them are compared by a [`Comparison`].
//!
//! Colours are of white light, D65 of luminance 1, over whole nanometres: of what gets straight through a column of d
//! metres, exp(-sigma_t d); of daylight in that depth, exp(-K d); and of an endless depth, R. K and R are those of
//! [`crate::optics::apparent`].

pub mod colour;
pub mod comparison;
pub mod csv;
pub mod diagrams;
mod measure;
mod phase;
pub mod quantity;
pub mod text;

use serde::Serialize;

use crate::optics::RefractiveIndex;
use crate::optics::medium::Medium;
use crate::optics::particles::{EnsemblePhase, Mixture, SpeciesBulk};
use crate::scene::description::{MediumDescription, Model, ModelPhase};

pub use colour::Colour;
pub use comparison::Comparison;

/// What is to be computed.
#[derive(Clone, Debug)]
pub struct MediumStudy {
    /// What results call the medium.
    pub name: String,
    /// The medium.
    pub subject: Subject,
    /// What is to be known of it.
    pub warnings: Vec<String>,
    /// Wavelengths of the tables in nm, rising.
    pub wavelengths: Vec<f64>,
    /// Length of the column in m.
    pub column: f64,
}

/// Where coefficients come from.
#[derive(Clone, Debug)]
pub enum Subject {
    /// From what is in it.
    Mixture {
        /// The host and its particles.
        mixture: Mixture,
        /// Which phase function it has.
        phase: ModelPhase,
    },
    /// As given, over wavelength.
    Given {
        /// Its index.
        index: RefractiveIndex,
        /// Its coefficients and phase function.
        medium: Box<Medium>,
    },
}

/// What a medium does to light. Lists have an entry a wavelength; nothing here depends on the machine or the time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MediumReport {
    /// What it is called.
    pub medium: String,
    /// Wavelengths in nm.
    pub wavelengths: Vec<f64>,
    /// Real refractive index of the host.
    pub n: Vec<f64>,
    /// Absorption in 1/m.
    pub sigma_a: Vec<f64>,
    /// Scattering in 1/m.
    pub sigma_s: Vec<f64>,
    /// Extinction in 1/m.
    pub sigma_t: Vec<f64>,
    /// Scattering over extinction; 0 where there is none.
    pub albedo: Vec<f64>,
    /// Mean cosine of the angle of scattering.
    pub g: Vec<f64>,
    /// sigma_s (1 - g) in 1/m.
    pub reduced_sigma_s: Vec<f64>,
    /// b_b, what is scattered back, in 1/m.
    pub backscattering: Vec<f64>,
    /// K in 1/m.
    pub diffuse_attenuation: Vec<f64>,
    /// R of an endless depth.
    pub reflectance: Vec<f64>,
    /// What each species does, without its host.
    pub species: Vec<SpeciesBulk>,
    /// Estimate of the greatest relative error of integrals over radius.
    pub quadrature_error: f64,
    /// Colours of a column.
    pub column: Column,
    /// The colour of an endless depth, seen straight from above, without a surface.
    pub depth: Colour,
    /// What is to be known of it.
    pub warnings: Vec<String>,
    /// Where light goes; JSON has it only where it is asked for.
    #[serde(skip)]
    pub phase: EnsemblePhase,
    /// Whether the scattering of its particles was in the cache; no file says so.
    #[serde(skip)]
    pub was_kept: bool,
}

/// Colours of white light behind a length of the medium.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Column {
    /// The length in m.
    pub length: f64,
    /// Of what goes straight through.
    pub straight: Colour,
    /// Of daylight in that depth.
    pub diffuse: Colour,
}

impl Subject {
    /// What a model computes, with what is to be known of it; `None` for a medium without a model.
    pub fn of_model(medium: &MediumDescription) -> Option<(Self, Vec<String>)> {
        let Model { mixture, phase, warnings, .. } = medium.model.clone()?;
        Some((Self::Mixture { mixture, phase }, warnings))
    }
}

impl MediumReport {
    /// Everything as JSON, in as many digits as tell a number from every other.
    pub fn json(&self, with_phase: bool) -> String {
        text_of(&self.value(with_phase))
    }

    /// The same for a larger document.
    fn value(&self, with_phase: bool) -> serde_json::Value {
        let mut value = serde_json::to_value(self).unwrap_or_default();
        if with_phase && let Some(object) = value.as_object_mut() {
            object.insert("phase".into(), phase::json(&self.phase));
        }
        value
    }
}

fn text_of(value: &serde_json::Value) -> String {
    serde_json::to_string_pretty(value).unwrap_or_default() + "\n"
}

#[cfg(test)]
mod tests;
