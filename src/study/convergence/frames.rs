//! The frame as each series needs it: mostly one for all.

use super::ConvergenceStudy;
use crate::driver::fingerprint::{Fingerprint, Fingerprints, FrameSource};
use crate::driver::job::FrameTask;
use crate::driver::{Job, RenderError};
use crate::film::ImageMetadata;
use crate::integrator::Integrator;
use crate::scene::description::{IntegratorKind, RenderDescription};
use crate::scene::frame::Frame;
use crate::sequence::{FrameNumber, FrameSelection};
use crate::study::error::StudyError;

/// The frame of a study, assembled for some settings.
pub(super) struct Frames<'a> {
    study: &'a ConvergenceStudy,
    job: Job,
    task: FrameTask,
    assembled: Vec<(RenderDescription, Frame)>,
}

impl<'a> Frames<'a> {
    /// Opens the scene and assembles the frame as the scene says.
    pub fn open(study: &'a ConvergenceStudy) -> Result<Self, StudyError> {
        let job = open(study, None)?;
        let task = task(&job, study.frame)?;
        let render = job.world.description.render.clone();
        let frame = task.assemble(&job.world, None)?;
        Ok(Self { study, job, task, assembled: vec![(render, frame)] })
    }

    /// Assembles the frame for other settings, unless there is one that serves.
    pub fn prepare(&mut self, render: &RenderDescription) -> Result<(), StudyError> {
        if self.of(render).is_none() {
            let frame = self.task.assemble(&open(self.study, Some(render))?.world, None)?;
            self.assembled.push((render.clone(), frame));
        }
        Ok(())
    }

    /// The frame for some settings, if it is prepared.
    pub fn of(&self, render: &RenderDescription) -> Option<&Frame> {
        self.assembled.iter().find(|(other, _)| other.share_frames(render)).map(|(_, frame)| frame)
    }

    /// The frame as the scene says.
    pub fn base(&self) -> &Frame {
        &self.assembled[0].1
    }

    /// What the scene says.
    pub fn settings(&self) -> &RenderDescription {
        &self.job.world.description.render
    }

    pub fn name(&self) -> &str {
        &self.job.name
    }

    pub fn number(&self) -> FrameNumber {
        self.task.number
    }

    /// What the reference is rendered by, and another way that leaves nothing out either, where there is one: paths, which
    /// have no bias, or beams where paths leave something out, and photons, finer than the scene's.
    pub fn estimators(&self, samples: u32, seed: u64) -> (RenderDescription, Option<RenderDescription>) {
        let needs = &self.base().needs;
        let [width, height] = self.base().views.opening.resolution();
        let photons = self.settings().photons.finer(width.saturating_mul(height));
        let exact = RenderDescription { samples, seed, similarity: 0, photons, ..self.settings().clone() };
        let by = |integrator| RenderDescription { integrator, ..exact.clone() };
        let [path, beams, photon] =
            [IntegratorKind::Path, IntegratorKind::Beams, IntegratorKind::Photon].map(by);
        let is_whole = |render: &RenderDescription| Integrator::new(render).left_out(needs).is_empty();
        let photons_differ = !needs.turbid_air && (needs.diffuse || needs.scattering);
        let best = [path, beams].into_iter().find(is_whole);
        match (best, photons_differ) {
            (Some(best), true) => (best, Some(photon)),
            (Some(best), false) => (best, None),
            (None, _) => (photon, None),
        }
    }

    /// What a picture of the frame with some settings depends on.
    pub fn identity(&self, render: &RenderDescription) -> Result<Fingerprint, StudyError> {
        let world = &self.job.world;
        let fingerprints = Fingerprints::new(world, render);
        Ok(FrameSource::read(world, &fingerprints, &self.task)?.identity.fingerprint)
    }

    pub fn metadata(&self) -> ImageMetadata {
        let (world, camera) = (&self.job.world, &self.base().views.opening);
        ImageMetadata {
            frame_number: self.task.number.integer().and_then(|n| i32::try_from(n).ok()).unwrap_or(0),
            fps: world.fps(),
            world_to_camera: camera.world_to_camera(world.origin),
            world_to_ndc: camera.world_to_ndc(world.origin),
            attributes: Vec::new(),
        }
    }
}

fn open(study: &ConvergenceStudy, render: Option<&RenderDescription>) -> Result<Job, RenderError> {
    Job::open_changed(&study.scene, |scene| {
        scene.camera.resolution = study.resolution.unwrap_or(scene.camera.resolution);
        scene.render = render.unwrap_or(&scene.render).clone();
    })
}

fn task(job: &Job, number: Option<FrameNumber>) -> Result<FrameTask, RenderError> {
    let tasks = match number {
        Some(number) => job.select(&FrameSelection::parse(&number.to_string())?)?,
        None => job.tasks(),
    };
    // A job without frames is refused where it is opened.
    Ok(tasks.into_iter().next().unwrap_or(FrameTask {
        number: FrameNumber::ONE,
        files: Vec::new(),
        next: None,
    }))
}
