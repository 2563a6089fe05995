//! Looks at the folder when something happens there, and now and then.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use super::wake::{News, Wake};
use super::worker::Done;
use super::{End, WatchOptions, WatchReport};
use crate::driver::arrivals::Arrivals;
use crate::driver::error::RenderError;
use crate::driver::ready::Rules;
use crate::driver::render::Observer;

/// The longest pause before signals are heeded and progress is told.
const HEARTBEAT: Duration = Duration::from_millis(100);

/// Looking may take one part in so many of the time.
const SHARE: u32 = 20;

/// The frames of a folder, as they come.
pub(super) struct Lookout<'a> {
    pub arrivals: Arrivals<'a>,
    pub observer: &'a dyn Observer,
    pub options: &'a WatchOptions,
    start: Instant,
    wake: Wake,
    sender: Sender<News>,
    news: Receiver<News>,
    /// Whether something has happened since the folder was looked at.
    woken: bool,
    /// When the folder is looked at again even if nothing happens, and not before which in any case.
    due: (Duration, Duration),
    /// Whether the simulation had said that it was done when the folder was looked at.
    done: bool,
}

impl<'a> Lookout<'a> {
    /// Starts the clock.
    pub fn new(base: PathBuf, pattern: &str, options: &'a WatchOptions, observer: &'a dyn Observer) -> Self {
        let (sender, news) = channel();
        Self {
            arrivals: Arrivals::new(&base, pattern, Rules::new(options.quiet)),
            observer,
            options,
            start: Instant::now(),
            wake: Wake::new(sender.clone()),
            sender,
            news,
            woken: true,
            due: (Duration::ZERO, Duration::ZERO),
            done: false,
        }
    }

    /// Looks for the frames of a scene from now on, if it has not done so already.
    pub fn settle_on(&mut self, base: &Path, pattern: &str) {
        if !self.arrivals.is_of(base, pattern) {
            self.turn_to(base.into(), pattern);
        }
    }

    /// Looks for other frames from now on.
    pub fn turn_to(&mut self, base: PathBuf, pattern: &str) {
        self.arrivals = Arrivals::new(&base, pattern, self.arrivals.rules());
        self.arrivals.touch(self.now());
        self.woken = true;
    }

    /// Time since the start.
    pub fn now(&self) -> Duration {
        self.start.elapsed()
    }

    /// Where workers send their news.
    pub fn sender(&self) -> Sender<News> {
        self.sender.clone()
    }

    /// What the workers have done; `None` when one of them is gone.
    pub fn done(&mut self) -> Option<Vec<Done>> {
        let mut all = Vec::new();
        while let Ok(news) = self.news.try_recv() {
            self.hear(news, &mut all)?;
        }
        Some(all)
    }

    fn hear(&mut self, news: News, all: &mut Vec<Done>) -> Option<()> {
        match news {
            News::Files => self.woken = true,
            News::Done(done) => all.push(*done),
            News::Gone => return None,
        }
        Some(())
    }

    /// Looks at the folder if it is time.
    ///
    /// # Errors
    /// When no file will ever be a frame.
    pub fn scan(&mut self) -> Result<(), RenderError> {
        let now = self.now();
        if now < self.due.1 || !(self.woken || now >= self.due.0) {
            return Ok(());
        }
        self.woken = false;
        self.wake.follow(&self.arrivals.folder());
        // First this, then the frames: all that were written before it are seen.
        self.done = self.done_file().is_some_and(|path| path.exists());
        if let Some(trouble) = self.arrivals.scan(now)? {
            self.observer.warning(&trouble);
        }
        let after = self.now();
        let cost = after.saturating_sub(now);
        let pause = cost.saturating_mul(SHARE).max(self.options.quiet / 5);
        self.due = (after.saturating_add(self.options.poll), after.saturating_add(pause));
        Ok(())
    }

    fn done_file(&self) -> Option<PathBuf> {
        Some(self.arrivals.folder().join(self.options.done_file.as_ref()?))
    }

    /// Waits for news, but not for long. Returns what a worker has done; `None` when one is gone.
    pub fn pause(&mut self) -> Option<Vec<Done>> {
        let now = self.now();
        let scan = if self.woken { self.due.1 } else { self.due.0 };
        let next = self.arrivals.next_due(now).map_or(scan, |due| due.min(scan));
        let pause = next.saturating_sub(now).clamp(Duration::from_millis(1), HEARTBEAT);
        let mut all = Vec::new();
        match self.news.recv_timeout(pause) {
            Ok(news) => self.hear(news, &mut all)?,
            // This end keeps a sender: it is never disconnected.
            Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => {}
        }
        Some(all)
    }

    /// How long nothing has changed.
    pub fn idle(&self) -> Duration {
        self.now().saturating_sub(self.arrivals.changed())
    }

    /// Whether nothing more is to be expected, as far as the user has told.
    pub fn is_over(&self) -> Option<End> {
        if !self.arrivals.is_settled() {
            return None;
        }
        if self.done && self.arrivals.is_clear() {
            return Some(End::DoneFile);
        }
        let timeout = self.options.idle_timeout?;
        (self.idle() >= timeout).then_some(End::Idle)
    }

    /// What has become of the frames. A folder in disorder may hold any number of others.
    pub fn report(mut self, ended: End) -> WatchReport {
        let mut report = WatchReport {
            ended,
            drawn: self.arrivals.gone().iter().copied().collect(),
            pending: Vec::new(),
            failures: Vec::new(),
            trouble: None,
            expected_more: ended == End::Interrupted && self.options.expects_more(),
            finished: 0,
            seconds: 0.0,
            places: None,
        };
        if let Some((error, untold)) = self.arrivals.take_trouble() {
            untold.iter().for_each(|text| self.observer.warning(text));
            report.trouble = Some(error.into());
        }
        for (number, arrival) in self.arrivals.iter_mut() {
            match arrival.failure.take() {
                Some(error) => report.failures.push((number, error)),
                None if arrival.is_settled() && arrival.drawn.is_some() => report.drawn.push(number),
                None => report.pending.push(number),
            }
        }
        report.drawn.sort_unstable();
        report
    }
}
