//! Where photons start.
//!
//! ```text
//! flux = L cos / (n pdf_a pdf_w)       over n photons of one kind of light; p_i n of them are of sun i
//! ```
//! * Suns and the sky: a direction from the light's own density, and a point on a disc perpendicular to it that covers
//!   the scene. Where the scene reaches much farther than what the eye sees, points lie log-uniformly around that, so that
//!   each octave of distance gets as many; those farther out are spread as much wider as their neighbours are farther away.
//! * Emitting triangles: a point by power, and a direction in the cone around the sphere of all that does not emit; by the
//!   cosine where the point is inside of it.
//!
//! Kinds that are there get equal numbers: photons 0, k, 2k, .. of k kinds are the first's. Each kind has sequences of its
//! own: every k-th point of one would miss parts of the domain.

use std::f32::consts::PI;

use std::borrow::Cow;

use glam::Vec3;

use super::suns::SunStarts;
use crate::accel::Ignored;
use crate::geometry::elementary::{exp, ln};
use crate::geometry::{Bounds, Frame as Basis, Ray};
use crate::light::LightSample;
use crate::optics::medium::MediumId;
use crate::sampling::{SampleStream, warp};
use crate::scene::frame::{Frame, Place};
use crate::scene::layers::Insides;
use crate::scene::surface::Surface;
use crate::spectrum::{Lanes, Wavelengths};

/// A sphere.
#[derive(Clone, Copy, Debug)]
struct Ball {
    centre: Vec3,
    radius: f32,
}

/// A kind of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Suns,
    Sky,
    Area,
}

/// How a frame's lights emit.
#[derive(Clone, Debug)]
pub(in crate::integrator) struct Emission {
    kinds: Vec<Kind>,
    /// Around everything that does not emit.
    scene: Ball,
    /// Around what the eye sees.
    seen: Ball,
    /// What is before each emitting triangle, by its entry among the lights; `None` where an interface crosses it.
    starts: Vec<Option<Place>>,
    /// None where there are no suns.
    suns: Option<SunStarts>,
}

/// The start of a photon.
#[derive(Clone, Copy, Debug)]
pub(super) struct Emitted {
    pub(super) origin: Vec3,
    pub(super) direction: Vec3,
    /// The triangle that it leaves.
    pub(super) leaves: u32,
    pub(super) place: Place,
    pub(super) flux: Lanes,
    /// As [`super::Photon::spread`].
    pub(super) spread: f32,
}

/// The scene reaches much farther than what is seen from this ratio of their radii on.
const FAR: f32 = 4.0;

impl Emission {
    /// `sky` says whether the sky is among the lights that emit photons.
    pub(super) fn new(frame: &Frame, sky: bool) -> Self {
        let lights = &frame.lights;
        let suns = SunStarts::by_power(&lights.suns);
        let kinds = [
            suns.as_ref().map(|_| Kind::Suns),
            sky.then_some(Kind::Sky),
            lights.area.as_ref().map(|_| Kind::Area),
        ];
        let scene = scene_ball(frame);
        let starts = starts(frame, 0.0);
        let kinds = kinds.into_iter().flatten().collect();
        Self { kinds, scene, seen: seen_ball(frame, scene), starts, suns }
    }

    /// That of the suns alone.
    pub(in crate::integrator) fn of_suns(frame: &Frame, suns: Option<SunStarts>) -> Self {
        let scene = scene_ball(frame);
        let kinds = suns.iter().map(|_| Kind::Suns).collect();
        Self { kinds, scene, seen: seen_ball(frame, scene), starts: Vec::new(), suns }
    }

