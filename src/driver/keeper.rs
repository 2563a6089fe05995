//! Keeps what is done of a frame: on a timer, when it is asked for, and when the run has to stop.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use super::accumulation::Accumulation;
use super::checkpoint::Checkpoint;
use super::interrupt::Interrupt;
use super::ledger::BeamRecord;
use super::render::{Observer, RenderOptions};
use super::tiles::Control;

/// Least time between two checkpoints on the timer, in milliseconds: a frame must get on in between.
const LEAST: u64 = 100;

/// Watches over one frame.
pub(super) struct Keeper<'a> {
    pub observer: &'a dyn Observer,
    pub interrupt: &'a Interrupt,
    /// Where it is kept; a preview is not.
    pub checkpoint: Option<&'a Checkpoint>,
    /// Seconds that the frame may take in all, and has taken in earlier runs.
    budget: Option<f64>,
    before: f64,
    start: Instant,
    /// Milliseconds between two checkpoints on the timer, and those from the start to the next one.
    every: u64,
    next: AtomicU64,
    beams: OnceLock<BeamRecord>,
}

impl<'a> Keeper<'a> {
    /// Saves what is done each time that `checkpoint_every`, or a tenth of a second, has passed; never on a timer without
    /// it.
    pub fn new(
        observer: &'a dyn Observer,
        options: &'a RenderOptions,
        checkpoint: Option<&'a Checkpoint>,
    ) -> Self {
        let every = options
            .checkpoint_every
            .map_or(u64::MAX, |every| u64::try_from(every.as_millis()).unwrap_or(u64::MAX).max(LEAST));
        Self {
            observer,
            interrupt: &options.interrupt,
            checkpoint,
            budget: options.time_budget.map(|budget| budget.as_secs_f64()),
            before: 0.0,
            start: Instant::now(),
            every,
            next: AtomicU64::new(every),
            beams: OnceLock::new(),
        }
    }

    /// The frame goes on, after so many seconds in earlier runs.
    pub fn goes_on(&mut self, seconds: f64) {
        self.before = seconds;
    }

    /// What the beams of the frame take.
    pub fn beams(&self) -> BeamRecord {
        self.beams.get().copied().unwrap_or_default()
    }

    /// What the frame has taken so far, in all runs.
    pub fn seconds(&self) -> f64 {
        self.before + self.start.elapsed().as_secs_f64()
    }

    fn milliseconds(&self) -> u64 {
        u64::try_from(self.start.elapsed().as_millis()).unwrap_or(u64::MAX)
    }
}

impl Control for Keeper<'_> {
    fn progress(&self, done: usize, of: usize) {
        self.observer.tiles(done, of);
    }

    fn stops(&self) -> bool {
        self.interrupt.is_requested()
    }

    fn built(&self, beams: BeamRecord) {
        self.beams.get_or_init(|| beams);
    }

    fn seconds_left(&self) -> Option<f64> {
        self.budget.map(|budget| budget - self.seconds())
    }

    fn wants_save(&self) -> bool {
        let is_time =
            || self.interrupt.wants_save() || self.milliseconds() >= self.next.load(Ordering::Relaxed);
        self.checkpoint.is_some() && is_time()
    }

    /// A disk that is full is no reason to lose the frame.
    fn save(&self, accumulation: &Accumulation) {
        let Some(checkpoint) = self.checkpoint else { return };
        if let Err(error) = self.interrupt.while_writing(|| checkpoint.save(accumulation, self.seconds())) {
            self.observer.warning(&format!("no checkpoint: {error}"));
        }
        self.next.store(self.milliseconds().saturating_add(self.every), Ordering::Relaxed);
        self.interrupt.has_saved();
    }
}
