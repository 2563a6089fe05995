//! Some of the samples of a frame, on the disk: `frame_0007.0-64.partial` beside `frame_0007.exr`.
//!
//! ```text
//! head (what kind of file, sizes of what is in it), label, tiles, counters, beams and what it took, seal
//! ```
//!
//! The label says which samples of which frame of which scene these are, and what has drawn them. The tiles hold the sums
//! of each pixel, exactly: those of several files, added in any order, are those of one run.

use std::fs::File;
use std::io::Read;
use std::ops::AddAssign;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::accumulation::{Accumulation, TilePart};
use super::error::RenderError;
use super::fingerprint::{Fingerprint, Fingerprints, FrameSource, PIXELS};
use super::job::{FrameTask, Job};
use super::lap;
use super::ledger::BeamRecord;
use super::render::RenderOptions;
use super::samples_range::SamplesRange;
use super::sealed::{self, layout};
use crate::film::FilmError;
use crate::integrator::Counters;
use crate::sequence::FrameNumber;

/// What every such file begins with, of any version.
const KIND: &str = "floe partial ";

/// Bytes in which there are head and label; they take some 100.
const LONGEST_LABEL: u64 = 4096;

fn head() -> String {
    format!("{KIND}2 {}\n", layout())
}

/// Which samples of which frame there are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Label {
    version: String,
    pixels: u32,
    frame: i64,
    resolution: [u32; 2],
    /// Samples of a pixel of which these are some.
    samples: u32,
    pub range: SamplesRange,
    fingerprint: [u8; 16],
}

/// The frame that partials are wanted of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    pub number: FrameNumber,
    pub resolution: [u32; 2],
    pub samples: u32,
    pub fingerprint: Fingerprint,
}

/// What is in a partial besides its label.
#[derive(Debug, PartialEq, Deserialize)]
pub(super) struct Contents {
    pub parts: Vec<TilePart>,
    pub counters: Counters,
    pub beams: BeamRecord,
    pub took: Took,
}

/// What samples took, in all runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Took {
    /// Light transport.
    pub seconds: f64,
    /// The same times the threads that rendered.
    pub thread_seconds: f64,
    /// CPU seconds of the processes.
    pub cpu_seconds: f64,
}

impl Took {
    /// Samples that took so long, of which this run has `rendered` the rest; of those before its CPU time is not known, but
    /// their threads were busy.
    pub fn of(seconds: f64, rendered: f64, threads: usize) -> Self {
        let threads = threads as f64;
        let cpu_seconds = lap::so_far() + threads * (seconds - rendered).max(0.0);
        Self { seconds, thread_seconds: threads * seconds, cpu_seconds }
    }

    /// Threads that rendered, in the mean over time.
    pub fn threads(&self) -> usize {
        (self.thread_seconds / self.seconds).round().max(1.0) as usize
    }
}

impl AddAssign for Took {
    fn add_assign(&mut self, other: Self) {
        self.seconds += other.seconds;
        self.thread_seconds += other.thread_seconds;
        self.cpu_seconds += other.cpu_seconds;
    }
}

impl Wanted {
    /// A frame as its files and the settings are now.
    ///
    /// # Errors
    /// When one of its files cannot be read.
    pub fn read(
        job: &Job,
        fingerprints: &Fingerprints,
        options: &RenderOptions,
        task: &FrameTask,
    ) -> Result<Self, RenderError> {
        let scene = &job.world.description;
        Ok(Self {
            number: task.number,
            resolution: scene.camera.resolution,
            samples: options.settings(&scene.render).samples,
            fingerprint: FrameSource::read(&job.world, fingerprints, task)?.identity.fingerprint,
        })
    }

    /// The label of some of its samples.
    pub fn label(&self, range: SamplesRange) -> Label {
        Label {
            version: env!("CARGO_PKG_VERSION").into(),
            pixels: PIXELS,
            frame: self.number.millionths(),
            resolution: self.resolution,
            samples: self.samples,
            range,
            fingerprint: self.fingerprint.0,
        }
    }

