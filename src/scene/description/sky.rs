//! Reads `[sky]`.

use super::SkyDescription;
use super::allowed::Allowed;
use super::error::SceneError;
use super::spectrum_value;
use super::value::Value;
use crate::light::ClearAir;
use crate::spectrum::Spectrum;

impl Default for SkyDescription {
    /// Black.
    fn default() -> Self {
        Self::Constant(Spectrum::Constant(0.0))
    }
}

/// Reads `[sky]`; `has_sun` says that there is a `[sun]`.
pub(super) fn read(value: &Value<'_>, has_sun: bool) -> Result<SkyDescription, SceneError> {
    let table = value.table("a table [sky]")?;
    let radiance = table.require(
        "radiance",
        "write for example [0.6, 0.7, 0.8], { image = \"sky.exr\" } or { model = \"hosek-wilkie\" }",
    )?;
    table.finish()?;
    if radiance.has_key("model") {
        return match has_sun {
            true => clear(&radiance),
            false => Err(radiance.invalid(
                "the light of this sky comes from the sun: add [sun] with `direction`, with `elevation` and `azimuth`, \
                 or with `date`, `time`, `latitude` and `longitude`",
            )),
        };
    }
    if !radiance.has_key("image") {
        return Ok(SkyDescription::Constant(spectrum_value::radiance(&radiance)?));
    }
    let table = radiance.table("{ image = \"sky.exr\" }")?;
    let image = table.require("image", "write an EXR or HDR file")?;
    table.finish()?;
    Ok(SkyDescription::Image { image: image.text("an EXR or HDR file")?.to_owned() })
}

/// `{ model = "hosek-wilkie", turbidity = 3, ground_albedo = 0.1 }`
fn clear(value: &Value<'_>) -> Result<SkyDescription, SceneError> {
    let table = value.table("{ model = \"hosek-wilkie\", turbidity = 3 }")?;
    table.require("model", "write \"hosek-wilkie\"")?.choice(&[("hosek-wilkie", ())])?;
    let number = |key, default, allowed| table.get(key).map_or(Ok(default), |v| v.number(allowed));
    let air = ClearAir {
        turbidity: number("turbidity", 3.0, &Allowed::TURBIDITY)?,
        ground_albedo: number("ground_albedo", 0.1, &Allowed::UNIT)?,
    };
    table.finish()?;
    Ok(SkyDescription::Clear(air))
}
