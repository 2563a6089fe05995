//! Renders frames one after the other.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::error::RenderError;
use super::job::{FrameTask, Job};
use super::ledger::{FrameRecord, Ledger, Status};
use super::tiles::{Sampling, render_pixels};
use crate::film::{DEFAULT_CONFIDENCE, Filter, FrameImage, ImageMetadata, estimate_error, write_frame};
use crate::integrator::{AmbientOcclusion, Integrator, PathTracer};
use crate::mesh;
use crate::sampling::SampleSeed;
use crate::scene::FrameError;
use crate::scene::assembly::{Assembled, FrameMesh};
use crate::scene::description::{IntegratorKind, RenderDescription};
use crate::scene::frame::Frame;
use crate::sequence::{
    FrameNumber, FrameSelection, Gap, SequenceError, check_output_pattern, format_numbers, gaps, output_path,
};
use crate::spectrum::LaneMode;

/// What the command line may override.
#[derive(Clone, Debug, Default)]
pub struct RenderOptions {
    /// Only these frames.
    pub frames: Option<FrameSelection>,
    /// Pattern of the pictures' names.
    pub output: Option<String>,
    /// Samples a pixel.
    pub samples: Option<u32>,
    /// Seed.
    pub seed: Option<u64>,
    /// Threads; all cores without it.
    pub threads: Option<usize>,
    /// Renders the other frames after a bad one.
    pub keep_going: bool,
}

/// Hears of what happens while frames are rendered.
pub trait Observer: Sync {
    /// The frames that will be rendered.
    fn started(&self, _frames: usize) {}
    /// A frame is begun.
    fn frame(&self, _number: FrameNumber) {}
    /// Tiles of the frame that are done, of how many.
    fn tiles(&self, _done: usize, _of: usize) {}
    /// Something that the user should look at.
    fn warning(&self, _text: &str) {}
    /// A frame is done, or has failed.
    fn finished(&self, _record: &FrameRecord) {}
}

/// What became of a job.
#[derive(Debug)]
pub struct RenderReport {
    /// One record a frame, in order.
    pub frames: Vec<FrameRecord>,
    /// The frames that have no picture, and why.
    pub failures: Vec<(FrameNumber, RenderError)>,
    /// Frames that were not tried because one before them failed.
    pub skipped: usize,
    /// From start to end.
    pub seconds: f64,
    /// Pattern of the pictures' names.
    pub pattern: String,
    /// The ledger.
    pub ledger: PathBuf,
}

/// Renders the frames of a job.
///
/// # Errors
/// When nothing can be rendered at all; what goes wrong with single frames is in the report.
pub fn render(
    job: &Job,
    options: &RenderOptions,
    observer: &dyn Observer,
) -> Result<RenderReport, RenderError> {
    let (tasks, absent) = chosen(job, options)?;
    let pattern = options.output.clone().unwrap_or_else(|| job.output_pattern());
    check_pictures(&pattern, tasks.len())?;
    let pool = thread_pool(options.threads)?;
    let start = Instant::now();
    let mut session = Session::new(job, options, observer, &pattern, &tasks)?;
    observer.started(tasks.len());
    if options.frames.is_none() {
        gaps(&job.files).iter().for_each(|gap| observer.warning(&missing(gap)));
    }
    for number in absent {
        let record = FrameRecord::failed(number.to_string(), None, picture(&pattern, number));
        session.conclude(number, record, Err(not_there(job, number)));
    }
    for (i, task) in tasks.iter().enumerate() {
        observer.frame(task.number);
        let (record, outcome) = pool.install(|| session.frame(task));
        let is_done = session.conclude(task.number, record, outcome);
        if !is_done && !options.keep_going {
            session.report.skipped = tasks.len() - i - 1;
            break;
        }
    }
    session.report.seconds = start.elapsed().as_secs_f64();
    Ok(session.report)
}

/// The frames to be rendered, and those that were asked for by their number but are not there.
fn chosen(job: &Job, options: &RenderOptions) -> Result<(Vec<FrameTask>, Vec<FrameNumber>), RenderError> {
    let Some(selection) = &options.frames else { return Ok((job.tasks(), Vec::new())) };
    let tasks = job.select(selection)?;
    let absent = selection.absent(&numbers(job));
    match absent.first() {
        Some(&number) if !options.keep_going => Err(not_there(job, number)),
        _ => Ok((tasks, absent)),
    }
}

fn numbers(job: &Job) -> Vec<FrameNumber> {
    job.tasks().iter().map(|task| task.number).collect()
}

fn not_there(job: &Job, number: FrameNumber) -> RenderError {
    SequenceError::NotThere { number, available: format_numbers(&numbers(job)) }.into()
}

fn missing(gap: &Gap) -> String {
    if gap.first == gap.last {
        format!("frame {gap} is missing in the sequence")
    } else {
        format!("frames {gap} are missing in the sequence")
    }
}

/// Checks that a pattern can name the pictures of some frames.
///
/// # Errors
/// [`RenderError::NotExr`] and those of [`check_output_pattern`].
pub fn check_pictures(pattern: &str, frames: usize) -> Result<(), RenderError> {
    check_output_pattern(pattern, frames)?;
    let extension = Path::new(pattern).extension();
    if extension.is_some_and(|e| e.eq_ignore_ascii_case("exr")) {
        return Ok(());
    }
    let example = Path::new(pattern).with_extension("exr").to_string_lossy().into_owned();
    Err(RenderError::NotExr { pattern: pattern.into(), example })
}