    /// The same at another time, where something moves; `count` photons will be emitted then.
    pub(super) fn at(&self, frame: &Frame, time: f32, count: u32) -> Cow<'_, Self> {
        if !frame.accel.is_in_motion() || self.starts.is_empty() {
            return Cow::Borrowed(self);
        }
        let is_worth_it = self.starts.len() < count as usize / 4;
        let starts = if is_worth_it { starts(frame, time) } else { vec![None; self.starts.len()] };
        Cow::Owned(Self { starts, ..self.clone() })
    }

    /// Radius of what the eye sees, in metres.
    pub(in crate::integrator) fn seen_radius(&self) -> f32 {
        self.seen.radius.min(self.scene.radius)
    }

    /// How many kinds of light emit photons, at least 1.
    pub(super) fn kinds(&self) -> u32 {
        (self.kinds.len() as u32).max(1)
    }

    /// True when some light emits photons.
    pub(in crate::integrator) fn is_possible(&self) -> bool {
        !self.kinds.is_empty() && self.scene.radius > 0.0
    }

    /// Photon `index` of `count`; `None` where none arrives.
    pub(super) fn emit(
        &self,
        frame: &Frame,
        (wavelengths, time): (&Wavelengths, f32),
        (index, count): (u32, u32),
        stream: &mut SampleStream,
    ) -> Option<Emitted> {
        let kinds = self.kinds();
        let kind = self.kinds[(index % kinds) as usize];
        // Photons index % kinds, + kinds, .. below count.
        let of_kind = (count - index % kinds).div_ceil(kinds) as f32;
        let u = stream.next4();
        let mut emitted = match kind {
            Kind::Suns => {
                let start = self.suns.as_ref()?.sample([u[2], u[3]]);
                let mut light = frame.lights.suns[start.sun].sample([u[0], u[1]], wavelengths);
                light.radiance /= start.density;
                self.start_at_infinity(frame, &light, start.place, (wavelengths, time))
            }
            Kind::Sky => {
                let light = frame.lights.environment.emit([u[0], u[1]], wavelengths)?;
                self.start_at_infinity(frame, &light, [u[2], u[3]], (wavelengths, time))
            }
            Kind::Area => self.start_on_triangle(frame, u, stream.next4()[0], (wavelengths, time)),
        }?;
        emitted.flux /= of_kind;
        (emitted.flux.max_element() > 0.0).then_some(emitted)
    }

    fn start_at_infinity(
        &self,
        frame: &Frame,
        light: &LightSample,
        u: [f32; 2],
        (wavelengths, time): (&Wavelengths, f32),
    ) -> Option<Emitted> {
        let basis = Basis::around(light.wi);
        let (offset, pdf_a, near, spread) = if self.scene.radius > FAR * self.seen.radius {
            let reach = self.scene.radius + self.scene.centre.distance(self.seen.centre);
            let (offset, pdf_a) = log_uniform_disc(u, self.seen.radius, reach);
            let relative = offset.length_squared() / (self.seen.radius * self.seen.radius);
            (offset, pdf_a, self.seen, (1.0 + relative).sqrt())
        } else {
            let disc = warp::disc(u) * self.scene.radius;
            (disc.extend(0.0), 1.0 / (PI * self.scene.radius * self.scene.radius), self.scene, 1.0)
        };
        let mut origin = near.centre + basis.to_world(offset) + light.wi * near.radius;
        if frame.accel.occluded(&Ray::new(origin, light.wi).at_time(time), Ignored::NOTHING) {
            // What is seen does not reach out of the scene there: start beyond all of it, with coarser coordinates.
            origin += light.wi * 2.0 * self.scene.radius;
            if frame.accel.occluded(&Ray::new(origin, light.wi).at_time(time), Ignored::NOTHING) {
                return None;
            }
        }
        let open_air = &frame.media[0];
        let back = Ray::new(origin, light.wi);
        let arrives = open_air.lanes(wavelengths).transmittance(open_air.density.length(&back));
        let flux = light.radiance * arrives / (light.pdf_w * pdf_a);
        let emitted =
            Emitted { origin, direction: -light.wi, leaves: u32::MAX, place: Place::OPEN_AIR, flux, spread };
        self.is_in_the_open(frame, &emitted, time).then_some(emitted)
    }

    /// False for light from below a sea without end, which there is not.
    fn is_in_the_open(&self, frame: &Frame, emitted: &Emitted, time: f32) -> bool {
        if !frame.endless.contains(&true) {
            return true;
        }
        let ray = Ray::new(emitted.origin, emitted.direction).at_time(time);
        let first = frame.accel.closest(&ray, Ignored::NOTHING);
        first.is_some_and(|hit| frame.is_boundary_of(MediumId(0), Insides::NONE, &hit))
    }

    fn start_on_triangle(
        &self,
        frame: &Frame,
        u: [f32; 4],
        choice: f32,
        (wavelengths, time): (&Wavelengths, f32),
    ) -> Option<Emitted> {
        let point = frame.lights.area.as_ref()?.sample_point([u[0], u[1], choice], wavelengths);
        let towards = self.scene.centre - point.position;
        let distance = towards.length();
        let sine = self.scene.radius / distance;
        let is_aimed = sine < 0.999;
        let (direction, pdf_w) = if is_aimed {
            let one_minus_cos = sine * sine / (1.0 + (1.0 - sine * sine).sqrt());
            let local = warp::cone([u[2], u[3]], one_minus_cos);
            (Basis::around(towards / distance).to_world(local).normalize(), warp::cone_pdf_w(one_minus_cos))
        } else {
            let local = warp::cosine_hemisphere([u[2], u[3]]);
            (Basis::around(point.normal).to_world(local).normalize(), warp::cosine_hemisphere_pdf_w(local.z))
        };
        let cos = direction.dot(point.normal);
        if cos <= 0.0 || pdf_w <= 0.0 {
            return None;
        }
        Some(Emitted {
            origin: point.position,
            direction,
            leaves: point.triangle,
            place: self.starts[point.entry]
                .unwrap_or_else(|| place_before(frame, point.position, point.normal, time)),
            flux: point.radiance * (cos / (point.pdf_a * pdf_w)),
            spread: 1.0,
        })
    }
}

/// A point on a disc of radius `greatest` with density 1 / (pi ln(1 + R^2 / r^2) (rho^2 + r^2)).
fn log_uniform_disc(u: [f32; 2], inner: f32, greatest: f32) -> (Vec3, f32) {
    let ratio = greatest / inner;
    let log = ln(1.0 + ratio * ratio);
    let squared = inner * inner * (exp(u[0] * log) - 1.0);
    let (sin, cos) = crate::geometry::elementary::sin_cos(2.0 * PI * u[1]);
    let rho = squared.sqrt();
    (Vec3::new(rho * cos, rho * sin, 0.0), 1.0 / (PI * log * (squared + inner * inner)))
}

