//! The loop: which frame is looked at next, what follows from a look, and when it is over.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::drawn::Sought;
use super::frame_files::Whole;
use super::lookout::Lookout;
use super::status::{Phase, Rate, WatchStatus};
use super::worker::{Commission, Done, Tagged, Worker};
use super::{End, WatchReport, shown};
use crate::driver::ahead::Preparation;
use crate::driver::arrivals::{Arrival, Came, read_signed};
use crate::driver::error::{Blame, RenderError};
use crate::driver::fingerprint::{Fingerprint, Fingerprints, FrameSource, Identity};
use crate::driver::job::{FrameTask, Job};
use crate::driver::picture::picture_path;
use crate::driver::ready::{Look, Others, Proof, Signature, Verdict};
use crate::driver::render::Observer;
use crate::driver::resume::add_missing_png;
use crate::driver::session::Session;
use crate::driver::whole::Traits;
use crate::film::write::write_atomically;
use crate::mesh::MeshError;
use crate::scene::FrameError;
use crate::scene::assembly::FrameMesh;
use crate::scene::inputs::Inputs;
use crate::sequence::FrameNumber;

/// The picture of the newest frame, beside the others.
const LATEST: &str = "latest.png";

/// A failure that may pass is tried again after 1, 2, 4, ... times the patience, up to 2 to this power.
const MOST_DOUBLINGS: u32 = 8;

/// A worker that there may be, and how far it is.
pub(super) type Bench<'a> = (Option<Worker>, &'a Tagged<'a>);

/// The loop's state.
pub(super) struct Watch<'a> {
    job: &'a Job,
    lookout: Lookout<'a>,
    pattern: &'a str,
    fingerprints: Fingerprints,
    /// Tells of frames that come to no worker.
    desk: Session<'a>,
    /// The one that finishes pictures, and the one that makes previews.
    benches: [Bench<'a>; 2],
    /// What `latest.png` shows, and the picture that it is to be a copy of.
    newest: Option<Came>,
    copied: Option<PathBuf>,
    /// What the mesh of the frame that was looked at last had, and then its surfaces.
    traits: Vec<Traits>,
    rate: Rate,
    finished: usize,
}

/// What was found in a file.
struct Found {
    look: Look,
    /// The mesh, and what picture it makes if the other files of the frame are there.
    contents: Result<(Whole, Result<FrameSource, FrameError>), MeshError>,
    read_seconds: f64,
}

