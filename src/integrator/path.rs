//! Volumetric path tracing through labelled interfaces.
//!
//! Both branches, reflection and refraction, are followed at the first `split` interfaces of a path; afterwards one is
//! chosen by Fresnel's reflectance. In media that only absorb the transmittance is exact; in media that scatter the
//! free flight is drawn in one lane and weighted over all (one-sample spectral multiple importance sampling). Where the
//! density changes from place to place, its integral along the ray stands in for the distance. What a medium emits
//! between one event and the next surface is added as its expectation, exactly.
//!
//! Russian roulette acts on the throughput without the factors (n_a / n_b)^2 of the boundaries crossed, relative to the
//! branch's share at the splits, so that a path which loses nothing is never ended by it.

use glam::{DVec3, Vec3};

use super::direct::Receiver;
use super::{EyeSample, FirstHit, Scratch};
use crate::accel::{Accel, Hit, Ignored};
use crate::geometry::Ray;
use crate::optics::medium::{MediumId, MediumLanes};
use crate::optics::phase::Deflection;
use crate::sampling::SampleStream;
use crate::scene::frame::Frame;
use crate::scene::geometry::SurfaceHit;
use crate::spectrum::{Lanes, Wavelengths};

/// Volumetric path tracing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathTracer {
    /// Interactions along a path at most; 0 for no limit but [`HARD_LIMIT`].
    pub max_depth: u32,
    /// Both branches are followed at this many interfaces.
    pub split: u32,
}

/// From this interaction on a path survives with [`LATE_SURVIVAL`], whatever its throughput.
const LATE_ROULETTE: u32 = 1024;
/// Probability of going on at each interaction beyond [`LATE_ROULETTE`].
const LATE_SURVIVAL: f32 = 0.98;
/// No path goes on beyond this many interactions.
pub const HARD_LIMIT: u32 = 65_536;

/// Sheets within a rounding error of each other that a path looks through for the one it has jumped over.
const MOST_SHEETS: u32 = 4;

/// A path being followed.
#[derive(Clone, Copy, Debug)]
pub struct Branch {
    pub(super) origin: Vec3,
    pub(super) direction: Vec3,
    /// The triangle that the ray leaves.
    pub(super) leaves: u32,
    pub(super) medium: MediumId,
    pub(super) throughput: Lanes,
    /// The product of (n_a / n_b)^2 that is part of the throughput.
    pub(super) index_factor: f32,
    /// The branch's share of the path at its splits, which roulette measures the throughput by.
    pub(super) share: f32,
    pub(super) interactions: u32,
    /// Interactions and index-matched boundaries.
    pub(super) steps: u32,
    pub(super) splits_left: u32,
    pub(super) arrival: Arrival,
    pub(super) clearing: Clearing,
    pub(super) stream: SampleStream,
}

/// How a path came to where it is, which decides what light counts when it runs into a source.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrival {
    /// Nothing but specular surfaces since the eye.
    pub(super) specular_from_eye: bool,
    /// The last vertex that was lit by next-event estimation, if the way from there was straight.
    pub(super) lit: Option<LitVertex>,
}

/// A vertex at which next-event estimation looked for the lights.
#[derive(Clone, Copy, Debug)]
pub(super) struct LitVertex {
    pub(super) position: Vec3,
    /// Density with which the path's direction was drawn there.
    pub(super) pdf_w: f32,
}

/// A ball without surfaces around a path in a medium that scatters: while the path stays in it nothing has to be traced.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clearing {
    centre: Vec3,
    /// Negative without a ball.
    radius: f32,
    /// Collisions since the last surface or ball, and how many there must be before the next is looked for.
    collisions: u32,
    patience: u32,
}

impl Clearing {
    pub(super) const NONE: Self =
        Self { centre: Vec3::ZERO, radius: -1.0, collisions: 0, patience: Self::FIRST_PATIENCE };
    /// Paths that collide a few times only are not worth the search.
    const FIRST_PATIENCE: u32 = 4;
    /// A ball of fewer mean free paths is soon left: the next is looked for later.
    const WORTH_A_SEARCH: f32 = 4.0;

    #[inline]
    fn holds(&self, point: Vec3) -> bool {
        self.radius > 0.0 && point.distance_squared(self.centre) < self.radius * self.radius
    }

    /// The path has collided at a point outside of the ball.
    #[inline]
    fn traced_to(&mut self, point: Vec3, sigma_t: f32, accel: &Accel) {
        self.radius = -1.0;
        self.collisions += 1;
        if self.collisions >= self.patience {
            self.centre = point;
            self.radius = accel.clearance(point) - rounding(point, 0.0);
            self.collisions = 0;
            let is_large = self.radius * sigma_t >= Self::WORTH_A_SEARCH;
            self.patience = if is_large { Self::FIRST_PATIENCE } else { 2 * self.patience };
        }
    }
}

