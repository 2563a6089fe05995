//! Dispersion: what becomes of a path's four wavelengths where each bends its own way.
//!
//! A path follows its hero, lane 0. Where the indices of an interface are in the same ratio on all lanes it carries all of
//! them on; else the first refraction leaves lane 0 alone `[WILKIE14]`. With R_i the reflectance on lane i and T_i the
//! throughput
//!
//! ```text
//! q = (R_0 + R_1 + R_2 + R_3) / 4          chance of reflection, or its share where both ways are followed
//! reflected, q:       T_i R_i / q                           on each lane
//! refracted, 1 - q:   4 T_0 (1 - R_0) / (1 - q)             on lane 0, and 0 on the others
//! ```
//! That is unbiased. A reflection keeps the expectation T_i R_i on each lane for any q that is not 0 where an R_i is not. A
//! refraction has 4 T_0 (1 - R_0); each of the four wavelengths is lane 0 with the same chance, as u and u + 1/4 give the
//! same four, so the mean over these is the sum of T_i (1 - R_i), all that the four of them refract. And it is bounded:
//! R_i <= 4 q and 1 - R_i <= 4 (1 - q), also where some lanes are reflected totally and others are not. Where the hero is,
//! q is 1: what others refract is found when they lead.
//!
//! Interpolated normals are taken or not by where the refracted direction ends up ([`super::interface`]). Where lanes
//! differ in that, they reflect apart, too, and lane 0 goes on alone either way. What is looked for through an interface
//! ([`super::beneath`]) is seen by lane 0 alone as well.
//!
//! Photons keep one lane too, but each draws its own, i with the chance T_i / sum_k T_k, and goes on with sum_k T_k on it.
//! So every lane keeps its expectation among photons, whatever eye paths do: what an eye path of lane 0 alone takes of
//! them is the fourth part of them that have lane 0, and nothing is counted sixteen-fold.

use super::interface::{Ways, ways};
use super::path::{Branch, Sample};
use crate::optics::medium::{MediumId, pick};
use crate::scene::geometry::SurfaceHit;
use crate::spectrum::Lanes;

/// The lanes that are left of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Carried {
    All,
    One(u8),
}

/// What goes on in lane 0 alone stands for all four.
const HERO_ALONE: Lanes = Lanes::new(4.0, 0.0, 0.0, 0.0);

/// An interface at which the lanes of a path part.
pub(super) struct Parting {
    /// q of the head.
    pub(super) reflectance: f32,
    /// Throughput of both ways over their chance.
    reflected: Lanes,
    refracted: Lanes,
    /// The lanes part where they are reflected, too.
    reflects_apart: bool,
}

impl Sample<'_> {
    /// The index beyond an interface over that before it, on each lane.
    #[inline]
    pub(super) fn eta(&self, incident: MediumId, beyond: MediumId) -> Lanes {
        self.index(beyond) / self.index(incident)
    }
}

/// True when the directions of a path's lanes are not one beyond an interface of these indices.
#[inline]
fn is_parted_by(carried: Carried, eta: Lanes) -> bool {
    carried == Carried::All && eta != Lanes::splat(eta.x)
}

/// What is seen by a path through an interface on each lane, over what one direction sees there.
#[inline]
pub(super) fn seen_through(carried: Carried, eta: Lanes) -> Lanes {
    if is_parted_by(carried, eta) { HERO_ALONE } else { Lanes::ONE }
}

impl Parting {
    /// Where lanes part; `ways` are those of lane 0.
    #[inline]
    pub(super) fn at(branch: &Branch, hit: &SurfaceHit, eta: Lanes, ways: &Ways) -> Option<Self> {
        is_parted_by(branch.carried, eta).then(|| Self::of_ways(branch, hit, eta, ways))
    }

    #[inline(never)]
    fn of_ways(branch: &Branch, hit: &SurfaceHit, eta: Lanes, hero: &Ways) -> Self {
        let mut each = Lanes::splat(hero.reflectance);
        let mut reflects_apart = false;
        for lane in 1..4 {
            let own = ways(-branch.direction, hit.ns, hit.ng, eta[lane]);
            each[lane] = own.reflectance;
            reflects_apart |= own.shaded != hero.shaded;
        }
        if reflects_apart {
            let (reflectance, reflected) = (hero.reflectance, HERO_ALONE);
            return Self { reflectance, reflected, refracted: HERO_ALONE, reflects_apart };
        }
        let reflectance = if hero.refracted.is_none() { 1.0 } else { 0.25 * each.element_sum() };
        let over = |share: Lanes, chance: f32| if chance > 0.0 { share / chance } else { Lanes::ZERO };
        let refracted = over(HERO_ALONE * (1.0 - hero.reflectance), 1.0 - reflectance);
        Self { reflectance, reflected: over(each, reflectance), refracted, reflects_apart }
    }

    /// The branch is reflected.
    pub(super) fn reflect(&self, branch: &mut Branch) {
        branch.throughput *= self.reflected;
        if self.reflects_apart {
            branch.leave_to_hero();
        }
    }

    /// The branch is refracted.
    pub(super) fn refract(&self, branch: &mut Branch) {
        branch.throughput *= self.refracted;
        branch.leave_to_hero();
    }
}

impl Branch {
    /// Roulette must not take the fourfold throughput for one that is worth more.
    fn leave_to_hero(&mut self) {
        self.carried = Carried::One(0);
        self.share *= HERO_ALONE.x;
    }

    /// The ratio of indices at which a photon bends; where its lanes part it draws the one that it keeps.
    #[inline]
    pub(super) fn drawn(&mut self, eta: Lanes) -> f32 {
        if is_parted_by(self.carried, eta) {
            self.draw();
        }
        match self.carried {
            Carried::All => eta.x,
            Carried::One(lane) => eta[usize::from(lane)],
        }
    }

    #[inline(never)]
    fn draw(&mut self) {
        let sum = self.throughput.element_sum();
        let (lane, _) = pick(self.throughput / sum, self.stream.next4()[0]);
        self.share *= sum / self.throughput[lane];
        self.throughput = Lanes::ZERO;
        self.throughput[lane] = sum;
        self.carried = Carried::One(lane as u8);
    }
}
