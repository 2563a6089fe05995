//! Rounds in which each half of a frame's samples decides how many of the other half are used.
//!
//! A half is two of the four replicates of each pixel ([`crate::film::halves`]). Each goes through rounds of its own: from
//! its samples alone follow the tiles that go on ([`super::allocation`]) and when it would stop. These rounds never look
//! at the other half, but all that the picture takes of that one is as many samples as they say. So given the samples of
//! half B the count n_A of every tile is fixed, whatever the samples of A are: the mean of A is unbiased, and so is the
//! variance that is reported for it.
//!
//! ```text
//! samples of B -> rounds of B -> n_A of each tile -> mean and variance of the first n_A samples of A
//! samples of A -> rounds of A -> n_B of each tile -> mean and variance of the first n_B samples of B
//! ```
//!
//! Each half is drawn as far as either needs it: up to max(n_A, n_B), rounded up to a rung. What lies beyond the count that
//! is used is dropped (`samples_dropped` of the ledger: 2 to 4 % of what is drawn in `sequences/`). A frame stops when both
//! halves would. Each asks of the picture of two halves like it that its interval ends at or below the target; where the
//! picture's own interval ends is told by samples that had no say in it, and may be a little above.
//!
//! A round is a function of the samples alone, so a frame that goes on from a checkpoint goes on as it would have.

use super::accumulation::{Accumulation, TilePart};
use super::allocation::{Decision, TileShare, decide};
use super::half_tile::Pair;
use super::ladder::Ladder;
use super::stopping::{Pace, StoppedBy, Target};
use super::tile_loop::{Rest, over_tiles};
use super::tiles::Control;
use crate::film::estimate::LUMINANCE_FLOOR;
use crate::film::{FilmSample, FrameImage, HALVES, HalfSums, TileRect, estimate_error};
use crate::integrator::{Counters, Scratch};
use crate::spectrum::luminance::luminance_f64;

/// Sample of a pixel by its index.
type Sample<'a> = dyn Fn(&mut Scratch, (u32, u32), u32) -> FilmSample + Sync + 'a;

/// Draws a frame until it is good enough.
pub(super) struct HalfRounds<'a> {
    pub target: Target,
    pub ladder: Ladder,
    pub control: &'a dyn Control,
    pub sample: &'a Sample<'a>,
}

/// Parts that the progress of a frame is told in.
const PARTS: f64 = 1000.0;

