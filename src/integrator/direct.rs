//! Next-event estimation: light that reaches a vertex straight from a source.
//!
//! Only index-matched boundaries may lie in between; what is refracted or reflected on the way is found by chance, or by a
//! guess of where it comes from ([`super::beneath`]).
//! Each sun and each other kind of light gets one sample, weighted against the chance of running into it by the balance
//! heuristic. Suns are never run into, so their samples count in full.

use glam::Vec3;

use super::dispersion::Carried;
use super::path::Sample;
use crate::accel::Ignored;
use crate::geometry::Ray;
use crate::light::{LightSample, balance};
use crate::optics::medium::MediumId;
use crate::sampling::SampleStream;
use crate::scene::geometry::SurfaceHit;
use crate::scene::layers::Insides;
use crate::scene::surface::Surface;
use crate::spectrum::Lanes;

/// A vertex that receives light.
pub(super) struct Receiver {
    pub(super) position: Vec3,
    /// The surface, if it is on one.
    pub(super) normal: Option<SurfaceHit>,
    pub(super) medium: MediumId,
    /// The meshes that it is in, of those that overlap.
    pub(super) insides: Insides,
    /// The triangle that shadow rays leave.
    pub(super) leaves: u32,
    /// Interactions of the path before it.
    pub(super) interactions: u32,
    /// The lanes of the path.
    pub(super) carried: Carried,
    /// How much of its light counts, in the sense of [`super::path::Branch::weight`].
    pub(super) weight: f32,
}

