//! The frames of a sequence that is still being written: which are there, which may be looked at, what is drawn of them.
//!
//! A scan lists the folder and takes each file's signature; it reads nothing. What it cannot list (no folder yet, no
//! frames, two sequences in one folder for a while) changes nothing about the frames that are known; and as long as what
//! comes cannot be seen, a watch is not complete.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::ops::Bound;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::error::RenderError;
use super::fingerprint::Fingerprint;
use super::ready::{Others, Readiness, Rules, Signature};
use crate::sequence::{FrameFile, FrameNumber, SequenceError, discover, gaps, listed_folder};

/// Which frame is drawn first when several wait.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// The lowest number.
    #[default]
    Oldest,
    /// The one that was written last; the highest number of several.
    Newest,
}

/// When a frame came, to order frames by; those of one scan by number.
pub(super) type Came = (Duration, FrameNumber);

/// One frame of the sequence.
#[derive(Debug)]
pub(super) struct Arrival {
    /// Its file.
    pub path: PathBuf,
    /// What is known about the file.
    pub readiness: Readiness,
    /// What the frame's finished picture is of.
    pub drawn: Option<Fingerprint>,
    /// The signature of the files that a preview was made of.
    pub previewed: Option<Signature>,
    /// Whether its picture is being finished.
    pub in_work: bool,
    /// Why there is no picture of the file as it is.
    pub failure: Option<RenderError>,
    /// How often drawing the file as it is has failed.
    pub failures: u32,
}

impl Arrival {
    fn new(path: PathBuf, signature: Signature, now: Duration) -> Self {
        Self {
            path,
            readiness: Readiness::new(signature, now),
            drawn: None,
            previewed: None,
            in_work: false,
            failure: None,
            failures: 0,
        }
    }

    /// Forgets what was wrong with the file that it was.
    pub fn forgive(&mut self) {
        self.failure = None;
        self.failures = 0;
    }

    /// Whether it is drawn as it is, or told to be bad. Files beside it may be a moment late: what may pass is tried twice.
    pub fn is_settled(&self) -> bool {
        let is_tried_again = self.failures == 1 && self.readiness.is_retried();
        self.readiness.is_settled() && !self.in_work && !is_tried_again
    }
}

/// The state of the other files that make a frame with its mesh.
type OthersOf<'a> = Box<dyn Fn(FrameNumber, &Path) -> Others + 'a>;

/// All frames that are there.
pub(super) struct Arrivals<'a> {
    base: PathBuf,
    pattern: String,
    others: OthersOf<'a>,
    rules: Rules,
    frames: BTreeMap<FrameNumber, Arrival>,
    /// The frames that were drawn and are not there any more.
    gone: BTreeSet<FrameNumber>,
    /// When a file came, changed or went away.
    changed: Duration,
    /// What is wrong with the folder now.
    trouble: Option<Trouble>,
}

/// A folder of which nobody can say what its frames are.
#[derive(Debug)]
struct Trouble {
    error: SequenceError,
    since: Duration,
    is_told: bool,
}

impl Trouble {
    /// What the user has to know, once.
    fn tell(&mut self) -> Option<String> {
        let text = format!("{}; until that is mended no other frame is seen", self.error);
        (!std::mem::replace(&mut self.is_told, true)).then_some(text)
    }
}

impl<'a> Arrivals<'a> {
    /// Frames of a pattern relative to a folder; none before the first scan.
    pub fn new(base: &Path, pattern: &str, rules: Rules) -> Self {
        Self {
            base: base.into(),
            pattern: pattern.into(),
            others: Box::new(|_, _| Others::default()),
            rules,
            frames: BTreeMap::new(),
            gone: BTreeSet::new(),
            changed: Duration::ZERO,
            trouble: None,
        }
    }

