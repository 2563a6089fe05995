//! Reads `[[surfaces]]`: meshes that the simulator did not write.

use std::collections::BTreeMap;

use glam::DVec3;

use super::allowed::Allowed;
use super::error::SceneError;
use super::value::Value;
use super::{NormalsDescription, SurfaceDescription, frames, material};

/// Reads every `[[surfaces]]`; `media` are those that the scene defines.
pub(super) fn read<T>(
    value: &Value<'_>,
    media: &BTreeMap<String, T>,
) -> Result<Vec<SurfaceDescription>, SceneError> {
    value.elements("tables with the heading [[surfaces]]")?.iter().map(|v| surface(v, media)).collect()
}

fn surface<T>(value: &Value<'_>, media: &BTreeMap<String, T>) -> Result<SurfaceDescription, SceneError> {
    let table = value.table("a table with the heading [[surfaces]]")?;
    let mesh = table.require("mesh", "write a mesh file or a pattern such as \"bottom_####.ply\"")?;
    let material =
        table.require("material", "write for example { kind = \"diffuse\", reflectance = 0.5 }")?;
    let sides = material::Sides { front: table.get("front"), back: table.get("back") };
    let (scale, translate) = table.get("transform").map_or(Ok((None, DVec3::ZERO)), |v| transform(&v))?;
    let surface = SurfaceDescription {
        mesh: mesh.text("a mesh file or a pattern such as \"bottom_####.ply\"")?.to_owned(),
        normals: table.get("normals").map_or(Ok(NormalsDescription::default()), |v| frames::normals(&v))?,
        scale: scale.unwrap_or(1.0),
        translate,
        material: material::read(&table, &material, sides, media)?,
    };
    table.finish()?;
    Ok(surface)
}

/// `transform = { scale = .., translate = [..] }`
pub(super) fn transform(value: &Value<'_>) -> Result<(Option<f64>, DVec3), SceneError> {
    let table = value.table("a table such as { scale = 1.0, translate = [0, 0, 0] }")?;
    let scale = table.get("scale").map(|v| v.number(&Allowed::SCALE)).transpose()?;
    let translate = table.get("translate").map_or(Ok(DVec3::ZERO), |v| v.point())?;
    table.finish()?;
    Ok((scale, translate))
}
