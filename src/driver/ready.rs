//! When a file that a simulation is still writing may be read: a state machine that is told the time.
//!
//! Simulators open the final name, write it in pieces and close it, so that neither its existence nor its size says that
//! a file is whole. A file is looked at once its signature has not changed for a while, and how long that has to be
//! depends on how well the bytes that are found prove that they are all there:
//!
//! ```text
//! changed --quiet--> proven by counts or a checksum: accepted
//!         --settled (4 quiet)--> plausible, such as a text that ends with a line: accepted
//!         --patience (20 quiet)--> doubtful: accepted with a warning; unreadable: refused, told once
//! ```
//! Whatever has happened, a new signature starts all over. Not being readable is no error before the last step.
//! The driver's loop reads, this module only decides; times are since any fixed moment.

use std::fs::Metadata;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::PathBuf;
use std::time::{Duration, SystemTime};

/// What tells two states of a file apart without reading it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Signature {
    /// Bytes.
    pub size: u64,
    /// When its contents were last written, as the file says: writers may set it to anything.
    pub modified: Option<SystemTime>,
    /// When anything about it was last changed, in seconds and nanoseconds; no writer can set it. 0 where there is none.
    pub changed: (i64, i64),
    /// Device and number of the file, which differ when another file takes its name. 0 where there are none.
    pub identity: (u64, u64),
    /// The same of the other files of the frame.
    pub others: Others,
}

impl Signature {
    /// The signature of a file's metadata.
    pub fn of(metadata: &Metadata) -> Self {
        #[cfg(unix)]
        let (changed, identity) = {
            use std::os::unix::fs::MetadataExt;
            ((metadata.ctime(), metadata.ctime_nsec()), (metadata.dev(), metadata.ino()))
        };
        #[cfg(not(unix))]
        let (changed, identity) = ((0, 0), (0, 0));
        let others = Others::default();
        Self { size: metadata.len(), modified: metadata.modified().ok(), changed, identity, others }
    }

    /// The same, of a file that makes a frame with others.
    pub fn with(self, others: Others) -> Self {
        Self { others, ..self }
    }

    /// Whether its times are whole seconds: such a file system may hide what is written within the second.
    fn is_coarse(&self) -> bool {
        let since_epoch = self.modified.and_then(|time| time.duration_since(SystemTime::UNIX_EPOCH).ok());
        self.others.is_coarse
            || self.changed.1 == 0 && since_epoch.is_none_or(|time| time.subsec_nanos() == 0)
    }
}

/// What tells two states of several files apart, whether they are there or not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Others {
    /// Of all names and signatures; 0 of no files.
    hash: u64,
    is_coarse: bool,
}

impl Others {
    /// Of the files of these names.
    pub fn of(paths: &[PathBuf]) -> Self {
        if paths.is_empty() {
            return Self::default();
        }
        let signature = |path: &PathBuf| std::fs::metadata(path).ok().map(|found| Signature::of(&found));
        let signatures: Vec<_> = paths.iter().map(|path| (path, signature(path))).collect();
        let mut hasher = DefaultHasher::new();
        signatures.hash(&mut hasher);
        let is_coarse = signatures.iter().filter_map(|(_, found)| *found).any(|found| found.is_coarse());
        Self { hash: hasher.finish(), is_coarse }
    }
}

/// Longer than the steps of any file system's clock: those of FAT are 2 s.
const COARSE: Duration = Duration::from_millis(2100);

/// How well bytes prove that nothing is missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Proof {
    /// Counts or a checksum say so.
    Proven,
    /// Nothing speaks against it, but the format or the last bytes leave it open.
    Plausible,
    /// Something speaks against it.
    Doubtful,
}

/// How long a file has to be unchanged, by [`Proof`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rules([Duration; 3]);

impl Rules {
    /// Rules by the least time of quiet.
    pub fn new(quiet: Duration) -> Self {
        Self([quiet, quiet.saturating_mul(4), quiet.saturating_mul(20)])
    }

    /// How long a file has to be quiet before it is looked at.
    pub fn quiet(&self) -> Duration {
        self.0[0]
    }

    /// After how long the last is said about an unchanged file.
    pub fn patience(&self) -> Duration {
        self.0[2]
    }

    fn step(&self, index: usize, signature: &Signature) -> Duration {
        let step = self.0[index.min(2)];
        if signature.is_coarse() { step.max(COARSE) } else { step }
    }
}

