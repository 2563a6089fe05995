//! Whether the picture of a frame is there from before the watch began.
//!
//! Where velocities follow from the next frame, `floe render` makes pictures that depend on it, and a watch makes such as
//! do not. To draw without motion what is there with it would undo the other's work.

use std::path::Path;
use std::time::Duration;

use crate::driver::fingerprint::{Fingerprints, FrameSource, Identity};
use crate::driver::job::{FrameTask, NextFrame};
use crate::driver::picture::{PictureState, read_identity};
use crate::scene::world::World;
use crate::sequence::FrameNumber;

/// A frame whose picture is looked for.
pub(super) struct Sought<'a> {
    pub number: FrameNumber,
    /// Its mesh.
    pub path: &'a Path,
    /// What the watch would draw.
    pub identity: &'a Identity,
    /// The frame after it and its mesh, if it is there.
    pub next: Option<(FrameNumber, &'a Path)>,
    /// What a frame may take.
    pub time_budget: Option<Duration>,
}

impl Sought<'_> {
    /// Whether a picture is that of the frame.
    pub fn is_drawn(&self, world: &World, fingerprints: &Fingerprints, picture: &Path) -> bool {
        match PictureState::of(picture, &self.identity.fingerprint) {
            state @ (PictureState::Complete | PictureState::Cut(_)) => state.is_enough(self.time_budget),
            PictureState::Stale => world.follows_vertices() && self.moves(world, fingerprints, picture),
            PictureState::Missing | PictureState::Corrupt(_) => false,
        }
    }

    /// Whether a whole picture is that of the frame with motion; without the next frame its mesh has to do.
    fn moves(&self, world: &World, fingerprints: &Fingerprints, picture: &Path) -> bool {
        let Some(found) = read_identity(picture).filter(|f| f.mesh_hash == self.identity.mesh_hash) else {
            return false;
        };
        let Some((number, path)) = self.next else { return true };
        let next = NextFrame { number, files: vec![path.into()] };
        let task = FrameTask { number: self.number, files: vec![self.path.into()], next: Some(next) };
        FrameSource::read(world, fingerprints, &task).is_ok_and(|source| source.identity == found)
    }
}
