//! Renders and writes the frames of one run, each when its turn comes.

use std::path::{Path, PathBuf};

use super::ahead::{Preparation, timed};
use super::error::RenderError;
use super::frame_seeds::FrameSeeds;
use super::job::{FrameTask, Job};
use super::ledger::{FrameRecord, Ledger, Status};
use super::render::{Observer, RenderOptions, RenderReport};
use super::tiles::{Sampling, render_pixels};
use crate::accel::Hierarchy;
use crate::film::{DEFAULT_CONFIDENCE, Denoiser, FrameImage, ImageMetadata, estimate_error, write_frame};
use crate::scene::assembly::Assembled;
use crate::scene::description::{Aov, RenderDescription};
use crate::sequence::{FrameNumber, output_path};
use crate::spectrum::LaneMode;

/// The frames of one run: their settings, and what has become of them.
pub(super) struct Session<'a> {
    job: &'a Job,
    pattern: String,
    settings: RenderDescription,
    sampling: Sampling,
    seeds: FrameSeeds,
    denoiser: Option<Denoiser>,
    ledger: Ledger,
    pub report: RenderReport,
    observer: &'a dyn Observer,
}

impl<'a> Session<'a> {
    pub fn new(
        job: &'a Job,
        options: &RenderOptions,
        observer: &'a dyn Observer,
        pattern: &str,
        tasks: &[FrameTask],
    ) -> Result<Self, RenderError> {
        let settings = effective(&job.world.description.render, options);
        let denoise = options.denoise || job.world.description.output.denoise;
        let denoiser = denoise.then(Denoiser::load).transpose()?;
        let first_picture = tasks.first().map_or_else(PathBuf::new, |t| picture(pattern, t.number));
        let ledger = Ledger::beside(&first_picture)?;
        let report = RenderReport {
            frames: Vec::new(),
            failures: Vec::new(),
            skipped: 0,
            seconds: 0.0,
            pattern: pattern.into(),
            ledger: ledger.path().into(),
        };
        let sampling = Sampling::new(&settings);
        let seeds = FrameSeeds::new(&job.world.description.render, settings.seed, settings.samples);
        if let Some(text) = seeds.overlap().filter(|_| job.files.len() > 1) {
            observer.warning(&text);
        }
        Ok(Self {
            job,
            pattern: pattern.into(),
            settings,
            sampling,
            seeds,
            denoiser,
            ledger,
            report,
            observer,
        })
    }

    /// Tells the ledger, the observer and the report what became of a frame; true when its picture is there.
    fn conclude(
        &mut self,
        number: FrameNumber,
        mut record: FrameRecord,
        outcome: Result<(), RenderError>,
    ) -> bool {
        let outcome = outcome.inspect_err(|error| record.error = Some(error.to_string()));
        // What became of the picture is worth more than that the ledger could not be written.
        let outcome = outcome.and(self.ledger.append(&record));
        record.error = outcome.as_ref().err().map(ToString::to_string);
        self.observer.finished(&record);
        self.report.frames.push(record);
        let Err(error) = outcome else { return true };
        self.report.failures.push((number, error));
        false
    }

    /// A frame that was asked for by its number but is not there.
    pub fn absent(&mut self, number: FrameNumber, error: RenderError) {
        let record = FrameRecord::failed(number.to_string(), None, picture(&self.pattern, number));
        self.conclude(number, record, Err(error));
    }

    /// Renders a frame that is ready, or tells what is wrong with it; true when its picture is there.
    pub fn turn(
        &mut self,
        task: &FrameTask,
        prepared: Result<&Assembled, RenderError>,
        preparation: Preparation,
    ) -> bool {
        let output = picture(&self.pattern, task.number);
        let mut record = FrameRecord::failed(task.number.to_string(), task.file.clone(), output);
        record.read_seconds = preparation.read_seconds;
        record.build_seconds = preparation.build_seconds;
        record.wait_seconds = preparation.wait_seconds;
        let outcome = prepared.and_then(|assembled| self.render(task, assembled, &mut record));
        if outcome.is_ok() {
            record.status = Status::Complete;
        }
        self.conclude(task.number, record, outcome)
    }

