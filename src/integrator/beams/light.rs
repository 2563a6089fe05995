//! What suns bring to a vertex through the triangles that bend them there.
//!
//! How often a vertex looks goes with what light from where most of it comes would bring: where that is little, as of particles
//! that scatter forward for most paths, looks are taken with a chance, and where it is much there are several. In the scene of
//! `tests/bench/hero` the chances leave 0.43 of the looks and 0.71 of the time, at 1.01 times the variance, and the further looks
//! a third of the pixels that stand out by eight standard deviations.

use std::f32::consts::PI;

use glam::Vec3;

use super::super::direct::Receiver;
use super::super::flight::rounding;
use super::super::interface;
use super::super::path::Sample;
use super::super::roulette::chance_of_a_look;
use super::query::{Query, Way};
use super::{Beams, SunBeams};
use crate::accel::{Hit, Ignored};
use crate::geometry::Ray;
use crate::light::Sun;
use crate::sampling::SampleStream;
use crate::scene::surface::Surface;
use crate::spectrum::Lanes;

/// The response to light counts as so much of white at least: it may come from elsewhere than most of it does.
const LEAST_RESPONSE: f32 = 0.02;
/// One look is enough for a vertex that returns so much of what an eye path's first white surface does.
const WORTH_ANOTHER: f32 = 0.25;
/// Most looks of a vertex.
const MOST_LOOKS: f32 = 16.0;

impl SunBeams {
    /// How much of white a vertex returns of light through triangles, about.
    fn worth(&self, receiver: &Receiver, response: &impl Fn(Vec3) -> (Lanes, f32)) -> f32 {
        if self.beams.is_empty() {
            return 0.0;
        }
        let brightest = self.mean.map(|wi| response(wi).0.max_element()).into_iter().fold(0.0, f32::max);
        receiver.weight * (PI * brightest).max(LEAST_RESPONSE)
    }
}

impl<'a> Sample<'a> {
    /// The beams that may reach a vertex with so many interactions before it; `max_depth` must leave room for the interface.
    pub(in crate::integrator) fn beams_to(&self, receiver: &Receiver) -> Option<&'a Beams> {
        let has_room = receiver.interactions.saturating_add(1) < self.max_depth;
        self.beams.filter(|beams| has_room && beams.reach(receiver.medium))
    }

    /// Light of points of each disc through all triangles; `response` is as in [`Sample::direct`]. All suns are looked for with
    /// the same numbers.
    pub(in crate::integrator) fn suns_through(
        &mut self,
        beams: &Beams,
        receiver: &Receiver,
        response: &impl Fn(Vec3) -> (Lanes, f32),
        stream: &mut SampleStream,
    ) -> Lanes {
        let worth = beams.of_suns.iter().map(|own| own.worth(receiver, response)).fold(0.0, f32::max);
        let survival = chance_of_a_look(worth);
        if stream.next4()[0] >= survival {
            return Lanes::ZERO;
        }
        let looks = (worth / WORTH_ANOTHER).ceil().clamp(1.0, MOST_LOOKS);
        let mut sum = Lanes::ZERO;
        for _ in 0..looks as u32 {
            let u = stream.next4();
            for (sun, own) in self.frame.lights.suns.iter().zip(&beams.of_suns) {
                sum += self.sun_through(sun, own, receiver, response, u);
            }
        }
        sum / (survival * looks)
    }

    /// Light of a point of the disc.
    fn sun_through(
        &mut self,
        sun: &Sun,
        beams: &SunBeams,
        receiver: &Receiver,
        response: &impl Fn(Vec3) -> (Lanes, f32),
        [x, y, u, v]: [f32; 4],
    ) -> Lanes {
        if beams.beams.is_empty() {
            return Lanes::ZERO;
        }
        let light = sun.sample([x, y], self.wavelengths);
        let query = Query {
            x: beams.sun.local(receiver.position),
            to_sun: beams.sun.local(light.wi).normalize(),
            one_minus_cos: sun.one_minus_cos().into(),
            place: [u, v],
            medium: receiver.medium,
            carried: receiver.carried,
            time: self.time,
        };
        let mut ways = std::mem::take(&mut self.scratch.ways);
        self.scratch.counters.beam_queries += 1;
        self.scratch.counters.beam_candidates +=
            beams.ways(self.frame, &query, &self.scratch.media, &mut ways);
        let (power, mut sum) = (light.radiance / light.pdf_w, Lanes::ZERO);
        for way in &ways.found {
            sum += way.shown * self.sun_along(beams, way, receiver, response, power);
        }
        self.scratch.ways = ways;
        sum
    }

    /// What comes along one ray.
    fn sun_along(
        &mut self,
        beams: &SunBeams,
        Way { beam, corners: v, root, to_sun, gathered, eta, .. }: &Way,
        receiver: &Receiver,
        response: &impl Fn(Vec3) -> (Lanes, f32),
        power: Lanes,
    ) -> Lanes {
        let (frame, to_sun) = (self.frame, beams.sun.world(*to_sun));
        let direction = beams.sun.world(-root.pass.bent.direction);
        if receiver.normal.is_some_and(|hit| direction.dot(hit.ng) <= 0.0) {
            return Lanes::ZERO;
        }
        let weights = Vec3::new((1.0 - root.uv.x - root.uv.y) as f32, root.uv.x as f32, root.uv.y as f32);
        let t = (v[0] * weights.x + v[1] * weights.y + v[2] * weights.z - receiver.position).length();
        let hit = Hit { triangle: beam.triangle, t, barycentric: weights, from_front: !beam.front };
        let surface = frame.geometry.surface_hit(&hit, direction, self.time);
        let ways = interface::ways(-direction, surface.ns, surface.ng, *eta);
        // Where it is the triangle's own, the interpolated normal tells nothing of which of the two bent the ray.
        let is_own = || frame.geometry.interpolated_normal(&hit, surface.ng, self.time) == surface.ng;
        let shaded = ways.shaded || (frame.geometry.is_smooth(beam.triangle) && is_own());
        if shaded != beam.shaded || ways.refracted.is_none() {
            return Lanes::ZERO;
        }
        self.scratch.counters.beam_roots += 1;
        let gathered = (gathered * f64::from(1.0 - ways.reflectance)) as f32;
        let unshadowed = response(direction).0 * power * gathered;
        if unshadowed.max_element() <= 0.0 || !unshadowed.is_finite() {
            return Lanes::ZERO;
        }
        let origin = receiver.normal.map_or(receiver.position, |hit| hit.point.spawn(hit.ng, direction));
        // A neighbour that the ray meets at the common edge is not in the way.
        let cos = direction.dot(surface.ng).abs().max(1e-3);
        let t_max = (t - 4.0 * rounding(origin, t) / cos).max(0.0);
        let way = Ray { t_max, ..self.ray(origin, direction) };
        let Surface::Interface(pair) = frame.surface(beam.triangle) else { return Lanes::ZERO };
        let (outer, _) = pair.crossed(beam.front);
        let inside = (receiver.medium, receiver.insides);
        let left = self.left_along(&way, Ignored([receiver.leaves, beam.triangle]), inside);
        if left == Lanes::ZERO {
            return Lanes::ZERO;
        }
        let way = self.ray(surface.point.spawn(-surface.ng, to_sun), to_sun);
        unshadowed * left * self.left_along(&way, Ignored::one(beam.triangle), (outer, receiver.insides))
    }
}
