//! Reads `[sky]`.

use super::SkyDescription;
use super::error::SceneError;
use super::spectrum_value;
use super::value::Value;
use crate::spectrum::Spectrum;

impl Default for SkyDescription {
    /// Black.
    fn default() -> Self {
        Self::Constant(Spectrum::Constant(0.0))
    }
}

/// Reads `[sky]`.
pub(super) fn read(value: &Value<'_>) -> Result<SkyDescription, SceneError> {
    let table = value.table("a table [sky]")?;
    let radiance =
        table.require("radiance", "write for example [0.6, 0.7, 0.8] or { image = \"sky.exr\" }")?;
    table.finish()?;
    if !radiance.has_key("image") {
        return Ok(SkyDescription::Constant(spectrum_value::radiance(&radiance)?));
    }
    let table = radiance.table("{ image = \"sky.exr\" }")?;
    let image = table.require("image", "write an EXR or HDR file")?;
    table.finish()?;
    Ok(SkyDescription::Image { image: image.text("an EXR or HDR file")?.to_owned() })
}
