//! `[camera]`: where it is over time, and what it sees.

use std::mem;

use glam::{DVec3, Vec3};

use super::Axis;
use super::allowed::Allowed;
use super::document::Table;
use super::error::SceneError;
use super::value::Value;

/// `[camera]`
#[derive(Clone, Debug, PartialEq)]
pub struct CameraDescription {
    /// Where the camera is, at the first key if there are any; `None` frames the first frame.
    pub placement: Option<Placement>,
    /// Where the camera is in which frame, in order; empty where it is the same in all.
    pub keys: Vec<CameraKey>,
    /// Turns the camera round its target.
    pub turntable: Option<TurntableDescription>,
    /// The direction that is up in the picture, a unit vector (`frames.up`).
    pub up: Vec3,
    /// Field of view (40 degrees vertically).
    pub fov: FieldOfView,
    /// How long the shutter is open, as a part of a frame; it opens at the time of the frame (0).
    pub shutter: f32,
    /// Diameter of the lens in metres (0, a pinhole).
    pub aperture: f32,
    /// Depth that is in focus, in metres; `None` is that of the target.
    pub focus_distance: Option<f64>,
    /// Width and height in pixels (640 x 360).
    pub resolution: [u32; 2],
}

/// Where the camera is in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraKey {
    /// The frame's number.
    pub frame: f64,
    /// Where the camera is.
    pub placement: Placement,
    /// Field of view; of the same kind in all keys.
    pub fov: FieldOfView,
    /// Depth that is in focus, in metres; `None` is that of the target.
    pub focus_distance: Option<f64>,
}

/// `camera.turntable`
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurntableDescription {
    /// Angle by which the camera goes on around its target in each frame, anticlockwise seen from above.
    pub degrees_per_frame: f64,
    /// The frame in which it is where the scene says (1).
    pub frame: f64,
}

/// Where the camera is and what it looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Where the camera is, in metres.
    pub eye: DVec3,
    /// What it looks at, in metres; not the eye, and not straight along the camera's up.
    pub target: DVec3,
}

/// Full angle of view in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FieldOfView {
    /// Across the height.
    Vertical(f32),
    /// Across the width.
    Horizontal(f32),
}

/// Sine of the least angle between the view and up. Below it, which way is up depends on rounding.
const PARALLEL: f64 = 1e-6;

impl CameraDescription {
    /// A camera of which a scene says nothing; `up` is a unit vector.
    pub fn new(up: Vec3) -> Self {
        Self {
            placement: None,
            keys: Vec::new(),
            turntable: None,
            up,
            fov: FieldOfView::Vertical(40.0),
            shutter: 0.0,
            aperture: 0.0,
            focus_distance: None,
            resolution: [640, 360],
        }
    }
}

/// Reads `[camera]`; `scene_up` is the direction that is up unless the camera says otherwise.
pub(super) fn read(value: Option<&Value<'_>>, scene_up: Axis) -> Result<CameraDescription, SceneError> {
    let mut camera = CameraDescription::new(scene_up.vector());
    let Some(value) = value else { return Ok(camera) };
    let table = value.table("a table [camera]")?;
    if let Some(up) = table.get("up") {
        camera.up = up.direction()?;
    }
    if let Some(fov) = field_of_view(&table)? {
        camera.fov = fov;
    }
    camera.focus_distance = focus_distance(&table)?;
    match table.get("eye").filter(is_list_of_keys) {
        Some(list) => {
            camera.keys = keys(&list, table.get("target").as_ref(), &camera)?;
            camera.placement = camera.keys.first().map(|key| key.placement);
        }
        None => camera.placement = placement(&table, camera.up)?,
    }
    camera.turntable = table.get("turntable").map(|v| turntable(&v)).transpose()?;
    let number = |key, allowed| table.get(key).map_or(Ok(0.0), |v| v.number32(allowed));
    camera.shutter = number("shutter", &Allowed::UNIT)?;
    camera.aperture = number("aperture", &Allowed::NOT_NEGATIVE)?;
    if let Some(size) = table.get("resolution") {
        camera.resolution = resolution(&size)?;
    }
    table.finish()?;
    Ok(camera)
}

/// `eye` and `target`, both or neither.
fn placement(table: &Table<'_>, up: Vec3) -> Result<Option<Placement>, SceneError> {
    if table.get("eye").is_none() && table.get("target").is_none() {
        return Ok(None);
    }
    let eye =
        table.require("eye", "write where the camera stands, or remove `target` to frame the first frame")?;
    let target = table
        .require("target", "write what the camera looks at, or remove `eye` to frame the first frame")?;
    looks(&eye, &target, up).map(Some)
}

