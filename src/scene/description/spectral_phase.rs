//! Reads phase functions over wavelength: `g = { wavelength = [..], value = [..] }` of Henyey and Greenstein's lobe, and a
//! table of values for each of several wavelengths.

use super::allowed::Allowed;
use super::document::Table;
use super::error::SceneError;
use super::phase::{angles, made, numbers};
use super::spectrum_value;
use super::value::Value;
use crate::optics::phase::SpectralPhase;

/// The phase function of a table that gives one over wavelength; `None` of every other.
pub(super) fn read(
    kind: &str,
    table: &Table<'_>,
    value: &Value<'_>,
) -> Result<Option<SpectralPhase>, SceneError> {
    match kind {
        "tabulated" if value.has_key("wavelength") => tabulated(table, value).map(Some),
        "henyey-greenstein" => table.get("g").filter(Value::is_table).map(|g| curve(&g)).transpose(),
        _ => Ok(None),
    }
}

fn curve(g: &Value<'_>) -> Result<SpectralPhase, SceneError> {
    let over_wavelength = spectrum_value::spectrum(g, &Allowed::MEAN_COSINE)?;
    made(g, SpectralPhase::henyey_greenstein(over_wavelength))
}

fn tabulated(table: &Table<'_>, value: &Value<'_>) -> Result<SpectralPhase, SceneError> {
    let wavelengths = spectrum_value::wavelengths(table)?;
    let angles = angles(table)?;
    let rows = table.require("value", "write a list of one number for each angle for each wavelength")?;
    let elements = rows.elements("a list of one number for each angle for each wavelength")?;
    if elements.len() != wavelengths.len() {
        let (found, count) = (elements.len(), wavelengths.len());
        return Err(rows.invalid(format!("{found} lists for {count} wavelengths: write one for each")));
    }
    let mut values = Vec::with_capacity(elements.len());
    for row in &elements {
        let numbers = numbers(row, angles.len())?;
        if numbers.iter().all(|number| *number == 0.0) {
            return Err(row.invalid("nothing is scattered at this wavelength: write a number above 0"));
        }
        values.push(numbers);
    }
    let wavelengths: Vec<f64> = wavelengths.into_iter().map(f64::from).collect();
    made(value, SpectralPhase::tabulated(&wavelengths, &angles, &values))
}
