//! Reads `model = ..` of a medium: what is in it, from which its index, absorption and scattering are computed.
//!
//! Each model has a reader here; what they make is a [`Mixture`]. Keys that say what the model computes are errors.

mod iceberg;
mod milk;
mod natural_water;
mod particles;

use super::document::Table;
use super::error::SceneError;
use super::phase;
use super::value::Value;
use crate::optics::particles::Mixture;
use crate::optics::phase::MediumPhase;
use crate::optics::{ice, water};

/// A medium that is computed from what is in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Which model.
    pub kind: ModelKind,
    /// The host and what it carries.
    pub mixture: Mixture,
    /// Where scattered light goes.
    pub phase: ModelPhase,
    /// What a user should know about it: formulas outside of their range.
    pub warnings: Vec<String>,
}

/// `model`
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModelKind {
    /// Water with minerals, algae and what is dissolved in it.
    NaturalWater,
    /// Ice with air and brine.
    Iceberg,
    /// Milk.
    Milk,
    /// Any host with any spheres.
    Particles,
}

/// `phase` of a medium with a model.
#[derive(Clone, Debug, PartialEq)]
pub enum ModelPhase {
    /// As computed, at each wavelength.
    LorenzMie,
    /// One lobe with the computed mean cosine, at each wavelength.
    HenyeyGreenstein,
    /// Another in its place.
    Given(MediumPhase),
}

impl ModelKind {
    /// Every model.
    pub const ALL: [Self; 4] = [Self::NaturalWater, Self::Iceberg, Self::Milk, Self::Particles];

    /// The names of its presets.
    pub fn presets(self) -> Vec<&'static str> {
        fn names<T>(presets: &[(&'static str, T)]) -> Vec<&'static str> {
            presets.iter().map(|(name, _)| *name).collect()
        }
        match self {
            Self::NaturalWater => names(&water::natural::PRESETS),
            Self::Iceberg => names(&ice::iceberg::PRESETS),
            Self::Milk => names(&crate::optics::milk::PRESETS),
            Self::Particles => Vec::new(),
        }
    }

    /// Its name in the scene file.
    pub fn name(self) -> &'static str {
        match self {
            Self::NaturalWater => "natural-water",
            Self::Iceberg => "iceberg",
            Self::Milk => "milk",
            Self::Particles => "particles",
        }
    }

    /// What the model computes and the file therefore must not say.
    fn computed(self) -> &'static [&'static str] {
        const ALL: [&str; 8] = [
            "scattering",
            "extinction",
            "albedo",
            "mass_absorption",
            "mass_scattering",
            "mass_concentration",
            "absorption",
            "ior",
        ];
        match self {
            Self::Particles => &ALL[..6],
            _ => &ALL,
        }
    }

    fn read(self, table: &Table<'_>) -> Result<Contents, SceneError> {
        match self {
            Self::NaturalWater => natural_water::read(table),
            Self::Iceberg => iceberg::read(table),
            Self::Milk => milk::read(table),
            Self::Particles => particles::read(table),
        }
    }
}

/// What is in a medium, and what a user should know about it.
struct Contents {
    mixture: Mixture,
    warnings: Vec<String>,
}

/// Computed phase functions, and whether one lobe stands for them.
const COMPUTED: [(&str, bool); 2] = [("lorenz-mie", false), ("henyey-greenstein", true)];

/// How it is computed, or a phase function as other media have it.
fn model_phase(value: &Value<'_>) -> Result<ModelPhase, SceneError> {
    if value.is_table() {
        return phase::read(value).map(ModelPhase::Given);
    }
    Ok(if value.choice(&COMPUTED)? { ModelPhase::HenyeyGreenstein } else { ModelPhase::LorenzMie })
}

/// Reads the model of the medium in `table`, whose key `model` has this value.
pub(super) fn read(table: &Table<'_>, value: &Value<'_>) -> Result<Model, SceneError> {
    let kind = value.choice(&ModelKind::ALL.map(|kind| (kind.name(), kind)))?;
    if let Some(given) = kind.computed().iter().find_map(|key| table.get(key)) {
        return Err(given.invalid(format!(
            "\"{}\" computes this from what is in it: remove this, or `model`",
            kind.name()
        )));
    }
    let phase = table.get("phase").map_or(Ok(ModelPhase::LorenzMie), |v| model_phase(&v))?;
    let Contents { mixture, mut warnings } = kind.read(table)?;
    warnings.extend(mixture.host.index.warning());
    // At no wavelength: whether the volumes and sizes can be.
    mixture.bulk(&[]).map_err(|error| value.invalid(error.to_string()))?;
    Ok(Model { kind, mixture, phase, warnings })
}

/// A preset by its name, or what stands for all others.
fn preset<T: Copy>(table: &Table<'_>, presets: &[(&str, T)], default: T) -> Result<T, SceneError> {
    table.get("preset").map_or(Ok(default), |v| v.choice(presets))
}
