//! Forced scattering: a way through a medium splits into the light that gets through and the light that is scattered.
//!
//! A free flight through a thin medium rarely ends at a particle, and is noisy for it. Here the surface at length d is
//! found first, and both outcomes are followed `[PEREZ03]`, each with its share of the path:
//!
//! ```text
//! passed:     T(d) = P(d) (T(d) / P(d)),                  P(d) = sum over the lanes of p exp(-sigma_t d)
//! scattered:  t drawn from the density of free flights over [0, d], divided by their probability 1 - P(d)
//! ```
//! p being the selection probabilities of the lanes. So each branch is a free flight on condition of its outcome, times
//! the outcome's probability: the weights over the lanes and the expectation are those of free flights.

use super::flight::{Around, Event};
use super::path::{Branch, Fate, Sample};

impl Sample<'_> {
    /// The next surface of a path; what is scattered on the way to it becomes a branch of its own.
    pub(super) fn fly_and_scatter<const DIRECT: bool, const VARIED: bool>(
        &mut self,
        branch: &mut Branch,
    ) -> Event {
        let medium = self.scratch.media[branch.medium.0 as usize];
        branch.forced_left -= 1;
        let endless = self.ray(branch.origin, branch.direction);
        let found = self.nearest_on_way::<VARIED>(branch, &medium, f32::INFINITY);
        let length = self.length::<VARIED>(branch, found.map_or(f32::INFINITY, |hit| hit.t));
        if let Some(strays) = self.strays_in(branch) {
            let up_to = (found.map_or(f32::INFINITY, |hit| hit.t), found);
            self.add_strays(strays, branch, up_to, |length| medium.transmittance(length));
        }
        let mut scattered = *branch;
        scattered.stream = branch.stream.fork(2);
        // It waits for its turn, so no flight may be drawn for it here; the other has a surface before it.
        let outward = std::mem::replace(&mut self.scratch.around, Around::NOTHING).outward;
        let u = scattered.stream.next4();
        let flight = medium.free_flight_within(branch.throughput, length, u[0]);
        let distance = match VARIED {
            true => self.frame.medium(branch.medium).density.distance(&endless, flight.distance),
            false => flight.distance,
        };
        let share = flight.probability_within(&medium, length);
        if share > 0.0 && distance.is_finite() {
            scattered.throughput *= medium.scatter_weight(&flight) * share;
            scattered.share *= share;
            // The picture's extra layers show one of the two.
            let first = self.first;
            let is_shown = scattered.stream.next4()[0] < share;
            if self.scatter::<DIRECT>(&mut scattered, distance, u) == Fate::GoesOn {
                self.scratch.branches.push(scattered);
            }
            if !is_shown {
                self.first = first;
            }
        }
        self.scratch.around = Around { outward, ..Around::NOTHING };
        branch.throughput *= medium.transmittance(length);
        branch.share *= flight.probability_beyond(&medium, length);
        found.map_or(Event::Nothing, Event::Surface)
    }
}
