//! The densities of media, placed in a scene.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;

use super::description::{Axis, DensityDescription, SceneDescription};
use super::error::FrameError;
use super::inputs::Inputs;
use crate::optics::density::{Density, GridDensity, Stratified};
use crate::sequence::{FrameNumber, SequenceError, frame_path, has_place};

/// The density that is the same in every frame; that of a grid for each frame waits for [`of_frame`].
pub(super) fn still(
    density: &DensityDescription,
    scene: &SceneDescription,
    origin: DVec3,
    inputs: &mut Inputs,
) -> Result<Density, FrameError> {
    match density {
        DensityDescription::Homogeneous => Ok(Density::Homogeneous),
        DensityDescription::Stratified { depth, surface } => {
            let up = scene.frames.as_ref().map_or(Axis::Z, |frames| frames.up).vector();
            let surface = (surface - origin.dot(up.as_dvec3())) as f32;
            Ok(Density::Stratified(Stratified { up, surface, rate: (1.0 / depth) as f32 }))
        }
        DensityDescription::Grid { file, min, max } if !has_place(file) => {
            grid(&scene.directory.join(file), *min - origin, *max - origin, inputs)
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
    inputs: &mut Inputs,
) -> Result<Option<Density>, FrameError> {
    match (density, file_of_frame(density, scene, number)) {
        (DensityDescription::Grid { min, max, .. }, Some(path)) => {
            Ok(Some(grid(&path?, *min - origin, *max - origin, inputs)?))
        }
        _ => Ok(None),
    }
}

/// The file of a density that has one for each frame.
pub(super) fn file_of_frame(
    density: &DensityDescription,
    scene: &SceneDescription,
    number: FrameNumber,
) -> Option<Result<PathBuf, SequenceError>> {
    match density {
        DensityDescription::Grid { file, .. } if has_place(file) => {
            Some(frame_path(file, number).map(|file| scene.directory.join(file)))
        }
        _ => None,
    }
}

fn grid(path: &Path, min: DVec3, max: DVec3, inputs: &mut Inputs) -> Result<Density, FrameError> {
    let volume = inputs.volume(path)?;
    Ok(Density::Grid(Arc::new(GridDensity::new(&volume, min, max))))
}
