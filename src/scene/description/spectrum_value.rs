//! Reads a quantity over wavelength: a number, RGB, a table, and for lights a black body or the sun's measured spectrum.

use super::allowed::Allowed;
use super::document::Table;
use super::error::SceneError;
use super::value::Value;
use crate::spectrum::luminance::LUMENS_PER_WATT;
use crate::spectrum::{Spectrum, solar};

const FORMS: &str = "a number, [r, g, b], or { wavelength = [..], value = [..] }";
const LIGHT_FORMS: &str = "a number, [r, g, b], { wavelength = [..], value = [..] }, or { blackbody = .. }";
const SUN_FORMS: &str = "{ table = \"astm-g173\", scale = 1.0 }";

/// Reads one number.
type ReadNumber<'a> = dyn Fn(&Value<'_>) -> Result<f32, SceneError> + 'a;

/// Number | RGB | `{ wavelength = [..], value = [..] }`, each number within a range.
pub(super) fn spectrum(value: &Value<'_>, allowed: &Allowed) -> Result<Spectrum, SceneError> {
    read(value, allowed, FORMS)
}

/// The radiance of a light: as [`spectrum`], or `{ blackbody = K }` for what a body of that temperature
/// emits.
pub(super) fn radiance(value: &Value<'_>) -> Result<Spectrum, SceneError> {
    if !value.has_key("blackbody") {
        return read(value, &Allowed::NOT_NEGATIVE, LIGHT_FORMS);
    }
    let table = value.table(LIGHT_FORMS)?;
    let temperature =
        table.require("blackbody", "write a temperature in kelvin")?.number32(&Allowed::KELVIN)?;
    table.finish()?;
    Ok(Spectrum::Planck { temperature })
}

/// The irradiance of a light: as [`spectrum`], `{ blackbody = K, illuminance = lux }` or `{ table = "astm-g173" }`.
pub(super) fn irradiance(value: &Value<'_>) -> Result<Spectrum, SceneError> {
    if value.has_key("table") {
        return table_of_the_sun(value);
    }
    if !value.has_key("blackbody") && !value.has_key("illuminance") {
        return read(value, &Allowed::NOT_NEGATIVE, LIGHT_FORMS);
    }
    let table = value.table(LIGHT_FORMS)?;
    let temperature = table.require("blackbody", "write a temperature in kelvin, such as 5778")?;
    let illuminance = table.require("illuminance", "write the illuminance in lux, such as 100000")?;
    let spectrum = Spectrum::Blackbody {
        temperature: temperature.number32(&Allowed::KELVIN_OF_LIGHT)?,
        luminance: illuminance.number32(&Allowed::NOT_NEGATIVE)? / LUMENS_PER_WATT as f32,
    };
    table.finish()?;
    Ok(spectrum)
}

/// `{ table = "astm-g173", scale = 1 }`
fn table_of_the_sun(value: &Value<'_>) -> Result<Spectrum, SceneError> {
    let table = value.table(SUN_FORMS)?;
    table.require("table", "write \"astm-g173\"")?.choice(&[("astm-g173", ())])?;
    let scale = table.get("scale").map_or(Ok(1.0), |v| v.number32(&Allowed::NOT_NEGATIVE))?;
    table.finish()?;
    Ok(solar::direct(f64::from(scale)))
}

/// A share as [`spectrum`], and what it leaves of 1: taken before both are rounded, so that it has its digits where it
/// is next to nothing.
pub(super) fn share_and_rest(value: &Value<'_>) -> Result<[Spectrum; 2], SceneError> {
    let rest = |v: &Value<'_>| Ok((1.0 - v.number(&Allowed::UNIT)?) as f32);
    Ok([spectrum(value, &Allowed::UNIT)?, read_by(value, FORMS, &rest)?])
}

fn read(value: &Value<'_>, allowed: &Allowed, forms: &str) -> Result<Spectrum, SceneError> {
    read_by(value, forms, &|v| v.number32(allowed))
}

fn read_by(value: &Value<'_>, forms: &str, number: &ReadNumber<'_>) -> Result<Spectrum, SceneError> {
    if value.is_table() {
        let table = value.table(forms)?;
        let wavelengths = wavelengths(&table)?;
        let values = samples_by(&table, "value", number, wavelengths.len())?;
        table.finish()?;
        Ok(Spectrum::Table { wavelengths, values })
    } else if value.is_array() {
        Ok(Spectrum::Rgb(value.triple(forms, number)?))
    } else if value.is_number() {
        Ok(Spectrum::Constant(number(value)?))
    } else {
        Err(value.invalid(format!("write {forms}")))
    }
}

/// `wavelength = [..]`: strictly rising, in nanometres.
pub(super) fn wavelengths(table: &Table<'_>) -> Result<Vec<f32>, SceneError> {
    let forms = "rising wavelengths in nanometres, such as [400, 550, 700]";
    let value = table.require("wavelength", &format!("write {forms}"))?;
    let elements = value.elements(forms)?;
    let mut wavelengths = Vec::with_capacity(elements.len());
    for element in &elements {
        let wavelength = element.number32(&Allowed::WAVELENGTH)?;
        if wavelengths.last().is_some_and(|&last| last >= wavelength) {
            return Err(element.invalid("wavelengths must rise strictly: sort them and keep each once"));
        }
        wavelengths.push(wavelength);
    }
    if wavelengths.is_empty() {
        return Err(value.invalid(format!("write {forms}")));
    }
    Ok(wavelengths)
}

/// One number for each wavelength.
pub(super) fn samples(
    table: &Table<'_>,
    key: &'static str,
    allowed: &Allowed,
    count: usize,
) -> Result<Vec<f32>, SceneError> {
    samples_by(table, key, &|v| v.number32(allowed), count)
}

fn samples_by(
    table: &Table<'_>,
    key: &'static str,
    number: &ReadNumber<'_>,
    count: usize,
) -> Result<Vec<f32>, SceneError> {
    let value = table.require(key, "write one number for each wavelength")?;
    let numbers = value.elements("one number for each wavelength")?;
    if numbers.len() != count {
        let found = numbers.len();
        return Err(value.invalid(format!("{found} numbers for {count} wavelengths: write one for each")));
    }
    numbers.iter().map(number).collect()
}