/// The ball around everything that does not emit; of radius 0 when there is nothing.
fn scene_ball(frame: &Frame) -> Ball {
    let geometry = &frame.geometry;
    let corners = (0..geometry.triangles.len() as u32)
        .filter(|&id| !matches!(frame.surface(id), Surface::Emitter { .. }))
        .flat_map(|id| [0.0, frame.views.shutter].map(|time| geometry.vertices_at(id, time)))
        .flatten();
    let bounds = Bounds::of_points(corners.clone());
    let centre = bounds.centre();
    let squared = corners.map(|p| p.distance_squared(centre)).fold(0.0, f32::max);
    // Rounding must leave no corner outside.
    Ball { centre, radius: squared.sqrt() * 1.000_01 }
}

/// The ball around what the middle of the eye's rays meet: their median point, and twice the median distance from it.
fn seen_ball(frame: &Frame, scene: Ball) -> Ball {
    const RAYS: u32 = 16;
    let [width, height] = frame.views.opening.resolution().map(|n| n as f32 / RAYS as f32);
    let mut seen: Vec<Vec3> = Vec::new();
    for i in 0..RAYS * RAYS {
        let (x, y) = ((i % RAYS) as f32 + 0.5, (i / RAYS) as f32 + 0.5);
        let ray = frame.views.opening.ray(x * width, y * height);
        let hit = frame.accel.closest(&ray, Ignored::NOTHING);
        let hit = hit.filter(|hit| !matches!(frame.surface(hit.triangle), Surface::Emitter { .. }));
        seen.extend(hit.map(|hit| ray.at(hit.t)));
    }
    if seen.is_empty() {
        return scene;
    }
    let median = |mut values: Vec<f32>| {
        values.sort_unstable_by(f32::total_cmp);
        values[values.len() / 2]
    };
    let centre = Vec3::from_array([0, 1, 2].map(|axis| median(seen.iter().map(|p| p[axis]).collect())));
    let radius = 2.0 * median(seen.iter().map(|p| p.distance(centre)).collect());
    if radius > 0.0 { Ball { centre, radius } } else { scene }
}

/// What is on the bright side of each emitting triangle at a time.
fn starts(frame: &Frame, time: f32) -> Vec<Option<Place>> {
    let place = |(corners, normal): ([Vec3; 3], Vec3)| place_of_triangle(frame, &corners, normal, time);
    frame.lights.area.as_ref().map_or_else(Vec::new, |area| area.bright_sides().map(place).collect())
}

/// What is on the bright side of an emitting triangle, where it is the same at the centroid and near the corners.
fn place_of_triangle(frame: &Frame, corners: &[Vec3; 3], normal: Vec3, time: f32) -> Option<Place> {
    let centroid = (corners[0] + corners[1] + corners[2]) / 3.0;
    let place = place_before(frame, centroid, normal, time);
    let is_same = |corner: &Vec3| place_before(frame, corner.lerp(centroid, 1e-3), normal, time) == place;
    corners.iter().all(is_same).then_some(place)
}

/// What is on the bright side of a point on an emitting triangle.
fn place_before(frame: &Frame, point: Vec3, normal: Vec3, time: f32) -> Place {
    if !frame.needs.specular && !frame.needs.matched_interfaces {
        return Place::OPEN_AIR;
    }
    // A little in front of it, so that an interface that it touches is seen from the bright side.
    let size = point.abs().max_element();
    frame.place_of(point + normal * (size * 4.0 * f32::EPSILON), time)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integrals over the disc, estimated with the samples: the area, and a Gaussian as wide as the inner radius.
    #[test]
    fn the_log_uniform_disc_has_the_density_that_it_states() {
        let (inner, greatest, n) = (0.5_f32, 80.0_f32, 512);
        let (mut area, mut gaussian) = (0.0_f64, 0.0_f64);
        for i in 0..n * n {
            let u = [((i % n) as f32 + 0.5) / n as f32, ((i / n) as f32 + 0.5) / n as f32];
            let (point, pdf_a) = log_uniform_disc(u, inner, greatest);
            assert!(point.length() <= greatest * 1.000_01);
            area += 1.0 / f64::from(pdf_a);
            gaussian += f64::from((-point.length_squared() / (inner * inner)).exp() / pdf_a);
        }
        let n = f64::from(n * n);
        let expected = std::f64::consts::PI * f64::from(greatest * greatest);
        // The midpoint rule on 512 strata that each span 2 % of the squared radius.
        assert!((area / n / expected - 1.0).abs() < 1e-3, "{}", area / n / expected);
        let expected = std::f64::consts::PI * f64::from(inner * inner);
        assert!((gaussian / n / expected - 1.0).abs() < 1e-3, "{}", gaussian / n / expected);
    }
}
