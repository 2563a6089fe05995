//! Walks that are led to the surface that they came in through ([`crate::optics::dwivedi`]).
//!
//! They are where [`Frame::led`] says so, in frames that take the loop without varied media, once a path has met an
//! interface of its medium. A particle draws a direction and keeps the flight that belongs to it, whose weight has that of
//! the direction; between both the throughput is that of arriving at the particle. Flights that are forced, and those of
//! photons, are not led.

use glam::Vec3;

use super::Scratch;
use super::flight::{Clearing, Event, rounding};
use super::path::{Branch, Sample};
use crate::geometry::Ray;
use crate::optics::dwivedi::{Dwivedi, Led, LedFlight};
use crate::scene::frame::Frame;

impl Scratch {
    /// Takes the media that lead their walks at the wavelengths of a new sample.
    pub(super) fn lead(&mut self, frame: &Frame) {
        if self.led.is_empty() && frame.led.contains(&true) {
            let lanes = frame.media.iter().zip(&self.media).zip(&frame.led);
            let dwivedi = lanes.map(|((m, lanes), led)| {
                m.phase.one().filter(|_| *led).map(|phase| Dwivedi::new(lanes, phase))
            });
            self.led.extend(dwivedi);
        }
    }
}

impl Sample<'_> {
    /// How a path is led from the particle that it has met.
    #[inline]
    pub(super) fn led(&self, branch: &Branch) -> Option<Led> {
        let dwivedi = self.scratch.led.get(branch.medium.0 as usize)?.as_ref()?;
        let knows_where = self.scratch.around.outward != Vec3::ZERO;
        let goes_freely = branch.forced_left == 0 && branch.scatterings_left > 1;
        (knows_where && goes_freely)
            .then(|| dwivedi.at(branch.direction, self.scratch.around.outward, branch.throughput))
    }

    /// Draws the next event of a path that was led, with the random number `u`.
    #[inline(never)]
    pub(super) fn fly_led(&mut self, branch: &mut Branch, u: f32) -> Event {
        let medium = self.scratch.media[branch.medium.0 as usize];
        let flight = std::mem::replace(&mut self.scratch.around.flight, LedFlight::NONE);
        let distance = flight.distance(u);
        let ray = self.ray(branch.origin, branch.direction);
        let point = ray.at(distance);
        if self.scratch.around.clearing.holds(point) {
            self.scratch.counters.untraced += 1;
        } else {
            let t_max = distance + rounding(branch.origin, distance);
            let found = self.nearest(branch, &Ray { t_max, ..ray });
            if let Some(strays) = self.strays_in(branch) {
                let up_to = (found.map_or(distance, |hit| hit.t.min(distance)), found);
                self.add_strays(strays, branch, up_to, |length| flight.pass_weight(&medium, length));
            }
            if let Some(hit) = found {
                branch.throughput *= flight.pass_weight(&medium, hit.t);
                self.scratch.around.clearing = Clearing::NONE;
                return Event::Surface(hit);
            }
            self.collided_at(branch, point, &medium);
        }
        branch.throughput *= flight.scatter_weight(&medium, distance);
        Event::Particle(distance)
    }
}