/// A camera at `eye` that looks at `target`.
fn looks(eye: &Value<'_>, target: &Value<'_>, up: Vec3) -> Result<Placement, SceneError> {
    let placement = Placement { eye: eye.point()?, target: target.point()? };
    let Some(view) = (placement.target - placement.eye).try_normalize() else {
        return Err(target.invalid("the target is where the eye is: move one of them"));
    };
    if view.cross(up.as_dvec3()).length() < PARALLEL {
        return Err(
            target.invalid("the camera looks along its `up`: write another up, such as up = [0, 1, 0]")
        );
    }
    Ok(placement)
}

fn is_list_of_keys(eye: &Value<'_>) -> bool {
    eye.elements("").is_ok_and(|elements| elements.first().is_some_and(Value::is_table))
}

/// `eye = [{ frame = 1, eye = [..], target = [..] }, ..]`; what a key does not say is as the camera says.
fn keys(
    list: &Value<'_>,
    target: Option<&Value<'_>>,
    camera: &CameraDescription,
) -> Result<Vec<CameraKey>, SceneError> {
    let forms = "a key such as { frame = 1, eye = [4, 0, 1], target = [0, 0, 0] }";
    let mut keys: Vec<CameraKey> = Vec::new();
    for value in list.elements(forms)? {
        let table = value.table(forms)?;
        let frame = table.require("frame", "write the number of the frame in which the camera is there")?;
        let eye = table.require("eye", "write where the camera stands")?;
        let of_key = table.get("target");
        let target = match (&of_key, target) {
            (Some(target), _) | (None, Some(target)) => target,
            (None, None) => {
                &table.require("target", "write what the camera looks at, here or in [camera]")?
            }
        };
        let fov = field_of_view(&table)?.unwrap_or(camera.fov);
        let key = CameraKey {
            frame: frame.number(&Allowed::COORDINATE)?,
            placement: looks(&eye, target, camera.up)?,
            fov,
            focus_distance: focus_distance(&table)?.or(camera.focus_distance),
        };
        table.finish()?;
        if let Some(before) = keys.last() {
            if key.frame <= before.frame {
                return Err(frame.invalid("the frames of the keys must rise: put the keys in order"));
            }
            if mem::discriminant(&key.fov) != mem::discriminant(&before.fov) {
                return Err(value.invalid("write vertical_fov in all keys, or horizontal_fov in all"));
            }
        }
        keys.push(key);
    }
    Ok(keys)
}

/// `focus_distance`
fn focus_distance(table: &Table<'_>) -> Result<Option<f64>, SceneError> {
    table.get("focus_distance").map(|v| v.number(&Allowed::LENGTH)).transpose()
}

/// `turntable = { degrees_per_frame = 3 }` or `{ frames_per_turn = 120 }`, both with `frame`.
fn turntable(value: &Value<'_>) -> Result<TurntableDescription, SceneError> {
    let table = value.table("a table such as { frames_per_turn = 120 }")?;
    let degrees_per_frame = match (table.get("degrees_per_frame"), table.get("frames_per_turn")) {
        (Some(degrees), None) => degrees.number(&Allowed::DEGREES_PER_FRAME)?,
        (None, Some(frames)) => match frames.number(&Allowed::FRAMES_PER_TURN)? {
            count if count.abs() >= 1.0 => 360.0 / count,
            _ => return Err(frames.invalid("a turn takes a frame or more: write a number such as 120")),
        },
        _ => return Err(value.invalid("write either degrees_per_frame or frames_per_turn")),
    };
    let frame = table.get("frame").map_or(Ok(1.0), |v| v.number(&Allowed::COORDINATE))?;
    table.finish()?;
    Ok(TurntableDescription { degrees_per_frame, frame })
}

/// `vertical_fov` or `horizontal_fov`.
fn field_of_view(table: &Table<'_>) -> Result<Option<FieldOfView>, SceneError> {
    match (table.get("vertical_fov"), table.get("horizontal_fov")) {
        (Some(_), Some(horizontal)) => {
            Err(horizontal.invalid("there is a `vertical_fov` already: keep one of the two"))
        }
        (Some(angle), None) => Ok(Some(FieldOfView::Vertical(angle.number32(&Allowed::HALF_TURN)?))),
        (None, Some(angle)) => Ok(Some(FieldOfView::Horizontal(angle.number32(&Allowed::HALF_TURN)?))),
        (None, None) => Ok(None),
    }
}

/// `resolution = [width, height]`
fn resolution(value: &Value<'_>) -> Result<[u32; 2], SceneError> {
    let forms = "width and height in pixels, such as [640, 360]";
    match value.elements(forms)?.as_slice() {
        [width, height] => Ok([width.integer(1, 65536)?, height.integer(1, 65536)?]),
        _ => Err(value.invalid(format!("write {forms}"))),
    }
}
