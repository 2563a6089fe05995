//! Reads `[sun]`, or several with the heading `[[sun]]`.

use super::allowed::Allowed;
use super::error::SceneError;
use super::spectrum_value;
use super::sun_place;
use super::value::Value;
use super::{Axis, SkyDescription, SunDescription};
use crate::light::ClearAir;
use crate::light::atmosphere::direct_sunlight;

/// Mean diameter of the sun's disc in degrees.
const DIAMETER: f32 = 0.53;

const FORMS: &str = "a table [sun], or several with the heading [[sun]]";

/// The tables of the suns.
pub(super) fn tables(value: Value<'_>) -> Result<Vec<Value<'_>>, SceneError> {
    if value.is_array() { value.elements(FORMS) } else { Ok(vec![value]) }
}

/// Reads every sun; the light of a clear sky is that of the first.
pub(super) fn read(
    tables: &[Value<'_>],
    up: Axis,
    sky: &SkyDescription,
) -> Result<Vec<SunDescription>, SceneError> {
    let air = match sky {
        SkyDescription::Clear(air) => Some(air),
        _ => None,
    };
    tables.iter().enumerate().map(|(i, table)| sun(table, up, air.filter(|_| i == 0))).collect()
}

/// Without an irradiance of its own it is what the clear air lets through that it lights.
fn sun(value: &Value<'_>, up: Axis, air: Option<&ClearAir>) -> Result<SunDescription, SceneError> {
    let table = value.table(FORMS)?;
    let (direction, north) = sun_place::read(&table, up)?;
    let clear = match air {
        Some(air) => Some((air, height(value, direction.dot(up.vector()))?)),
        None => None,
    };
    let irradiance = match (table.get("irradiance"), clear) {
        (Some(irradiance), _) => spectrum_value::irradiance(&irradiance)?,
        (None, Some((air, elevation))) => direct_sunlight(air.turbidity, elevation),
        (None, None) => {
            let cure = "write for example [1.0, 0.95, 0.85] or { table = \"astm-g173\" }; the model of a clear sky in [sky] has that of \
                        the first sun alone";
            spectrum_value::irradiance(&table.require("irradiance", cure)?)?
        }
    };
    let angular_diameter =
        table.get("angular_diameter").map_or(Ok(DIAMETER), |v| v.number32(&Allowed::HALF_TURN))?;
    table.finish()?;
    Ok(SunDescription { direction, north, angular_diameter, irradiance })
}

/// Degrees above the horizon, for a clear sky.
fn height(value: &Value<'_>, sine: f32) -> Result<f64, SceneError> {
    // A direction in the horizon is rounded to single precision.
    let degrees = libm::asin(f64::from(sine.clamp(-1.0, 1.0))).to_degrees();
    if degrees < -1e-4 {
        return Err(value.invalid(format!(
            "the sun is {:.2} degrees below the horizon, and the sky's model is of the day: let it stand above, or give the \
             sky another `radiance`",
            -degrees
        )));
    }
    Ok(degrees.max(0.0))
}