impl HalfRounds<'_> {
    /// Goes on with a frame until both halves would stop; `None` when it was told to stop before.
    pub fn run(&self, accumulation: &mut Accumulation) -> Option<StoppedBy> {
        for part in accumulation.parts.iter_mut().filter(|part| !part.halves.is_used()) {
            part.halves.rungs = [1; HALVES];
        }
        let pace = Pace::new(self.control.seconds_left(), self.drawn(accumulation));
        loop {
            if !self.draw(accumulation) {
                return None;
            }
            accumulation.parts.iter_mut().for_each(|part| part.halves.merge());
            let decisions = [0, 1].map(|half| self.decide(accumulation, half));
            if !decisions.iter().any(|decision| matches!(decision, Decision::Further(_))) {
                let reached = decisions.iter().all(|decision| *decision == Decision::Reached);
                return Some(if reached { StoppedBy::Target } else { StoppedBy::Samples });
            }
            let drawn = self.drawn(accumulation);
            let before: Vec<_> = accumulation.parts.iter().map(|part| part.halves.rungs).collect();
            for (half, decision) in decisions.into_iter().enumerate() {
                if let Decision::Further(rungs) = decision {
                    let parts = accumulation.parts.iter_mut();
                    parts.zip(rungs).for_each(|(part, rung)| part.halves.rungs[half] = rung);
                }
            }
            let next = self.wanted(accumulation) - drawn;
            if !pace.allows(self.control.seconds_left(), drawn, next) {
                let parts = accumulation.parts.iter_mut();
                parts.zip(before).for_each(|(part, rungs)| part.halves.rungs = rungs);
                return Some(StoppedBy::Time);
            }
        }
    }

    /// What a half decides from its own samples.
    fn decide(&self, accumulation: &Accumulation, half: usize) -> Decision {
        let image = accumulation.image_of(|part| part.halves.foreseen(half));
        let estimate = estimate_error(&image, self.target.confidence);
        if let Some(estimate) = estimate.filter(|_| half == 0) {
            let share = (self.target.error / estimate.high).min(1.0);
            self.control.progress((PARTS * share * share) as usize, PARTS as usize);
        }
        let tiles = accumulation.parts.iter().zip(&accumulation.rects);
        let tiles: Vec<TileShare> = tiles
            .map(|(part, rect)| TileShare {
                area: rect.area() as u32,
                rung: part.halves.rungs[half],
                share: share(&image, *rect),
                cost: self.cost(part, *rect, half),
            })
            .collect();
        decide(&tiles, estimate, &self.target, self.ladder)
    }

    /// What a sample of a half costs: what is traced for it, on the first rung, and as much as a ray for all else.
    fn cost(&self, part: &TilePart, rect: TileRect, half: usize) -> f64 {
        let samples = rect.area() as f64 * f64::from(self.ladder.samples(1)) / HALVES as f64;
        1.0 + part.halves.work[half] as f64 / samples
    }

    /// Draws all tiles up to the rungs that are decided on.
    fn draw(&self, accumulation: &mut Accumulation) -> bool {
        let is_done = |part: &TilePart, rect: TileRect| part.halves.next(rect).is_none();
        over_tiles(accumulation, self.control, is_done, |part, rect, scratch, rest| {
            while let Some((rung, begun)) = part.halves.next(rect) {
                if !self.draw_rung(part, rect, (rung, begun), scratch, rest) {
                    return;
                }
            }
        })
    }

    /// Draws a rung of a tile, from its first pixel without it on; false when it is broken off.
    fn draw_rung(
        &self,
        part: &mut TilePart,
        rect: TileRect,
        (rung, begun): (u32, usize),
        scratch: &mut Scratch,
        rest: &Rest<'_>,
    ) -> bool {
        for at in rect.pixels().skip(begun) {
            if rest.is_wanted() {
                return false;
            }
            scratch.counters = Counters::default();
            let (mut pair, mut work) = (Pair::default(), [0; HALVES]);
            for index in self.ladder.samples(rung - 1)..self.ladder.samples(rung) {
                if self.control.stops() {
                    return false;
                }
                let (half, before) = (HalfSums::half_of(index), steps(&scratch.counters));
                pair[half].add(index, &(self.sample)(scratch, at, index));
                work[half] += steps(&scratch.counters) - before;
            }
            part.halves.push(rung, rect.area(), pair);
            if rung == 1 {
                part.halves.work.iter_mut().zip(work).for_each(|(sum, more)| *sum += more);
            }
            rest.got_on();
            part.counters += scratch.counters;
        }
        true
    }

    /// Samples of all pixels up to the rungs that are decided on.
    fn wanted(&self, accumulation: &Accumulation) -> u64 {
        self.samples(accumulation, |part, _| part.halves.wanted())
    }

    /// Samples of all pixels on the rungs that are drawn.
    fn drawn(&self, accumulation: &Accumulation) -> u64 {
        let rung = |part: &TilePart, rect| match part.halves.next(rect) {
            Some((rung, _)) => rung - 1,
            None => part.halves.wanted(),
        };
        self.samples(accumulation, rung)
    }

    fn samples(&self, accumulation: &Accumulation, rung: impl Fn(&TilePart, TileRect) -> u32) -> u64 {
        let tiles = accumulation.parts.iter().zip(&accumulation.rects);
        tiles.map(|(part, r)| r.area() as u64 * u64::from(self.ladder.samples(rung(part, *r)))).sum()
    }
}

/// Rays and flights.
fn steps(counters: &Counters) -> u64 {
    counters.rays + counters.shadow_rays + counters.untraced
}

/// The share of a tile in the squared relative error of a frame.
fn share(image: &FrameImage, rect: TileRect) -> f64 {
    let relative = |(x, y): (u32, u32)| {
        let pixel = &image.row(y)[x as usize];
        let luminance = luminance_f64(pixel.rgb.as_dvec3());
        f64::from(pixel.luminance_variance) / (luminance * luminance + LUMINANCE_FLOOR * LUMINANCE_FLOOR)
    };
    rect.pixels().map(relative).sum::<f64>() / image.pixels.len() as f64
}

#[cfg(test)]
mod tests;
