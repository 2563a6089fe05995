//! Photons that stand for the sunlight that eye paths do not find, and for no other.
//!
//! Sunlight is parted by what has turned it before the first vertex that scatters it, a diffuse surface or a particle:
//!
//! | the sun comes there | found by |
//! |---|---|
//! | straight, through index-matched boundaries | next-event estimation |
//! | through one interface that bends it, and index-matched ones | beams ([`crate::integrator::beams`]) |
//! | by any other way: bent twice, mirrored, through meshes that overlap | stray photons |
//!
//! Such a photon ends at that vertex. Eye paths find what becomes of its light, and ask for it at every diffuse surface
//! and along every way through a medium that scatters. So no light is counted twice, and none is lost that beams do not
//! look for: a photon that was bent once is kept where they do not.
//!
//! Nothing is left to chance where it need not be. At the first interface every way is followed with its share of the flux,
//! since most light passes it and what it mirrors is what is wanted. On its way through a medium a photon leaves
//! what is scattered there in one place, drawn on condition that it is on the way, and goes on with what gets through:
//!
//! ```text
//! left behind:  flux sigma_s T(t) P(d) / p(t),   t drawn with p(t) / P(d) in [0, d],     goes on:  flux T(d)
//! ```

use super::map::Photon;
use super::trace::{Flying, History, Walk};
use crate::geometry::Ray;
use crate::integrator::beams::Beams;
use crate::integrator::interface::PhotonWay;
use crate::integrator::path::Fate;
use crate::scene::geometry::SurfaceHit;
use crate::scene::surface::MediumPair;

/// What no stray photon stands for besides what comes straight.
#[derive(Clone, Copy, Debug)]
pub(in crate::integrator) struct Strays<'a> {
    /// Through which triangles paths look for the sun.
    pub(in crate::integrator) beams: Option<&'a Beams>,
}

impl Walk<'_> {
    /// Leaves what is scattered up to the next surface and takes the photon through that.
    pub(super) fn pass_on(&mut self, strays: &Strays, flying: &mut Flying, u: [f32; 4]) -> Fate {
        let branch = &mut flying.branch;
        let medium = self.sample.scratch.media[branch.medium.0 as usize];
        let endless = self.sample.ray(branch.origin, branch.direction);
        let found = self.sample.nearest(branch, &endless);
        let length = self.sample.length::<true>(branch, found.map_or(f32::INFINITY, |hit| hit.t));
        let passed = medium.transmittance(length);
        if medium.scatters && strays.keeps(flying) {
            self.leave_scattered(flying, &endless, length);
        }
        flying.branch.throughput *= passed;
        match found {
            Some(hit) if flying.branch.throughput.max_element() > 0.0 => self.meet(flying, &hit, u),
            _ => Fate::Ends,
        }
    }

    /// `length` is that of the way in metres of density 1.
    fn leave_scattered(&mut self, flying: &mut Flying, endless: &Ray, length: f32) {
        let branch = &mut flying.branch;
        let medium = self.sample.scratch.media[branch.medium.0 as usize];
        let v = branch.stream.next4();
        let flight = medium.free_flight_within(branch.throughput, length, v[0]);
        let distance = self.tracing.frame.medium(branch.medium).density.distance(endless, flight.distance);
        let share = flight.probability_within(&medium, length);
        if share > 0.0 && distance.is_finite() {
            let weight = medium.scatter_weight(&flight) * (share * flying.scale);
            self.arrivals.volume.push(Photon {
                position: self.sample.particle(branch, distance),
                direction: branch.direction,
                normal: glam::Vec3::ZERO,
                medium: branch.medium,
                flux: branch.throughput * weight,
                scattered: false,
                spread: flying.spread,
            });
        }
    }

    /// True where eye paths do not find the light of a photon that arrives.
    pub(super) fn is_kept(&self, flying: &Flying) -> bool {
        self.tracing.strays.is_none_or(|strays| strays.keeps(flying))
    }

    /// True when beams are looked for.
    pub(super) fn has_beams(&self) -> bool {
        self.tracing.strays.is_some_and(|strays| strays.beams.is_some())
    }

    /// True before a medium that eye paths do not get into.
    pub(super) fn stops_before(&self, pair: &MediumPair, hit: &SurfaceHit) -> bool {
        self.tracing.strays.is_some() && self.tracing.frame.reflects_beyond(pair, hit.from_front)
    }

    /// True where every way is followed.
    pub(super) fn splits(&self, flying: &Flying) -> bool {
        self.tracing.strays.is_some() && flying.history == History::Straight
    }

    /// Follows every way with its share: the last one now.
    pub(super) fn split(
        &mut self,
        flying: &mut Flying,
        ways: &[PhotonWay],
        taken: impl Fn(&Flying, &PhotonWay, f32) -> Flying,
        u: f32,
    ) -> Fate {
        let arrived = *flying;
        let mut fate = Fate::Ends;
        for (way, number) in ways.iter().zip(0..).filter(|(way, _)| way.share > 0.0) {
            let mut next = taken(&arrived, way, way.share);
            next.branch.share *= way.share;
            next.branch.stream = arrived.branch.stream.fork(number);
            if next.branch.interacted(u) == Fate::Ends {
                continue;
            }
            if fate == Fate::GoesOn {
                self.waiting.push(*flying);
            }
            (*flying, fate) = (next, Fate::GoesOn);
        }
        fate
    }
}

impl Strays<'_> {
    fn keeps(&self, flying: &Flying) -> bool {
        match flying.history {
            History::Straight | History::Scattered => false,
            History::Bent => self.beams.is_none_or(|beams| !beams.reach(flying.branch.medium)),
            History::Narrowed => true,
        }
    }
}
