//! Reads `[frames]`.

use super::allowed::Allowed;
use super::document::Table;
use super::error::SceneError;
use super::value::Value;
use super::{Axis, FramesDescription, NormalsDescription, VelocityDescription};
use crate::mesh::Region;

impl Default for FramesDescription {
    fn default() -> Self {
        Self {
            path: String::new(),
            fps: 24.0,
            scale: 1.0,
            up: Axis::Z,
            normals: NormalsDescription::default(),
            velocity: VelocityDescription::default(),
            inside: Region(1),
        }
    }
}

/// Reads `[frames]`; `has_meshes` says that its files are those of `[[meshes]]`.
pub(super) fn read(value: &Value<'_>, has_meshes: bool) -> Result<FramesDescription, SceneError> {
    let table = value.table("a table [frames]")?;
    let path = path(&table, has_meshes)?;
    let number = |key, default, allowed| table.get(key).map_or(Ok(default), |v| v.number(allowed));
    let default = FramesDescription::default();
    let frames = FramesDescription {
        path,
        fps: number("fps", default.fps, &Allowed::POSITIVE)?,
        scale: number("scale", default.scale, &Allowed::SCALE)?,
        up: table.get("up").map_or(Ok(default.up), |v| axis(&v))?,
        normals: table.get("normals").map_or(Ok(default.normals), |v| normals(&v))?,
        velocity: table.get("velocity").map_or(Ok(default.velocity), |v| velocity(&v))?,
        inside: table.get("inside").map_or(Ok(default.inside), |v| inside(&v))?,
    };
    table.finish()?;
    Ok(frames)
}

/// `path = ..`, which `[[meshes]]` have instead.
fn path(table: &Table<'_>, has_meshes: bool) -> Result<String, SceneError> {
    const PATTERN: &str = "a pattern such as \"frames/frame_####.ply\", a glob or a folder";
    if !has_meshes {
        return Ok(table.require("path", &format!("write {PATTERN}"))?.text(PATTERN)?.to_owned());
    }
    match table.get("path") {
        Some(path) => Err(path.invalid("the files are those of [[meshes]]: make this one of them")),
        None => Ok(String::new()),
    }
}

/// `normals = "smooth" | "flat" | "file"`
pub(super) fn normals(value: &Value<'_>) -> Result<NormalsDescription, SceneError> {
    use NormalsDescription::{File, Flat, Smooth};
    value.choice(&[("smooth", Smooth), ("flat", Flat), ("file", File)])
}

/// `velocity = "auto" | "none" | "frames" | NAME`
fn velocity(value: &Value<'_>) -> Result<VelocityDescription, SceneError> {
    use VelocityDescription::{Auto, Frames, None, Property};
    Ok(match value.text("\"auto\", \"none\", \"frames\" or the name of a property of the frame files,")? {
        "auto" => Auto,
        "none" => None,
        "frames" => Frames,
        name => Property(name.to_owned()),
    })
}

/// `up = "z"`
fn axis(value: &Value<'_>) -> Result<Axis, SceneError> {
    let axis = |index, negative| Axis { index, negative };
    value.choice(&[
        ("x", axis(0, false)),
        ("y", axis(1, false)),
        ("z", axis(2, false)),
        ("-x", axis(0, true)),
        ("-y", axis(1, true)),
        ("-z", axis(2, true)),
    ])
}

/// The label inside unlabelled meshes cannot be the outside's.
fn inside(value: &Value<'_>) -> Result<Region, SceneError> {
    match value.integer(i32::MIN.into(), i32::MAX.into())? {
        0 => Err(value.invalid("label 0 is the outside: write the label of the medium inside, such as 1")),
        label => Ok(Region(label)),
    }
}
