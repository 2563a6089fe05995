//! Reads the ledgers beside pictures: `ledger.jsonl`, and `ledger.3.jsonl` of shard 3.
//!
//! Nobody keeps them in order. Workers that were killed leave half a line, on some network file systems lines of several
//! writers run into each other, and pictures of other scenes may have a line in the same file. What cannot be understood
//! is told and left out.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::ledger::FrameRecord;
use crate::sequence::FrameNumber;

/// The ledgers of a folder.
#[derive(Clone, Debug, Default)]
pub struct Ledgers {
    /// The files, that of a whole run first, then by shard.
    pub files: Vec<PathBuf>,
    /// Their lines. Those of a frame are in the order of time: as they end, or as they stand where that is not known.
    pub lines: Vec<LedgerLine>,
    /// What is no line.
    pub unusable: Vec<Unusable>,
}

/// A line.
#[derive(Clone, Debug)]
pub struct LedgerLine {
    /// Which of the files it is in, and in which line, from 1.
    pub place: (usize, usize),
    /// Which shard wrote it; `None` of a run that was none.
    pub shard: Option<u32>,
    /// The frame.
    pub number: FrameNumber,
    /// What it says.
    pub record: FrameRecord,
}

/// A line that is left out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Unusable {
    /// The ledger.
    pub file: PathBuf,
    /// The line, from 1.
    pub line: usize,
    /// Why.
    pub reason: Reason,
}

/// Why a line is left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Reason {
    /// It is no JSON: most likely its writer was killed.
    Torn,
    /// It is of something else than a frame.
    Foreign,
    /// It is of a picture of another name.
    Other,
}

impl Ledgers {
    /// Reads all in a folder; none where there is no folder.
    ///
    /// # Errors
    /// When a file is there and cannot be read; it is named.
    pub fn in_folder(folder: &Path) -> std::io::Result<Self> {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let names = std::fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
        let mut found: Vec<(Option<u32>, PathBuf)> =
            names.filter_map(|entry| Some((shard_of(&entry.file_name())?, entry.path()))).collect();
        found.sort();
        let mut ledgers = Self::default();
        for (shard, file) in found {
            let bytes = std::fs::read(&file)
                .map_err(|error| std::io::Error::new(error.kind(), format!("{}: {error}", file.display())))?;
            ledgers.files.push(file);
            ledgers.read(shard, &bytes);
        }
        // Lines of versions that did not tell are older than others.
        ledgers.lines.sort_by(|a, b| {
            let ended = |line: &LedgerLine| line.record.ended.unwrap_or(f64::NEG_INFINITY);
            a.number.cmp(&b.number).then(ended(a).total_cmp(&ended(b)))
        });
        Ok(ledgers)
    }

    /// Leaves out the lines of pictures that do not have the name that a frame's picture has.
    pub fn keep_pictures(&mut self, name: impl Fn(FrameNumber) -> PathBuf) {
        let is_ours = |line: &LedgerLine| line.record.output.file_name() == name(line.number).file_name();
        let (kept, others) = std::mem::take(&mut self.lines).into_iter().partition(is_ours);
        self.lines = kept;
        let others: Vec<LedgerLine> = others;
        let files = &self.files;
        self.unusable.extend(others.into_iter().map(|LedgerLine { place: (file, line), .. }| Unusable {
            file: files[file].clone(),
            line,
            reason: Reason::Other,
        }));
    }

    fn read(&mut self, shard: Option<u32>, bytes: &[u8]) {
        let file = self.files.len() - 1;
        for (line, text) in (1..).zip(bytes.split(|byte| *byte == b'\n')) {
            if text.trim_ascii().is_empty() {
                continue;
            }
            let (record, problem) = record(text);
            self.unusable.extend(problem.map(|reason| Unusable {
                file: self.files[file].clone(),
                line,
                reason,
            }));
            let place = (file, line);
            self.lines.extend(record.map(|(number, record)| LedgerLine { place, shard, number, record }));
        }
    }
}

/// The beginning of every line that floe writes.
const BEGINNING: &[u8] = b"{\"frame\":\"";

/// What a line says, and what is wrong with it. A whole line may follow on half a one.
fn record(text: &[u8]) -> (Option<(FrameNumber, FrameRecord)>, Option<Reason>) {
    match parsed(text) {
        Ok(record) => (Some(record), None),
        Err(Reason::Torn) => {
            let begins = text.windows(BEGINNING.len()).rposition(|bytes| bytes == BEGINNING);
            let last = begins.filter(|at| *at > 0).and_then(|at| parsed(&text[at..]).ok());
            (last, Some(Reason::Torn))
        }
        Err(reason) => (None, Some(reason)),
    }
}

fn parsed(text: &[u8]) -> Result<(FrameNumber, FrameRecord), Reason> {
    match serde_json::from_slice::<FrameRecord>(text) {
        Ok(record) => match record.frame.parse() {
            Ok(number) => Ok((number, record)),
            Err(_) => Err(Reason::Foreign),
        },
        Err(error) if error.is_data() => Err(Reason::Foreign),
        Err(_) => Err(Reason::Torn),
    }
}

/// The shard whose ledger has this name; `None` inside for the ledger of whole runs.
fn shard_of(name: &OsStr) -> Option<Option<u32>> {
    let name = name.to_str()?;
    if name == "ledger.jsonl" {
        return Some(None);
    }
    let digits = name.strip_prefix("ledger.")?.strip_suffix(".jsonl")?;
    let is_number = digits.bytes().all(|byte| byte.is_ascii_digit());
    digits.parse().ok().filter(|_| is_number).map(Some)
}

#[cfg(test)]
mod tests;
