//! Random walks in a ball without surfaces, where nothing is traced and nothing shines: a loop of its own.
//!
//! Where flights and angles depend on nothing that the path has been through, [`super::ahead`] draws several collisions
//! at a time. Elsewhere each turn draws what [`Sample::fly`] and [`Sample::scatter`] would draw from the same random
//! numbers, keeps the path in registers and brings directions back to unit length by a step of Newton's method for 1 /
//! sqrt(d . d):
//!
//! ```text
//! d' = d (3 - d . d) / 2,   |d'| - 1 = -3/2 (|d| - 1)^2
//! ```

use super::path::{Branch, Fate, Sample};
use crate::optics::phase::{PhaseFunction, PhaseLanes, SpectralLanes};
use crate::spectrum::Lanes;
use glam::Vec3;

/// How particles turn a path.
trait Turns {
    /// A new direction and its weight, for a path that arrives with this throughput.
    fn turn(&self, forward: Vec3, u: [f32; 2], throughput: Lanes) -> (Vec3, Lanes);
}

impl Turns for PhaseFunction {
    #[inline(always)]
    fn turn(&self, forward: Vec3, u: [f32; 2], _: Lanes) -> (Vec3, Lanes) {
        let (wi, weight) = self.turn(forward, u);
        let wi = match self {
            // It does not come from the one before, so that no errors add up.
            Self::Isotropic(_) => wi,
            _ => near_unit(wi),
        };
        (wi, Lanes::splat(weight))
    }
}

impl Turns for SpectralLanes<'_> {
    #[inline(always)]
    fn turn(&self, forward: Vec3, u: [f32; 2], throughput: Lanes) -> (Vec3, Lanes) {
        let turned = self.sample(forward, u, throughput);
        (turned.wi, turned.weight)
    }
}

#[inline(always)]
fn near_unit(direction: Vec3) -> Vec3 {
    direction * (1.5 - 0.5 * direction.length_squared())
}

impl Sample<'_> {
    /// Goes on with a path until its next flight would leave the ball, and leaves that flight to be drawn again.
    pub(super) fn walk(&mut self, branch: &mut Branch) -> Fate {
        if self.walks_ahead(branch) {
            return self.walk_ahead(branch);
        }
        match self.frame.medium(branch.medium).phase.at(self.wavelengths) {
            PhaseLanes::One(phase @ PhaseFunction::Isotropic(_)) => self.walk_by(branch, phase),
            PhaseLanes::One(phase @ PhaseFunction::HenyeyGreenstein(_)) => self.walk_by(branch, phase),
            PhaseLanes::One(phase) => self.walk_by(branch, phase),
            PhaseLanes::Spectral(phase) => self.walk_by(branch, &phase),
        }
    }

    #[inline(always)]
    fn walk_by(&mut self, walked: &mut Branch, phase: &impl Turns) -> Fate {
        let medium = self.scratch.media[walked.medium.0 as usize];
        let clearing = self.scratch.around.clearing;
        let mut branch = *walked;
        let mut fate = Fate::GoesOn;
        let before = branch.interactions;
        while branch.interactions < self.max_depth && branch.is_below_the_longest() {
            let mut stream = branch.stream;
            let u = stream.next4();
            let flight = medium.free_flight(branch.throughput, u[0]);
            let point = branch.origin + branch.direction * flight.distance;
            if !clearing.holds(point) {
                break;
            }
            let collided = medium.scatter_weight(&flight);
            let (wi, weight) = phase.turn(branch.direction, [u[1], u[2]], branch.throughput * collided);
            branch.stream = stream;
            branch.origin = point;
            branch.direction = wi;
            branch.throughput *= collided * weight;
            fate = branch.goes_on(u[3]);
            if fate == Fate::Ends {
                break;
            }
        }
        self.scratch.counters.untraced += u64::from(branch.interactions - before);
        *walked = branch;
        fate
    }
}
