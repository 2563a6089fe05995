//! What the page shows, kept up to date by what the watch tells.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::UNIX_EPOCH;

use serde::Serialize;

use crate::cli::watching::describe;
use crate::driver::ledgers::{LedgerLine, Ledgers};
use crate::driver::picture::picture_path;
use crate::driver::watch::Phase;
use crate::driver::{FrameRecord, Job, Observer, Status, WatchStatus};
use crate::sequence::FrameNumber;

/// State and frames.
#[derive(Default)]
pub struct Board(Mutex<State>);

#[derive(Default)]
struct State {
    revision: u64,
    line: String,
    share: f32,
    drawn: usize,
    failed: usize,
    queue: usize,
    frames_per_hour: Option<f64>,
    frames: BTreeMap<FrameNumber, Entry>,
    /// The newest picture.
    latest: Option<PathBuf>,
}

/// One frame.
#[derive(Clone, Serialize)]
struct Entry {
    frame: String,
    /// Of the board when this was changed.
    revision: u64,
    state: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    problem: Option<String>,
    /// Render seconds and relative error, of the preview and of the picture.
    points: Vec<[f64; 2]>,
    #[serde(skip)]
    png: PathBuf,
}

/// The answer to a request for the state.
#[derive(Serialize)]
struct Answer<'a> {
    revision: u64,
    line: &'a str,
    share: f32,
    drawn: usize,
    failed: usize,
    queue: usize,
    frames_per_hour: Option<f64>,
    /// Tells one newest picture from another.
    latest: Option<u128>,
    frames: Vec<&'a Entry>,
}

impl Board {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes up what an earlier watch wrote into the ledger of the same pictures. Where they are follows from the pattern:
    /// what a ledger says may be of another folder, or of anyone.
    fn recall(&self, folder: &Path, pattern: &str) {
        let ledgers = Ledgers::in_folder(folder).unwrap_or_default();
        let mut state = self.lock();
        for LedgerLine { number, record, .. } in ledgers.lines {
            state.put(&FrameRecord { output: picture_path(pattern, number), ..record });
        }
    }

    /// State and frames that have changed since a revision, as JSON.
    pub fn json(&self, since: u64) -> String {
        let state = self.lock();
        let written = |path: &PathBuf| std::fs::metadata(path).and_then(|m| m.modified()).ok();
        let latest = state.latest.as_ref().and_then(written);
        let answer = Answer {
            revision: state.revision,
            line: &state.line,
            share: state.share,
            drawn: state.drawn,
            failed: state.failed,
            queue: state.queue,
            frames_per_hour: state.frames_per_hour,
            latest: latest.and_then(|time| time.duration_since(UNIX_EPOCH).ok()).map(|age| age.as_nanos()),
            frames: state.frames.values().filter(|entry| entry.revision > since).collect(),
        };
        serde_json::to_string(&answer).unwrap_or_default()
    }

    /// Where the newest picture is.
    pub fn latest(&self) -> Option<PathBuf> {
        self.lock().latest.clone()
    }

    /// Where the PNG of a frame is, by its number as the page has it.
    pub fn png(&self, frame: &str) -> Option<PathBuf> {
        let state = self.lock();
        Some(state.frames.get(&frame.parse().ok()?)?.png.clone())
    }
}

/// Tells two what it hears.
pub struct Both<'a> {
    /// Hears all.
    pub first: &'a dyn Observer,
    /// The board, which learns where the pictures are as well.
    pub board: &'a Board,
}

impl Observer for Both<'_> {
    fn opened(&self, job: &Job, pattern: &str) {
        self.first.opened(job, pattern);
        self.board.opened(job, pattern);
    }

    fn watching(&self, status: &WatchStatus) {
        self.first.watching(status);
        self.board.watching(status);
    }

    fn warning(&self, text: &str) {
        self.first.warning(text);
    }

    fn finished(&self, record: &FrameRecord) {
        self.first.finished(record);
        self.board.finished(record);
    }
}

