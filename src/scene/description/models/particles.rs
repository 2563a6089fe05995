//! Reads `model = "particles"`: any host and any spheres. Radii are in micrometres, as their keys say.

use super::super::AbsorptionDescription;
use super::super::allowed::Allowed;
use super::super::document::Table;
use super::super::error::SceneError;
use super::super::media::{absorption, ior};
use super::super::value::Value;
use super::Contents;
use crate::optics::particles::{Host, Mixture, SizeDistribution, Species};

const METRES: f64 = 1e-6;

const SPECIES: &str = "a list such as [{ ior = 1.5, volume_fraction = 1e-6, \
                       sizes = { kind = \"log-normal\", median_um = 1, deviation = 0.3 } }]";

const SIZES: &str = "{ kind = \"power-law\", exponent = 3.6, least_um = 0.1, greatest_um = 100 }, \
                     { kind = \"log-normal\", median_um = 1, deviation = 0.3 } or \
                     { kind = \"table\", radius_um = [..], number = [..] }";

type SizesReader = for<'t, 'v> fn(&'v Table<'t>) -> Result<SizeDistribution, SceneError>;

const SIZE_KINDS: [(&str, SizesReader); 3] =
    [("power-law", power_law), ("log-normal", log_normal), ("table", size_table)];

pub(super) fn read(table: &Table<'_>) -> Result<Contents, SceneError> {
    let index = table.require("ior", "write the index of what the particles lie in")?;
    let index = ior(&index)?;
    let given = table.get("absorption").map(|v| absorption(&v)).transpose()?;
    let list = table.require("species", &format!("write {SPECIES}"))?;
    let elements = list.elements(SPECIES)?;
    if elements.is_empty() {
        return Err(list.invalid(format!("write {SPECIES}")));
    }
    let species = elements.iter().enumerate().map(|(i, v)| one_species(v, i)).collect::<Result<_, _>>()?;
    let absorption = AbsorptionDescription::or_implied(given.as_ref(), &index);
    let host = Host { index, absorption, molecular: None };
    Ok(Contents { mixture: Mixture { host, species }, warnings: Vec::new() })
}

fn one_species(value: &Value<'_>, which: usize) -> Result<Species, SceneError> {
    let table = value.table("a table such as { ior = 1.5, volume_fraction = 1e-6, sizes = { .. } }")?;
    let name = table.get("name").map(|v| v.text("what these particles are called")).transpose()?;
    let index = ior(&table.require("ior", "write the index of the particles")?)?;
    let share =
        table.require("volume_fraction", "write the share of the volume that they take, such as 1e-6")?;
    let sizes = table.require("sizes", &format!("write {SIZES}"))?;
    let species = Species {
        name: name.map_or_else(|| format!("species {which}"), str::to_owned),
        index,
        sizes: read_sizes(&sizes)?,
        volume_fraction: share.number(&Allowed::VOLUME_FRACTION)?,
    };
    table.finish()?;
    Ok(species)
}

fn read_sizes(value: &Value<'_>) -> Result<SizeDistribution, SceneError> {
    let table = value.table(SIZES)?;
    let reader = table.require("kind", &format!("write {SIZES}"))?.choice(&SIZE_KINDS)?;
    let sizes = reader(&table)?;
    table.finish()?;
    Ok(sizes)
}

fn power_law(table: &Table<'_>) -> Result<SizeDistribution, SceneError> {
    let cure = "write a radius in micrometres";
    let least = METRES * table.require("least_um", cure)?.number(&Allowed::RADIUS)?;
    let end = table.require("greatest_um", cure)?;
    let greatest = METRES * end.number(&Allowed::RADIUS)?;
    if greatest <= least {
        return Err(end.invalid("the greatest radius must be above the least: exchange them"));
    }
    let exponent = table.require("exponent", "write how steeply the number falls, such as exponent = 3.6")?;
    Ok(SizeDistribution::PowerLaw { exponent: exponent.number(&Allowed::SIZE_EXPONENT)?, least, greatest })
}

fn log_normal(table: &Table<'_>) -> Result<SizeDistribution, SceneError> {
    let median = table.require("median_um", "write the radius in micrometres that half of them are below")?;
    let deviation = table.require("deviation", "write the standard deviation of ln r, such as 0.3")?;
    Ok(SizeDistribution::LogNormal {
        median: METRES * median.number(&Allowed::RADIUS)?,
        deviation: deviation.number(&Allowed::SIZE_DEVIATION)?,
    })
}

fn size_table(table: &Table<'_>) -> Result<SizeDistribution, SceneError> {
    const FORM: &str = "rising radii in micrometres, such as radius_um = [0.1, 1, 10]";
    let given = table.require("radius_um", &format!("write {FORM}"))?;
    let mut radii: Vec<f64> = Vec::new();
    for element in given.elements(FORM)? {
        let radius = METRES * element.number(&Allowed::RADIUS)?;
        if radii.last().is_some_and(|&last| last >= radius) {
            return Err(element.invalid("radii must rise strictly: sort them and keep each once"));
        }
        radii.push(radius);
    }
    let values = table.require("number", "write one relative number for each radius")?;
    let numbers = values.elements("one relative number for each radius")?;
    if numbers.len() != radii.len() || numbers.is_empty() {
        let (found, count) = (numbers.len(), radii.len());
        return Err(values.invalid(format!("{found} numbers for {count} radii: write one for each")));
    }
    let number: Vec<f64> =
        numbers.iter().map(|v| v.number(&Allowed::NOT_NEGATIVE)).collect::<Result<_, _>>()?;
    if number.iter().all(|n| *n == 0.0) {
        return Err(values.invalid("there are no particles of any size: write a number above 0"));
    }
    Ok(SizeDistribution::Table { radii, number })
}
