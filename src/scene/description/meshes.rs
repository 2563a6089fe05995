//! `[[meshes]]`: several meshes a frame, which may overlap.

use std::collections::BTreeMap;

use glam::DVec3;

use super::document::Table;
use super::error::SceneError;
use super::media::existing_medium;
use super::value::Value;
use super::{FramesDescription, NormalsDescription, frames, regions, surfaces};
use crate::mesh::Region;

/// `[[meshes]]`
#[derive(Clone, Debug, PartialEq)]
pub struct MeshDescription {
    /// As that of `[frames]`, or the one file that is the same in every frame.
    pub path: String,
    /// What is within.
    pub contents: MeshContents,
    /// The mesh of the greater one is where meshes overlap, the first in the file among equal ones (0).
    pub priority: i32,
    /// Where shading normals come from (those of `[frames]`).
    pub normals: NormalsDescription,
    /// Metres per unit of the file (that of `[frames]`).
    pub scale: f64,
    /// Added after scaling, in metres.
    pub translate: DVec3,
}

/// What is within one of the `[[meshes]]`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MeshContents {
    /// One medium: the mesh is closed and carries no labels.
    Inside(String),
    /// Medium names by label, those of `[regions]` unless the mesh has its own.
    Regions(BTreeMap<Region, String>),
}

/// What the meshes take from the rest of the scene.
pub(super) struct Around<'a, T> {
    pub frames: Option<&'a FramesDescription>,
    pub regions: &'a BTreeMap<Region, String>,
    pub media: &'a BTreeMap<String, T>,
}

/// Reads every `[[meshes]]`.
pub(super) fn read<T>(value: &Value<'_>, around: &Around<'_, T>) -> Result<Vec<MeshDescription>, SceneError> {
    value.elements("tables with the heading [[meshes]]")?.iter().map(|v| mesh(v, around)).collect()
}

fn mesh<T>(value: &Value<'_>, around: &Around<'_, T>) -> Result<MeshDescription, SceneError> {
    const PATTERN: &str = "a pattern such as \"water_####.ply\", a glob, a folder or one file";
    let table = value.table("a table with the heading [[meshes]]")?;
    let path = table.require("path", &format!("write {PATTERN}"))?;
    let (scale, translate) =
        table.get("transform").map_or(Ok((None, DVec3::ZERO)), |v| surfaces::transform(&v))?;
    let frames = around.frames;
    let mesh = MeshDescription {
        path: path.text(PATTERN)?.to_owned(),
        contents: contents(&table, around)?,
        priority: table.get("priority").map_or(Ok(0), |v| v.integer(i32::MIN.into(), i32::MAX.into()))?,
        normals: match table.get("normals") {
            Some(normals) => frames::normals(&normals)?,
            None => frames.map_or_else(Default::default, |frames| frames.normals),
        },
        scale: scale.unwrap_or(frames.map_or(1.0, |frames| frames.scale)),
        translate,
    };
    table.finish()?;
    Ok(mesh)
}

/// `inside = ".."` or `regions = { .. }`
fn contents<T>(table: &Table<'_>, around: &Around<'_, T>) -> Result<MeshContents, SceneError> {
    match (table.get("inside"), table.get("regions")) {
        (Some(inside), None) => {
            Ok(MeshContents::Inside(existing_medium(&inside, around.media, "what is inside")?))
        }
        (None, Some(own)) => {
            if own.has_key("0") {
                return Err(own.invalid("label 0 is the outside of the mesh: leave it out"));
            }
            Ok(MeshContents::Regions(regions::read(&own, around.media)?))
        }
        (None, None) => Ok(MeshContents::Regions(around.regions.clone())),
        (Some(inside), Some(_)) => Err(inside.invalid(
            "the mesh has `regions` too: `inside` is for meshes without labels; keep one of the two",
        )),
    }
}
