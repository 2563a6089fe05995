//! Reads `[output]`.

use super::allowed::Allowed;
use super::error::SceneError;
use super::value::Value;
use super::{Aov, OutputDescription};

impl Default for OutputDescription {
    fn default() -> Self {
        Self { path: None, png: true, exposure: 0.0, denoise: false, aovs: Vec::new() }
    }
}

const AOVS: [(&str, Aov); 7] = [
    ("albedo", Aov::Albedo),
    ("N", Aov::Normal),
    ("P", Aov::Position),
    ("Z", Aov::Depth),
    ("variance", Aov::Variance),
    ("motion", Aov::Motion),
    ("samples", Aov::Samples),
];

/// Reads `[output]`; what it does not say is as in `default`.
pub(super) fn read(value: &Value<'_>, default: OutputDescription) -> Result<OutputDescription, SceneError> {
    let table = value.table("a table [output]")?;
    let path = table.get("path").map(|v| v.text("a pattern such as \"out/frame_####.exr\"")).transpose()?;
    let output = OutputDescription {
        path: path.map(str::to_owned),
        png: table.get("png").map_or(Ok(default.png), |v| v.boolean())?,
        exposure: table.get("exposure").map_or(Ok(default.exposure), |v| v.number32(&Allowed::STOPS))?,
        denoise: table.get("denoise").map_or(Ok(default.denoise), |v| v.boolean())?,
        aovs: table.get("aovs").map_or(Ok(default.aovs), |v| aovs(&v))?,
    };
    table.finish()?;
    Ok(output)
}

/// `aovs = [..]`, each layer once.
fn aovs(value: &Value<'_>) -> Result<Vec<Aov>, SceneError> {
    let mut aovs = Vec::new();
    for element in value.elements("a list such as [\"albedo\", \"N\"]")? {
        let aov = element.choice(&AOVS)?;
        if aovs.contains(&aov) {
            return Err(element.invalid("this layer is there twice: keep it once"));
        }
        aovs.push(aov);
    }
    Ok(aovs)
}