impl<'a> Watch<'a> {
    /// The loop of a job whose scene is open.
    pub fn new(
        job: &'a Job,
        mut lookout: Lookout<'a>,
        pattern: &'a str,
        desk: Session<'a>,
        benches: [Bench<'a>; 2],
    ) -> Self {
        let description = &job.world.description;
        if let Some(frames) = &description.frames {
            // The scene may have come after the folder was looked at.
            lookout.settle_on(&description.directory, &frames.path);
        }
        let world = &job.world;
        lookout.arrivals.look_beside(|number, mesh| Others::of(&Inputs::paths_of_frame(world, number, mesh)));
        let settings = lookout.options.render.settings(&description.render);
        let fingerprints = Fingerprints::new(&job.world, &settings);
        Self {
            job,
            lookout,
            pattern,
            fingerprints,
            desk,
            benches,
            newest: None,
            copied: None,
            traits: Vec::new(),
            rate: Rate::default(),
            finished: 0,
        }
    }

    /// Goes on until it is over.
    pub fn run(mut self) -> Result<WatchReport, RenderError> {
        let ended = loop {
            let Some(mut done) = self.lookout.done() else { break End::Interrupted };
            if self.lookout.options.render.interrupt.is_requested() {
                break End::Interrupted;
            }
            self.lookout.scan()?;
            if done.is_empty() && !self.look_round() {
                if let Some(end) = self.is_over() {
                    break end;
                }
                self.copy_latest();
                self.tell(None);
                let Some(paused) = self.lookout.pause() else { break End::Interrupted };
                done = paused;
            }
            done.into_iter().for_each(|done| self.settle(done));
        };
        self.copy_latest();
        Ok(self.report(ended))
    }

    /// Looks at one frame, if one is to be looked at and someone could draw it.
    fn look_round(&mut self) -> bool {
        let (now, order) = (self.lookout.now(), self.lookout.options.order);
        let is_free = |bench: &Bench| bench.0.as_ref().is_some_and(|worker| !worker.busy);
        let fresh = |_: FrameNumber, a: &Arrival| a.previewed != Some(a.readiness.signature());
        let next = match &self.benches {
            [_, (Some(previewer), _)] if previewer.busy => None,
            [_, bench] if is_free(bench) && self.lookout.arrivals.next(order, now, fresh).is_some() => {
                self.lookout.arrivals.next(order, now, fresh).map(|number| (number, true))
            }
            [bench, _] if is_free(bench) => {
                self.lookout.arrivals.next(order, now, |_, _| true).map(|number| (number, false))
            }
            _ => None,
        };
        let Some((number, preview)) = next else { return false };
        self.tell(Some(number));
        self.look(number, preview);
        true
    }

    fn look(&mut self, number: FrameNumber, preview: bool) {
        let Some(found) = self.find(number) else { return };
        let (now, rules) = (self.lookout.now(), self.lookout.arrivals.rules());
        let Some(arrival) = self.lookout.arrivals.get_mut(number) else { return };
        let Found { look, contents, read_seconds } = found;
        match (arrival.readiness.judge(&look, &rules), contents) {
            (Verdict::Changed, _) => {
                arrival.forgive();
                self.lookout.arrivals.touch(now);
            }
            (Verdict::NotYet, _) => {}
            (Verdict::Refused | Verdict::Accepted, Err(error)) => {
                self.fail(number, look.before, FrameError::from(error).into());
            }
            (_, Ok((_, Err(error)))) => self.fail(number, look.before, error.into()),
            (_, Ok((inspected, Ok(source)))) => {
                self.commission(number, preview, look, source, inspected, read_seconds);
            }
        }
    }

    /// Reads a file; `None` when its picture is there already, or nothing is known of the frame any more.
    fn find(&mut self, number: FrameNumber) -> Option<Found> {
        let at = self.lookout.now();
        let arrival = self.lookout.arrivals.get_mut(number)?;
        let (path, known) = (arrival.path.clone(), arrival.readiness.signature());
        let start = Instant::now();
        let others = self.lookout.arrivals.others(number, &path);
        let (before, bytes, after) = match read_signed(&path) {
            Ok(read) => read,
            Err(source) => {
                let look = Look { at, end: at, before: known, after: Some(known), found: None };
                let contents = Err(MeshError::Io { path, source });
                return Some(Found { look, contents, read_seconds: 0.0 });
            }
        };
        let (bytes, source) = match Inputs::of_frame(&self.job.world, number, std::slice::from_ref(&path)) {
            Err(error) => (bytes, Err(error)),
            Ok(inputs) => {
                let meshes = vec![(path.clone(), bytes)];
                let mut source = FrameSource::of(&self.fingerprints, number, meshes, inputs);
                (source.meshes.pop().map(|(_, bytes)| bytes).unwrap_or_default(), Ok(source))
            }
        };
        // Whatever else the frame is made of has been read by now.
        let others_after = self.lookout.arrivals.others(number, &path);
        let (before, after) = (before.with(others), after.map(|after| after.with(others_after)));
        let mut look = Look { at, end: at + start.elapsed(), before, after, found: Some(Proof::Proven) };
        if let Ok(FrameSource { identity, .. }) = &source
            && self.is_drawn(number, identity)
        {
            self.take_for_drawn(number, &look, identity.fingerprint);
            return None;
        }
        let inputs = source.as_ref().ok().map(|source| &source.inputs);
        let whole = Whole::of(&self.job.world, number, (&path, &bytes), inputs, &self.traits);
        look.found = whole.as_ref().ok().map(|whole| whole.proof);
        let contents = whole.map(|whole| (whole, source));
        Some(Found { look, contents, read_seconds: start.elapsed().as_secs_f64() })
    }

    /// Whether the picture of a frame is there; after a restart its file is asked.
    fn is_drawn(&self, number: FrameNumber, identity: &Identity) -> bool {
        let arrivals = &self.lookout.arrivals;
        match arrivals.get(number).map(|arrival| (&arrival.path, arrival.drawn)) {
            None => false,
            Some((_, Some(known))) => known == identity.fingerprint,
            Some((path, None)) => {
                let next = arrivals.after(number).map(|(next, arrival)| (next, arrival.path.as_path()));
                let time_budget = self.lookout.options.render.time_budget;
                let frame = Sought { number, path, identity, next, time_budget };
                frame.is_drawn(&self.job.world, &self.fingerprints, &picture_path(self.pattern, number))
            }
        }
    }

    /// A frame whose picture is there need not be handed on.
    fn take_for_drawn(&mut self, number: FrameNumber, look: &Look, fingerprint: Fingerprint) {
        let rules = self.lookout.arrivals.rules();
        let Some(arrival) = self.lookout.arrivals.get_mut(number) else { return };
        if arrival.readiness.judge(look, &rules) != Verdict::Accepted {
            return;
        }
        arrival.drawn = Some(fingerprint);
        arrival.forgive();
        let came = (arrival.readiness.since(), number);
        if let Err(error) = add_missing_png(self.job, &picture_path(self.pattern, number)) {
            self.lookout.observer.warning(&error.to_string());
        }
        self.show(came, None);
    }

    fn commission(
        &mut self,
        number: FrameNumber,
        preview: bool,
        look: Look,
        source: FrameSource,
        inspected: Whole,
        read_seconds: f64,
    ) {
        let Some(arrival) = self.lookout.arrivals.get_mut(number) else { return };
        let path = arrival.path.clone();
        if let Some(doubt) = inspected.doubt.filter(|_| arrival.previewed != Some(look.before)) {
            let text = format!("{}: {doubt}; it is drawn, since it does not change any more", path.display());
            self.lookout.observer.warning(&text);
        }
        self.traits = inspected.traits;
        arrival.previewed = Some(look.before);
        if preview {
            arrival.readiness.wanted_again(&look);
        } else {
            arrival.in_work = true;
        }
        let commission = Commission {
            task: FrameTask { number, files: vec![path.clone()], next: None },
            mesh: FrameMesh { path, mesh: inspected.mesh },
            inputs: source.inputs,
            identity: source.identity,
            signature: look.before,
            came: (arrival.readiness.since(), number),
            read_seconds,
        };
        let (worker, tagged) = &mut self.benches[usize::from(preview)];
        tagged.frame(number);
        if let Some(worker) = worker {
            worker.give(commission);
        }
    }

    /// A frame of which no worker will hear.
    fn fail(&mut self, number: FrameNumber, signature: Signature, error: RenderError) {
        let Some(arrival) = self.lookout.arrivals.get_mut(number) else { return };
        let task = FrameTask { number, files: vec![arrival.path.clone()], next: None };
        self.desk.turn(&task, Err(error), Preparation::default());
        self.desk.report.frames.clear();
        if let Some((_, error)) = self.desk.report.failures.pop() {
            self.failed(number, signature, error);
        }
    }

    /// No picture came of a file.
    fn failed(&mut self, number: FrameNumber, signature: Signature, error: RenderError) {
        let (now, patience) = (self.lookout.now(), self.lookout.arrivals.rules().patience());
        let Some(arrival) = self.lookout.arrivals.get_mut(number) else { return };
        let delay = patience.saturating_mul(1 << arrival.failures.min(MOST_DOUBLINGS));
        arrival
            .readiness
            .failed(signature, may_pass(&error, &arrival.path).then_some(now.saturating_add(delay)));
        arrival.failures += 1;
        arrival.failure = Some(error);
    }

    /// Takes note of what a worker has done.
    fn settle(&mut self, done: Done) {
        if let Some(worker) = &mut self.benches[usize::from(done.preview)].0 {
            worker.busy = false;
        }
        let now = self.lookout.now();
        if let Some(arrival) = self.lookout.arrivals.get_mut(done.number).filter(|_| !done.preview) {
            arrival.in_work = false;
            if done.outcome.is_none() {
                // It was to stop: whatever picture is there is of what the file was before.
                arrival.drawn = None;
            }
            if let Some(Ok(_)) = done.outcome {
                arrival.drawn = Some(done.fingerprint);
                arrival.readiness.drawn(done.signature);
                arrival.forgive();
                self.rate.count(now);
                self.finished += 1;
            }
        }
        if self.lookout.arrivals.get_mut(done.number).is_none()
            && !done.preview
            && matches!(done.outcome, Some(Ok(_)))
        {
            self.lookout.arrivals.outlived(done.number);
            self.finished += 1;
        }
        match done.outcome {
            Some(Ok(png)) => self.show(done.came, Some(&png)),
            Some(Err(error)) if !done.preview => self.failed(done.number, done.signature, error),
            _ => {}
        }
    }

    /// Puts a picture where the newest is, if it is of the newest frame; without bytes it is copied later.
    fn show(&mut self, came: Came, png: Option<&[u8]>) {
        if self.newest.is_some_and(|newest| newest > came) {
            return;
        }
        self.newest = Some(came);
        let picture = picture_path(self.pattern, came.1);
        self.copied = match png {
            None => Some(picture.with_extension("png")),
            Some(png) => {
                self.write_latest(png);
                None
            }
        };
    }

    fn copy_latest(&mut self) {
        // Without PNGs there is nothing to copy.
        if let Some(bytes) = self.copied.take().and_then(|path| std::fs::read(path).ok()) {
            self.write_latest(&bytes);
        }
    }

    fn write_latest(&self, png: &[u8]) {
        let latest = picture_path(self.pattern, FrameNumber::ONE).with_file_name(LATEST);
        // The picture itself is there; the next one tries again.
        if let Err(error) = write_atomically(&latest, png) {
            self.lookout.observer.warning(&error.to_string());
        }
    }

    fn is_over(&self) -> Option<End> {
        let arrivals = &self.lookout.arrivals;
        if let Some(last) = self.lookout.options.until
            && arrivals.is_clear()
            && arrivals.is_done_up_to(last)
            // Frames may come out of order: those that seem to be missing get a little time.
            && (!arrivals.has_gaps_before(last) || self.lookout.idle() >= arrivals.rules().patience())
        {
            return Some(End::Until);
        }
        self.lookout.is_over()
    }

    fn tell(&self, reading: Option<FrameNumber>) {
        let now = self.lookout.now();
        let arrivals = &self.lookout.arrivals;
        let rendering: Vec<_> =
            self.benches.iter().rev().filter_map(|(_, tagged)| tagged.rendering()).collect();
        let phase = match reading {
            Some(number) => Phase::Reading(number),
            None if rendering.is_empty() => {
                Phase::Waiting(format!("frames in {}", shown(&arrivals.folder())))
            }
            None => Phase::Rendering(rendering),
        };
        self.lookout.observer.watching(&WatchStatus {
            phase,
            queue: arrivals.queue(now),
            drawn: arrivals.iter().filter(|(_, arrival)| arrival.drawn.is_some()).count(),
            failed: arrivals.iter().filter(|(_, arrival)| arrival.failure.is_some()).count(),
            frames_per_hour: self.rate.per_hour(),
        });
    }

    fn report(self, ended: End) -> WatchReport {
        WatchReport {
            finished: self.finished,
            places: Some((self.pattern.into(), self.desk.report.ledger.clone())),
            ..self.lookout.report(ended)
        }
    }
}

/// Whether drawing a file may succeed although it stays as it is: other files are missing or not whole, or the disk is full.
fn may_pass(error: &RenderError, file: &Path) -> bool {
    match (error.blame(), error) {
        (Blame::CannotCreate | Blame::CannotWrite, _) => true,
        (Blame::Missing | Blame::Data, RenderError::Frame(FrameError::Mesh(error))) => error.path() != file,
        (Blame::Missing | Blame::Data, RenderError::Frame(FrameError::Volume(_))) => true,
        _ => false,
    }
}