/// Whether a branch goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fate {
    GoesOn,
    Ends,
}

/// The scene and the sample that a path belongs to.
pub(super) struct Sample<'a> {
    pub(super) frame: &'a Frame,
    pub(super) scratch: &'a mut Scratch,
    pub(super) wavelengths: &'a Wavelengths,
    /// Interactions along a path at most.
    pub(super) max_depth: u32,
    pub(super) radiance: Lanes,
    pub(super) first: Option<FirstHit>,
}

impl PathTracer {
    /// Radiance along an eye ray.
    pub(super) fn trace(
        &self,
        frame: &Frame,
        scratch: &mut Scratch,
        ray: &Ray,
        wavelengths: &Wavelengths,
        stream: SampleStream,
    ) -> EyeSample {
        scratch.start(frame, wavelengths);
        scratch.branches.push(Branch {
            origin: ray.origin,
            direction: ray.direction,
            leaves: u32::MAX,
            medium: frame.camera_medium,
            throughput: frame.mode.white(),
            index_factor: 1.0,
            share: 1.0,
            interactions: 0,
            steps: 0,
            splits_left: self.split,
            arrival: Arrival { specular_from_eye: true, lit: None },
            clearing: Clearing::NONE,
            stream,
        });
        let max_depth = if self.max_depth == 0 { u32::MAX } else { self.max_depth };
        let mut sample =
            Sample { frame, scratch, wavelengths, max_depth, radiance: Lanes::ZERO, first: None };
        // Light transport is compiled five times over what the scene needs in its inner loop.
        let varied = frame.needs.heterogeneous || frame.needs.emission;
        match (varied, frame.needs.scattering, frame.needs.direct_light) {
            (false, false, false) => self.follow_all::<false, false, false>(&mut sample),
            (false, false, true) => self.follow_all::<false, true, false>(&mut sample),
            (false, true, false) => self.follow_all::<true, false, false>(&mut sample),
            (false, true, true) => self.follow_all::<true, true, false>(&mut sample),
            (true, ..) => self.follow_all::<true, true, true>(&mut sample),
        }
        EyeSample { radiance: sample.radiance, first: sample.first }
    }

    fn follow_all<const SCATTERING: bool, const DIRECT: bool, const VARIED: bool>(
        &self,
        sample: &mut Sample,
    ) {
        while let Some(mut branch) = sample.scratch.branches.pop() {
            while sample.advance::<SCATTERING, DIRECT, VARIED>(&mut branch) == Fate::GoesOn {}
        }
    }
}

