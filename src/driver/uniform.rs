//! The same number of samples in every pixel: tile by tile, or in rounds of all tiles where time may be up before.
//!
//! Either way the samples of a pixel are added one after the other, so that the picture is the same to the bit. A frame
//! that was begun in one way goes on in the other: a tile keeps to the way that it was begun in. Where sums are wanted rather
//! than pixels, there are rounds.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::accumulation::Accumulation;
use super::accumulation::TilePart;
use super::stopping::{Pace, StoppedBy};
use super::tile_loop::{Rest, over_tiles};
use super::tiles::Work;
use crate::film::{PixelAccumulator, REPLICATES, TileRect};
use crate::integrator::{Counters, Scratch};

/// Samples of a pixel after the round in which it has `samples`: a quarter more, in all its replicates.
pub(super) fn next_round(samples: u32, limit: u32) -> u32 {
    let replicates = REPLICATES as u32;
    let more = (samples / 4 / replicates).max(1) * replicates;
    samples.saturating_add(more).min(limit)
}

impl Work<'_> {
    /// Every pixel with all its samples, or with those that time is left for.
    pub(super) fn uniform(&self, accumulation: &mut Accumulation) -> Option<StoppedBy> {
        let limit = self.sampling.samples;
        let pace = Pace::new(self.control.seconds_left(), accumulation.drawn(limit));
        loop {
            let to = if pace.is_limited() { accumulation.next_round(limit) } else { limit };
            if !self.bring_to(accumulation, to) {
                return None;
            }
            if to == limit {
                return Some(StoppedBy::Samples);
            }
            let next = u64::from(next_round(to, limit) - to) * accumulation.pixels();
            if !pace.allows(self.control.seconds_left(), accumulation.drawn(limit), next) {
                return Some(StoppedBy::Time);
            }
        }
    }

    /// Goes on until every pixel has so many samples, or all.
    fn bring_to(&self, accumulation: &mut Accumulation, to: u32) -> bool {
        let limit = self.sampling.samples;
        let total = accumulation.pixels() as usize * (limit - accumulation.first()) as usize;
        let done = AtomicUsize::new(accumulation.drawn(limit) as usize);
        let is_done = |part: &TilePart, rect: TileRect| part.samples(rect, limit) >= to;
        over_tiles(accumulation, self.control, is_done, |part, rect, scratch, rest| {
            let before = part.drawn(rect, limit);
            if part.sums.is_empty() && (to == limit || !part.pixels.is_empty()) {
                self.trace(part, rect, scratch, rest);
            } else {
                self.advance(part, rect, scratch, rest, to);
            }
            let drawn = (part.drawn(rect, limit) - before) as usize;
            self.control.progress(done.fetch_add(drawn, Ordering::Relaxed) + drawn, total);
        })
    }

    /// Goes on with a tile pixel by pixel. A pixel that is broken off begins anew.
    fn trace(&self, part: &mut TilePart, rect: TileRect, scratch: &mut Scratch, rest: &Rest<'_>) {
        part.pixels.reserve_exact(rect.area() - part.pixels.len());
        for at in rect.pixels().skip(part.pixels.len()) {
            if rest.is_wanted() {
                return;
            }
            scratch.counters = Counters::default();
            let mut pixel = PixelAccumulator::new();
            if !self.add_samples(scratch, &mut pixel, at, 0..self.sampling.samples) {
                return;
            }
            part.pixels.push(pixel.finish());
            rest.got_on();
            part.counters += scratch.counters;
        }
    }

    /// Goes on with a tile round by round.
    fn advance(&self, part: &mut TilePart, rect: TileRect, scratch: &mut Scratch, rest: &Rest<'_>, to: u32) {
        part.sums.resize(rect.area(), PixelAccumulator::new());
        while part.passes < to {
            let next = next_round(part.passes, self.sampling.samples);
            for (sums, at) in part.sums.iter_mut().zip(rect.pixels()).skip(part.ahead) {
                if rest.is_wanted() {
                    return;
                }
                scratch.counters = Counters::default();
                let mut pixel = sums.clone();
                if !self.add_samples(scratch, &mut pixel, at, part.passes..next) {
                    return;
                }
                *sums = pixel;
                part.ahead += 1;
                rest.got_on();
                part.counters += scratch.counters;
            }
            (part.passes, part.ahead) = (next, 0);
        }
    }

    /// Adds some samples of a pixel; false when it was told to stop between them.
    fn add_samples(
        &self,
        scratch: &mut Scratch,
        pixel: &mut PixelAccumulator,
        at: (u32, u32),
        samples: std::ops::Range<u32>,
    ) -> bool {
        for index in samples {
            if self.control.stops() {
                return false;
            }
            pixel.add(index as usize, &self.sample(scratch, at, index, None));
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_grow_in_whole_replicates_up_to_the_limit() {
        let rounds = |limit| {
            let round = |&samples: &u32| (samples < limit).then(|| next_round(samples, limit));
            std::iter::successors(Some(0), round).collect::<Vec<_>>()
        };
        assert_eq!(rounds(50), [0, 4, 8, 12, 16, 20, 24, 28, 32, 40, 48, 50]);
        assert_eq!(rounds(1), [0, 1]);
        assert_eq!(next_round(u32::MAX - 3, u32::MAX), u32::MAX);
    }
}