/// What is known about one file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Readiness {
    signature: Signature,
    since: Duration,
    stage: Stage,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// To be looked at after the step of this index.
    Changing(usize),
    /// Unreadable for so long that it was told.
    Refused,
    /// Its bytes are taken.
    Accepted,
    /// Its bytes were taken, but no picture came of them; whether and when they are to be looked at again.
    Failed(Option<Duration>),
}

/// What a look at a file has led to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The file is not the one that was expected, or changed meanwhile.
    Changed,
    /// Too early to say.
    NotYet,
    /// Unreadable, and unchanged for so long that the user has to know.
    Refused,
    /// All there: the bytes may be drawn.
    Accepted,
}

/// A look at a file.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// When it began.
    pub at: Duration,
    /// When the last signature was taken.
    pub end: Duration,
    /// The signature before the bytes were read.
    pub before: Signature,
    /// The signature after that, of whatever had the name then; `None` when nothing had.
    pub after: Option<Signature>,
    /// How well the bytes prove that they are whole; `None` when they cannot be read.
    pub found: Option<Proof>,
}

impl Readiness {
    /// A file that is seen for the first time.
    pub fn new(signature: Signature, now: Duration) -> Self {
        Self { signature, since: now, stage: Stage::Changing(0) }
    }

    /// The signature that was seen last.
    pub fn signature(&self) -> Signature {
        self.signature
    }

    /// When the file was last seen to change.
    pub fn since(&self) -> Duration {
        self.since
    }

    /// Takes note of a signature; true when it is a new one.
    pub fn seen(&mut self, signature: Signature, now: Duration) -> bool {
        let is_new = signature != self.signature;
        if is_new {
            *self = Self::new(signature, now);
        }
        is_new
    }

    /// When the file is to be looked at; `None` when there is nothing to be done before it changes.
    pub fn due(&self, rules: &Rules) -> Option<Duration> {
        match self.stage {
            Stage::Changing(step) => Some(self.since.saturating_add(rules.step(step, &self.signature))),
            Stage::Failed(again) => again,
            Stage::Refused | Stage::Accepted => None,
        }
    }

    /// Whether it is to be looked at again although it did not change, after a failure that may pass.
    pub fn is_retried(&self) -> bool {
        matches!(self.stage, Stage::Failed(Some(_)))
    }

    /// Whether everything is said about the file as it is.
    pub fn is_settled(&self) -> bool {
        !matches!(self.stage, Stage::Changing(_))
    }

    /// Decides after a look.
    pub fn judge(&mut self, look: &Look, rules: &Rules) -> Verdict {
        let Some(after) = look.after.filter(|after| *after == look.before && *after == self.signature) else {
            // Even if it is the signature that is known: what was read may be of another.
            *self = Self::new(look.after.unwrap_or(look.before), look.end);
            return Verdict::Changed;
        };
        let quiet = look.at.saturating_sub(self.since);
        let waited = |step: usize| quiet >= rules.step(step, &after);
        match look.found {
            Some(proof) if waited(proof as usize) => {
                self.stage = Stage::Accepted;
                Verdict::Accepted
            }
            Some(proof) => {
                self.stage = Stage::Changing(proof as usize);
                Verdict::NotYet
            }
            None if waited(2) => {
                self.stage = Stage::Refused;
                Verdict::Refused
            }
            None => {
                self.stage = Stage::Changing(if waited(1) { 2 } else { 1 });
                Verdict::NotYet
            }
        }
    }

    /// The bytes were taken, but only for a preview: the file is to be looked at again.
    pub fn wanted_again(&mut self, look: &Look) {
        if look.before == self.signature && self.stage == Stage::Accepted {
            self.stage = Stage::Changing(look.found.map_or(0, |proof| proof as usize));
        }
    }

    /// No picture came of the bytes of a signature; `again` is when that may be different.
    pub fn failed(&mut self, signature: Signature, again: Option<Duration>) {
        if signature == self.signature {
            self.stage = Stage::Failed(again);
        }
    }

    /// A picture of the bytes of a signature is there.
    pub fn drawn(&mut self, signature: Signature) {
        if signature == self.signature {
            self.stage = Stage::Accepted;
        }
    }
}

#[cfg(test)]
mod tests;