    /// The folder that the files are in.
    pub fn folder(&self) -> PathBuf {
        let folder = listed_folder(&self.base, &self.pattern);
        if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder }
    }

    /// Whether these are the frames of a pattern relative to a folder.
    pub fn is_of(&self, base: &Path, pattern: &str) -> bool {
        self.base == base && self.pattern == pattern
    }

    /// What other files make a frame from now on.
    pub fn look_beside(&mut self, others: impl Fn(FrameNumber, &Path) -> Others + 'a) {
        self.others = Box::new(others);
    }

    /// The state of the other files that make a frame with a mesh.
    pub fn others(&self, number: FrameNumber, mesh: &Path) -> Others {
        (self.others)(number, mesh)
    }

    /// When anything changed last.
    pub fn changed(&self) -> Duration {
        self.changed
    }

    /// A frame.
    pub fn get_mut(&mut self, number: FrameNumber) -> Option<&mut Arrival> {
        self.frames.get_mut(&number)
    }

    /// A frame as it is known.
    pub fn get(&self, number: FrameNumber) -> Option<&Arrival> {
        self.frames.get(&number)
    }

    /// The frame that follows another one.
    pub fn after(&self, number: FrameNumber) -> Option<(FrameNumber, &Arrival)> {
        let after = (Bound::Excluded(number), Bound::Unbounded);
        self.frames.range(after).next().map(|(number, arrival)| (*number, arrival))
    }

    /// What the frames go by.
    pub fn rules(&self) -> Rules {
        self.rules
    }

    /// A file turned out to have changed.
    pub fn touch(&mut self, now: Duration) {
        self.changed = now;
    }

    /// All frames in order.
    pub fn iter(&self) -> impl Iterator<Item = (&FrameNumber, &Arrival)> {
        self.frames.iter()
    }

    /// All frames in order, to be changed.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = (FrameNumber, &mut Arrival)> {
        self.frames.iter_mut().map(|(number, arrival)| (*number, arrival))
    }

    /// Looks at names and signatures. Returns what the user has to know of the folder, once.
    ///
    /// # Errors
    /// [`SequenceError::Pattern`]: no file will ever match.
    pub fn scan(&mut self, now: Duration) -> Result<Option<String>, SequenceError> {
        let nothing =
            |error: &io::Error| matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory);
        let clock = Instant::now();
        match discover(&self.base, &self.pattern) {
            Ok(files) => {
                self.trouble = None;
                self.take(files, now, clock);
                Ok(None)
            }
            Err(SequenceError::NothingFound { .. }) => {
                self.trouble = None;
                self.take(Vec::new(), now, clock);
                Ok(None)
            }
            Err(SequenceError::Io { source, .. }) if nothing(&source) => {
                self.trouble = None;
                Ok(None)
            }
            Err(error @ SequenceError::Pattern { .. }) => Err(error),
            Err(error) => {
                let known =
                    self.frames.iter().map(|(number, a)| FrameFile { number: *number, path: a.path.clone() });
                self.take(known.collect(), now, clock);
                Ok(self.complain(error, now))
            }
        }
    }

    /// A folder may be in disorder for a moment, such as while a file is replaced by its compressed form.
    fn complain(&mut self, error: SequenceError, now: Duration) -> Option<String> {
        let patience = self.rules.patience();
        match &mut self.trouble {
            Some(trouble) if trouble.error.to_string() == error.to_string() => {
                let is_time = now.saturating_sub(trouble.since) >= patience;
                is_time.then(|| trouble.tell()).flatten()
            }
            _ => {
                self.changed = now;
                self.trouble = Some(Trouble { error, since: now, is_told: false });
                None
            }
        }
    }

    /// Whether it is known which files are frames.
    pub fn is_clear(&self) -> bool {
        self.trouble.is_none()
    }

    /// Why nobody can say which files are frames, at the end; and that in words if it was not told yet.
    pub fn take_trouble(&mut self) -> Option<(SequenceError, Option<String>)> {
        let mut trouble = self.trouble.take()?;
        let text = trouble.tell();
        Some((trouble.error, text))
    }

    /// `since` is when the listing began; what is new may be so only since its signature was taken.
    fn take(&mut self, files: Vec<FrameFile>, since: Duration, clock: Instant) {
        let there: BTreeMap<FrameNumber, (PathBuf, Signature)> = files
            .into_iter()
            .filter_map(|file| {
                let metadata = std::fs::metadata(&file.path).ok()?;
                let signature = Signature::of(&metadata).with(self.others(file.number, &file.path));
                Some((file.number, (file.path, signature)))
            })
            .collect();
        let now = since + clock.elapsed();
        let before = self.frames.len();
        let gone = &mut self.gone;
        self.frames.retain(|number, arrival| {
            let is_there = there.contains_key(number);
            if !is_there && arrival.drawn.is_some() {
                gone.insert(*number);
            }
            is_there
        });
        self.gone.retain(|number| !there.contains_key(number));
        let mut any_change = self.frames.len() < before;
        for (number, (path, signature)) in there {
            match self.frames.get_mut(&number) {
                Some(arrival) => {
                    if arrival.readiness.seen(signature, now) {
                        any_change = true;
                        arrival.forgive();
                    }
                    arrival.path = path;
                }
                None => {
                    any_change = true;
                    self.frames.insert(number, Arrival::new(path, signature, now));
                }
            }
        }
        if any_change {
            self.changed = now;
        }
    }

    /// Of the frames that are to be looked at now and that are wanted, the first in an order.
    pub fn next(
        &self,
        order: Order,
        now: Duration,
        mut wanted: impl FnMut(FrameNumber, &Arrival) -> bool,
    ) -> Option<FrameNumber> {
        let mut due = self.frames.iter().filter(|(number, arrival)| {
            arrival.readiness.due(&self.rules).is_some_and(|due| due <= now) && wanted(**number, arrival)
        });
        match order {
            Order::Oldest => due.next().map(|(number, _)| *number),
            Order::Newest => {
                due.max_by_key(|(number, arrival)| (arrival.readiness.since(), **number)).map(|(n, _)| *n)
            }
        }
    }

    /// When the next frame is to be looked at that is not to be looked at yet.
    pub fn next_due(&self, now: Duration) -> Option<Duration> {
        self.frames.values().filter_map(|a| a.readiness.due(&self.rules)).filter(|due| *due > now).min()
    }

    /// How many frames wait to be drawn.
    pub fn queue(&self, now: Duration) -> usize {
        let due = |arrival: &&Arrival| arrival.readiness.due(&self.rules).is_some_and(|due| due <= now);
        self.frames.values().filter(due).count()
    }

    /// Whether everything that is there is drawn, or told to be bad.
    pub fn is_settled(&self) -> bool {
        self.frames.values().all(Arrival::is_settled)
    }

    /// A picture was finished of a file that is not there any more.
    pub fn outlived(&mut self, number: FrameNumber) {
        self.gone.insert(number);
    }

    /// The frames that were drawn and are not there any more.
    pub fn gone(&self) -> &BTreeSet<FrameNumber> {
        &self.gone
    }

    /// Whether a frame is drawn or bad as it is, and so is every one before it that is there.
    pub fn is_done_up_to(&self, last: FrameNumber) -> bool {
        (self.frames.contains_key(&last) || self.gone.contains(&last))
            && self.frames.range(..=last).all(|(_, arrival)| arrival.is_settled())
    }

    /// Whether frames before `last` are not there that the steps of the others suggest.
    pub fn has_gaps_before(&self, last: FrameNumber) -> bool {
        let file = |number: &FrameNumber| FrameFile { number: *number, path: PathBuf::new() };
        let there = self.frames.range(..=last).map(|(number, _)| number);
        let known: BTreeSet<&FrameNumber> = there.chain(self.gone.range(..=last)).collect();
        !gaps(&known.into_iter().map(file).collect::<Vec<_>>()).is_empty()
    }
}

/// The bytes of a file, with its signature before they were read and that of whatever has the name afterwards.
pub(super) fn read_signed(path: &Path) -> io::Result<(Signature, Vec<u8>, Option<Signature>)> {
    // Opening asks network file systems for what the file is now; a listing may be a minute old.
    let mut file = File::open(path)?;
    let before = Signature::of(&file.metadata()?);
    let mut bytes = room_for(before.size)?;
    file.read_to_end(&mut bytes)?;
    let after = std::fs::metadata(path).ok().map(|metadata| Signature::of(&metadata));
    let is_whole = bytes.len() as u64 == before.size;
    Ok((before, bytes, after.filter(|_| is_whole)))
}

/// A file may say that it is larger than any memory, such as one with holes.
fn room_for(size: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let room = usize::try_from(size).ok().and_then(|size| bytes.try_reserve_exact(size).ok());
    room.map(|()| bytes).ok_or_else(|| ErrorKind::OutOfMemory.into())
}

#[cfg(test)]
mod tests;
