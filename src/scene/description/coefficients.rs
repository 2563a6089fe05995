//! Reads what a medium absorbs and scatters.
//!
//! Each of absorption and scattering is given per metre, or per metre and concentration (a mass coefficient in m^2/kg
//! with `mass_concentration` in kg/m^3); or both follow from `extinction` and `albedo`. What contradicts is an error.

use super::allowed::Allowed;
use super::document::Table;
use super::error::SceneError;
use super::spectrum_value;
use super::value::Value;
use super::{AbsorptionDescription, ExtinctionDescription};
use crate::spectrum::Spectrum;

/// Absorption and scattering of a medium, in any of the ways to give them.
pub(super) struct Coefficients {
    pub absorption: Option<AbsorptionDescription>,
    pub scattering: Spectrum,
    pub extinction: Option<ExtinctionDescription>,
}

/// Reads the keys of a medium's table; `absorption` reads the key of that name.
pub(super) fn read(
    table: &Table<'_>,
    absorption: impl Fn(&Value<'_>) -> Result<AbsorptionDescription, SceneError>,
) -> Result<Coefficients, SceneError> {
    let [absorbing, scattering] = ["absorption", "scattering"].map(|key| table.get(key));
    let [mass_absorption, mass_scattering] = ["mass_absorption", "mass_scattering"].map(|key| table.get(key));
    let [extinction, albedo] = ["extinction", "albedo"].map(|key| table.get(key));
    let concentration = table.get("mass_concentration");
    if extinction.is_some() || albedo.is_some() {
        let others = [&absorbing, &scattering, &mass_absorption, &mass_scattering, &concentration];
        if let Some(other) = others.into_iter().flatten().next() {
            return Err(other.invalid(
                "`extinction` and `albedo` say already what is absorbed and scattered: remove this or them",
            ));
        }
        let extinction = table.require("extinction", "`albedo` is a share of it: write it in 1/m")?;
        let albedo = table.require("albedo", "write the share of scattering in `extinction`, from 0 to 1")?;
        let [albedo, absorbed] = spectrum_value::share_and_rest(&albedo)?;
        let extinction = spectrum_value::spectrum(&extinction, &Allowed::NOT_NEGATIVE)?;
        let extinction = ExtinctionDescription { extinction, albedo, absorbed };
        let scattering = Spectrum::Constant(0.0);
        return Ok(Coefficients { absorption: None, scattering, extinction: Some(extinction) });
    }
    for (given, by_mass) in [(&absorbing, &mass_absorption), (&scattering, &mass_scattering)] {
        if let (Some(_), Some(by_mass)) = (given, by_mass) {
            return Err(by_mass.invalid("this is given per metre as well: remove one of the two"));
        }
    }
    let concentration = match (&mass_absorption, &mass_scattering, concentration) {
        (None, None, None) => 0.0,
        (None, None, Some(value)) => {
            return Err(value.invalid(
                "nothing is multiplied by it: write `mass_absorption` or `mass_scattering` in m^2/kg, or remove it",
            ));
        }
        (_, _, Some(value)) => value.number32(&Allowed::NOT_NEGATIVE)?,
        (..) => {
            let cure = "mass coefficients need it: write the concentration in kg/m^3";
            table.require("mass_concentration", cure)?.number32(&Allowed::NOT_NEGATIVE)?
        }
    };
    let by_mass = |value: &Value<'_>| scaled(value, concentration);
    Ok(Coefficients {
        absorption: match (absorbing, mass_absorption) {
            (Some(value), _) => Some(absorption(&value)?),
            (None, Some(value)) => Some(AbsorptionDescription::Spectrum(by_mass(&value)?)),
            (None, None) => None,
        },
        scattering: match (scattering, mass_scattering) {
            (Some(value), _) => spectrum_value::spectrum(&value, &Allowed::NOT_NEGATIVE)?,
            (None, Some(value)) => by_mass(&value)?,
            (None, None) => Spectrum::Constant(0.0),
        },
        extinction: None,
    })
}

/// A mass coefficient times a concentration.
fn scaled(value: &Value<'_>, concentration: f32) -> Result<Spectrum, SceneError> {
    let times = |v: f32| v * concentration;
    let product = match spectrum_value::spectrum(value, &Allowed::NOT_NEGATIVE)? {
        Spectrum::Constant(v) => Spectrum::Constant(times(v)),
        Spectrum::Rgb(rgb) => Spectrum::Rgb(rgb.map(times)),
        Spectrum::Table { wavelengths, values } => {
            Spectrum::Table { wavelengths, values: values.into_iter().map(times).collect() }
        }
        thermal => thermal,
    };
    let finite = match &product {
        Spectrum::Constant(v) => v.is_finite(),
        Spectrum::Rgb(rgb) => rgb.iter().all(|v| v.is_finite()),
        Spectrum::Table { values, .. } => values.iter().all(|v| v.is_finite()),
        Spectrum::Blackbody { .. } | Spectrum::Planck { .. } => true,
    };
    if finite {
        Ok(product)
    } else {
        Err(value
            .invalid("times `mass_concentration` it leaves single precision: make one of the two smaller"))
    }
}
