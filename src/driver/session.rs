//! Renders and writes the frames of one run, each when its turn comes.

mod doubts;
mod part;

use std::path::{Path, PathBuf};

use super::accumulation::Accumulation;
use super::ahead::{Preparation, Ready, timed};
use super::checkpoint::Checkpoint;
use super::error::RenderError;
use super::fingerprint::Identity;
use super::frame_seeds::FrameSeeds;
use super::job::{FrameTask, Job};
use super::keeper::Keeper;
use super::lap;
use super::ledger::{BeamRecord, FrameRecord, Ledger, PerPixel, Status};
use super::picture::{FINGERPRINT, MESH_HASH, TIME_BUDGET, denoised_path, picture_path as picture, png_path};
use super::render::{Observer, RenderOptions, RenderReport};
use super::stopping::StoppedBy;
use super::tiles::{Control, Sampling, accumulate};
use crate::accel::Hierarchy;
use crate::film::write::remove_abandoned;
use crate::film::{Denoiser, FrameImage, ImageMetadata, estimate_error, write_frame};
use crate::integrator::{Counters, Integrator};
use crate::scene::assembly::Assembled;
use crate::scene::camera::Camera;
use crate::scene::description::{Aov, RenderDescription};
use crate::scene::frame::Frame;
use crate::sequence::FrameNumber;
use crate::spectrum::LaneMode;

/// The frames of one run: their settings, and what has become of them.
pub(super) struct Session<'a> {
    job: &'a Job,
    options: &'a RenderOptions,
    pattern: String,
    settings: RenderDescription,
    sampling: Sampling,
    seeds: FrameSeeds,
    denoiser: Option<Denoiser>,
    /// None where frames stay in memory.
    ledger: Option<Ledger>,
    pub report: RenderReport,
    observer: &'a dyn Observer,
}

impl<'a> Session<'a> {
    pub fn new(
        job: &'a Job,
        options: &'a RenderOptions,
        observer: &'a dyn Observer,
        pattern: &str,
        tasks: &[FrameTask],
    ) -> Result<Self, RenderError> {
        let denoiser = options.wants_denoised(&job.world.description).then(Denoiser::load).transpose()?;
        // A shard may have no frame.
        let first_picture = picture(pattern, tasks.first().map_or(FrameNumber::ONE, |task| task.number));
        let ledger = Ledger::beside(&first_picture, options.shard, options.samples_range)?;
        remove_abandoned(&first_picture);
        lap::since_last();
        Ok(Self { denoiser, ..Self::with(job, options, observer, pattern, Some(ledger)) })
    }

    /// A session whose frames stay in memory.
    pub fn unrecorded(job: &'a Job, options: &'a RenderOptions, observer: &'a dyn Observer) -> Self {
        Self::with(job, options, observer, "", None)
    }

    fn with(
        job: &'a Job,
        options: &'a RenderOptions,
        observer: &'a dyn Observer,
        pattern: &str,
        ledger: Option<Ledger>,
    ) -> Self {
        let settings = options.settings(&job.world.description.render);
        let report = RenderReport {
            frames: Vec::new(),
            already: Vec::new(),
            interrupted: false,
            failures: Vec::new(),
            skipped: 0,
            seconds: 0.0,
            pattern: pattern.into(),
            ledger: ledger.as_ref().map_or_else(PathBuf::new, |ledger| ledger.path().into()),
        };
        let samples = options.samples_range.map_or(settings.samples, |range| range.end);
        let sampling = Sampling { samples, ..Sampling::new(&settings) };
        let seeds = FrameSeeds::new(&job.world.description.render, settings.seed, settings.samples);
        if let Some(text) = seeds.overlap().filter(|_| job.files.len() > 1) {
            observer.warning(&text);
        }
        let (denoiser, pattern) = (None, pattern.into());
        Self { job, options, pattern, settings, sampling, seeds, denoiser, ledger, report, observer }
    }

    /// Tells the ledger, the observer and the report what became of a frame; true when its picture is there.
    fn conclude(
        &mut self,
        number: FrameNumber,
        mut record: FrameRecord,
        outcome: Result<(), RenderError>,
    ) -> bool {
        record.end();
        let outcome = outcome.inspect_err(|error| record.error = Some(error.to_string()));
        // What became of the picture is worth more than that the ledger could not be written.
        let outcome = outcome.and(self.ledger.as_ref().map_or(Ok(()), |ledger| ledger.append(&record)));
        record.error = outcome.as_ref().err().map(ToString::to_string);
        self.observer.finished(&record);
        self.report.frames.push(record);
        match outcome {
            Ok(()) => return true,
            Err(RenderError::Interrupted) => self.report.interrupted = true,
            Err(error) => self.report.failures.push((number, error)),
        }
        false
    }

