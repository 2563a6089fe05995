//! Reads `[media.NAME]`: refractive index, coefficients, emission, phase function and density, or what a model makes of
//! what is in it.

use std::collections::BTreeMap;

use super::allowed::Allowed;
use super::error::SceneError;
use super::nearest::suggestion;
use super::value::Value;
use super::{AbsorptionDescription, DensityDescription, MediumDescription};
use super::{coefficients, density, models, phase, spectrum_value};
use crate::optics::RefractiveIndex;
use crate::optics::particles::Mixture;
use crate::optics::phase::{Isotropic, PhaseFunction};
use crate::optics::refractive_index::REFERENCE_WAVELENGTH;
use crate::spectrum::Spectrum;

/// The medium that every scene has.
pub(super) const AIR: &str = "air";

/// Temperature in degrees Celsius and salinity in parts per thousand of sea water.
const SEA_WATER: (f32, f32) = (10.0, 35.0);

/// The media of a scene that defines none.
pub(super) fn air_alone() -> BTreeMap<String, MediumDescription> {
    BTreeMap::from([(AIR.to_owned(), MediumDescription::default())])
}

/// Reads every `[media.NAME]`.
pub(super) fn read(value: &Value<'_>) -> Result<BTreeMap<String, MediumDescription>, SceneError> {
    let mut media = air_alone();
    let table = value.table("tables such as [media.sea]")?;
    for (name, value) in table.entries() {
        if name.get_ref().trim().is_empty() {
            return Err(
                table.invalid_key(name, "a medium needs a name: write for example [media.sea]".to_owned())
            );
        }
        media.insert(name.get_ref().to_string(), medium(&value)?);
    }
    Ok(media)
}

/// The name of a medium that the scene defines; `user` says what needs it.
pub(super) fn existing_medium<T>(
    value: &Value<'_>,
    media: &BTreeMap<String, T>,
    user: &str,
) -> Result<String, SceneError> {
    let name = value.text("the name of a medium")?;
    if media.contains_key(name) {
        return Ok(name.to_owned());
    }
    let known: Vec<&str> = media.keys().map(String::as_str).collect();
    let near = suggestion(name, &known, "the media of this scene are");
    Err(value.invalid(format!("{user} needs a medium [media.{name}], which is not there: {near}")))
}

pub(super) fn medium(value: &Value<'_>) -> Result<MediumDescription, SceneError> {
    let table = value.table("a table such as [media.sea]")?;
    let emission = table.get("emission");
    let default = MediumDescription {
        emission: emission.as_ref().map_or(Ok(Spectrum::Constant(0.0)), spectrum_value::radiance)?,
        density: table.get("density").map_or(Ok(DensityDescription::Homogeneous), |v| density::read(&v))?,
        ..MediumDescription::default()
    };
    let medium = match table.get("model") {
        Some(model) => {
            let model = models::read(&table, &model)?;
            MediumDescription { ior: model.mixture.host.index.clone(), model: Some(model), ..default }
        }
        None => {
            let coefficients = coefficients::read(&table, absorption)?;
            MediumDescription {
                ior: table.get("ior").map_or(Ok(default.ior), |v| ior(&v))?,
                absorption: coefficients.absorption,
                scattering: coefficients.scattering,
                extinction: coefficients.extinction,
                phase: table.get("phase").map_or(Ok(default.phase), |v| phase::read(&v))?,
                ..default
            }
        }
    };
    table.finish()?;
    match emission {
        Some(value) if !medium.emission.is_zero() && !medium.absorbs() => Err(value.invalid(
            "a medium emits as it absorbs, and this one absorbs nothing: give it `absorption`, or remove `emission`",
        )),
        _ => Ok(medium),
    }
}

impl AbsorptionDescription {
    /// What is given in 1/m, or what the imaginary part of an index implies.
    pub fn or_implied(given: Option<&Self>, ior: &RefractiveIndex) -> Spectrum {
        let implied = |index: &RefractiveIndex| index.absorption().unwrap_or(Spectrum::Constant(0.0));
        match given {
            Some(Self::Spectrum(spectrum)) => spectrum.clone(),
            Some(Self::Water) => implied(&RefractiveIndex::Water { temperature: 20.0, salinity: 0.0 }),
            Some(Self::Ice) => implied(&RefractiveIndex::Ice),
            None => implied(ior),
        }
    }
}

