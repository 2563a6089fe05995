//! Progress for programs: one JSON object a line on standard error.
//!
//! ```text
//! {"event":"started", ..}   progress | finished | failed | warning | message ..   {"event":"summary", .., "exit":0}
//! ```
//! `progress` comes once a second at most. Each line is whole, so that several workers may share a log.

use std::sync::{Mutex, MutexGuard, PoisonError};

use serde_json::{Map, Value, json};

use super::Reporter;
use super::advance::Advance;
use crate::cli::exit::Exit;
use crate::cli::streams::{event, say};
use crate::cli::watching::describe;
use crate::driver::watch::Phase;
use crate::driver::{FrameRecord, Job, Observer, Status, WatchStatus};
use crate::sequence::{FrameNumber, Shard};

/// Objects on standard error.
pub struct Json {
    quiet: bool,
    shard: Option<Shard>,
    advance: Mutex<Advance>,
}

impl Json {
    /// With `quiet` only of warnings, errors and the summary.
    pub fn new(quiet: bool, shard: Option<Shard>) -> Self {
        Self { quiet, shard, advance: Mutex::new(Advance::new()) }
    }

    fn lock(&self) -> MutexGuard<'_, Advance> {
        self.advance.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Tells an event; where all is in order only if that is wanted.
    fn tell(&self, mut object: Map<String, Value>) {
        if !self.quiet || matches!(object["event"].as_str(), Some("failed" | "warning" | "summary")) {
            object.insert("shard".into(), self.shard.map(Shard::number).into());
            event(&Value::Object(object));
        }
    }
}

impl Observer for Json {
    fn started(&self, frames: usize) {
        let mut advance = self.lock();
        advance.started(frames);
        self.tell(advance.event("started"));
    }

    fn frame(&self, number: FrameNumber) {
        self.lock().frame(number);
    }

    fn tiles(&self, done: usize, of: usize) {
        let mut advance = self.lock();
        if advance.tiles(done, of) {
            self.tell(advance.event("progress"));
        }
    }

    fn warning(&self, text: &str) {
        let [name, text] = ["warning", text].map(Value::from);
        self.tell(Map::from_iter([("event".into(), name), ("text".into(), text)]));
    }

    fn finished(&self, record: &FrameRecord) {
        let mut advance = self.lock();
        advance.finished(record);
        let name = if record.status == Status::Failed { "failed" } else { "finished" };
        let mut object = advance.event(name);
        object.extend(of_frame(record));
        self.tell(object);
    }

    fn opened(&self, job: &Job, _: &str) {
        if let Some(scene) = &job.written_scene {
            say(&format!("wrote {}: edit it to change camera, light and media", scene.display()));
        }
    }

    fn watching(&self, status: &WatchStatus) {
        let mut advance = self.lock();
        if !advance.is_time() {
            return;
        }
        let mut object = advance.event("progress");
        let rendered = match &status.phase {
            Phase::Rendering(all) => all.iter().map(|one| one.number.to_string()).collect(),
            Phase::Reading(number) => vec![number.to_string()],
            Phase::Waiting(_) => Vec::new(),
        };
        object.insert("frame".into(), rendered.first().cloned().into());
        object.insert("done".into(), status.drawn.into());
        object.insert("waiting".into(), status.queue.into());
        object.insert("failed".into(), status.failed.into());
        object.insert("frames_per_hour".into(), status.frames_per_hour.into());
        object.insert("text".into(), describe(status).into());
        self.tell(object);
    }
}

impl Reporter for Json {
    fn ended(&self, results: Value, exit: Exit) {
        let mut object = Map::from_iter([("event".into(), "summary".into())]);
        if let Value::Object(results) = results {
            object.extend(results);
        }
        object.insert("exit".into(), (exit as u8).into());
        self.tell(object);
    }
}

/// What became of a frame; `samples`, `seconds` and `relative_error` are those of the run.
fn of_frame(record: &FrameRecord) -> Map<String, Value> {
    let error = record.error.clone();
    let object = match record.status {
        Status::Failed => json!({ "frame": record.frame, "error": error }),
        status => json!({
            "frame": record.frame,
            "status": status,
            "output": record.output,
            "frame_seconds": record.seconds(),
            "frame_samples": record.samples,
            "samples_per_pixel": record.samples_per_pixel.map(|samples| samples.mean),
            "stopped_by": record.stopped_by,
            "frame_relative_error": record.relative_error,
        }),
    };
    match object {
        Value::Object(object) => object,
        _ => Map::new(),
    }
}
