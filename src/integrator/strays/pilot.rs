//! Photons that tell where others are worth emitting, and how wide these are spread.

use rayon::prelude::*;

use super::StrayFrame;
use crate::integrator::photon::{Emission, Photon, Radii, SunStarts, common_of_pass, holding};
use crate::integrator::{Counters, Scratch};
use crate::scene::frame::Frame;
use crate::spectrum::Lanes;

/// Cells along each edge of the unit square of a sun.
const CELLS: usize = 32;
/// Photons that tell what the cells of a sun bring: sixteen in each.
const PILOT: u32 = 16_384;
/// The part of the photons that is drawn evenly.
const EVEN: f64 = 0.2;
/// Photons that the first radius takes in on surfaces and in media: few, since the noise that they leave is little beside that
/// of the paths that ask, and each that is asked costs time.
const NEIGHBOURS: [f32; 2] = [4.0, 2.0];
/// Photons that tell the radii, at most.
const OF_RADII: u32 = 65_536;

impl StrayFrame<'_> {
    /// The same with photons where they are worth it, and radii; `None` where none bring anything.
    pub(super) fn guided(mut self, frame: &Frame) -> Option<Self> {
        let worth = SunStarts::by_worth(&self.worth_of_cells(frame)?, CELLS)?;
        self.emission = Emission::of_suns(frame, Some(worth));
        let count = self.count.min(OF_RADII);
        let pilot = self.trace(frame, 0, count, &|| false);
        // Photons of one pilot stand for so many photons of a pass.
        let share = count as f32 / self.count as f32;
        let settings = &self.mapper.settings;
        let widest = 0.1 * self.emission.seen_radius();
        let radius = |given: Option<f32>, photons: &[Photon], neighbours: f32| {
            given.unwrap_or_else(|| holding(photons, neighbours * share).unwrap_or(widest).min(widest))
        };
        let caustic = radius(settings.radius, &pilot.caustic, NEIGHBOURS[0]);
        let volume = radius(settings.volume_radius, &pilot.volume, NEIGHBOURS[1]);
        self.radii = Radii { caustic, global: caustic, volume };
        Some(self)
    }

    /// Sun by sun, and row by row; `None` where none is worth anything.
    fn worth_of_cells(&self, frame: &Frame) -> Option<Vec<f64>> {
        let (wavelengths, time) = common_of_pass(frame, self.seed, 0);
        let suns = frame.lights.suns.len();
        let pilot = PILOT * suns as u32;
        let tracing = self.tracing(frame, (&wavelengths, time), pilot);
        let stream = self.stream(0);
        let left_by: Vec<(usize, f64)> = (0..pilot)
            .into_par_iter()
            .map_init(Scratch::default, |scratch, index| {
                scratch.counters = Counters::default();
                scratch.start(frame, &wavelengths, Lanes::ZERO);
                let [.., x, y] = stream(index).next4();
                // The squares of the suns lie one beyond the other along y.
                let [x, y] = [x, y * suns as f32].map(|u| (u * CELLS as f32) as usize);
                let mut walk = tracing.walk(scratch);
                walk.emit(index, stream(index));
                let left = walk.arrivals.caustic.iter().chain(&walk.arrivals.volume);
                (y * CELLS + x, left.map(|photon| f64::from(photon.flux.element_sum())).sum())
            })
            .collect();
        let mut cells = vec![0.0; suns * CELLS * CELLS];
        for (cell, flux) in left_by {
            cells[cell] += flux * flux;
        }
        cells.iter_mut().for_each(|square| *square = square.sqrt());
        let mean = cells.iter().sum::<f64>() / cells.len() as f64;
        if mean <= 0.0 {
            return None;
        }
        Some(cells.iter().map(|w| EVEN * mean + (1.0 - EVEN) * w).collect())
    }
}
