//! Restarts by a scheduler that bring nothing new.
//!
//! A scheduler that starts a job again when it ends with 75, when its node is lost or when it took too much memory may do so
//! for ever, and a worker that is killed says nothing. So each restart notes beside the pictures what it found,
//! `.restart.1234.frame_0007.json` for job 1234 whose first picture is `frame_0007.exr`, and the next one compares. [`ENOUGH`] in a row that left
//! everything as they found it are enough. What counts is which pictures are missing and what is in their checkpoints; a run
//! that is not a restart is never given up.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::checkpoint::Checkpoint;
use super::error::RenderError;
use super::fingerprint::{Fingerprints, hexadecimal};
use super::job::{FrameTask, Job};
use super::picture::picture_path;
use super::render::{Observer, RenderOptions};
use super::survey::FrameState;
use crate::film::write::write_atomically;
use crate::sequence::FrameNumber;

/// Restarts in a row, which are known to have brought nothing, after which the next one gives up: one may be the accident of
/// a node, and each costs the time until memory or patience ends.
const ENOUGH: u32 = 2;

/// That a scheduler has started a job again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Restart {
    /// Which job.
    pub job: u64,
    /// How often, from 1.
    pub count: u32,
}

/// What a restart found.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Found {
    restart: u32,
    unfinished: String,
    /// Restarts before it, in a row, that found the same.
    fruitless: u32,
}

/// The note of a job.
pub(super) struct RestartNote {
    path: PathBuf,
    restart: Restart,
}

impl RestartNote {
    /// That of a job whose first picture, or partial, is to be there; one job may run the command several times, for
    /// other frames, samples or scenes each, none of which may judge by what another has found.
    pub fn of(restart: Restart, first: &Path) -> Self {
        let stem = first.file_stem().unwrap_or_default().to_string_lossy();
        Self { path: first.with_file_name(format!(".restart.{}.{stem}.json", restart.job)), restart }
    }

    /// Compares the frames that are to be drawn with what the restarts before this one found, and notes them.
    ///
    /// # Errors
    /// [`RenderError::Fruitless`] when it is time to give up.
    pub fn compare(
        &self,
        (job, fingerprints, pattern): (&Job, &Fingerprints, &str),
        tasks: &[FrameTask],
        options: &RenderOptions,
        observer: &dyn Observer,
    ) -> Result<(), RenderError> {
        let is_left = |task: &&FrameTask| {
            let picture = picture_path(pattern, task.number);
            options.resume || FrameState::of(&job.world, fingerprints, task, &picture) != FrameState::Complete
        };
        let left: Vec<FrameNumber> = tasks.iter().filter(is_left).map(|task| task.number).collect();
        let Restart { job, count } = self.restart;
        let found = self.next(count, digest(&left, pattern, options));
        if let Some(&number) = left.first().filter(|_| found.fruitless >= ENOUGH) {
            let (path, cure) = (self.path.clone(), cure(options));
            return Err(RenderError::Fruitless { path, number, job, count, fruitless: ENOUGH, cure });
        }
        let text = serde_json::to_vec(&found).unwrap_or_default();
        if let Err(error) = write_atomically(&self.path, &text) {
            observer.warning(&format!("restarts that bring nothing new are not noticed: {error}"));
        }
        Ok(())
    }

    /// What is to be noted after what stands there.
    fn next(&self, restart: u32, unfinished: String) -> Found {
        let before = std::fs::read(&self.path).ok();
        let before = before.and_then(|bytes| serde_json::from_slice::<Found>(&bytes).ok());
        let fruitless = match before {
            Some(before) if before.unfinished != unfinished || before.restart > restart => 0,
            // Another worker of the same restart.
            Some(before) if before.restart == restart => before.fruitless,
            Some(before) => before.fruitless + 1,
            None => 0,
        };
        Found { restart, unfinished, fruitless }
    }

    /// Takes it away.
    pub fn remove(&self) {
        let _ = std::fs::remove_file(&self.path);
    }
}

/// Without `resume` nothing goes on from a checkpoint, so that it makes no difference.
fn digest(left: &[FrameNumber], pattern: &str, options: &RenderOptions) -> String {
    let mut hasher = Sha256::new();
    for &number in left {
        hasher.update(number.millionths().to_le_bytes());
        let place = Some(options.place(pattern, number)).filter(|_| options.resume);
        hasher.update(place.and_then(|place| Checkpoint::samples_beside(&place)).unwrap_or_default());
    }
    hexadecimal(&hasher.finalize()[..16])
}

fn cure(options: &RenderOptions) -> String {
    if !options.resume {
        return "each begins anew: add --resume, and ask for more time".into();
    }
    let every = match options.checkpoint_every {
        Some(every) => format!("{} s", every.as_secs_f64()),
        None => "never".into(),
    };
    format!(
        "each may have been killed for want of memory, or before its first checkpoint: ask for more memory or time, or \
         save more often than now ({every}) with --checkpoint-every 30s"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn restarts_that_find_the_same_are_counted() {
        let folder = tempfile::tempdir().unwrap();
        let restart = Restart { job: 12, count: 1 };
        let note = RestartNote::of(restart, &folder.path().join("a.1.exr"));
        assert!(note.path.ends_with(".restart.12.a.1.json"));
        for (restart, unfinished, fruitless) in [
            (1, "a", 0),
            (2, "a", 1),
            // The other worker of the same restart.
            (2, "a", 1),
            (3, "b", 0),
            (4, "b", 1),
            (7, "b", 2),
            // Another job of the same number.
            (1, "b", 0),
            (2, "a", 0),
        ] {
            let found = note.next(restart, unfinished.into());
            assert_eq!(found.fruitless, fruitless, "{restart} {unfinished}");
            std::fs::write(&note.path, serde_json::to_vec(&found).unwrap()).unwrap();
        }
        std::fs::write(&note.path, "{\"restart\":").unwrap();
        assert_eq!(note.next(3, "a".into()).fruitless, 0);
    }
}
