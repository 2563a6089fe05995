//! Goes over the tiles of a frame on all threads until each is drawn, with rests in which what is done is saved.

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::accumulation::{Accumulation, TilePart};
use super::tiles::Control;
use crate::film::TileRect;
use crate::integrator::Scratch;

/// Tells a tile when to rest. However often the frame rests to be saved, it gets on by a pixel in between.
pub(super) struct Rest<'a> {
    control: &'a dyn Control,
    gets_on: AtomicBool,
}

impl Rest<'_> {
    /// Whether to break off between two pixels.
    pub fn is_wanted(&self) -> bool {
        self.control.wants_save() && self.gets_on.load(Ordering::Relaxed)
    }

    /// A pixel is done.
    pub fn got_on(&self) {
        self.gets_on.store(true, Ordering::Relaxed);
    }
}

/// Draws in every tile that is not done until it is; false when told to stop before.
pub(super) fn over_tiles(
    accumulation: &mut Accumulation,
    control: &dyn Control,
    is_done: impl Fn(&TilePart, TileRect) -> bool + Sync,
    draw: impl Fn(&mut TilePart, TileRect, &mut Scratch, &Rest<'_>) + Sync,
) -> bool {
    loop {
        if accumulation.parts.iter().zip(&accumulation.rects).all(|(part, rect)| is_done(part, *rect)) {
            return true;
        }
        if control.stops() {
            return false;
        }
        if control.wants_save() {
            control.save(accumulation);
        }
        let rest = Rest { control, gets_on: AtomicBool::new(false) };
        let tiles = accumulation.parts.par_iter_mut().zip(&accumulation.rects);
        tiles.for_each_init(Scratch::default, |scratch, (part, rect)| {
            if !is_done(part, *rect) {
                draw(part, *rect, scratch, &rest);
            }
        });
    }
}
