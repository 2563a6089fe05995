//! What suns bring to a vertex through the triangles that bend them there.

use glam::{DVec3, Vec3};

use super::super::direct::Receiver;
use super::super::dispersion::Carried;
use super::super::flight::rounding;
use super::super::interface;
use super::super::path::Sample;
use super::super::roulette::chance_of_a_look;
use super::index::sheared;
use super::patch::{Aim, Patch};
use super::roots::{self, Root};
use super::{Beam, Beams, SunBeams};
use crate::accel::{Hit, Ignored};
use crate::geometry::Ray;
use crate::light::Sun;
use crate::scene::surface::Surface;
use crate::spectrum::Lanes;

/// A point of the sun's disc, how it shines, and what it is to light.
#[derive(Clone, Copy)]
struct Shine {
    /// Direction to it, in the world and in the frame of the sun.
    to_sun: Vec3,
    local: DVec3,
    /// Its irradiance.
    power: Lanes,
    /// The vertex, in the frame of the sun.
    x: DVec3,
}

impl<'a> Sample<'a> {
    /// The beams that may reach a vertex with so many interactions before it; `max_depth` must leave room for the interface.
    pub(in crate::integrator) fn beams_to(&self, receiver: &Receiver) -> Option<&'a Beams> {
        let has_room = receiver.interactions.saturating_add(1) < self.max_depth;
        self.beams.filter(|beams| has_room && beams.reach(receiver.medium))
    }

    /// Light of a point of each disc, drawn with `u`, through all triangles, or now and then where that matters little;
    /// `response` is as in [`Sample::direct`].
    pub(in crate::integrator) fn suns_through(
        &mut self,
        beams: &Beams,
        receiver: &Receiver,
        response: &impl Fn(Vec3) -> (Lanes, f32),
        u: [f32; 4],
    ) -> Lanes {
        let survival = chance_of_a_look(receiver.weight);
        if u[2] >= survival {
            return Lanes::ZERO;
        }
        let mut sum = Lanes::ZERO;
        for (sun, own) in self.frame.lights.suns.iter().zip(&beams.of_suns) {
            sum += self.sun_through(sun, own, receiver, response, [u[0], u[1]]);
        }
        sum / survival
    }

    fn sun_through(
        &mut self,
        sun: &Sun,
        beams: &SunBeams,
        receiver: &Receiver,
        response: &impl Fn(Vec3) -> (Lanes, f32),
        u: [f32; 2],
    ) -> Lanes {
        if beams.beams.is_empty() {
            return Lanes::ZERO;
        }
        let light = sun.sample(u, self.wavelengths);
        let local = beams.sun.local(light.wi).normalize();
        let at = beams.sun.local(receiver.position);
        let shine = Shine { to_sun: light.wi, local, power: light.radiance / light.pdf_w, x: at };
        let x = at.as_vec3();
        self.scratch.counters.beam_queries += 1;
        let mut candidates = std::mem::take(&mut self.scratch.candidates);
        beams.index.find(sheared(x, beams.shear.as_vec2()), &mut candidates);
        let mut sum = Lanes::ZERO;
        for number in candidates.iter().map(|number| *number as usize) {
            if beams.sieves[number].holds(x) {
                sum += self.sun_through_one(beams, &beams.beams[number], receiver, response, &shine);
            }
        }
        self.scratch.candidates = candidates;
        sum
    }

    fn sun_through_one(
        &mut self,
        beams: &SunBeams,
        beam: &Beam,
        receiver: &Receiver,
        response: &impl Fn(Vec3) -> (Lanes, f32),
        shine: &Shine,
    ) -> Lanes {
        let frame = self.frame;
        let Surface::Interface(pair) = frame.surface(beam.triangle) else { return Lanes::ZERO };
        let (outer, inner) = pair.crossed(beam.front);
        if inner != receiver.medium && !frame.needs.matched_interfaces {
            return Lanes::ZERO;
        }
        self.scratch.counters.beam_candidates += 1;
        let v = frame.geometry.vertices_at(beam.triangle, self.time);
        let normals = beam.shaded.then(|| frame.geometry.shading_normals(beam.triangle, self.time)).flatten();
        let patch = Patch::new(&beams.sun, &v, normals, if beam.front { 1.0 } else { -1.0 });
        let etas = self.eta(inner, outer);
        let mut roots = std::mem::take(&mut self.scratch.roots);
        let mut sum = Lanes::ZERO;
        for lane in 0..4 {
            let shown = match receiver.carried {
                Carried::One(own) if usize::from(own) != lane => continue,
                Carried::All if etas == Lanes::splat(etas.x) => Lanes::ONE,
                _ => Lanes::AXES[lane],
            };
            let eta = etas[lane];
            let aim = Aim { patch: &patch, x: shine.x, to_sun: shine.local, eta: f64::from(eta) };
            roots::find(&aim, &beam.piece, &mut roots);
            for root in &roots {
                sum += shown * self.sun_along(beams, (beam, &v), &aim, root, receiver, response, shine);
            }
            if shown == Lanes::ONE {
                break;
            }
        }
        self.scratch.roots = roots;
        sum
    }

    /// What comes along one ray.
    #[expect(clippy::too_many_arguments, reason = "the two ends of the ray and what is between")]
    fn sun_along(
        &mut self,
        beams: &SunBeams,
        (beam, v): (&Beam, &[Vec3; 3]),
        aim: &Aim,
        root: &Root,
        receiver: &Receiver,
        response: &impl Fn(Vec3) -> (Lanes, f32),
        shine: &Shine,
    ) -> Lanes {
        let frame = self.frame;
        let direction = beams.sun.world(-root.pass.bent.direction);
        if receiver.normal.is_some_and(|hit| direction.dot(hit.ng) <= 0.0) {
            return Lanes::ZERO;
        }
        let weights = Vec3::new((1.0 - root.uv.x - root.uv.y) as f32, root.uv.x as f32, root.uv.y as f32);
        let t = (v[0] * weights.x + v[1] * weights.y + v[2] * weights.z - receiver.position).length();
        let hit = Hit { triangle: beam.triangle, t, barycentric: weights, from_front: !beam.front };
        let surface = frame.geometry.surface_hit(&hit, direction, self.time);
        let ways = interface::ways(-direction, surface.ns, surface.ng, aim.eta as f32);
        // Where it is the triangle's own, the interpolated normal tells nothing of which of the two bent the ray.
        let is_own = || frame.geometry.interpolated_normal(&hit, surface.ng, self.time) == surface.ng;
        let shaded = ways.shaded || (frame.geometry.is_smooth(beam.triangle) && is_own());
        if shaded != beam.shaded || ways.refracted.is_none() {
            return Lanes::ZERO;
        }
        self.scratch.counters.beam_roots += 1;
        let gathered = (aim.gathered(&root.pass) * f64::from(1.0 - ways.reflectance)) as f32;
        let unshadowed = response(direction).0 * shine.power * gathered;
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
        let way = self.ray(surface.point.spawn(-surface.ng, shine.to_sun), shine.to_sun);
        unshadowed * left * self.left_along(&way, Ignored::one(beam.triangle), (outer, receiver.insides))
    }
}