impl Sample<'_> {
    /// Light from every kind of source, or with `lamps` false from those alone that photons do not carry; `response` gives value (cosine included) and density of the vertex's own
    /// sampling for a direction.
    pub(super) fn direct(
        &mut self,
        receiver: &Receiver,
        lamps: bool,
        response: impl Fn(Vec3) -> (Lanes, f32),
        stream: &mut SampleStream,
    ) -> Lanes {
        let u = stream.next4();
        let frame = self.frame;
        let mut sum = match self.beams_to(receiver) {
            None => Lanes::ZERO,
            Some(beams) => self.suns_through(beams, receiver, &response, stream),
        };
        if let Some(beneath) = self.looks_beneath(receiver.medium, receiver.interactions) {
            return sum + self.beneath(beneath, receiver, response, [u[0], u[1]]);
        }
        if !frame.lit[receiver.medium.0 as usize] {
            return sum;
        }
        let lights = &frame.lights;
        for sun in lights.suns.iter().filter(|_| lamps) {
            let light = sun.sample([u[0], u[1]], self.wavelengths);
            sum += self.contribution(receiver, &response, &light, |_| 1.0);
        }
        if (lamps || self.sky_is_for_paths())
            && let Some(light) = lights.environment.sample([u[2], u[3]], self.wavelengths)
        {
            sum += self.contribution(receiver, &response, &light, |pdf_w| balance(light.pdf_w, pdf_w));
        }
        if let Some(area) = lights.area.as_ref().filter(|_| lamps) {
            let v = stream.next4();
            if let Some(light) = area.sample(receiver.position, [v[0], v[1], v[2]], self.wavelengths) {
                sum += self.contribution(receiver, &response, &light, |pdf_w| balance(light.pdf_w, pdf_w));
            }
        }
        sum
    }

    /// True where next-event estimation can find a light; photons carry what lies beneath interfaces.
    pub(super) fn looks_for_lights(&self, medium: MediumId) -> bool {
        self.frame.looks_for_lights(medium)
            && (self.photons.is_none() || self.frame.beneath[medium.0 as usize].is_none())
            || self.beams.is_some_and(|beams| beams.reach(medium))
    }

    /// True where eye paths find the light of the sky on their own.
    pub(super) fn sky_is_for_paths(&self) -> bool {
        self.photons.is_none_or(|pass| !pass.sky)
    }

    fn contribution(
        &mut self,
        receiver: &Receiver,
        response: &impl Fn(Vec3) -> (Lanes, f32),
        light: &LightSample,
        weight: impl Fn(f32) -> f32,
    ) -> Lanes {
        if receiver.normal.is_some_and(|hit| light.wi.dot(hit.ng) <= 0.0) {
            return Lanes::ZERO;
        }
        let (value, pdf_w) = response(light.wi);
        let unshadowed = value * light.radiance * (weight(pdf_w) / light.pdf_w);
        if unshadowed.max_element() <= 0.0 {
            return Lanes::ZERO;
        }
        unshadowed * self.visibility(receiver, light)
    }

    /// What is left on the straight way to a light.
    fn visibility(&mut self, receiver: &Receiver, light: &LightSample) -> Lanes {
        let origin = receiver.normal.map_or(receiver.position, |hit| hit.point.spawn(hit.ng, light.wi));
        let ray = Ray { t_max: light.distance, ..self.ray(origin, light.wi) };
        let ignored = Ignored([receiver.leaves, light.triangle.unwrap_or(u32::MAX)]);
        self.left_along(&ray, ignored, (receiver.medium, receiver.insides))
    }

    /// Transmittance times (n_a / n_b)^2 of the boundaries along a ray that begins in a medium and meshes; zero when blocked.
    pub(super) fn left_along(
        &mut self,
        ray: &Ray,
        ignored: Ignored,
        (medium, insides): (MediumId, Insides),
    ) -> Lanes {
        self.scratch.counters.shadow_rays += 1;
        let blocked = if self.frame.needs.matched_interfaces {
            self.find_crossings(ray, ignored)
        } else {
            self.frame.accel.occluded(ray, ignored)
        };
        match blocked {
            true => Lanes::ZERO,
            false if self.frame.needs.layers => self.transmittance_among_layers(medium, insides, ray),
            false => self.transmittance(medium, ray),
        }
    }

    /// Lists the index-matched boundaries that a ray crosses; true when something else blocks it.
    fn find_crossings(&mut self, ray: &Ray, ignored: Ignored) -> bool {
        let frame = self.frame;
        let crossings = &mut self.scratch.crossings;
        crossings.clear();
        let mut blocked = false;
        frame.accel.each_hit(ray, ignored, |hit| {
            // Whether a layer is in the way is told when all are known.
            blocked = !match frame.surface(hit.triangle) {
                Surface::Interface(pair) => pair.matched && !frame.reflects_beyond(pair, hit.from_front),
                Surface::Layer(_) => true,
                _ => false,
            };
            crossings.push(hit);
            blocked
        });
        crossings.sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.triangle.cmp(&b.triangle)));
        blocked
    }

    /// What is left of light along a ray that begins in `medium` and crosses the boundaries that were found.
    fn transmittance(&self, mut medium: MediumId, ray: &Ray) -> Lanes {
        let mut left = Lanes::ONE;
        let mut travelled = 0.0;
        for hit in &self.scratch.crossings {
            let Surface::Interface(pair) = self.frame.surface(hit.triangle) else { continue };
            let beyond = pair.crossed(hit.from_front).1;
            left *= self.transmittance_of(medium, ray, travelled, hit.t);
            // From the medium that light is in: at an edge both triangles are met, and the second changes nothing.
            left *= self.index_factor(medium, beyond);
            (medium, travelled) = (beyond, hit.t);
        }
        if self.ends_in_the_dark(ray, medium) {
            return Lanes::ZERO;
        }
        left * self.transmittance_of(medium, ray, travelled, ray.t_max)
    }

    /// What one medium leaves of light between two distances along a ray.
    #[inline]
    pub(super) fn transmittance_of(&self, medium: MediumId, ray: &Ray, from: f32, to: f32) -> Lanes {
        let mut length = to - from;
        if self.frame.needs.heterogeneous {
            let way = Ray { origin: ray.at(from), t_max: length, ..*ray };
            length = self.frame.medium(medium).density.length(&way);
        }
        self.scratch.media[medium.0 as usize].transmittance(length)
    }

    /// True when the ray runs to infinity in a medium without end.
    pub(super) fn ends_in_the_dark(&self, ray: &Ray, medium: MediumId) -> bool {
        ray.t_max.is_infinite() && self.frame.endless[medium.0 as usize]
    }
}
