//! How far the pixels of a frame have come: what rendering adds to, and what a checkpoint holds.

use serde::{Deserialize, Serialize};

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
}

/// How far a tile has come. Its pixels are either rendered one after the other, or get a sample in each pass.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct TilePart {
    /// The first pixels, which have all their samples.
    pub pixels: Vec<Pixel>,
    /// Sums over the passes.
    pub sums: Vec<PixelAccumulator>,
    /// Passes in the sums of all pixels.
    pub passes: u32,
    /// Pixels in whose sums there is one pass more.
    pub ahead: usize,
    /// What happened to the paths of these samples.
    pub counters: Counters,
}

impl Accumulation {
    /// A frame of which nothing is done.
    pub fn new(resolution: [u32; 2]) -> Self {
        let rects = tiles(resolution[0], resolution[1], TILE_SIZE);
        let parts = vec![TilePart::default(); rects.len()];
        Self { resolution, rects, parts, counters: Counters::default() }
    }

    /// Takes over what was done earlier; false when it is not of a frame of this size.
    #[must_use]
    pub(super) fn restore(&mut self, parts: Vec<TilePart>, counters: Counters) -> bool {
        let fits = parts.len() == self.rects.len() && parts.iter().zip(&self.rects).all(|(p, r)| p.fits(*r));
        if fits {
            (self.parts, self.counters) = (parts, counters);
        }
        fits
    }

    /// Tiles whose pixels all have all their samples.
    pub(super) fn traced(&self) -> usize {
        self.parts.iter().zip(&self.rects).filter(|(part, rect)| part.pixels.len() == rect.area()).count()
    }

    pub(super) fn is_traced(&self) -> bool {
        self.traced() == self.rects.len()
    }

    /// Whether any sample is there.
    pub(super) fn is_begun(&self) -> bool {
        self.parts.iter().any(|part| !part.pixels.is_empty() || part.passes > 0 || part.ahead > 0)
    }

    /// The picture, and what happened on the way.
    pub fn finish(self) -> (FrameImage, Counters) {
        let [width, height] = self.resolution;
        let mut counters = self.counters;
        let tiles = self.parts.into_iter().zip(self.rects).map(|(part, rect)| {
            counters += part.counters;
            let pixels = if part.sums.is_empty() {
                part.pixels
            } else {
                part.sums.iter().map(PixelAccumulator::finish).collect()
            };
            Tile { rect, pixels }
        });
        let image = FrameImage::from_tiles(width, height, tiles);
        counters.non_finite = image.rejected();
        (image, counters)
    }
}

impl TilePart {
    fn fits(&self, rect: TileRect) -> bool {
        let area = rect.area();
        if self.sums.is_empty() {
            self.pixels.len() <= area && self.passes == 0 && self.ahead == 0
        } else {
            self.pixels.is_empty() && self.sums.len() == area && self.ahead < area
        }
    }
}
