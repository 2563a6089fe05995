//! What is left of a run that was broken off.

use std::fs::File;
use std::path::Path;

use rayon::prelude::*;

use super::checkpoint::Checkpoint;
use super::fingerprint::Fingerprints;
use super::job::{FrameTask, Job};
use super::partial::{self, Wanted};
use super::picture::{PictureState, denoised_path, picture_path, png_path, read_identity};
use super::render::{Observer, RenderOptions};
use super::samples_range::SamplesRange;
use super::survey::FrameState;
use crate::film::png::has_exposure;
use crate::film::{FilmError, write_png_of};
use crate::sequence::{FrameNumber, format_numbers};

/// What is left to be done, and what is not.
pub(super) struct Left {
    pub tasks: Vec<FrameTask>,
    /// The frames whose pictures are there.
    pub already: Vec<FrameNumber>,
}

/// Parts the frames into those that are left and those whose pictures are there, those without noise too if they are
/// wanted; a PNG that is missing or of another exposure is made of its picture. Tells which pictures are there but of no
/// use.
pub(super) fn left(
    job: &Job,
    fingerprints: &Fingerprints,
    pattern: &str,
    tasks: Vec<FrameTask>,
    options: &RenderOptions,
    observer: &dyn Observer,
) -> Left {
    let denoise = options.wants_denoised(&job.world.description);
    let range = options.samples_range;
    let state = |task: &FrameTask| {
        let picture = picture_path(pattern, task.number);
        let own = FrameState::of(&job.world, fingerprints, task, &picture);
        // Samples of a picture that is there are of no use.
        if let Some(range) = range.filter(|_| own != FrameState::Complete) {
            return state_of_part(job, fingerprints, task, &picture, (range, options));
        }
        match own {
            FrameState::Complete => {
                Checkpoint::remove_beside(&picture);
                complete(job, &picture, denoise)
            }
            // What more time would be needed for is still in its checkpoint.
            state @ FrameState::Cut(_) if state.is_enough(options.time_budget) => {
                complete(job, &picture, denoise)
            }
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
                let place = options.place(pattern, task.number);
                observer.warning(&format!("{}: {reason}; it is drawn again", place.display()));
            }
            FrameState::Cut(_)
            | FrameState::Partial
            | FrameState::Unmerged
            | FrameState::Parts(_)
            | FrameState::Missing
            | FrameState::Unreadable(_) => {}
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

/// What there is of some samples of a frame.
fn state_of_part(
    job: &Job,
    fingerprints: &Fingerprints,
    task: &FrameTask,
    picture: &Path,
    (range, options): (SamplesRange, &RenderOptions),
) -> FrameState {
    let path = range.partial_of(picture);
    if !path.exists() {
        return FrameState::Missing;
    }
    let wanted = match Wanted::read(job, fingerprints, options, task) {
        Ok(wanted) => wanted,
        Err(error) => return FrameState::Unreadable(error.to_string()),
    };
    let label = wanted.label(range);
    let checked = partial::read_label(&path).and_then(|found| wanted.check(&found));
    match checked.and_then(|()| partial::read(&path, &label)) {
        Ok(_) => {
            Checkpoint::remove_beside(&path);
            FrameState::Complete
        }
        Err(reason) => FrameState::Corrupt(format!("the partial {reason}")),
    }
}

/// What is beside a picture that is whole and up to date is brought up to date too.
fn complete(job: &Job, picture: &Path, denoise: bool) -> FrameState {
    let denoised = denoise.then(|| denoised_path(picture));
    // Noise is taken from more than the picture holds, such as albedo and normals: the frame is drawn again.
    if denoised.as_ref().is_some_and(|denoised| !is_of_the_same(denoised, picture)) {
        return FrameState::Missing;
    }
    let mut pictures = [Some(picture), denoised.as_deref()].into_iter().flatten();
    match pictures.try_for_each(|picture| add_missing_png(job, picture)) {
        Ok(()) => FrameState::Complete,
        Err(error) => FrameState::Corrupt(error.to_string()),
    }
}

/// Whether a picture without noise is whole and has the fingerprint of its picture.
fn is_of_the_same(denoised: &Path, picture: &Path) -> bool {
    read_identity(picture).is_some_and(|id| {
        let states = [denoised, picture].map(|path| PictureState::of(path, &id.fingerprint));
        states[0] == states[1] && matches!(states[0], PictureState::Complete | PictureState::Cut(_))
    })
}

/// Makes the PNG of a picture that is there without the one that the scene wants, or with one of another exposure.
pub(super) fn add_missing_png(job: &Job, picture: &Path) -> Result<(), FilmError> {
    let scene = &job.world.description;
    let exposure = scene.output.exposure;
    let is_there = |png: &Path| File::open(png).is_ok_and(|file| has_exposure(file, exposure));
    match png_path(scene, picture) {
        Some(png) if !is_there(&png) => write_png_of(picture, &png, exposure),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::driver::render;

    /// A still of the sky.
    const SCENE: &str = "[sky]\nradiance = 1\n[camera]\neye = [0, -4, 0]\ntarget = [0, 0, 0]\nresolution = [4, 3]\n[render]\nsamples = 1\n";

    /// The denoiser itself need not be there: any picture of the same fingerprint does.
    #[test]
    fn a_frame_that_lacks_its_denoised_picture_is_left_to_do() {
        let folder = tempfile::tempdir().unwrap();
        let [scene, other] = ["scene.toml", "other.toml"].map(|name| folder.path().join(name));
        std::fs::write(&scene, SCENE).unwrap();
        std::fs::write(&other, SCENE.replace("samples = 1", "samples = 2")).unwrap();
        let [picture, stale] = ["a.exr", "b.exr"].map(|name| folder.path().join(name));
        for (scene, picture) in [(&scene, &picture), (&other, &stale)] {
            let output = Some(picture.to_str().unwrap().to_owned());
            let options = RenderOptions { output, ..RenderOptions::default() };
            let report = render(&Job::open(scene).unwrap(), &options, &()).unwrap();
            assert!(report.failures.is_empty());
        }
        let job = Job::open(&scene).unwrap();
        let fingerprints = Fingerprints::new(&job.world, &job.world.description.render);
        let pattern = picture.to_str().unwrap();
        let count = |denoise| {
            let options = RenderOptions { denoise, ..RenderOptions::default() };
            left(&job, &fingerprints, pattern, job.tasks(), &options, &()).tasks.len()
        };
        assert_eq!((count(false), count(true)), (0, 1));
        let denoised = folder.path().join("a.denoised.exr");
        std::fs::copy(&stale, &denoised).unwrap();
        assert_eq!(count(true), 1);
        std::fs::copy(&picture, &denoised).unwrap();
        assert_eq!(count(true), 0);
        assert!(folder.path().join("a.denoised.png").exists());
        std::fs::write(&denoised, &std::fs::read(&picture).unwrap()[..900]).unwrap();
        assert_eq!((count(false), count(true)), (0, 1));
    }
}
