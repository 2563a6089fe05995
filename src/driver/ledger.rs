//! The ledger: one JSON line a frame, `ledger.jsonl` beside the pictures. Each shard has its own, `ledger.3.jsonl`: lines
//! of two machines tear each other on network file systems. [`super::ledgers`] reads all of them.
//!
//! It holds what the pictures must not: run times, rays, and how often something rare happened.

use std::collections::BTreeMap;
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use serde::{Deserialize, Deserializer, Serialize};

use super::error::RenderError;
use super::lap;
use super::samples_range::SamplesRange;
use super::stopping::StoppedBy;
use crate::accel::Hierarchy;
use crate::film::{ErrorEstimate, FrameImage};
use crate::integrator::Counters;
use crate::sequence::Shard;

/// What became of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// The picture is there.
    Complete,
    /// Some of its samples are there, in a file of their own.
    Partial,
    /// There is a PNG of few samples to look at; the picture is still to come.
    Preview,
    /// There is no picture.
    Failed,
    /// There is no picture yet: the run was asked to stop.
    Interrupted,
}

/// A line of the ledger. What a line of an older version lacks is as of a frame of which nothing is known.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(default)]
pub struct FrameRecord {
    /// Frame number as it is in the file's name.
    pub frame: String,
    /// What became of it.
    pub status: Status,
    /// Why there is no picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
    /// The frame's file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// The picture.
    pub output: PathBuf,
    /// Triangles, surfaces and the extended sea included.
    pub triangles: usize,
    /// Triangles of the frame's mesh by "front|back" labels.
    pub interfaces: BTreeMap<String, usize>,
    /// Bytes of the hierarchy.
    pub accel_bytes: usize,
    /// The same for one triangle.
    pub accel_bytes_per_triangle: f64,
    /// What became of the hierarchy of the frame before; `None` when the frame could not be assembled.
    pub hierarchy: Option<Hierarchy>,
    /// True when it was refitted.
    pub refitted: bool,
    /// Cost of the refitted hierarchy relative to that when it was built: the reason when it was rebuilt after all.
    pub cost_ratio: Option<f32>,
    /// Reading the mesh, mostly while the frame before was rendered.
    pub read_seconds: f64,
    /// Checking it, stitching, normals, hierarchy; likewise.
    pub build_seconds: f64,
    /// How long nothing was rendered because the frame was not ready.
    pub wait_seconds: f64,
    /// Light transport, in this run.
    pub render_seconds: f64,
    /// Encoding and writing.
    pub write_seconds: f64,
    /// CPU seconds of the whole process since it last wrote a line, what makes the next frame ready included; of a merged
    /// frame those of its parts too.
    pub cpu_seconds: Option<f64>,
    /// Threads that rendered.
    pub threads: usize,
    /// When this was known, in seconds since 1970 by the clock of the machine.
    pub ended: Option<f64>,
    /// Samples over all pixels.
    pub samples: u64,
    /// The same of a pixel; `None` when there is no picture.
    pub samples_per_pixel: Option<PerPixel>,
    /// Samples that were drawn but are in no mean, since the other half of the frame did not ask for them.
    pub samples_dropped: u64,
    /// Why there are not more samples; `None` when there is no picture.
    pub stopped_by: Option<StoppedBy>,
    /// Relative error at which the frame was to stop.
    pub target_error: Option<f64>,
    /// Seconds that its light transport might take, in all runs.
    pub time_budget: Option<f64>,
    /// Estimated relative error; `None` with fewer than two replicates.
    pub relative_error: Option<RelativeError>,
    /// The triangles that bend the sun's light to where it is looked for.
    #[serde(flatten)]
    pub beams: BeamRecord,
    /// Rays and rare events, those before a checkpoint included.
    #[serde(flatten)]
    pub counters: Counters,
    /// Light that the picture lacks.
    pub left_out: Vec<String>,
    /// What the user should look at.
    pub warnings: Vec<String>,
}

/// What [`Beams`] are made of; nothing where a frame has none.
///
/// [`Beams`]: crate::integrator::Beams
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct BeamRecord {
    /// Triangles and pieces of them, those whose own normal may be taken for the interpolated one twice.
    pub beams: usize,
    /// Bytes that they occupy.
    pub beam_bytes: usize,
    /// Seconds that it took to build them, which are among those of rendering.
    pub beam_seconds: f64,
}

/// Estimate and confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RelativeError {
    /// Estimate of the root of the mean relative squared error of this picture.
    pub estimate: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end; `null` in the ledger where there is none.
    #[serde(deserialize_with = "or_infinite")]
    pub high: f64,
    /// Its confidence.
    pub confidence: f64,
}

/// Samples of the pixels of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PerPixel {
    /// Their mean.
    pub mean: f64,
    /// The fewest.
    pub least: u32,
    /// The most.
    pub most: u32,
}

impl PerPixel {
    /// Of a picture; `None` of one without pixels.
    pub fn of(image: &FrameImage) -> Option<Self> {
        let samples = || image.pixels.iter().map(|pixel| pixel.samples);
        let mean = image.samples() as f64 / image.pixels.len() as f64;
        Some(Self { mean, least: samples().min()?, most: samples().max()? })
    }
}

