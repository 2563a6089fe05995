//! A tile whose pixels are kept as two halves, each of which decides how many samples the other uses.
//!
//! Samples are summed by rungs of the ladder. The rungs that both halves have decided on are one sum; those that only one
//! has are apart, since the other half may stop before them. Where a half decides on its own samples it takes those up
//! to its own rung, and where the picture is made, those up to the other's.

use serde::{Deserialize, Serialize};

use crate::film::{HALVES, HalfSums, Pixel, TileRect, joined};

/// Both halves of a pixel.
pub(super) type Pair = [HalfSums; HALVES];

/// How far a tile of halves has come.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct HalfTile {
    /// The rung that each half has decided on; 0 when the tile has no halves.
    pub rungs: [u32; HALVES],
    /// Work for the samples of each half on the first rung.
    pub work: [u64; HALVES],
    /// Rungs in `both`.
    merged: u32,
    /// Sums of the pixels over these rungs.
    both: Vec<Pair>,
    /// Sums of the pixels over each rung after these; of the last one maybe not of all pixels yet.
    apart: Vec<Vec<Pair>>,
}

impl HalfTile {
    /// Whether there are halves at all.
    pub fn is_used(&self) -> bool {
        self.rungs != [0; HALVES]
    }

    /// The furthest rung that one of the halves has decided on.
    pub fn wanted(&self) -> u32 {
        self.rungs.into_iter().max().unwrap_or(0)
    }

    /// The rung that is being drawn, and the pixels that have it; `None` when all are.
    pub fn next(&self, rect: TileRect) -> Option<(u32, usize)> {
        let begun = self.merged + self.apart.len() as u32;
        match self.apart.last() {
            Some(last) if last.len() < rect.area() => Some((begun, last.len())),
            _ => (begun < self.wanted()).then_some((begun + 1, 0)),
        }
    }

    /// Adds the next pixel of a rung.
    pub fn push(&mut self, rung: u32, area: usize, pair: Pair) {
        if self.merged + self.apart.len() as u32 != rung {
            self.apart.push(Vec::with_capacity(area));
        }
        if let Some(last) = self.apart.last_mut() {
            last.push(pair);
        }
    }

    /// Makes one sum of the rungs that both halves have decided on; of a tile that is drawn.
    pub fn merge(&mut self) {
        let common = self.rungs.into_iter().min().unwrap_or(0);
        while self.merged < common && !self.apart.is_empty() {
            let rung = self.apart.remove(0);
            if self.both.is_empty() {
                self.both = rung;
            } else {
                for (sum, more) in self.both.iter_mut().zip(&rung) {
                    sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
                }
            }
            self.merged += 1;
        }
    }

    /// A half of a pixel up to a rung that one of the halves has decided on.
    fn up_to(&self, pixel: usize, half: usize, rung: u32) -> HalfSums {
        let mut sums = self.both[pixel][half];
        let further = rung.saturating_sub(self.merged) as usize;
        self.apart[..further].iter().for_each(|rung| sums += &rung[pixel][half]);
        sums
    }

    /// The pixels as a half foresees them, from what it decides on: its own samples alone.
    pub fn foreseen(&self, half: usize) -> Vec<Pixel> {
        let pixels = 0..self.both.len();
        pixels.map(|pixel| self.up_to(pixel, half, self.rungs[half]).foreseen()).collect()
    }

    /// The pixels of the picture: of each half as many samples as the other has decided on.
    pub fn pixels(&self) -> Vec<Pixel> {
        let [a, b] = self.rungs;
        let joined = |pixel| joined([&self.up_to(pixel, 0, b), &self.up_to(pixel, 1, a)]);
        (0..self.both.len()).map(joined).collect()
    }

    /// Samples of all pixels, used or not.
    pub fn samples(&self) -> u64 {
        let pairs = self.both.iter().chain(self.apart.iter().flatten());
        pairs.flatten().map(|half| u64::from(half.samples())).sum()
    }

    /// Whether it can be a tile of this size.
    pub fn fits(&self, rect: TileRect) -> bool {
        let area = rect.area();
        let whole = self.apart.len().saturating_sub(1);
        let expected = if self.merged == 0 { 0 } else { area };
        self.both.len() == expected
            && self.rungs.into_iter().all(|rung| rung >= self.merged && rung > 0)
            && self.merged as usize + self.apart.len() <= self.wanted() as usize
            && self.apart[..whole].iter().all(|rung| rung.len() == area)
            && self.apart.last().is_none_or(|last| (1..=area).contains(&last.len()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::FilmSample;
    use glam::Vec3;

    const RECT: TileRect = TileRect { x: 0, y: 0, width: 2, height: 1 };

    /// Each half has one sample a rung: half A the rung's number, B ten times that.
    fn pair(rung: u32) -> Pair {
        let mut pair = Pair::default();
        for (half, value) in [rung as f32, 10.0 * rung as f32].into_iter().enumerate() {
            pair[half].add(2 * half as u32, &FilmSample::of_sky(Vec3::splat(value)));
        }
        pair
    }

    fn draw(tile: &mut HalfTile) {
        while let Some((rung, _)) = tile.next(RECT) {
            tile.push(rung, RECT.area(), pair(rung));
        }
        tile.merge();
    }

    #[test]
    fn each_half_uses_what_the_other_has_decided_on() {
        let mut tile = HalfTile { rungs: [1, 1], ..HalfTile::default() };
        assert_eq!(tile.next(RECT), Some((1, 0)));
        draw(&mut tile);
        for (rungs, merged) in [([2, 1], 1), ([3, 1], 1), ([4, 3], 3)] {
            tile.rungs = rungs;
            draw(&mut tile);
            assert_eq!((tile.merged, tile.apart.len() as u32), (merged, tile.wanted() - merged));
            assert!(tile.fits(RECT) && tile.next(RECT).is_none());
            let mean = |rungs: u32| f64::from(rungs + 1) / 2.0;
            let pixel = tile.pixels()[1];
            let expected = (mean(rungs[1]) + 10.0 * mean(rungs[0])) / 2.0;
            assert!((f64::from(pixel.rgb.x) - expected).abs() < 1e-6, "{rungs:?}: {pixel:?}");
            assert_eq!(pixel.samples, rungs[0] + rungs[1]);
            assert_eq!(tile.samples(), u64::from(4 * tile.wanted()));
            let foreseen = [0, 1].map(|half| f64::from(tile.foreseen(half)[0].rgb.x));
            assert_eq!(foreseen, [mean(rungs[0]), 10.0 * mean(rungs[1])]);
        }
    }

    #[test]
    fn what_cannot_be_a_tile_is_found_out() {
        let mut tile = HalfTile { rungs: [2, 1], ..HalfTile::default() };
        assert!(tile.fits(RECT));
        tile.push(1, 2, pair(1));
        assert!(tile.fits(RECT));
        assert_eq!(tile.next(RECT), Some((1, 1)));
        tile.apart.push(Vec::new());
        assert!(!tile.fits(RECT));
        draw(&mut tile);
        let whole = HalfTile { rungs: [2, 1], ..HalfTile::default() };
        let mut whole = whole;
        draw(&mut whole);
        assert!(whole.fits(RECT) && !whole.fits(TileRect { width: 3, ..RECT }));
        assert!(!HalfTile { rungs: [0, 1], ..whole.clone() }.fits(RECT));
        assert!(!HalfTile { merged: 0, ..whole }.fits(RECT));
    }
}
