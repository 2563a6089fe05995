//! Reads `model = "iceberg"`.

use super::super::allowed::Allowed;
use super::super::document::Table;
use super::super::error::SceneError;
use super::{Contents, preset};
use crate::optics::ice::iceberg::{Iceberg, PRESETS, TEMPERATURE};
use crate::optics::ice::{TEMPERATURE_RANGE, density};

pub(super) fn read(table: &Table<'_>) -> Result<Contents, SceneError> {
    let base = preset(table, &PRESETS, PRESETS[0].1)?;
    let given = |key, allowed| table.get(key).map(|v| v.number(allowed)).transpose();
    let asked = given("temperature", &Allowed::CELSIUS)?.unwrap_or(TEMPERATURE);
    let [least, greatest] = TEMPERATURE_RANGE;
    let temperature = asked.clamp(least, greatest);
    let warning = (temperature != asked).then(|| {
        format!(
            "temperature = {asked}: what ice encloses is known from {least} to {greatest} degrees Celsius; \
             {temperature} is taken"
        )
    });
    let salinity = given("salinity", &Allowed::SALINITY)?.unwrap_or(0.0);
    let ice_density = given("ice_density", &Allowed::ICE_DENSITY)?;
    let ice = Iceberg {
        temperature,
        salinity,
        density: ice_density.unwrap_or_else(|| density(temperature, salinity, base.air)),
        algae: given("algae", &Allowed::VOLUME_FRACTION)?.unwrap_or(base.algae),
    };
    let said = ["ice_density", "salinity", "temperature"].iter().find_map(|key| table.get(key));
    let blamed = said.map_or_else(|| table.require("model", "write model = \"iceberg\""), Ok)?;
    let mixture = ice.mixture().map_err(|error| blamed.invalid(error.to_string()))?;
    Ok(Contents { mixture, warnings: warning.into_iter().collect() })
}