impl MediumDescription {
    /// Absorption in 1/m of a medium without a model, as given or implied by its index.
    pub fn absorbed(&self) -> Spectrum {
        AbsorptionDescription::or_implied(self.absorption.as_ref(), &self.ior)
    }

    /// What a user should know about it: formulas outside of their range.
    pub fn warnings(&self) -> Vec<String> {
        match &self.model {
            Some(model) => model.warnings.clone(),
            None => self.ior.warning().into_iter().collect(),
        }
    }

    /// Whether anything is absorbed.
    fn absorbs(&self) -> bool {
        match (&self.model, &self.extinction) {
            // Of particles alone k is what absorbs.
            (Some(model), _) => {
                let absorbing = |index: &RefractiveIndex| index.k(REFERENCE_WAVELENGTH) > 0.0;
                let Mixture { host, species } = &model.mixture;
                !host.absorption.is_zero() || species.iter().any(|species| absorbing(&species.index))
            }
            (None, Some(given)) => !given.extinction.is_zero() && given.albedo != Spectrum::Constant(1.0),
            (None, None) => !self.absorbed().is_zero(),
        }
    }
}

impl Default for MediumDescription {
    /// Clear, with index 1: air.
    fn default() -> Self {
        Self {
            ior: RefractiveIndex::Constant(1.0),
            absorption: None,
            scattering: Spectrum::Constant(0.0),
            extinction: None,
            emission: Spectrum::Constant(0.0),
            phase: PhaseFunction::Isotropic(Isotropic).into(),
            density: DensityDescription::Homogeneous,
            model: None,
        }
    }
}

/// Substances with measured tables.
#[derive(Clone, Copy)]
enum Substance {
    Water,
    Ice,
}

const SUBSTANCES: [(&str, Substance); 2] = [("water", Substance::Water), ("ice", Substance::Ice)];

/// `ior = ..`
pub(super) fn ior(value: &Value<'_>) -> Result<RefractiveIndex, SceneError> {
    const FORMS: &str =
        "a number, { table = \"water\" }, { table = \"ice\" }, or { wavelength = [..], n = [..], k = [..] }";
    if value.is_number() {
        return Ok(RefractiveIndex::Constant(value.number32(&Allowed::POSITIVE)?));
    }
    let table = value.table(FORMS)?;
    let ior = match table.get("table").map(|v| v.choice(&SUBSTANCES)).transpose()? {
        Some(Substance::Water) => {
            let number = |key, allowed, default| table.get(key).map_or(Ok(default), |v| v.number32(allowed));
            RefractiveIndex::Water {
                temperature: number("temperature", &Allowed::CELSIUS_OF_WATER, SEA_WATER.0)?,
                salinity: number("salinity", &Allowed::SALINITY_OF_WATER, SEA_WATER.1)?,
            }
        }
        Some(Substance::Ice) => RefractiveIndex::Ice,
        None => {
            let wavelengths = spectrum_value::wavelengths(&table)?;
            let count = wavelengths.len();
            let n = spectrum_value::samples(&table, "n", &Allowed::POSITIVE, count)?;
            let k = match table.get("k") {
                Some(_) => spectrum_value::samples(&table, "k", &Allowed::NOT_NEGATIVE, count)?,
                None => vec![0.0; count],
            };
            RefractiveIndex::Table { wavelengths, n, k }
        }
    };
    table.finish()?;
    Ok(ior)
}

/// `absorption = ..`
pub(super) fn absorption(value: &Value<'_>) -> Result<AbsorptionDescription, SceneError> {
    if !value.has_key("table") {
        let spectrum = spectrum_value::spectrum(value, &Allowed::NOT_NEGATIVE)?;
        return Ok(AbsorptionDescription::Spectrum(spectrum));
    }
    let table = value.table("{ table = \"water\" }")?;
    let substance = table.require("table", "write \"water\" or \"ice\"")?.choice(&SUBSTANCES)?;
    table.finish()?;
    Ok(match substance {
        Substance::Water => AbsorptionDescription::Water,
        Substance::Ice => AbsorptionDescription::Ice,
    })
}
