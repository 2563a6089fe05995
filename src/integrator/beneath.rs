//! Light that reaches a vertex through one refracting interface.
//!
//! A direction is drawn from where compact lights are likely to be ([`crate::light::beneath`]) and followed through the
//! interface that lies there. What it finds and what a path finds by chance that goes straight from the vertex through one
//! interface into a light are weighted by the balance heuristic, with the densities of the direction at the vertex.

use glam::Vec3;

use super::direct::Receiver;
use super::dispersion::seen_through;
use super::interface;
use super::layers::Seen;
use super::path::{Branch, LitVertex, Looked, Sample};
use crate::accel::Ignored;
use crate::geometry::Ray;
use crate::light::{Beneath, balance};
use crate::optics::medium::MediumId;
use crate::scene::layers::Insides;
use crate::scene::surface::Surface;
use crate::spectrum::Lanes;

impl<'a> Sample<'a> {
    /// What next-event estimation has looked for at a vertex that a path leaves along `wi`.
    pub(super) fn looked(&self, branch: &Branch, vertex: LitVertex, wi: Vec3) -> Looked {
        match self.looks_beneath(branch.medium, branch.interactions) {
            Some(beneath) => Looked::Beneath(balance(vertex.pdf_w, beneath.pdf_w(wi))),
            None if self.frame.lit[branch.medium.0 as usize] => Looked::Straight(vertex),
            // The sun alone was looked for, through interfaces.
            None => Looked::Not,
        }
    }

    /// Where lights are looked for through an interface from a vertex with so many interactions before it; photons carry
    /// that light where there are any. The interface is an interaction too, for which `max_depth` must leave room.
    pub(super) fn looks_beneath(&self, medium: MediumId, interactions: u32) -> Option<&'a Beneath> {
        let has_room = interactions.saturating_add(1) < self.max_depth;
        self.frame.beneath[medium.0 as usize].as_ref().filter(|_| has_room && self.photons.is_none())
    }

    /// Light in a direction drawn with `u`; `response` is as in [`Sample::direct`].
    pub(super) fn beneath(
        &mut self,
        beneath: &Beneath,
        receiver: &Receiver,
        response: impl Fn(Vec3) -> (Lanes, f32),
        u: [f32; 2],
    ) -> Lanes {
        let (wi, guess_w) = beneath.sample(u);
        if guess_w <= 0.0 || receiver.normal.is_some_and(|hit| wi.dot(hit.ng) <= 0.0) {
            return Lanes::ZERO;
        }
        let (value, pdf_w) = response(wi);
        if value.max_element() <= 0.0 {
            return Lanes::ZERO;
        }
        let weighted = value * (balance(guess_w, pdf_w) / guess_w);
        let origin = receiver.normal.map_or(receiver.position, |hit| hit.point.spawn(hit.ng, wi));
        weighted * self.light_through_interface(receiver, &self.ray(origin, wi))
    }

    /// What a ray sees of the lights that are looked for, on its way through one interface.
    fn light_through_interface(&mut self, receiver: &Receiver, ray: &Ray) -> Lanes {
        let frame = self.frame;
        self.scratch.counters.shadow_rays += 1;
        let seen = self.seen(ray, receiver.leaves, receiver.insides);
        let Some(Seen { hit, pair: Some(pair), beyond: insides }) = seen else { return Lanes::ZERO };
        let (incident, beyond) = pair.crossed(hit.from_front);
        // From the wrong side rounding has met it.
        if pair.matched || incident != receiver.medium || frame.reflects_beyond(&pair, hit.from_front) {
            return Lanes::ZERO;
        }
        let point = frame.geometry.surface_hit(&hit, ray.direction, self.time);
        let eta = self.eta(incident, beyond);
        let ways = interface::ways(-ray.direction, point.ns, point.ng, eta.x);
        let Some(direction) = ways.refracted else { return Lanes::ZERO };
        let passed = (1.0 - ways.reflectance) * self.index_factor(incident, beyond);
        let passed = passed * seen_through(receiver.carried, eta);
        let left = self.transmittance_of(incident, ray, 0.0, hit.t) * passed;
        let way = self.ray(point.point.position, direction);
        left * self.light_along(&way, hit.triangle, (beyond, insides))
    }

    /// What a ray meets first; what overlaps it hides is looked through.
    fn seen(&mut self, ray: &Ray, leaves: u32, insides: Insides) -> Option<Seen> {
        let frame = self.frame;
        let hit = frame.accel.closest(ray, Ignored::one(leaves))?;
        match frame.surface(hit.triangle) {
            Surface::Layer(_) => self.first_seen(ray, leaves, insides),
            other => Some(Seen { hit, pair: other.pair().copied(), beyond: insides }),
        }
    }

    /// The light at the end of a ray that leaves triangle `leaves` and is in a medium and meshes, if nothing is in between.
    fn light_along(&mut self, ray: &Ray, leaves: u32, (medium, insides): (MediumId, Insides)) -> Lanes {
        let frame = self.frame;
        self.scratch.counters.shadow_rays += 1;
        let found = self.seen(ray, leaves, insides).map(|seen| seen.hit);
        let (radiance, distance) = match found.map(|hit| (frame.surface(hit.triangle), hit)) {
            Some((Surface::Emitter { radiance }, hit)) if hit.from_front => {
                (radiance.lanes(self.wavelengths), hit.t)
            }
            None if frame.lights.environment.is_sampled() && !frame.endless[medium.0 as usize] => {
                (frame.lights.environment.radiance(ray.direction, self.wavelengths), f32::INFINITY)
            }
            _ => return Lanes::ZERO,
        };
        radiance * self.transmittance_of(medium, ray, 0.0, distance)
    }
}
