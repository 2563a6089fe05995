//! Renders the frames of a scene with each `render.seed_mode`, twice, and measures what an eye would see.
//!
//! Every frame is assembled once and rendered six times: three modes, two seeds.

use serde::Serialize;

use super::error::StudyError;
use super::temporal::{TemporalErrors, TemporalMetrics, WINDOW};
use crate::driver::RenderError;
use crate::driver::frame_seeds::FrameSeeds;
use crate::driver::job::{FrameTask, Job};
use crate::driver::tiles::{Sampling, render_pixels};
use crate::film::tonemap::ToneMap;
use crate::scene::description::{RenderDescription, SeedMode};
use crate::scene::frame::Frame;
use crate::sequence::{FrameNumber, FrameSelection, format_numbers};
use crate::spectrum::luminance::luminance;

/// Most frames of a still.
const MOST_FRAMES: usize = 10_000;

/// What is rendered.
#[derive(Clone, Debug, Default)]
pub struct SeedModeStudy {
    /// Only these frames; of a still, with these numbers.
    pub frames: Option<FrameSelection>,
    /// Shows the mesh of this frame in every frame, so that nothing moves.
    pub hold: Option<FrameNumber>,
    /// Samples a pixel; also what the stride of `sequence` follows.
    pub samples: Option<u32>,
    /// The first of the two seeds.
    pub seed: Option<u64>,
}

/// The measures of each mode.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TemporalStudy {
    /// The frames as a selection.
    pub frames: String,
    /// How many there are.
    pub count: usize,
    /// Samples a pixel.
    pub samples: u32,
    /// Pixels of a frame.
    pub pixels: usize,
    /// By the name of the mode.
    pub modes: Vec<(&'static str, TemporalMetrics)>,
}

/// Renders and measures; `rendered` hears of each frame that is done.
///
/// # Errors
/// When a frame cannot be rendered, or there are too few.
pub fn study_seed_modes(
    job: &Job,
    study: &SeedModeStudy,
    mut rendered: impl FnMut(FrameNumber),
) -> Result<TemporalStudy, StudyError> {
    let tasks = tasks(job, study)?;
    if tasks.len() < WINDOW {
        return Err(StudyError::TooFewFrames { found: tasks.len(), least: WINDOW });
    }
    let scene = &job.world.description.render;
    let scene = &RenderDescription {
        samples: study.samples.unwrap_or(scene.samples),
        // Modes are compared at the same number of samples.
        target_error: None,
        ..scene.clone()
    };
    let seed = study.seed.unwrap_or(scene.seed);
    let [width, height] = job.world.description.camera.resolution.map(|n| n as usize);
    let tone_map = ToneMap::new(job.world.description.output.exposure);
    let mut errors = SeedMode::ALL.map(|_| TemporalErrors::new(width, height));
    let mut previous: Option<Frame> = None;
    for task in &tasks {
        let frame = task.assemble(&job.world, previous.as_ref())?;
        for ((_, mode), errors) in SeedMode::ALL.iter().zip(&mut errors) {
            let settings = RenderDescription { seed_mode: Some(*mode), ..scene.clone() };
            let shown = |seed| shown(&frame, &settings, tone_map, seed, task.number);
            errors.push(differences(&shown(seed)?, &shown(seed.wrapping_add(1))?));
        }
        rendered(task.number);
        previous = Some(frame);
    }
    let numbers: Vec<FrameNumber> = tasks.iter().map(|task| task.number).collect();
    let modes =
        SeedMode::ALL.iter().zip(&errors).filter_map(|((name, _), errors)| Some((*name, errors.metrics()?)));
    Ok(TemporalStudy {
        frames: format_numbers(&numbers),
        count: tasks.len(),
        samples: scene.samples,
        pixels: width * height,
        modes: modes.collect(),
    })
}

/// The frames with the meshes that they show.
fn tasks(job: &Job, study: &SeedModeStudy) -> Result<Vec<FrameTask>, StudyError> {
    let files = match study.hold {
        Some(number) => {
            let all = job.tasks();
            let numbers: Vec<FrameNumber> = all.iter().map(|task| task.number).collect();
            let held = all.into_iter().find(|task| task.number == number);
            held.ok_or_else(|| StudyError::NothingToHold { number, available: format_numbers(&numbers) })?
                .files
        }
        None if job.files.is_empty() => Vec::new(),
        None => {
            let chosen = study.frames.as_ref().map_or_else(|| Ok(job.tasks()), |frames| job.select(frames));
            return Ok(chosen.map_err(RenderError::from)?);
        }
    };
    let frames = study.frames.as_ref().ok_or(StudyError::NoNumbers)?;
    let numbers: Vec<FrameNumber> = frames.numbers().take(MOST_FRAMES + 1).collect();
    if numbers.len() > MOST_FRAMES {
        return Err(StudyError::TooManyFrames { most: MOST_FRAMES });
    }
    Ok(numbers.into_iter().map(|number| FrameTask { number, files: files.clone(), next: None }).collect())
}

/// The luma of one picture as a screen shows it, from 0 to 1.
fn shown(
    frame: &Frame,
    settings: &RenderDescription,
    tone_map: ToneMap,
    seed: u64,
    number: FrameNumber,
) -> Result<Vec<f32>, RenderError> {
    let seed = FrameSeeds::new(settings, seed, settings.samples).of_frame(number)?;
    let sampling = Sampling { seed, ..Sampling::new(settings) };
    let (image, _) = render_pixels(frame, &sampling, &|_, _| ());
    Ok(image.pixels.iter().map(|pixel| luminance(tone_map.apply(pixel.rgb))).collect())
}

/// Equation (7) of [`super::temporal`].
fn differences(a: &[f32], b: &[f32]) -> Vec<f32> {
    a.iter().zip(b).map(|(a, b)| std::f32::consts::FRAC_1_SQRT_2 * (a - b)).collect()
}
