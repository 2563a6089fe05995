//! Reads `[sun]`.

use super::SunDescription;
use super::allowed::Allowed;
use super::error::SceneError;
use super::spectrum_value;
use super::value::Value;

/// Mean diameter of the sun's disc in degrees.
const DIAMETER: f32 = 0.53;

/// Reads `[sun]`.
pub(super) fn read(value: &Value<'_>) -> Result<SunDescription, SceneError> {
    let table = value.table("a table [sun]")?;
    let direction =
        table.require("direction", "write the direction towards the sun, such as [0.4, 0.2, 0.9]")?;
    let irradiance = table.require("irradiance", "write for example [1.0, 0.95, 0.85]")?;
    let sun = SunDescription {
        direction: direction.direction()?,
        angular_diameter: table
            .get("angular_diameter")
            .map_or(Ok(DIAMETER), |v| v.number32(&Allowed::HALF_TURN))?,
        irradiance: spectrum_value::irradiance(&irradiance)?,
    };
    table.finish()?;
    Ok(sun)
}