    /// A frame that was asked for by its number but is not there.
    pub fn absent(&mut self, number: FrameNumber, error: RenderError) {
        let record = FrameRecord::failed(number.to_string(), None, picture(&self.pattern, number));
        self.conclude(number, record, Err(error));
    }

    /// Renders a frame that is ready, or tells what is wrong with it. Its pixels, when its picture is there.
    pub fn turn(
        &mut self,
        task: &FrameTask,
        prepared: Result<&Ready, RenderError>,
        preparation: Preparation,
    ) -> Option<FrameImage> {
        let mut record = self.record(task, preparation);
        let outcome = prepared.and_then(|ready| match self.options.samples_range {
            Some(range) => self.some_samples(task, ready, range, &mut record),
            None => self.whole(task, ready, &mut record),
        });
        let done = if self.options.samples_range.is_some() { Status::Partial } else { Status::Complete };
        self.settle(task, record, done, outcome)
    }

    /// Notes what became of a frame. Its pixels, when it is done.
    fn settle(
        &mut self,
        task: &FrameTask,
        mut record: FrameRecord,
        done: Status,
        outcome: Result<FrameImage, RenderError>,
    ) -> Option<FrameImage> {
        record.status = match outcome {
            Ok(_) => done,
            Err(RenderError::Interrupted) => Status::Interrupted,
            Err(_) => Status::Failed,
        };
        let (image, outcome) = match outcome {
            Ok(image) => (Some(image), Ok(())),
            Err(error) => (None, Err(error)),
        };
        self.conclude(task.number, record, outcome).then_some(image).flatten()
    }

    /// All samples of a frame, as its picture.
    fn whole(
        &mut self,
        task: &FrameTask,
        ready: &Ready,
        record: &mut FrameRecord,
    ) -> Result<FrameImage, RenderError> {
        let checkpoint = Checkpoint::of(&record.output, ready.identity.fingerprint);
        let draw = |session: &Self| session.draw(&ready.assembled.frame, Some(&checkpoint));
        let traced = self.trace(task, &ready.assembled, true, record, draw);
        if let Err(RenderError::Mismatches { .. }) = traced {
            checkpoint.remove();
        }
        let image = traced?;
        self.publish(task, ready, &image, record)?;
        // A frame that was cut may go on one day.
        if record.stopped_by != Some(StoppedBy::Time) {
            checkpoint.remove();
        }
        Ok(image)
    }

    fn publish(
        &self,
        task: &FrameTask,
        ready: &Ready,
        image: &FrameImage,
        record: &mut FrameRecord,
    ) -> Result<(), RenderError> {
        let camera = &ready.assembled.frame.views.opening;
        let of = Of { number: task.number, identity: &ready.identity, stopped_by: record.stopped_by };
        let write = || self.write_all(image, camera, of, &record.output);
        timed(&mut record.write_seconds, || self.options.interrupt.while_writing(write))
    }

    /// Renders a frame without writing it; `shown` takes the pixels and puts them where they can be seen.
    pub fn preview(
        &mut self,
        task: &FrameTask,
        ready: &Ready,
        preparation: Preparation,
        shown: impl FnOnce(&FrameImage) -> Result<(), RenderError>,
    ) -> bool {
        let mut record = self.record(task, preparation);
        let outcome = self
            .trace(task, &ready.assembled, false, &mut record, |session| {
                session.draw(&ready.assembled.frame, None)
            })
            .and_then(|image| timed(&mut record.write_seconds, || shown(&image)));
        // What went wrong is told when the picture is to be finished.
        if outcome.is_err() {
            return false;
        }
        record.status = Status::Preview;
        self.conclude(task.number, record, outcome)
    }

    /// What is known of a frame that is ready.
    pub fn record(&self, task: &FrameTask, preparation: Preparation) -> FrameRecord {
        let output = picture(&self.pattern, task.number);
        let mut record = FrameRecord::failed(task.number.to_string(), task.files.first().cloned(), output);
        record.read_seconds = preparation.read_seconds;
        record.build_seconds = preparation.build_seconds;
        record.wait_seconds = preparation.wait_seconds;
        record.target_error = self.settings.target_error;
        record.time_budget = self.options.time_budget.map(|budget| budget.as_secs_f64());
        record
    }