impl From<ErrorEstimate> for RelativeError {
    fn from(e: ErrorEstimate) -> Self {
        Self { estimate: e.relative, low: e.low, high: e.high, confidence: e.confidence }
    }
}

/// JSON has no number for what has no end.
fn or_infinite<'de, D: Deserializer<'de>>(value: D) -> Result<f64, D::Error> {
    Ok(Option::<f64>::deserialize(value)?.unwrap_or(f64::INFINITY))
}

impl Default for FrameRecord {
    fn default() -> Self {
        Self::failed(String::new(), None, PathBuf::new())
    }
}

impl FrameRecord {
    /// A frame of which nothing is known yet.
    pub fn failed(frame: String, file: Option<PathBuf>, output: PathBuf) -> Self {
        Self {
            frame,
            status: Status::Failed,
            error: None,
            file,
            output,
            triangles: 0,
            interfaces: BTreeMap::new(),
            accel_bytes: 0,
            accel_bytes_per_triangle: 0.0,
            hierarchy: None,
            refitted: false,
            cost_ratio: None,
            read_seconds: 0.0,
            build_seconds: 0.0,
            wait_seconds: 0.0,
            render_seconds: 0.0,
            write_seconds: 0.0,
            cpu_seconds: None,
            threads: 0,
            ended: None,
            samples: 0,
            samples_per_pixel: None,
            samples_dropped: 0,
            stopped_by: None,
            target_error: None,
            time_budget: None,
            relative_error: None,
            beams: BeamRecord::default(),
            counters: Counters::default(),
            left_out: Vec::new(),
            warnings: Vec::new(),
        }
    }

    /// It is known now what became of the frame.
    pub(super) fn end(&mut self) {
        self.cpu_seconds = Some(self.cpu_seconds.unwrap_or_default() + lap::since_last());
        self.ended = UNIX_EPOCH.elapsed().ok().map(|time| (1000.0 * time.as_secs_f64()).round() / 1000.0);
    }

    /// What the frame adds to the run: waiting for it, rendering and writing.
    pub fn seconds(&self) -> f64 {
        self.wait_seconds + self.render_seconds + self.write_seconds
    }
}

/// Appends to the ledger of a folder.
#[derive(Clone, Debug)]
pub struct Ledger {
    path: PathBuf,
}

impl Ledger {
    /// The ledger of a run, of its shard, or of its samples of each frame, beside a picture: lines of two machines tear each
    /// other on network file systems. It is made if it is not there: a folder that cannot be written to is found out before
    /// anything is rendered.
    ///
    /// # Errors
    /// [`RenderError::CannotCreate`] for the folder or the file.
    pub fn beside(
        picture: &Path,
        shard: Option<Shard>,
        range: Option<SamplesRange>,
    ) -> Result<Self, RenderError> {
        let shard = shard.map_or_else(String::new, |shard| format!("{}.", shard.number()));
        let range = range.map_or_else(String::new, |range| format!("{}-{}.", range.first, range.end));
        let name = format!("ledger.{shard}{range}jsonl");
        let ledger = Self { path: picture.with_file_name(name) };
        let folder = picture.parent().unwrap_or(Path::new(""));
        std::fs::create_dir_all(folder)
            .and_then(|()| ledger.open().map(drop))
            .map_err(|source| RenderError::CannotCreate { path: ledger.path.clone(), source })?;
        Ok(ledger)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Appends a line in one write. What a full disk or a dead machine left of the line before it stays a line of its own.
    ///
    /// # Errors
    /// [`RenderError::CannotWrite`], such as when the disk is full.
    pub fn append(&self, record: &FrameRecord) -> Result<(), RenderError> {
        let write = || {
            let mut line = serde_json::to_vec(record)?;
            line.push(b'\n');
            let mut file = self.open()?;
            if !ends_a_line(&mut file)? {
                line.insert(0, b'\n');
            }
            file.write_all(&line)
        };
        write().map_err(|source| RenderError::CannotWrite { path: self.path.clone(), source })
    }

    fn open(&self) -> std::io::Result<std::fs::File> {
        std::fs::OpenOptions::new().create(true).read(true).append(true).open(&self.path)
    }
}

fn ends_a_line(file: &mut std::fs::File) -> std::io::Result<bool> {
    if file.seek(SeekFrom::End(0))? == 0 {
        return Ok(true);
    }
    let mut last = [0];
    file.seek(SeekFrom::End(-1))?;
    file.read_exact(&mut last)?;
    Ok(last == *b"\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_a_line_does_not_spoil_the_next() {
        let folder = tempfile::tempdir().unwrap();
        let ledger = Ledger::beside(&folder.path().join("a.exr"), "2/3".parse().ok(), None).unwrap();
        assert!(ledger.path().ends_with("ledger.2.jsonl"));
        let append = || ledger.append(&FrameRecord::failed("7".into(), None, "a.exr".into())).unwrap();
        append();
        ledger.open().unwrap().write_all(b"{\"frame\":\"8\",\"sta").unwrap();
        append();
        append();
        let text = std::fs::read_to_string(ledger.path()).unwrap();
        let lines: Vec<bool> =
            text.lines().map(|line| serde_json::from_str::<serde_json::Value>(line).is_ok()).collect();
        assert_eq!(lines, [true, false, true, true], "{text}");
    }
}
