//! Where eye paths ask for stray photons.
//!
//! The eye's own rays ask along all of their ways through a medium, up to the surface. Later rays ask no farther than to the
//! particle that they have drawn, and divide by the chance with which the flight passes a photon, as for a surface there. Paths
//! that bring little ask now and then, with a chance that fits the share of photons in the light:
//!
//! ```text
//! whole way:  sum_p  T(t_p) ..,     up to the particle at s:  sum_p [t_p < s] T(t_p) / P(t_p) ..,     P(t) = chance of s > t
//! ```

use super::StrayPass;
use crate::accel::Hit;
use crate::geometry::Ray;
use crate::integrator::path::{Branch, Sample};
use crate::integrator::photon::reflected;
use crate::integrator::roulette::chance_of_a_look;
use crate::scene::geometry::SurfaceHit;
use crate::spectrum::Lanes;

/// The part of a path's light that photons bring, about: a path asks for them as often as one of so much of its weight asks for
/// what costs as much. With 0.1 the scene of `tests/bench/hero` takes 0.76 of the time that 1 takes, at 1.04 times the
/// variance, and has a quarter more fireflies than with this.
const SHARE: f32 = 0.3;

impl<'a> Sample<'a> {
    /// Radiance that a surface of albedo 1 reflects of stray photons.
    #[inline]
    pub(in crate::integrator) fn strays_on(&self, hit: &SurfaceHit) -> Lanes {
        self.strays.map_or(Lanes::ZERO, |pass| reflected(pass.kernel, &pass.surface, hit))
    }

    /// The photons that a path may meet in its medium.
    #[inline]
    pub(in crate::integrator) fn strays_in(&self, branch: &Branch) -> Option<&'a StrayPass> {
        let scatters = || self.scratch.media[branch.medium.0 as usize].scatters;
        self.strays.filter(|pass| !pass.volume.is_empty() && scatters())
    }

    /// Adds what photons scatter into a path on its way up to `t_max`; `end` is the surface there, if it is one, and `left`
    /// what is left of their light behind so many metres of density 1, over the chance that the way is as long.
    #[inline(never)]
    pub(in crate::integrator) fn add_strays(
        &mut self,
        pass: &StrayPass,
        branch: &mut Branch,
        (t_max, end): (f32, Option<Hit>),
        left: impl Fn(f32) -> Lanes,
    ) {
        let survival = chance_of_a_look(SHARE * branch.weight());
        if survival < 1.0 && branch.stream.next4()[0] >= survival {
            return;
        }
        let ray = Ray { t_max, ..self.ray(branch.origin, branch.direction) };
        let end = end.and_then(|hit| self.visible_end(branch, &hit));
        let found =
            self.gathered((&pass.volume, pass.kernel), branch, &ray, end, |_, _, length| left(length));
        self.radiance += branch.throughput * (found / survival);
    }

    /// How far the nearest photon is from spreading to a point, at most `radius`; 0 where one does.
    pub(in crate::integrator) fn clear_of_strays(&self, point: glam::Vec3, radius: f32) -> f32 {
        self.strays.map_or(radius, |pass| pass.volume.clearance(point, radius))
    }
}
