//! The densities of media, placed in a scene.

use std::sync::Arc;

use glam::DVec3;

use super::description::{Axis, DensityDescription, SceneDescription};
use super::error::FrameError;
use crate::optics::density::{Density, GridDensity, Stratified};
use crate::optics::volume;
use crate::sequence::{FrameNumber, frame_path, has_place};

/// The density that is the same in every frame; that of a grid for each frame waits for [`of_frame`].
pub(super) fn still(
    density: &DensityDescription,
    scene: &SceneDescription,
    origin: DVec3,
) -> Result<Density, FrameError> {
    match density {
        DensityDescription::Homogeneous => Ok(Density::Homogeneous),
        DensityDescription::Stratified { depth, surface } => {
            let up = scene.frames.as_ref().map_or(Axis::Z, |frames| frames.up).vector();
            let surface = (surface - origin.dot(up.as_dvec3())) as f32;
            Ok(Density::Stratified(Stratified { up, surface, rate: (1.0 / depth) as f32 }))
        }
        DensityDescription::Grid { file, min, max } if !has_place(file) => {
            grid(file, scene, *min - origin, *max - origin)
        }
        DensityDescription::Grid { .. } => Ok(Density::Homogeneous),
    }
}

/// The density of one frame, if each has its own.
pub(super) fn of_frame(
    density: &DensityDescription,
    scene: &SceneDescription,
    origin: DVec3,
    number: FrameNumber,
) -> Result<Option<Density>, FrameError> {
    match density {
        DensityDescription::Grid { file, min, max } if has_place(file) => {
            let file = frame_path(file, number)?;
            Ok(Some(grid(&file, scene, *min - origin, *max - origin)?))
        }
        _ => Ok(None),
    }
}

fn grid(file: &str, scene: &SceneDescription, min: DVec3, max: DVec3) -> Result<Density, FrameError> {
    let volume = volume::read(&scene.directory.join(file))?;
    Ok(Density::Grid(Arc::new(GridDensity::new(&volume, min, max))))
}
