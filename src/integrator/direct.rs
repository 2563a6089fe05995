//! Next-event estimation: light that reaches a vertex straight from a source.
//!
//! Only index-matched boundaries may lie in between; what is refracted or reflected on the way is found by chance.
//! Each kind of light gets one sample, weighted against the chance of running into it by the balance heuristic. The sun
//! is never run into, so its samples count in full.

use glam::Vec3;

use super::path::{HARD_LIMIT, Sample};
use crate::accel::Ignored;
use crate::geometry::Ray;
use crate::light::{LightSample, balance};
use crate::optics::medium::MediumId;
use crate::sampling::SampleStream;
use crate::scene::geometry::SurfaceHit;
use crate::scene::surface::Surface;
use crate::spectrum::Lanes;

/// A vertex that receives light.
pub(super) struct Receiver {
    pub(super) position: Vec3,
    /// The surface, if it is on one.
    pub(super) normal: Option<SurfaceHit>,
    pub(super) medium: MediumId,
    /// The triangle that shadow rays leave.
    pub(super) leaves: u32,
}

impl Sample<'_> {
    /// Light from every kind of source; `response` gives value (cosine included) and density of the vertex's own
    /// sampling for a direction.
    pub(super) fn direct(
        &mut self,
        receiver: &Receiver,
        response: impl Fn(Vec3) -> (Lanes, f32),
        stream: &mut SampleStream,
    ) -> Lanes {
        let u = stream.next4();
        let frame = self.frame;
        let lights = &frame.lights;
        let mut sum = Lanes::ZERO;
        if let Some(sun) = &lights.sun {
            let light = sun.sample([u[0], u[1]], self.wavelengths);
            sum += self.contribution(receiver, &response, &light, |_| 1.0);
        }
        if let Some(light) = lights.environment.sample([u[2], u[3]], self.wavelengths) {
            sum += self.contribution(receiver, &response, &light, |pdf_w| balance(light.pdf_w, pdf_w));
        }
        if let Some(area) = &lights.area {
            let v = stream.next4();
            if let Some(light) = area.sample(receiver.position, [v[0], v[1], v[2]], self.wavelengths) {
                sum += self.contribution(receiver, &response, &light, |pdf_w| balance(light.pdf_w, pdf_w));
            }
        }
        sum
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

    /// Transmittance times (n_a / n_b)^2 of the boundaries on the straight way to a light; zero when blocked.
    fn visibility(&mut self, receiver: &Receiver, light: &LightSample) -> Lanes {
        let origin = receiver.normal.map_or(receiver.position, |hit| hit.point.spawn(hit.ng, light.wi));
        let mut ray = Ray { origin, direction: light.wi, t_max: light.distance };
        let source = light.triangle.unwrap_or(u32::MAX);
        let mut ignored = Ignored([receiver.leaves, source]);
        let mut medium = receiver.medium;
        let mut visible = Lanes::ONE;
        for _ in 0..HARD_LIMIT {
            self.scratch.counters.shadow_rays += 1;
            let coefficients = self.scratch.media[medium.0 as usize];
            if !self.frame.needs.matched_interfaces {
                let blocked = self.ends_in_the_dark(&ray, medium) || self.frame.accel.occluded(&ray, ignored);
                return if blocked { Lanes::ZERO } else { visible * coefficients.transmittance(ray.t_max) };
            }
            let Some(hit) = self.frame.accel.closest(&ray, ignored) else {
                return if self.ends_in_the_dark(&ray, medium) {
                    Lanes::ZERO
                } else {
                    visible * coefficients.transmittance(ray.t_max)
                };
            };
            let Surface::Interface(pair) = self.frame.surface(hit.triangle) else {
                return Lanes::ZERO;
            };
            if !pair.matched {
                return Lanes::ZERO;
            }
            let (a, b) = pair.crossed(hit.from_front);
            visible *= coefficients.transmittance(hit.t) * self.index_factor(a, b);
            medium = b;
            let surface = self.frame.geometry.surface_hit(&hit, light.wi);
            ray.origin = surface.point.spawn(surface.ng, light.wi);
            ray.t_max -= hit.t;
            ignored = Ignored([hit.triangle, source]);
        }
        Lanes::ZERO
    }

    /// True when the ray runs to infinity in a medium without end.
    fn ends_in_the_dark(&self, ray: &Ray, medium: MediumId) -> bool {
        ray.t_max.is_infinite() && self.frame.endless[medium.0 as usize]
    }
}
