//! Waits for what has to be known before anything can be drawn: the scene, or else the first frame.
//!
//! Neither the folder nor a frame need be there yet. A folder without a scene gets one that fits its first frame that is
//! whole, and a camera without placement frames that one; so a frame has to be read before the scene can be opened.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::lookout::Lookout;
use super::status::{Phase, WatchStatus};
use super::{End, WatchOptions, shown};
use crate::driver::arrivals::{Order, read_signed};
use crate::driver::error::RenderError;
use crate::driver::job::{Job, SceneFile, find_scene};
use crate::driver::ready::{Look, Verdict};
use crate::driver::render::Observer;
use crate::driver::whole::{Inspected, Traits, inspect};
use crate::mesh::{MeshError, RawMesh, VelocityName};
use crate::scene::FrameError;
use crate::scene::description::{Placement, SceneDescription};
use crate::sequence::FrameNumber;

/// Which frames are waited for.
struct Expected {
    base: PathBuf,
    pattern: String,
    /// Whether there is a scene.
    has_scene: bool,
    /// Whether a frame is needed to open it.
    needs_frame: bool,
}

/// An open scene and its frames as they come, or how it ended before that.
type Opening<'a> = Result<(Job, Lookout<'a>), (End, Lookout<'a>)>;

/// Waits until a scene can be opened; how it ended if it could not.
///
/// # Errors
/// When the scene is wrong, or is about no frames.
pub(super) fn open<'a>(
    path: &Path,
    options: &'a WatchOptions,
    observer: &'a dyn Observer,
) -> Result<Opening<'a>, RenderError> {
    let mut expected = expect(path)?;
    let mut lookout = Lookout::new(expected.base.clone(), &expected.pattern, options, observer);
    loop {
        if !expected.needs_frame {
            let none = |_: &Path, _: &str| Err(RenderError::NotFound { path: path.into() });
            return Ok(Ok((Job::open_on(path, &none)?, lookout)));
        }
        lookout.scan()?;
        if let Some((number, mesh)) = first_frame(&mut lookout) {
            let job = Job::open_on(path, &|_: &Path, _: &str| Ok(mesh.clone()))?;
            if expected.has_scene {
                warn_of_camera(&job, number, observer);
            }
            return Ok(Ok((job, lookout)));
        }
        if options.render.interrupt.is_requested() {
            return Ok(Err((End::Interrupted, lookout)));
        }
        if let Some(end) = lookout.is_over() {
            return Ok(Err((end, lookout)));
        }
        tell(&lookout);
        let _ = lookout.pause();
        if !expected.has_scene {
            expected = expect(path)?;
            if expected.has_scene {
                lookout.turn_to(expected.base.clone(), &expected.pattern);
            }
        }
    }
}

fn expect(path: &Path) -> Result<Expected, RenderError> {
    let folder =
        |needs_frame| Expected { base: path.into(), pattern: String::new(), has_scene: false, needs_frame };
    if !path.exists() && path.extension().is_none_or(|extension| extension != "toml") {
        return Ok(folder(true));
    }
    let SceneFile::There { file, .. } = find_scene(path)? else { return Ok(folder(true)) };
    let scene = SceneDescription::from_file(&file)?;
    let needs_frame = scene.camera.placement.is_none();
    if !scene.meshes.is_empty() {
        return Err(RenderError::SeveralMeshes { scene: file });
    }
    let Some(frames) = scene.frames else { return Err(RenderError::NothingToWatch { scene: file }) };
    Ok(Expected { base: scene.directory, pattern: frames.path, has_scene: true, needs_frame })
}

/// The mesh of the lowest frame that is whole; the frame stays to be drawn.
fn first_frame(lookout: &mut Lookout<'_>) -> Option<(FrameNumber, RawMesh)> {
    let now = lookout.now();
    let rules = lookout.arrivals.rules();
    let number = lookout.arrivals.next(Order::Oldest, now, |_, _| true)?;
    let arrival = lookout.arrivals.get_mut(number)?;
    let start = Instant::now();
    let read = read_signed(&arrival.path);
    let end = now + start.elapsed();
    let (before, after) = read.as_ref().map_or_else(
        |_| (arrival.readiness.signature(), Some(arrival.readiness.signature())),
        |(before, _, after)| (*before, *after),
    );
    let inspected = match read {
        Ok((_, bytes, _)) => inspect(&bytes, &arrival.path, &VelocityName::Nothing, Traits::default()),
        Err(source) => Err(MeshError::Io { path: arrival.path.clone(), source }),
    };
    let found = inspected.as_ref().ok().map(|inspected| inspected.proof);
    let look = Look { at: now, end, before, after, found };
    match (arrival.readiness.judge(&look, &rules), inspected) {
        (Verdict::Accepted, Ok(Inspected { mesh, .. })) => {
            arrival.readiness.wanted_again(&look);
            return Some((number, mesh));
        }
        (Verdict::Refused, Err(error)) => {
            lookout.observer.warning(&format!("frame {number}: {error}"));
            arrival.failure = Some(FrameError::from(error).into());
        }
        (Verdict::Changed, _) => lookout.arrivals.touch(now),
        _ => {}
    }
    None
}

/// Another watch may see another frame first, and draw everything again from elsewhere.
fn warn_of_camera(job: &Job, number: FrameNumber, observer: &dyn Observer) {
    let scene = &job.world.description;
    let Some(Placement { eye, target }) = scene.camera.placement else { return };
    observer.warning(&format!(
        "{}: the camera frames frame {number}, the first that was whole; to have the same view whichever comes first, \
         write eye = {eye} and target = {target} into [camera]",
        scene.file.display()
    ));
}

fn tell(lookout: &Lookout<'_>) {
    let folder = lookout.arrivals.folder();
    let wanted = if folder.is_dir() { "a whole frame in" } else { "the folder" };
    let failed = lookout.arrivals.iter().filter(|(_, arrival)| arrival.failure.is_some()).count();
    lookout.observer.watching(&WatchStatus {
        phase: Phase::Waiting(format!("{wanted} {}", shown(&folder))),
        queue: lookout.arrivals.queue(lookout.now()),
        drawn: 0,
        failed,
        frames_per_hour: None,
    });
}