    fn render(
        &mut self,
        task: &FrameTask,
        assembled: &Assembled,
        record: &mut FrameRecord,
    ) -> Result<(), RenderError> {
        describe(record, assembled);
        let left_out = self.sampling.integrator.left_out(&assembled.frame.needs);
        record.left_out.extend(left_out.into_iter().map(Into::into));
        for warning in &record.warnings {
            self.observer.warning(warning);
        }
        self.sampling.seed = self.seeds.of_frame(task.number)?;
        let observer = self.observer;
        let (image, counters) = timed(&mut record.render_seconds, || {
            render_pixels(&assembled.frame, &self.sampling, &|done, of| observer.tiles(done, of))
        });
        record.counters = counters;
        record.samples = image.samples();
        record.relative_error = estimate_error(&image, DEFAULT_CONFIDENCE).map(Into::into);
        if counters.too_many_mismatches() {
            let (mismatches, rays) = (counters.label_mismatches, counters.rays);
            let path = task.file.clone().unwrap_or_else(|| self.job.world.description.file.clone());
            if assembled.labelled {
                return Err(RenderError::Mismatches { path, mismatches, rays });
            }
            // What is inside follows from the closed surface alone; where that crosses itself there is no right answer.
            let text = format!(
                "{}: at {mismatches} of {rays} rays the surface, which carries no labels, overlaps itself or is open: \
                 refraction is wrong there",
                path.display()
            );
            self.observer.warning(&text);
            record.warnings.push(text);
        }
        let output = record.output.clone();
        timed(&mut record.write_seconds, || {
            // A denoiser that fails does not cost the picture.
            let denoised = self.denoise(&image, task.number, &output);
            self.write(&image, task.number, &output, false).and(denoised)
        })
    }

    /// Writes the picture without its noise, `frame_0001.denoised.exr` beside `frame_0001.exr`, if that is asked for.
    fn denoise(&self, image: &FrameImage, number: FrameNumber, path: &Path) -> Result<(), RenderError> {
        let Some(denoiser) = &self.denoiser else { return Ok(()) };
        self.write(&denoiser.denoised(image)?, number, &path.with_extension("denoised.exr"), true)
    }

    fn write(
        &self,
        image: &FrameImage,
        number: FrameNumber,
        path: &Path,
        denoised: bool,
    ) -> Result<(), RenderError> {
        let world = &self.job.world;
        let output = &world.description.output;
        let metadata = ImageMetadata {
            frame_number: number.integer().and_then(|n| i32::try_from(n).ok()).unwrap_or(0),
            fps: world.frames().map_or(24.0, |f| f.fps),
            world_to_camera: world.camera.world_to_camera(world.origin),
            world_to_ndc: world.camera.world_to_ndc(world.origin),
            attributes: self
                .attributes(number)
                .into_iter()
                .chain(denoised.then(|| ("floe:denoised".into(), "Open Image Denoise".into())))
                .collect(),
        };
        // The other layers are those of the picture with its noise.
        let aovs: &[Aov] = if denoised { &[] } else { &output.aovs };
        let png = output.png.then(|| path.with_extension("png"));
        Ok(write_frame(image, &metadata, path, png.as_deref(), aovs, output.exposure)?)
    }

    /// The settings that made the picture.
    fn attributes(&self, number: FrameNumber) -> Vec<(String, String)> {
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
        .chain((s.forced_scattering > 0).then(|| ("forcedScattering", s.forced_scattering.to_string())))
        .map(|(name, value)| (format!("floe:{name}"), value))
        .collect()
    }
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
}

fn effective(scene: &RenderDescription, options: &RenderOptions) -> RenderDescription {
    RenderDescription {
        samples: options.samples.unwrap_or(scene.samples),
        seed: options.seed.unwrap_or(scene.seed),
        ..scene.clone()
    }
}

fn picture(pattern: &str, number: FrameNumber) -> PathBuf {
    PathBuf::from(output_path(pattern, number))
}