impl State {
    fn put(&mut self, record: &FrameRecord) {
        let Ok(number) = record.frame.parse::<FrameNumber>() else { return };
        self.revision += 1;
        let before = self.frames.remove(&number).map(|entry| (entry.state, entry.points));
        let (state, mut points) = match (record.status, before) {
            // A picture joins its preview; anything else begins anew.
            (Status::Complete, Some(("preview", points))) => ("complete", points),
            (Status::Complete, _) => ("complete", Vec::new()),
            (Status::Preview, _) => ("preview", Vec::new()),
            (_, before) => ("failed", before.map(|(_, points)| points).unwrap_or_default()),
        };
        if let Some(error) = record.relative_error
            && state != "failed"
        {
            points.push([record.render_seconds, error.estimate]);
        }
        let png = record.output.with_extension("png");
        let (frame, problem) = (record.frame.clone(), record.error.clone());
        let entry = Entry { frame, revision: self.revision, state, problem, points, png };
        self.frames.insert(number, entry);
    }
}

impl Observer for Board {
    fn opened(&self, _: &Job, pattern: &str) {
        let picture = picture_path(pattern, FrameNumber::ONE);
        self.recall(picture.parent().unwrap_or(Path::new("")), pattern);
        self.lock().latest = Some(picture.with_file_name("latest.png"));
    }

    fn finished(&self, record: &FrameRecord) {
        self.lock().put(record);
    }

    fn watching(&self, status: &WatchStatus) {
        let mut state = self.lock();
        state.line = describe(status);
        state.share = match &status.phase {
            Phase::Rendering(all) => all.iter().map(|rendering| rendering.share).fold(0.0, f32::max),
            Phase::Waiting(_) | Phase::Reading(_) => 0.0,
        };
        (state.drawn, state.failed, state.queue) = (status.drawn, status.failed, status.queue);
        state.frames_per_hour = status.frames_per_hour;
    }
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;

    fn record(frame: &str, status: Status) -> FrameRecord {
        let output = format!("out/frame_{frame}.exr").into();
        FrameRecord { status, render_seconds: 2.0, ..FrameRecord::failed(frame.into(), None, output) }
    }

    #[test]
    fn only_changes_are_told() {
        let board = Board::default();
        board.finished(&record("1", Status::Preview));
        board.finished(&record("2.5", Status::Failed));
        let answer = |since| serde_json::from_str::<Value>(&board.json(since)).unwrap();
        let all = answer(0);
        assert_eq!(all["revision"], 2);
        assert_eq!(all["frames"].as_array().unwrap().len(), 2);
        assert_eq!(all["frames"][1]["state"], "failed");
        board.finished(&record("1", Status::Complete));
        let changed = answer(2);
        assert_eq!(changed["frames"].as_array().unwrap().len(), 1);
        assert_eq!(changed["frames"][0]["state"], "complete");
        assert!(answer(3)["frames"].as_array().unwrap().is_empty());
    }

    #[test]
    fn a_ledger_does_not_say_where_pictures_are() {
        let folder = tempfile::tempdir().unwrap();
        let line = r#"{"frame":"7","status":"complete","output":"/etc/secret.exr"}"#;
        std::fs::write(
            folder.path().join("ledger.jsonl"),
            format!("{line}\n{{\"frame\":\"../8\",\"status\":\"complete\"}}\n"),
        )
        .unwrap();
        let board = Board::default();
        board.recall(folder.path(), "out/frame_####.exr");
        assert_eq!(board.png("7"), Some("out/frame_0007.png".into()));
        assert_eq!(board.lock().frames.len(), 1);
    }

    #[test]
    fn pictures_are_found_by_number_and_by_nothing_else() {
        let board = Board::default();
        board.finished(&record("7", Status::Complete));
        assert_eq!(board.png("7"), Some("out/frame_7.png".into()));
        for name in ["8", "", "../7", "7/../7", "%2e%2e", "frame_7"] {
            assert_eq!(board.png(name), None, "{name}");
        }
    }
}
