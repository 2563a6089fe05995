//! Photon passes: all tiles with one sample a pixel, each time with other photons.
//!
//! The sums of all pixels are kept in between. Photons are shared by all pixels, so tiles have no counts of their own: a
//! frame with a target is looked at after 16, 24, 32, 48, ... passes, and it stops by the same samples that it is made
//! of. So the error that is reported is a little too small: it is the first that was small enough. One of many looks at
//! a mean over thousands of pixels lowers it by less than the width of its interval.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::accumulation::{Accumulation, TilePart};
use super::ladder::Ladder;
use super::stopping::{Pace, StoppedBy, Target};
use super::tiles::Work;
use crate::film::{PixelAccumulator, REPLICATES, TileRect, estimate_error};
use crate::integrator::{Counters, Emitters, Pass, Scratch};

impl Work<'_> {
    /// Passes until there are all, or it is told to stop.
    pub(super) fn passes(
        &self,
        accumulation: &mut Accumulation,
        emitters: &Emitters,
        seconds_left: Option<f64>,
    ) -> Option<StoppedBy> {
        let before = accumulation.first();
        let Accumulation { rects, parts, .. } = accumulation;
        for (part, rect) in parts.iter_mut().zip(rects.iter()) {
            part.sums.resize(rect.area(), PixelAccumulator::new());
        }
        let first = parts.iter().map(|part| part.passes).min().unwrap_or(before);
        let total = rects.len().saturating_mul((self.sampling.samples - before) as usize);
        let done = AtomicUsize::new(parts.iter().map(|part| (part.passes - before) as usize).sum());
        let pace = Pace::new(seconds_left, first.into());
        for index in first..self.sampling.samples {
            if let Some(reason) = self.ends(accumulation, index, &pace) {
                return Some(reason);
            }
            let (photons, events) = emitters.pass(self.frame, index, &|| self.control.stops())?;
            let tiles = accumulation.parts.par_iter_mut().zip(&accumulation.rects);
            let left = tiles.filter(|(part, _)| part.passes == index);
            left.for_each_init(Scratch::default, |scratch, (part, rect)| {
                if self.add_pass(part, *rect, scratch, index, &photons) {
                    self.control.progress(done.fetch_add(1, Ordering::Relaxed) + 1, total);
                }
            });
            if accumulation.parts.iter().any(|part| part.passes == index) {
                return None;
            }
            accumulation.counters += events;
            if self.control.wants_save() {
                self.control.save(accumulation);
            }
        }
        let is_reached = |target: &Target| is_reached(accumulation, target);
        let reached = self.sampling.target.as_ref().is_some_and(is_reached);
        Some(if reached { StoppedBy::Target } else { StoppedBy::Samples })
    }

    /// Why a frame with so many passes needs no more; asked before each pass, of which a part may be done.
    fn ends(&self, accumulation: &Accumulation, passes: u32, pace: &Pace) -> Option<StoppedBy> {
        let ladder = Ladder { limit: self.sampling.samples };
        if passes == 0 || accumulation.parts.iter().any(|part| part.passes != passes || part.ahead > 0) {
            return None;
        }
        let is_rung = || (1..).map(|rung| ladder.samples(rung)).find(|&n| n >= passes) == Some(passes);
        let target = self.sampling.target.as_ref().filter(|_| is_rung());
        if target.is_some_and(|target| is_reached(accumulation, target)) {
            return Some(StoppedBy::Target);
        }
        let whole = REPLICATES as u32;
        let in_time = || pace.allows(self.control.seconds_left(), passes.into(), whole.into());
        (passes.is_multiple_of(whole) && !in_time()).then_some(StoppedBy::Time)
    }

    /// Goes on with the pass of a tile; true when it is done.
    fn add_pass(
        &self,
        part: &mut TilePart,
        rect: TileRect,
        scratch: &mut Scratch,
        index: u32,
        photons: &Pass,
    ) -> bool {
        scratch.counters = Counters::default();
        for (pixel, at) in part.sums.iter_mut().zip(rect.pixels()).skip(part.ahead) {
            if self.control.stops() {
                break;
            }
            pixel.add(index as usize, &self.sample(scratch, at, index, Some(photons)));
            part.ahead += 1;
        }
        part.counters += scratch.counters;
        let is_done = part.ahead == rect.area();
        if is_done {
            (part.passes, part.ahead) = (index + 1, 0);
        }
        is_done
    }
}

fn is_reached(accumulation: &Accumulation, target: &Target) -> bool {
    let estimate = estimate_error(&accumulation.image(), target.confidence);
    estimate.is_some_and(|estimate| estimate.high <= target.error)
}