fn thread_pool(threads: Option<usize>) -> Result<rayon::ThreadPool, RenderError> {
    let threads = threads.unwrap_or(0);
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|e| RenderError::Threads { threads, reason: e.to_string() })
}

fn effective(scene: &RenderDescription, options: &RenderOptions) -> RenderDescription {
    RenderDescription {
        samples: options.samples.unwrap_or(scene.samples),
        seed: options.seed.unwrap_or(scene.seed),
        ..scene.clone()
    }
}

fn sampling_of(settings: &RenderDescription) -> Sampling {
    let path = PathTracer { max_depth: settings.max_depth, split: settings.split };
    Sampling {
        integrator: match settings.integrator {
            IntegratorKind::Auto | IntegratorKind::Path => Integrator::Path(path),
            IntegratorKind::AmbientOcclusion => Integrator::AmbientOcclusion(AmbientOcclusion),
        },
        filter: Filter::new(settings.filter),
        samples: settings.samples,
        seed: SampleSeed { seed: settings.seed, frame: 0 },
    }
}

fn picture(pattern: &str, number: FrameNumber) -> PathBuf {
    PathBuf::from(output_path(pattern, number))
}

/// What the frames of one run have in common.
struct Session<'a> {
    job: &'a Job,
    pattern: String,
    settings: RenderDescription,
    sampling: Sampling,
    ledger: Ledger,
    report: RenderReport,
    /// The frame before, whose hierarchy may be refitted.
    previous: Option<Frame>,
    observer: &'a dyn Observer,
}

impl<'a> Session<'a> {
    fn new(
        job: &'a Job,
        options: &RenderOptions,
        observer: &'a dyn Observer,
        pattern: &str,
        tasks: &[FrameTask],
    ) -> Result<Self, RenderError> {
        let settings = effective(&job.world.description.render, options);
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
        let sampling = sampling_of(&settings);
        Ok(Self {
            job,
            pattern: pattern.into(),
            settings,
            sampling,
            ledger,
            report,
            previous: None,
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

    /// Renders one frame; the record is there whatever happens.
    fn frame(&mut self, task: &FrameTask) -> (FrameRecord, Result<(), RenderError>) {
        let output = picture(&self.pattern, task.number);
        let mut record = FrameRecord::failed(task.number.to_string(), task.file.clone(), output);
        let outcome = self.try_frame(task, &mut record);
        if outcome.is_ok() {
            record.status = Status::Complete;
        }
        (record, outcome)
    }

    fn try_frame(&mut self, task: &FrameTask, record: &mut FrameRecord) -> Result<(), RenderError> {
        let mesh = timed(&mut record.read_seconds, || read(task.file.as_deref()))?;
        let previous = self.previous.take();
        let world = &self.job.world;
        let assembled = timed(&mut record.build_seconds, || world.assemble(task.number, mesh, previous))?;
        describe(record, &assembled);
        for warning in &record.warnings {
            self.observer.warning(warning);
        }
        let labelled = assembled.labelled;
        let frame = self.previous.insert(assembled.frame);
        self.sampling.seed.frame = task.number.millionths();
        let observer = self.observer;
        let (image, counters) = timed(&mut record.render_seconds, || {
            render_pixels(frame, &self.sampling, &|done, of| observer.tiles(done, of))
        });
        record.counters = counters;
        record.samples = image.samples();
        record.relative_error = estimate_error(&image, DEFAULT_CONFIDENCE).map(Into::into);
        if counters.too_many_mismatches() {
            let (mismatches, rays) = (counters.label_mismatches, counters.rays);
            let path = task.file.clone().unwrap_or_else(|| world.description.file.clone());
            if labelled {
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
        timed(&mut record.write_seconds, || self.write(&image, task.number, &output))
    }

    fn write(&self, image: &FrameImage, number: FrameNumber, path: &Path) -> Result<(), RenderError> {
        let world = &self.job.world;
        let output = &world.description.output;
        let metadata = ImageMetadata {
            frame_number: number.integer().and_then(|n| i32::try_from(n).ok()).unwrap_or(0),
            fps: world.frames().map_or(24.0, |f| f.fps),
            world_to_camera: world.camera.world_to_camera(world.origin),
            world_to_ndc: world.camera.world_to_ndc(world.origin),
            attributes: self.attributes(number),
        };
        let png = output.png.then(|| path.with_extension("png"));
        Ok(write_frame(image, &metadata, path, png.as_deref(), &output.aovs, output.exposure)?)
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
            ("maxDepth", s.max_depth.to_string()),
            ("split", s.split.to_string()),
        ]
        .map(|(name, value)| (format!("floe:{name}"), value))
        .into()
    }
}

fn read(file: Option<&Path>) -> Result<Option<FrameMesh>, RenderError> {
    let Some(path) = file else { return Ok(None) };
    let mesh = mesh::read(path).map_err(FrameError::from)?;
    Ok(Some(FrameMesh { path: path.into(), mesh }))
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
    record.refitted = assembled.refitted;
    record.warnings.clone_from(&assembled.warnings);
    if frame.needs.sun_behind_interface {
        record.left_out.push("sunlight through refracting interfaces".into());
    }
}

fn timed<T>(seconds: &mut f64, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    *seconds += start.elapsed().as_secs_f64();
    result
}
