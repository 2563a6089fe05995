//! What wakes the loop: the system's file events, and workers that are done.
//!
//! Events are hints. Network file systems send none and queues overflow, so the loop also looks from time to time; and
//! a folder that does not exist yet, or was made anew, cannot be listened to before it is there.

use std::fs;
use std::path::Path;
use std::sync::mpsc::Sender;

use notify::event::{AccessKind, AccessMode};
use notify::{EventKind, RecommendedWatcher, RecursiveMode, Watcher};

use super::worker::Done;
use crate::driver::ready::Signature;

/// News for the loop.
pub(super) enum News {
    /// Something happened in the folder.
    Files,
    /// A worker has done what it was told to.
    Done(Box<Done>),
    /// A worker is gone, which only a panic makes it.
    Gone,
}

/// Listens to one folder.
pub(super) struct Wake {
    news: Sender<News>,
    /// Device and number of the folder that is listened to.
    listening: Option<((u64, u64), RecommendedWatcher)>,
}

impl Wake {
    /// Listens to nothing yet.
    pub fn new(news: Sender<News>) -> Self {
        Self { news, listening: None }
    }

    /// Listens to the folder of this name, if it is there and is not listened to already.
    pub fn follow(&mut self, folder: &Path) {
        let Ok(metadata) = fs::metadata(folder) else {
            self.listening = None;
            return;
        };
        let identity = Signature::of(&metadata).identity;
        if self.listening.as_ref().is_some_and(|(known, _)| *known == identity) {
            return;
        }
        let news = self.news.clone();
        let listener = notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
            if event.is_ok_and(|event| is_read(event.kind)) {
                return;
            }
            // The loop may have ended.
            let _ = news.send(News::Files);
        });
        // Where nothing can be listened to, looking from time to time has to do.
        self.listening = listener.ok().and_then(|mut listener| {
            listener.watch(folder, RecursiveMode::NonRecursive).ok()?;
            Some((identity, listener))
        });
    }
}

/// Whether an event tells only that a file was read, such as by the loop itself.
fn is_read(kind: EventKind) -> bool {
    matches!(kind, EventKind::Access(access) if access != AccessKind::Close(AccessMode::Write))
}