impl Sample<'_> {
    /// Follows a branch to its next event and through it.
    ///
    /// `VARIED` is for media of varying density and for those that emit.
    fn advance<const SCATTERING: bool, const DIRECT: bool, const VARIED: bool>(
        &mut self,
        branch: &mut Branch,
    ) -> Fate {
        if branch.steps >= HARD_LIMIT {
            return self.cut(branch);
        }
        branch.steps += 1;
        let u = branch.stream.next4();
        let medium = self.scratch.media[branch.medium.0 as usize];
        let flight = (SCATTERING && medium.scatters).then(|| medium.free_flight(branch.throughput, u[0]));
        let endless = Ray::new(branch.origin, branch.direction);
        let to_particle = flight.map_or(f32::INFINITY, |f| match VARIED {
            true => self.frame.medium(branch.medium).density.distance(&endless, f.distance),
            false => f.distance,
        });
        if SCATTERING
            && !VARIED
            && let Some(flight) = &flight
            && branch.clearing.holds(endless.at(to_particle))
        {
            self.scratch.counters.untraced += 1;
            branch.throughput *= medium.scatter_weight(flight);
            return self.scatter::<DIRECT>(branch, to_particle, u);
        }
        let t_max = to_particle + rounding(branch.origin, to_particle);
        let found = if VARIED {
            self.nearest_and_glow(branch, &medium, t_max)
        } else {
            self.nearest(branch, &Ray { t_max, ..endless })
        };
        match (found, flight) {
            (Some(hit), flight) => {
                branch.clearing = Clearing::NONE;
                let length = self.length::<VARIED>(branch, hit.t);
                branch.throughput *= match flight {
                    Some(flight) => medium.pass_weight(&flight, length),
                    None => medium.transmittance(length),
                };
                let hit = self.frame.geometry.surface_hit(&hit, branch.direction);
                self.meet::<DIRECT>(branch, &hit, u)
            }
            (None, Some(flight)) if to_particle.is_finite() => {
                let point = endless.at(to_particle);
                branch.clearing.traced_to(point, medium.sigma_t.max_element(), &self.frame.accel);
                branch.throughput *= medium.scatter_weight(&flight);
                self.scatter::<DIRECT>(branch, to_particle, u)
            }
            (None, flight) => {
                let length = self.length::<VARIED>(branch, f32::INFINITY);
                branch.throughput *= match flight {
                    Some(flight) => medium.pass_weight(&flight, length),
                    None => medium.transmittance(length),
                };
                self.escape(branch);
                Fate::Ends
            }
        }
    }

    /// The next surface if it is nearer than `t_max`, and what the medium emits on the way to it, however far it is.
    fn nearest_and_glow(&mut self, branch: &Branch, medium: &MediumLanes, t_max: f32) -> Option<Hit> {
        let glows =
            self.frame.needs.emission && self.scratch.sources[branch.medium.0 as usize] != Lanes::ZERO;
        let reach = if glows { f32::INFINITY } else { t_max };
        let ray = Ray { origin: branch.origin, direction: branch.direction, t_max: reach };
        let found = self.nearest(branch, &ray);
        if glows {
            let length = self.length::<true>(branch, found.map_or(f32::INFINITY, |hit| hit.t));
            let source = self.scratch.sources[branch.medium.0 as usize];
            self.radiance += branch.throughput * source * medium.opacity(length);
        }
        found.filter(|hit| hit.t <= t_max)
    }

    /// Metres of density 1 along the path's ray up to a distance.
    #[inline]
    fn length<const VARIED: bool>(&self, branch: &Branch, distance: f32) -> f32 {
        if !VARIED {
            return distance;
        }
        let ray = Ray { origin: branch.origin, direction: branch.direction, t_max: distance };
        self.frame.medium(branch.medium).density.length(&ray)
    }

    /// The surface that the path meets next.
    ///
    /// A ray that leaves an interface starts at the very point, so that it cannot jump over a sheet in the wedge where
    /// several meet. Rounding may put the point on the wrong side of a neighbour, or the ray on the wrong side of an edge,
    /// and at the edges of wedges it decides which sheet seems nearest; the labels tell which is meant. One that does
    /// not belong to the path's medium is looked through where rounding alone may have made it be met, and gives way
    /// elsewhere to one that does belong and is as far away.
    fn nearest(&mut self, branch: &Branch, ray: &Ray) -> Option<Hit> {
        self.scratch.counters.rays += 1;
        let (mut from, mut passed) = (*ray, 0.0);
        let mut ignored = Ignored::one(branch.leaves);
        let mut found = self.frame.accel.closest(&from, ignored);
        for _ in 0..MOST_SHEETS {
            let Some(hit) = found.filter(|hit| !self.frame.is_boundary_of(branch.medium, hit)) else { break };
            self.scratch.counters.rays += 1;
            if let Some(other) = self.beside(branch, &from, &hit) {
                found = Some(other);
                break;
            }
            if !self.is_met_by_rounding(ray, passed + hit.t, &hit) {
                break;
            }
            passed += hit.t;
            from = Ray { origin: from.at(hit.t), t_max: from.t_max - hit.t, ..from };
            ignored = Ignored([branch.leaves, hit.triangle]);
            found = self.frame.accel.closest(&from, ignored);
        }
        found.map(|hit| Hit { t: passed + hit.t, ..hit })
    }

    /// True when a ray begins on the plane of the triangle that it meets at `t`, or meets it at an edge, but for rounding.
    fn is_met_by_rounding(&self, ray: &Ray, t: f32, hit: &Hit) -> bool {
        let slack = 4.0 * rounding(ray.origin, t);
        // In double precision: the squares of areas leave the range of single precision among lengths that are valid.
        let v = self.frame.geometry.vertices(hit.triangle).map(|p| p.as_dvec3());
        let scaled = (v[1] - v[0]).cross(v[2] - v[0]);
        let doubled_area = scaled.length();
        // Height over the plane, and distances from the edges, both times twice the area.
        let height = f64::from(t) * scaled.dot(ray.direction.as_dvec3()).abs();
        let edges = DVec3::new((v[2] - v[1]).length(), (v[0] - v[2]).length(), (v[1] - v[0]).length());
        let from_edges = hit.barycentric.as_dvec3() * doubled_area * doubled_area / edges;
        height.min(from_edges.min_element()) <= f64::from(slack) * doubled_area
    }

    /// A boundary of the path's medium that is as far away as `found`, which is none.
    fn beside(&mut self, branch: &Branch, ray: &Ray, found: &Hit) -> Option<Hit> {
        let t_max = found.t + rounding(ray.origin, found.t);
        let other =
            self.frame.accel.closest(&Ray { t_max, ..*ray }, Ignored([branch.leaves, found.triangle]))?;
        self.frame.is_boundary_of(branch.medium, &other).then_some(other)
    }

    /// The path turns at a particle of the medium.
    fn scatter<const DIRECT: bool>(&mut self, branch: &mut Branch, distance: f32, u: [f32; 4]) -> Fate {
        if branch.throughput.max_element() <= 0.0 {
            return Fate::Ends;
        }
        if self.is_spent(branch) {
            return Fate::Ends;
        }
        let point = branch.origin + branch.direction * distance;
        if branch.interactions == 0 && self.first.is_none() {
            self.first = Some(FirstHit {
                distance: (point - self.frame.camera.eye()).length(),
                position: point,
                normal: -branch.direction,
                albedo: Lanes::ONE,
            });
        }
        let phase = &self.frame.medium(branch.medium).phase;
        let forward = branch.direction;
        let lit = DIRECT && self.frame.looks_for_lights(branch.medium);
        if lit {
            let receiver =
                Receiver { position: point, normal: None, medium: branch.medium, leaves: u32::MAX };
            let response = |wi: Vec3| {
                let turned = Deflection::between(forward, wi);
                (Lanes::splat(phase.value(turned)), phase.pdf_w(turned))
            };
            let direct = self.direct(&receiver, response, &mut branch.stream);
            self.radiance += branch.throughput * direct;
        }
        let turned = phase.sample(forward, [u[1], u[2]]);
        branch.throughput *= turned.weight;
        branch.origin = point;
        branch.direction = turned.wi;
        branch.leaves = u32::MAX;
        let vertex = LitVertex { position: point, pdf_w: turned.pdf_w };
        branch.arrival = Arrival { specular_from_eye: false, lit: lit.then_some(vertex) };
        branch.interacted(u[3])
    }

    /// The path meets nothing any more: it sees the sky, and the sun's disc on a purely specular chain.
    fn escape(&mut self, branch: &Branch) {
        if self.frame.endless[branch.medium.0 as usize] {
            return;
        }
        if branch.medium != MediumId(0) {
            self.scratch.counters.escaped_inside += 1;
        }
        let lights = &self.frame.lights;
        let weight = branch
            .arrival
            .lit
            .map_or(1.0, |v| crate::light::balance(v.pdf_w, lights.environment.pdf_w(branch.direction)));
        let mut radiance = lights.environment.radiance(branch.direction, self.wavelengths) * weight;
        if let Some(sun) = &lights.sun
            && branch.arrival.specular_from_eye
        {
            radiance += sun.radiance(branch.direction, self.wavelengths);
        }
        self.radiance += branch.throughput * radiance;
    }

    /// Remembers the first surface for the picture's extra layers.
    pub(super) fn remember_first(&mut self, branch: &Branch, hit: &SurfaceHit, albedo: Lanes) {
        if branch.interactions == 0 && self.first.is_none() {
            // Index-matched boundaries before it have moved the origin along the eye ray.
            let distance = (hit.point.position - self.frame.camera.eye()).length();
            self.first = Some(FirstHit { distance, position: hit.point.position, normal: hit.ns, albedo });
        }
    }

    /// True when the path has had all its interactions: it may still run into a light, but nothing turns it again.
    pub(super) fn is_spent(&mut self, branch: &Branch) -> bool {
        let spent = branch.interactions >= self.max_depth;
        self.scratch.counters.depth_limited += u64::from(spent);
        spent
    }

    fn cut(&mut self, branch: &Branch) -> Fate {
        let kept = branch.throughput.max_element() / (branch.index_factor * branch.share);
        if branch.arrival.specular_from_eye && kept > 0.999 {
            self.scratch.counters.trapped += 1;
        } else {
            self.scratch.counters.cut += 1;
        }
        Fate::Ends
    }
}

/// How far a point at `distance` from `origin` may be off; where a surface is that near, the path meets it.
///
/// Without this slack a particle next to a surface comes to lie beyond it, and its path goes on in the wrong medium.
fn rounding(origin: Vec3, distance: f32) -> f32 {
    8.0 * f32::EPSILON * (origin.abs().max_element() + distance)
}

impl Branch {
    /// Counts an interaction and plays Russian roulette with `u`.
    pub(super) fn interacted(&mut self, u: f32) -> Fate {
        self.interactions += 1;
        let kept = self.throughput.max_element() / (self.index_factor * self.share);
        let late = if self.interactions >= LATE_ROULETTE { LATE_SURVIVAL } else { 1.0 };
        // Not `min`, which would make 1 of a throughput that is not a number, or of a branch without any share.
        let survival = if kept >= 1.0 { late } else { kept * late };
        if survival >= 1.0 {
            return Fate::GoesOn;
        }
        if u < survival {
            self.throughput /= survival;
            Fate::GoesOn
        } else {
            Fate::Ends
        }
    }
}