    /// What `draw` makes of a frame, with all that is to be told about it.
    pub fn trace(
        &mut self,
        task: &FrameTask,
        assembled: &Assembled,
        is_final: bool,
        record: &mut FrameRecord,
        draw: impl FnOnce(&Self) -> Result<Drawn, RenderError>,
    ) -> Result<FrameImage, RenderError> {
        describe(record, assembled);
        record.threads = rayon::current_num_threads();
        let needs = &assembled.frame.needs;
        self.sampling.integrator = Integrator::new(&self.settings).on(needs);
        let left_out = self.sampling.integrator.left_out(needs);
        record.left_out.extend(left_out.into_iter().map(Into::into));
        for warning in &record.warnings {
            self.observer.warning(warning);
        }
        self.sampling.seed = self.seeds.of_frame(task.number)?;
        let drawn = timed(&mut record.render_seconds, || draw(self))?;
        let Drawn { image, counters, beams, stopped_by, dropped } = drawn;
        record.counters = counters;
        record.beams = beams;
        record.samples = image.samples();
        record.samples_per_pixel = PerPixel::of(&image);
        record.samples_dropped = dropped;
        record.stopped_by = Some(stopped_by);
        let estimate = estimate_error(&image, self.settings.confidence);
        record.relative_error = estimate.map(Into::into);
        // That a preview is noisy, or some of the samples are, is no news.
        let doubt = is_final.then(|| self.doubt(record, estimate)).flatten();
        for text in doubt.into_iter().chain(self.missed(record, estimate)) {
            self.observer.warning(&text);
            record.warnings.push(text);
        }
        if counters.too_many_mismatches(assembled.frame.roughness) {
            let (mismatches, rays) = (counters.label_mismatches, counters.rays);
            let scene = &self.job.world.description.file;
            let path = task.files.first().unwrap_or(scene).clone();
            if assembled.labelled {
                return Err(RenderError::Mismatches { path, mismatches, rays });
            }
            // What is inside follows from the closed surface alone; where that crosses itself there is no right answer.
            let text = format!(
                "{}: at {mismatches} of {rays} rays the surface, which carries no labels, overlaps itself or is open: \
                 refraction is wrong there; closed meshes that touch or overlap may each be a file of [[meshes]]",
                path.display()
            );
            self.observer.warning(&text);
            record.warnings.push(text);
        }
        Ok(image)
    }

    /// Draws a frame, or goes on with one that has a checkpoint.
    pub fn draw(&self, frame: &Frame, checkpoint: Option<&Checkpoint>) -> Result<Drawn, RenderError> {
        let mut accumulation = Accumulation::new(frame.views.opening.resolution());
        let (stopped_by, keeper) = self.go_on(&mut accumulation, frame, checkpoint)?;
        let in_halves = accumulation.in_halves();
        let (image, counters) = accumulation.finish();
        let dropped = in_halves.saturating_sub(image.samples());
        Ok(Drawn { image, counters, beams: keeper.beams(), stopped_by, dropped })
    }

