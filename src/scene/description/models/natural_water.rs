//! Reads `model = "natural-water"`.

use super::super::allowed::Allowed;
use super::super::document::Table;
use super::super::error::SceneError;
use super::{Contents, preset};
use crate::optics::water::natural::{NaturalWater, PRESETS};

pub(super) fn read(table: &Table<'_>) -> Result<Contents, SceneError> {
    let base = preset(table, &PRESETS, NaturalWater::SEA)?;
    let number = |key, allowed, default| table.get(key).map_or(Ok(default), |v| v.number(allowed));
    let molecules = table.get("molecular_scattering");
    let water = NaturalWater {
        temperature: number("temperature", &Allowed::CELSIUS_OF_WATER, base.temperature)?,
        salinity: number("salinity", &Allowed::SALINITY_OF_WATER, base.salinity)?,
        mineral: number("mineral", &Allowed::VOLUME_FRACTION, base.mineral)?,
        algae: number("algae", &Allowed::VOLUME_FRACTION, base.algae)?,
        rock_flour: number("rock_flour", &Allowed::VOLUME_FRACTION, base.rock_flour)?,
        dissolved: number("cdom", &Allowed::ABSORBED_AT_440, base.dissolved)?,
        molecular_scattering: molecules.map_or(Ok(base.molecular_scattering), |v| v.boolean())?,
    };
    Ok(Contents { mixture: water.mixture(), warnings: Vec::new() })
}
