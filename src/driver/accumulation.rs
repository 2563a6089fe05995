//! How far the pixels of a frame have come: what rendering adds to, and what a checkpoint holds.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::half_tile::HalfTile;
use super::samples_range::SamplesRange;
use super::uniform::next_round;
use crate::film::{FrameImage, Pixel, PixelAccumulator, Tile, TileRect, tiles};
use crate::integrator::Counters;

/// Edge of a tile in pixels.
const TILE_SIZE: u32 = 16;

/// The pixels of a frame so far.
#[derive(Clone, Debug, PartialEq)]
pub struct Accumulation {
    resolution: [u32; 2],
    /// The tiles of the frame.
    pub(super) rects: Vec<TileRect>,
    /// How far each has come.
    pub(super) parts: Vec<TilePart>,
    /// What happened to the photons of the passes that are done.
    pub(super) counters: Counters,
    /// The first sample, where the sums are wanted rather than the pixels.
    first: Option<u32>,
}

/// How far a tile has come. Its pixels are rendered one after the other, or get some samples in each round, or are kept
/// as halves.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct TilePart {
    /// The first pixels, which have all their samples.
    pub pixels: Vec<Pixel>,
    /// Sums over the rounds, of which photon passes are such of one sample.
    pub sums: Vec<PixelAccumulator>,
    /// Samples in the sums of all pixels.
    pub passes: u32,
    /// Pixels in whose sums there is one round more.
    pub ahead: usize,
    /// Halves of pixels.
    pub halves: HalfTile,
    /// What happened to the paths of these samples.
    pub counters: Counters,
}

impl Accumulation {
    /// A frame of which nothing is done.
    pub fn new(resolution: [u32; 2]) -> Self {
        let rects = tiles(resolution[0], resolution[1], TILE_SIZE);
        let parts = vec![TilePart::default(); rects.len()];
        Self { resolution, rects, parts, counters: Counters::default(), first: None }
    }

    /// A frame of whose samples some, from this index on, are to be summed up.
    pub(super) fn of_range(resolution: [u32; 2], first: u32) -> Self {
        let mut begun = Self { first: Some(first), ..Self::new(resolution) };
        for (part, rect) in begun.parts.iter_mut().zip(&begun.rects) {
            part.sums = vec![PixelAccumulator::new(); rect.area()];
            part.passes = first;
        }
        begun
    }

    /// The samples of each pixel before the first that is drawn.
    pub(super) fn first(&self) -> u32 {
        self.first.unwrap_or(0)
    }

    /// The tiles, and what happened to photons.
    pub(super) fn parts(&self) -> (&[TilePart], &Counters) {
        (&self.parts, &self.counters)
    }

    /// Adds the sums over other samples of the same frame; false when they are not those of these samples.
    #[must_use]
    pub(super) fn add(&mut self, others: &[TilePart], counters: Counters, range: SamplesRange) -> bool {
        let fits = |(other, rect): (&TilePart, &TileRect)| other.fits(*rect) && other.holds(range);
        if others.len() != self.rects.len() || !others.iter().zip(&self.rects).all(fits) {
            return false;
        }
        self.parts.par_iter_mut().zip(others).for_each(|(part, other)| {
            part.sums.iter_mut().zip(&other.sums).for_each(|(own, other)| *own += other);
            part.passes += range.count();
            part.counters += other.counters;
        });
        self.counters += counters;
        true
    }

    /// Takes over what was done earlier; false when it is not of a frame of this size.
    #[must_use]
    pub(super) fn restore(&mut self, parts: Vec<TilePart>, counters: Counters) -> bool {
        let keeps_sums =
            |p: &TilePart| self.first.is_none_or(|first| !p.sums.is_empty() && p.passes >= first);
        let fits = |(p, r): (&TilePart, &TileRect)| p.fits(*r) && keeps_sums(p);
        let fits = parts.len() == self.rects.len() && parts.iter().zip(&self.rects).all(fits);
        if fits {
            (self.parts, self.counters) = (parts, counters);
        }
        fits
    }

    /// Pixels of the frame.
    pub(super) fn pixels(&self) -> u64 {
        self.rects.iter().map(|rect| rect.area() as u64).sum()
    }