    /// Draws until no more samples are needed; an error when the run is to stop before.
    fn go_on<'b>(
        &'b self,
        accumulation: &mut Accumulation,
        frame: &Frame,
        checkpoint: Option<&'b Checkpoint>,
    ) -> Result<(StoppedBy, Keeper<'b>), RenderError> {
        let loaded = checkpoint.filter(|_| self.options.resume).map(|c| c.load(accumulation));
        let mut keeper = Keeper::new(self.observer, self.options, checkpoint);
        match loaded {
            Some(Ok(Some(seconds))) => keeper.goes_on(seconds),
            Some(Err(reason)) => self.observer.warning(&reason),
            Some(Ok(None)) | None => {}
        }
        let stopped_by = accumulate(accumulation, frame, &self.sampling, &keeper);
        let may_go_on = stopped_by.is_none_or(|reason| reason == StoppedBy::Time);
        if may_go_on && accumulation.is_begun() {
            keeper.save(accumulation);
        }
        stopped_by.map(|reason| (reason, keeper)).ok_or(RenderError::Interrupted)
    }

    /// Writes the picture and, if that is asked for, `frame_0001.denoised.exr` beside `frame_0001.exr`.
    fn write_all(
        &self,
        image: &FrameImage,
        camera: &Camera,
        of: Of<'_>,
        path: &Path,
    ) -> Result<(), RenderError> {
        // A denoiser that fails does not cost the picture.
        let denoised = self.denoiser.as_ref().map_or(Ok(()), |denoiser| {
            let path = denoised_path(path);
            self.write(&denoiser.denoised(image)?, camera, of, &path, true)
        });
        self.write(image, camera, of, path, false).and(denoised)
    }

    fn write(
        &self,
        image: &FrameImage,
        camera: &Camera,
        of: Of<'_>,
        path: &Path,
        denoised: bool,
    ) -> Result<(), RenderError> {
        let output = &self.job.world.description.output;
        let metadata = self.metadata(camera, of, denoised);
        // The other layers are those of the picture with its noise.
        let aovs: &[Aov] = if denoised { &[] } else { &output.aovs };
        let png = png_path(&self.job.world.description, path);
        Ok(write_frame(image, &metadata, path, png.as_deref(), aovs, output.exposure)?)
    }

    /// What the header of a picture says.
    pub fn metadata(&self, camera: &Camera, of: Of<'_>, denoised: bool) -> ImageMetadata {
        let world = &self.job.world;
        ImageMetadata {
            frame_number: of.number.integer().and_then(|n| i32::try_from(n).ok()).unwrap_or(0),
            fps: world.fps(),
            world_to_camera: camera.world_to_camera(world.origin),
            world_to_ndc: camera.world_to_ndc(world.origin),
            attributes: self
                .attributes(of)
                .into_iter()
                .chain(denoised.then(|| ("floe:denoised".into(), "Open Image Denoise".into())))
                .collect(),
        }
    }

    /// The seconds after which a frame was cut, if it was.
    fn cut_after(&self, of: Of<'_>) -> Option<f64> {
        let budget = self.options.time_budget.filter(|_| of.stopped_by == Some(StoppedBy::Time))?;
        Some(budget.as_secs_f64())
    }

    /// Why there are not more samples, where that can be told apart.
    fn stopped(&self, of: Of<'_>) -> impl Iterator<Item = (&'static str, String)> {
        let is_cut = of.stopped_by == Some(StoppedBy::Time);
        let is_told = is_cut || self.settings.target_error.is_some();
        of.stopped_by.filter(|_| is_told).map(|reason| ("stoppedBy", reason.name().to_owned())).into_iter()
    }

    /// The settings that made the picture.
    fn attributes(&self, of: Of<'_>) -> Vec<(String, String)> {
        let Of { number, identity, .. } = of;
        let lanes = match self.job.world.mode {
            LaneMode::Rgb => "rgb",
            LaneMode::Spectral => "spectral",
        };
        let s = &self.settings;
        [
            ("frame", number.to_string()),
            ("integrator", self.sampling.integrator.name().into()),
            ("lanes", lanes.into()),
            ("samples", s.samples.to_string()),
            ("seed", s.seed.to_string()),
            ("seedMode", self.seeds.mode(number).name().into()),
            ("maxDepth", s.max_depth.to_string()),
            ("split", s.split.to_string()),
            ("similarity", s.similarity.to_string()),
        ]
        .into_iter()
        .chain(s.dispersion.then(|| ("dispersion", s.dispersion.to_string())))
        .chain((s.forced_scattering > 0).then(|| ("forcedScattering", s.forced_scattering.to_string())))
        .chain(
            s.target_error.into_iter().flat_map(|error| {
                [("targetError", error.to_string()), ("confidence", s.confidence.to_string())]
            }),
        )
        .chain(self.stopped(of))
        .map(|(name, value)| (format!("floe:{name}"), value))
        .chain([
            (FINGERPRINT.into(), identity.fingerprint.to_string()),
            (MESH_HASH.into(), identity.mesh_hash.clone()),
        ])
        .chain(self.cut_after(of).map(|seconds| (TIME_BUDGET.into(), seconds.to_string())))
        .collect()
    }
}

/// Which frame a picture is of, and why it has not more samples.
#[derive(Clone, Copy)]
pub(super) struct Of<'a> {
    pub number: FrameNumber,
    pub identity: &'a Identity,
    pub stopped_by: Option<StoppedBy>,
}

/// A frame that is drawn.
pub(super) struct Drawn {
    image: FrameImage,
    counters: Counters,
    beams: BeamRecord,
    stopped_by: StoppedBy,
    dropped: u64,
}

fn describe(record: &mut FrameRecord, assembled: &Assembled) {
    let frame = &assembled.frame;
    record.triangles = frame.geometry.triangles.len();
    record.interfaces = assembled
        .interfaces
        .iter()
        .map(|(i, count)| (format!("{}|{}", i.front.0, i.back.0), *count))
        .collect();
    record.accel_bytes = frame.accel.bytes();
    record.accel_bytes_per_triangle = record.accel_bytes as f64 / record.triangles.max(1) as f64;
    record.hierarchy = Some(assembled.update.hierarchy);
    record.refitted = assembled.update.hierarchy == Hierarchy::Refitted;
    record.cost_ratio = assembled.update.cost_ratio;
    record.warnings.clone_from(&assembled.warnings);
    record.left_out.extend(assembled.reduced.iter().map(|reduced| {
        format!("exact scattering in \"{}\" (similarity {}, biased)", reduced.medium, reduced.order)
    }));
    record.left_out.extend(assembled.reflected.iter().map(ToString::to_string));
}
