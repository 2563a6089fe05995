//! What signals ask of a run: to stop, or to save how far it has come.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Requests to a run. Clones are the same requests, so that one may be kept where signals are caught.
#[derive(Clone, Debug, Default)]
pub struct Interrupt {
    stop: Arc<AtomicBool>,
    save: Arc<AtomicBool>,
    writers: Arc<AtomicUsize>,
}

impl Interrupt {
    /// Asks the run to save the frame that it is at and to stop.
    pub fn request(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    /// Takes the request to stop back: what it was for has ended.
    pub fn withdraw(&self) {
        self.stop.store(false, Ordering::Relaxed);
    }

    /// Whether the run is to stop.
    pub fn is_requested(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Asks the run to save the frame that it is at and to go on.
    pub fn request_save(&self) {
        self.save.store(true, Ordering::Relaxed);
    }

    /// Whether the frame is to be saved.
    pub(super) fn wants_save(&self) -> bool {
        self.save.load(Ordering::Relaxed)
    }

    /// The frame is saved.
    pub(super) fn has_saved(&self) {
        self.save.store(false, Ordering::Relaxed);
    }

    /// Does what a process that must end soon had better wait for.
    pub fn while_writing<T>(&self, work: impl FnOnce() -> T) -> T {
        self.writers.fetch_add(1, Ordering::SeqCst);
        let result = work();
        self.writers.fetch_sub(1, Ordering::SeqCst);
        result
    }

    /// True while a picture or a checkpoint is being written.
    pub fn is_writing(&self) -> bool {
        self.writers.load(Ordering::SeqCst) > 0
    }
}