    /// Checks that some samples are of this frame.
    ///
    /// # Errors
    /// Whose they are, and what to do, in words.
    pub fn check(&self, label: &Label) -> Result<(), String> {
        let Self { number, samples, resolution: [width, height], .. } = *self;
        let own = self.label(label.range);
        let again = format!("render it again with --samples-range {}", label.range);
        if (&label.version, label.pixels) != (&own.version, own.pixels) {
            return Err(format!("was drawn by floe {} with other pixels: {again}", label.version));
        }
        if label.frame != own.frame {
            return Err(format!("is of another frame than {number}: give it back its name, or remove it"));
        }
        if label.samples != samples {
            let of = label.samples;
            return Err(format!(
                "is a part of {of} samples, not of {samples}: merge with --samples {of}, or {again}"
            ));
        }
        if label.resolution != own.resolution {
            let [w, h] = label.resolution;
            return Err(format!("has {w} x {h} pixels, and the scene {width} x {height}: {again}"));
        }
        if label.fingerprint != own.fingerprint {
            return Err(format!(
                "is of another scene, another mesh, or other settings such as --seed, than frame {number} has now: merge \
                 with what it was rendered with, or {again}"
            ));
        }
        if label.range.end > samples || label.range.count() == 0 {
            return Err(DAMAGED.into());
        }
        Ok(())
    }
}

const DAMAGED: &str = "is damaged or cut short: remove it, and render it again";

fn unreadable(error: &std::io::Error) -> String {
    format!("cannot be read: {error}; check who may read it, or remove it and render it again")
}

/// Writes the samples of a range.
///
/// # Errors
/// When they cannot be written.
pub(super) fn write(
    path: &Path,
    label: &Label,
    sums: &Accumulation,
    beams: BeamRecord,
    took: Took,
) -> Result<(), FilmError> {
    let (parts, counters) = sums.parts();
    sealed::write(path, head().as_bytes(), &(label, parts, counters, beams, took))
}

/// Reads the label alone.
///
/// # Errors
/// Why there is none, and what to do, in words.
pub(super) fn read_label(path: &Path) -> Result<Label, String> {
    let mut start = Vec::new();
    let read = File::open(path).and_then(|file| file.take(LONGEST_LABEL).read_to_end(&mut start));
    read.map_err(|error| unreadable(&error))?;
    Ok(label_of(&start)?.0)
}

/// Reads the sums of a label.
///
/// # Errors
/// What is wrong with them, and what to do, in words.
pub(super) fn read(path: &Path, label: &Label) -> Result<Contents, String> {
    let bytes = std::fs::read(path).map_err(|error| unreadable(&error))?;
    let (found, contents) = decoded(&bytes)?;
    if found == *label { Ok(contents) } else { Err("was replaced meanwhile: merge again".into()) }
}

fn decoded(bytes: &[u8]) -> Result<(Label, Contents), String> {
    // Whose it is says more than that its seal is that of another version.
    label_of(bytes)?;
    let (label, rest) = label_of(sealed::unsealed(bytes).ok_or(DAMAGED)?)?;
    match postcard::take_from_bytes(rest) {
        Ok((contents, [])) => Ok((label, contents)),
        _ => Err(DAMAGED.into()),
    }
}

/// The label, and what is behind it.
fn label_of(bytes: &[u8]) -> Result<(Label, &[u8]), String> {
    let Some(body) = bytes.strip_prefix(head().as_bytes()) else {
        let is_other = bytes.starts_with(KIND.as_bytes());
        let other =
            "was left by another version of floe: take one version for all parts, and render it again";
        return Err(if is_other { other } else { DAMAGED }.into());
    };
    postcard::take_from_bytes(body).map_err(|_| DAMAGED.into())
}

#[cfg(test)]
mod tests;