    /// Samples of all pixels so far, where all are to have `limit`; of pixels that are not done, those before.
    pub(super) fn drawn(&self, limit: u32) -> u64 {
        let drawn: u64 =
            self.parts.iter().zip(&self.rects).map(|(part, rect)| part.drawn(*rect, limit)).sum();
        drawn - self.pixels() * u64::from(self.first())
    }

    /// Samples of each pixel after the next round; tiles that are rendered pixel by pixel get all in it.
    pub(super) fn next_round(&self, limit: u32) -> u32 {
        let in_rounds = self.parts.iter().filter(|part| part.pixels.is_empty());
        in_rounds.map(|part| part.passes).min().map_or(limit, |samples| next_round(samples, limit))
    }

    /// Whether any sample is there.
    pub(super) fn is_begun(&self) -> bool {
        let is_begun =
            |part: &TilePart| !part.pixels.is_empty() || part.passes > self.first() || part.ahead > 0;
        self.parts.iter().any(|part| is_begun(part) || part.halves.is_used())
    }

    /// Samples in halves, those included that their picture does not use.
    pub(super) fn in_halves(&self) -> u64 {
        self.parts.iter().map(|part| part.halves.samples()).sum()
    }

    /// The picture so far, of a frame that is between two rounds.
    pub(super) fn image(&self) -> FrameImage {
        self.image_of(TilePart::picture)
    }

    /// A picture of pixels that are made of each tile.
    pub(super) fn image_of(&self, pixels: impl Fn(&TilePart) -> Vec<Pixel> + Sync) -> FrameImage {
        let [width, height] = self.resolution;
        let tiles: Vec<Tile> = self
            .parts
            .par_iter()
            .zip(&self.rects)
            .map(|(part, rect)| Tile { rect: *rect, pixels: pixels(part) })
            .collect();
        FrameImage::from_tiles(width, height, tiles)
    }

    /// The picture so far, and what happened on the way, of a frame that is between two rounds.
    pub(super) fn so_far(&self) -> (FrameImage, Counters) {
        let image = self.image();
        let mut counters = self.counters;
        self.parts.iter().for_each(|part| counters += part.counters);
        counters.non_finite = image.rejected();
        (image, counters)
    }

    /// The picture, and what happened on the way.
    pub fn finish(self) -> (FrameImage, Counters) {
        let [width, height] = self.resolution;
        let mut counters = self.counters;
        let tiles = self.parts.into_iter().zip(self.rects).map(|(part, rect)| {
            counters += part.counters;
            let pixels = if part.pixels.is_empty() { part.picture() } else { part.pixels };
            Tile { rect, pixels }
        });
        let image = FrameImage::from_tiles(width, height, tiles);
        counters.non_finite = image.rejected();
        (image, counters)
    }
}

impl TilePart {
    /// Samples that all pixels have, where all are to have `limit`.
    pub fn samples(&self, rect: TileRect, limit: u32) -> u32 {
        if self.pixels.len() == rect.area() { limit } else { self.passes }
    }

    /// Samples of all pixels together; of those that are not done, those before.
    pub fn drawn(&self, rect: TileRect, limit: u32) -> u64 {
        let area = rect.area() as u64;
        self.pixels.len() as u64 * u64::from(limit) + area * u64::from(self.passes)
    }

    /// Whether it is the sums over these samples and nothing else.
    fn holds(&self, range: SamplesRange) -> bool {
        let is_whole = self.passes == range.end && self.ahead == 0;
        is_whole && !self.sums.is_empty() && self.sums.iter().all(|sums| sums.has_seen(range.count()))
    }

    /// The pixels as they are.
    fn picture(&self) -> Vec<Pixel> {
        if self.halves.is_used() {
            self.halves.pixels()
        } else if self.sums.is_empty() {
            self.pixels.clone()
        } else {
            self.sums.iter().map(PixelAccumulator::finish).collect()
        }
    }

    fn fits(&self, rect: TileRect) -> bool {
        let area = rect.area();
        if self.halves.is_used() {
            let is_alone = self.pixels.is_empty() && self.sums.is_empty() && self.passes == 0;
            is_alone && self.ahead == 0 && self.halves.fits(rect)
        } else if self.sums.is_empty() {
            self.pixels.len() <= area && self.passes == 0 && self.ahead == 0
        } else {
            self.pixels.is_empty() && self.sums.len() == area && self.ahead < area
        }
    }
}
