//! Reads `[camera]`.

use glam::Vec3;

use super::allowed::Allowed;
use super::document::Table;
use super::error::SceneError;
use super::value::Value;
use super::{Axis, CameraDescription, FieldOfView, Placement};

/// Sine of the least angle between the view and up. Below it, which way is up depends on rounding.
const PARALLEL: f64 = 1e-6;

/// Reads `[camera]`; `scene_up` is the direction that is up unless the camera says otherwise.
pub(super) fn read(value: Option<&Value<'_>>, scene_up: Axis) -> Result<CameraDescription, SceneError> {
    let mut camera = CameraDescription {
        placement: None,
        up: scene_up.vector(),
        fov: FieldOfView::Vertical(40.0),
        resolution: [640, 360],
    };
    let Some(value) = value else { return Ok(camera) };
    let table = value.table("a table [camera]")?;
    if let Some(up) = table.get("up") {
        camera.up = up.direction()?;
    }
    camera.placement = placement(&table, camera.up)?;
    if let Some(fov) = field_of_view(&table)? {
        camera.fov = fov;
    }
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
    let placement = Placement { eye: eye.point()?, target: target.point()? };
    let Some(view) = (placement.target - placement.eye).try_normalize() else {
        return Err(target.invalid("the target is where the eye is: move one of them"));
    };
    if view.cross(up.as_dvec3()).length() < PARALLEL {
        return Err(
            target.invalid("the camera looks along its `up`: write another up, such as up = [0, 1, 0]")
        );
    }
    Ok(Some(placement))
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
