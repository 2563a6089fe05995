//! Which frames are there already.

use std::path::Path;
use std::time::Duration;

use rayon::prelude::*;

use super::checkpoint::Checkpoint;
use super::chosen::{Chosen, chosen, not_there};
use super::error::RenderError;
use super::fingerprint::{Fingerprints, FrameSource};
use super::job::{FrameTask, Job};
use super::partial::Wanted;
use super::parts::{among, folder_of, labels, names_in};
use super::picture::{PictureState, picture_path};
use super::render::RenderOptions;
use crate::scene::world::World;
use crate::sequence::FrameNumber;

/// What there is of a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FrameState {
    /// Its picture, whole.
    Complete,
    /// Its picture, whole, of a frame whose time was up; with that time.
    Cut(Duration),
    /// A checkpoint: rendering can go on.
    Partial,
    /// Nothing.
    Missing,
    /// Partials of all its samples: they have only to be merged.
    Unmerged,
    /// Partials, but not of all samples or not of this frame, with what is wrong.
    Parts(String),
    /// A whole picture of another scene, other settings or another mesh.
    Stale,
    /// A picture that is damaged, with what is wrong.
    Corrupt(String),
    /// Its own files cannot be read, with what is wrong.
    Unreadable(String),
}

impl FrameState {
    /// Whether a run that gives each frame so much time has nothing to add to the picture.
    pub fn is_enough(&self, time_budget: Option<Duration>) -> bool {
        match self {
            Self::Complete => true,
            Self::Cut(spent) => PictureState::Cut(*spent).is_enough(time_budget),
            _ => false,
        }
    }

    /// Looks at a frame. Nothing is parsed, and where there is neither picture nor checkpoint nothing is read.
    pub fn of(world: &World, fingerprints: &Fingerprints, task: &FrameTask, picture: &Path) -> Self {
        if !picture.exists() && !Checkpoint::path_beside(picture).exists() {
            return Self::Missing;
        }
        let fingerprint = match FrameSource::read(world, fingerprints, task) {
            Ok(source) => source.identity.fingerprint,
            Err(error) => return Self::Unreadable(error.to_string()),
        };
        match PictureState::of(picture, &fingerprint) {
            PictureState::Complete => Self::Complete,
            PictureState::Cut(time) => Self::Cut(time),
            _ if Checkpoint::of(picture, fingerprint).is_there() => Self::Partial,
            PictureState::Missing => Self::Missing,
            PictureState::Stale => Self::Stale,
            PictureState::Corrupt(reason) => Self::Corrupt(reason),
        }
    }
}

/// What there is of the frames that are asked for, in order, and the pattern of their pictures' names.
///
/// # Errors
/// When the selection leaves no frame.
pub fn survey(
    job: &Job,
    options: &RenderOptions,
) -> Result<(Vec<(FrameNumber, FrameState)>, String), RenderError> {
    let pattern = options.output.clone().unwrap_or_else(|| job.output_pattern());
    let Chosen { tasks, absent, .. } = chosen(job, &RenderOptions { keep_going: true, ..options.clone() })?;
    let fingerprints = Fingerprints::new(&job.world, &options.settings(&job.world.description.render));
    let first = tasks.first().map(|task| picture_path(&pattern, task.number));
    let partials = first.map(|picture| names_in(folder_of(&picture))).unwrap_or_default();
    let state = |task: &FrameTask| {
        let picture = picture_path(&pattern, task.number);
        let state = FrameState::of(&job.world, &fingerprints, task, &picture);
        let partials = among(&picture, &partials);
        let has_picture = matches!(state, FrameState::Complete | FrameState::Cut(_));
        if partials.is_empty() || has_picture {
            return (task.number, state);
        }
        let found = Wanted::read(job, &fingerprints, options, task)
            .and_then(|wanted| labels(&wanted, &picture, &partials));
        (
            task.number,
            found.map_or_else(|error| FrameState::Parts(error.to_string()), |_| FrameState::Unmerged),
        )
    };
    let mut states: Vec<(FrameNumber, FrameState)> = tasks.par_iter().map(state).collect();
    let missing = |number| (number, FrameState::Unreadable(not_there(job, number).to_string()));
    states.extend(absent.into_iter().map(missing));
    states.sort_by_key(|(number, _)| *number);
    Ok((states, pattern))
}
