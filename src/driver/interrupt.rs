//! What signals ask of a run: to stop, or to save how far it has come.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Requests to a run. Clones are the same requests, so that one may be kept where signals are caught.
#[derive(Clone, Debug, Default)]
pub struct Interrupt {
    stop: Arc<AtomicBool>,
    save: Arc<AtomicBool>,
}

impl Interrupt {
    /// Asks the run to save the frame that it is at and to stop.
    pub fn request(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    /// Whether the run is to stop.
    pub fn is_requested(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Asks the run to save the frame that it is at and to go on.
    pub fn request_save(&self) {
        self.save.store(true, Ordering::Relaxed);
    }

    /// Whether the frame is to be saved; the request is done with then.
    pub fn take_save(&self) -> bool {
        self.save.load(Ordering::Relaxed) && self.save.swap(false, Ordering::Relaxed)
    }

    /// The flag that [`request`](Self::request) sets, for handlers of signals.
    pub fn stop_flag(&self) -> Arc<AtomicBool> {
        self.stop.clone()
    }

    /// The flag that [`request_save`](Self::request_save) sets, for handlers of signals.
    pub fn save_flag(&self) -> Arc<AtomicBool> {
        self.save.clone()
    }
}
