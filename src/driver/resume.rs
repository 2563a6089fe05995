//! What is left of a run that was broken off.

use std::path::Path;

use rayon::prelude::*;

use super::fingerprint::Fingerprints;
use super::job::{FrameTask, Job};
use super::picture::{picture_path, png_path};
use super::render::Observer;
use super::survey::FrameState;
use crate::film::{FilmError, write_png_of};
use crate::sequence::{FrameNumber, format_numbers};

/// What is left to be done, and what is not.
pub(super) struct Left {
    pub tasks: Vec<FrameTask>,
    /// The frames whose pictures are there.
    pub already: Vec<FrameNumber>,
}

/// Parts the frames into those that are left and those whose pictures are there; a PNG that is missing is made of its
/// picture. Tells which pictures are there but of no use.
pub(super) fn left(
    job: &Job,
    fingerprints: &Fingerprints,
    pattern: &str,
    tasks: Vec<FrameTask>,
    observer: &dyn Observer,
) -> Left {
    let state = |task: &FrameTask| {
        let picture = picture_path(pattern, task.number);
        match FrameState::of(&job.world, fingerprints, task, &picture) {
            FrameState::Complete => match add_missing_png(job, &picture) {
                Ok(()) => FrameState::Complete,
                Err(error) => FrameState::Corrupt(error.to_string()),
            },
            state => state,
        }
    };
    let states: Vec<FrameState> = tasks.par_iter().map(state).collect();
    let mut left = Left { tasks: Vec::new(), already: Vec::new() };
    let mut stale = Vec::new();
    for (task, state) in tasks.into_iter().zip(states) {
        match state {
            FrameState::Complete => {
                left.already.push(task.number);
                continue;
            }
            FrameState::Stale => stale.push(task.number),
            FrameState::Corrupt(reason) => {
                let picture = picture_path(pattern, task.number);
                observer.warning(&format!("{}: {reason}; it is drawn again", picture.display()));
            }
            FrameState::Partial | FrameState::Missing | FrameState::Unreadable(_) => {}
        }
        left.tasks.push(task);
    }
    if !stale.is_empty() {
        let numbers = format_numbers(&stale);
        observer
            .warning(&format!("drawn again since the scene, the settings or the mesh changed: {numbers}"));
    }
    left
}

/// Makes the PNG of a picture that is there without the one that the scene wants.
pub(super) fn add_missing_png(job: &Job, picture: &Path) -> Result<(), FilmError> {
    let scene = &job.world.description;
    match png_path(scene, picture) {
        Some(png) if !png.exists() => write_png_of(picture, &png, scene.output.exposure),
        _ => Ok(()),
    }
}
