//! Rays among meshes that overlap ([`crate::scene::layers`]).
//!
//! A path meets every triangle, the hidden ones too: there it goes straight on and nothing is counted. So hidden triangles
//! are met with the same care for rounding as others, and where a particle is never depends on which side of one it fell.
//!
//! Faces of several meshes may lie on each other. Whichever of them is found first, all are crossed at once: otherwise a
//! ray from water into glass would pass through a film of air that is not there, wherever their common wall is left by the
//! one before it is entered into the other. What is crossed is told from where the faces are and not from the distances
//! along the ray, which rounding sets apart the more the farther it comes:
//!
//! ```text
//! |(q - p) . n_p|  and  |(q - p) . n_q|  <=  COINCIDENT max over both triangles of sum_axes |n_a| max(|corners_a|)
//! ```
//! for hits p and q with unit normals n. Of one mesh only faces that share a corner are, so that no plate is so thin that
//! its two sides are crossed as one. A ray that leaves one of such faces is past, or not yet past, all of them: others
//! that it meets from the wrong side within twice that are those.

use glam::{DVec3, Vec3};

use super::Scratch;
use super::flight::rounding;
use super::path::{Branch, Fate, Sample};
use crate::accel::{Hit, Ignored};
use crate::geometry::Ray;
use crate::optics::medium::MediumId;
use crate::scene::frame::Frame;
use crate::scene::geometry::SurfaceHit;
use crate::scene::layers::{COINCIDENT, Insides, Layer};
use crate::scene::surface::{MediumPair, Surface};
use crate::spectrum::Lanes;

/// The faces of overlapping meshes that a ray crosses at one place.
pub(super) struct Crossing {
    /// What the ray is in before them.
    pub before: Insides,
    /// What it is in beyond.
    pub beyond: Insides,
    /// The media there.
    pub media: (MediumId, MediumId),
    /// The face of a mesh that is stronger than that of the one that was found.
    pub stronger: Option<Hit>,
    /// True when the mesh that was found contradicts what the ray was believed to be in.
    pub contradicts: bool,
}

impl Crossing {
    pub(super) fn is_hidden(&self) -> bool {
        self.media.0 == self.media.1
    }

    /// The interface, whose front the ray comes from or not.
    pub(super) fn pair(&self, frame: &Frame, from_front: bool) -> MediumPair {
        frame.boundary(self.media.0, self.media.1, from_front)
    }
}

/// A face with the plane that it is on.
struct Face<'f> {
    layer: &'f Layer,
    from_front: bool,
    triangle: u32,
    point: DVec3,
    normal: DVec3,
    /// When it is there, in frames.
    time: f32,
    /// Its farthest coordinate along the normal, which bounds the rounding of the plane: however far a level sea goes on,
    /// its height is exact.
    height: f64,
    /// Its farthest coordinate.
    size: f64,
}

impl<'f> Face<'f> {
    /// The face of a layer at a point on it and a time; `None` for other surfaces.
    fn new(frame: &'f Frame, triangle: u32, from_front: bool, point: DVec3, time: f32) -> Option<Self> {
        let Surface::Layer(layer) = frame.surface(triangle) else { return None };
        let v = frame.geometry.vertices_at(triangle, time).map(|p| p.as_dvec3());
        let normal = (v[1] - v[0]).cross(v[2] - v[0]).normalize_or_zero();
        let farthest = v.iter().map(|p| p.abs()).fold(DVec3::ZERO, DVec3::max);
        let (height, size) = (farthest.dot(normal.abs()), farthest.max_element());
        Some(Self { layer, from_front, triangle, point, normal, time, height, size })
    }

    fn at(frame: &'f Frame, hit: &Hit, time: f32) -> Option<Self> {
        let v = frame.geometry.vertices_at(hit.triangle, time).map(|p| p.as_dvec3());
        let weights = hit.barycentric.as_dvec3();
        let point = v[0] * weights.x + v[1] * weights.y + v[2] * weights.z;
        Self::new(frame, hit.triangle, hit.from_front, point, time)
    }

    fn coincides(&self, other: &Self) -> bool {
        let apart = other.point - self.point;
        let height = apart.dot(self.normal).abs().max(apart.dot(other.normal).abs());
        height <= f64::from(COINCIDENT) * self.height.max(other.height)
    }

    /// True when a point lies on the plane, but for what puts faces on each other twice over.
    fn holds(&self, point: Vec3) -> bool {
        let height = (point.as_dvec3() - self.point).dot(self.normal).abs();
        height <= 2.0 * f64::from(COINCIDENT) * self.height
    }

    /// How much farther along a ray than this face, at distance `t`, faces may be met that coincide with it.
    fn reach(&self, ray: &Ray, t: f32) -> f32 {
        let slack = 4.0 * rounding(ray.origin, t) + COINCIDENT * self.size as f32;
        let cos = ray.direction.as_dvec3().dot(self.normal).abs() as f32;
        slack / cos.max(f32::MIN_POSITIVE)
    }
}

fn shares_corner(frame: &Frame, a: &Face, b: &Face) -> bool {
    let [a, b] = [a, b].map(|face| frame.geometry.triangles[face.triangle as usize]);
    a.iter().any(|corner| b.contains(corner))
}

/// What a ray in `insides` crosses at a face, together with those of `others` that coincide with it.
fn cross(frame: &Frame, first: &Face, others: &[Hit], insides: Insides) -> Crossing {
    let before = first.layer.before(insides, first.from_front);
    let mut beyond = first.layer.beyond(insides, first.from_front);
    let (mut mesh, mut stronger) = (first.layer.mesh, None);
    let coinciding = |hit: &Hit| {
        let face = Face::at(frame, hit, first.time).filter(|face| face.triangle != first.triangle);
        let may_join = |face: &Face| face.layer.mesh != first.layer.mesh || shares_corner(frame, face, first);
        face.filter(|face| may_join(face) && face.coincides(first)).map(|face| (*hit, face.layer))
    };
    let mut rest: Vec<(Hit, &Layer)> = others.iter().filter_map(coinciding).collect();
    // Each time the first one that what the ray is in lets it meet: where several of one mesh meet at an edge, rounding
    // decides on their order.
    while let Some(at) = rest.iter().position(|(hit, layer)| layer.is_met_in(beyond, hit.from_front)) {
        let (hit, layer) = rest.remove(at);
        beyond = layer.beyond(beyond, hit.from_front);
        if layer.mesh > mesh {
            (mesh, stronger) = (layer.mesh, Some(hit));
        }
    }
    let media = (frame.layers.medium(before), frame.layers.medium(beyond));
    Crossing { before, beyond, media, stronger, contradicts: before != insides }
}

impl Scratch {
    /// Lists what a ray meets up to `t_max`, nearest first.
    fn list_hits(&mut self, frame: &Frame, ray: &Ray, leaves: u32) {
        self.crossings.clear();
        frame.accel.each_hit(ray, Ignored::one(leaves), |hit| {
            self.crossings.push(hit);
            false
        });
        self.crossings.sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.triangle.cmp(&b.triangle)));
    }
}

impl Sample<'_> {
    /// What a path that has met a layer crosses there.
    pub(super) fn crossing(&mut self, branch: &Branch, hit: &SurfaceHit) -> Option<Crossing> {
        let point = hit.point.position.as_dvec3();
        let face = Face::new(self.frame, hit.triangle, hit.from_front, point, self.time)?;
        let ray = self.ray(branch.origin, branch.direction);
        let ray = Ray { t_max: hit.t + face.reach(&ray, hit.t), ..ray };
        self.scratch.list_hits(self.frame, &ray, branch.leaves);
        Some(cross(self.frame, &face, &self.scratch.crossings, branch.insides))
    }

    /// A triangle of a mesh that overlaps others: an interface between what the strongest of them say, or nothing.
    pub(super) fn meet_layer(&mut self, branch: &mut Branch, hit: &SurfaceHit, u: [f32; 4]) -> Fate {
        let Some(crossing) = self.crossing(branch, hit) else { return Fate::Ends };
        if crossing.contradicts {
            self.scratch.counters.label_mismatches += 1;
            branch.medium = crossing.media.0;
        }
        if crossing.is_hidden() {
            branch.insides = crossing.beyond;
            branch.go_on(hit, branch.direction);
            return Fate::GoesOn;
        }
        let geometry = &self.frame.geometry;
        let hit =
            crossing.stronger.map_or(*hit, |face| geometry.surface_hit(&face, branch.direction, self.time));
        let pair = crossing.pair(self.frame, hit.from_front);
        branch.insides = crossing.before;
        let fate = match pair.matched {
            true => self.pass(branch, &hit, &pair),
            false => self.refract(branch, &hit, &pair, u),
        };
        if branch.medium == crossing.media.1 {
            branch.insides = crossing.beyond;
        }
        fate
    }

    /// The surface that a path meets next when the nearest one is none that it can meet.
    pub(super) fn nearest_among_layers(&mut self, branch: &Branch, ray: &Ray) -> Option<Hit> {
        self.scratch.counters.rays += 1;
        self.scratch.list_hits(self.frame, ray, branch.leaves);
        let hits = &self.scratch.crossings;
        let is_met = |hit: &&Hit| self.frame.is_boundary_of(branch.medium, branch.insides, hit);
        let is_by_rounding = |hit: &Hit| {
            let face = Face::at(self.frame, hit, self.time);
            face.is_some_and(|face| face.holds(ray.origin)) || self.is_met_by_rounding(ray, hit.t, hit)
        };
        let at = hits.iter().position(|hit| is_met(&hit) || !is_by_rounding(hit))?;
        let found = &hits[at];
        let slack = rounding(ray.origin, found.t);
        let beside = hits[at..].iter().take_while(|hit| hit.t <= found.t + slack).find(is_met);
        Some(*beside.unwrap_or(found))
    }

    /// What is left of light along a ray through the boundaries that were found; zero when one of them is in its way.
    pub(super) fn transmittance_among_layers(
        &self,
        mut medium: MediumId,
        insides: Insides,
        ray: &Ray,
    ) -> Lanes {
        let mut left = Lanes::ONE;
        let mut travelled = 0.0;
        let mut way = Way::new(self, ray, insides);
        while let Some(Seen { hit, pair, .. }) = way.next() {
            let is_open =
                |pair: &MediumPair| pair.matched && !self.frame.reflects_beyond(pair, hit.from_front);
            let Some(pair) = pair.filter(is_open) else { return Lanes::ZERO };
            let beyond = pair.crossed(hit.from_front).1;
            left *= self.transmittance_of(medium, ray, travelled, hit.t) * self.index_factor(medium, beyond);
            (medium, travelled) = (beyond, hit.t);
        }
        if self.ends_in_the_dark(ray, medium) {
            return Lanes::ZERO;
        }
        left * self.transmittance_of(medium, ray, travelled, ray.t_max)
    }

    /// The first thing along a ray in `insides` that is not hidden.
    pub(super) fn first_seen(&mut self, ray: &Ray, leaves: u32, insides: Insides) -> Option<Seen> {
        self.scratch.list_hits(self.frame, ray, leaves);
        Way::new(self, ray, insides).next()
    }

    /// The triangle that ends the medium of a path where it meets one; `None` where that is hidden.
    pub(super) fn visible_end(&mut self, branch: &Branch, found: &Hit) -> Option<u32> {
        let Surface::Layer(_) = self.frame.surface(found.triangle) else { return Some(found.triangle) };
        let hit = self.frame.geometry.surface_hit(found, branch.direction, self.time);
        let crossing = self.crossing(branch, &hit).filter(|crossing| !crossing.is_hidden())?;
        Some(crossing.stronger.map_or(found.triangle, |face| face.triangle))
    }

    /// True for a triangle of a mesh that a stronger one hides from a path.
    pub(super) fn is_hidden(&self, branch: &Branch, triangle: u32) -> bool {
        let Surface::Layer(layer) = self.frame.surface(triangle) else { return false };
        let medium = |insides| self.frame.layers.medium(insides);
        medium(layer.before(branch.insides, true)) == medium(layer.beyond(branch.insides, true))
    }
}

/// What a ray meets that is not hidden.
#[derive(Clone, Copy)]
pub(super) struct Seen {
    pub hit: Hit,
    /// The media that it parts, if it is a boundary.
    pub pair: Option<MediumPair>,
    /// What the ray is in beyond.
    pub beyond: Insides,
}

/// Goes along the hits that were listed.
struct Way<'s> {
    sample: &'s Sample<'s>,
    ray: &'s Ray,
    insides: Insides,
    next: usize,
    /// The face that was crossed last.
    last: Option<Face<'s>>,
}

impl<'s> Way<'s> {
    fn new(sample: &'s Sample<'s>, ray: &'s Ray, insides: Insides) -> Self {
        Self { sample, ray, insides, next: 0, last: None }
    }

    fn next(&mut self) -> Option<Seen> {
        let (frame, hits) = (self.sample.frame, &self.sample.scratch.crossings);
        while let Some(hit) = hits.get(self.next) {
            self.next += 1;
            let Some(face) = Face::at(frame, hit, self.sample.time) else {
                let pair = frame.surface(hit.triangle).pair().copied();
                return Some(Seen { hit: *hit, pair, beyond: self.insides });
            };
            if !face.layer.is_met_in(self.insides, hit.from_front) && self.is_crossed(&face, hit) {
                continue;
            }
            let near = hit.t + face.reach(self.ray, hit.t);
            let others = hits[self.next..].iter().take_while(|other| other.t <= near).count();
            let crossing = cross(frame, &face, &hits[self.next..][..others], self.insides);
            self.insides = crossing.beyond;
            self.last = Some(face);
            if !crossing.is_hidden() {
                let hit = Hit { t: hit.t, ..crossing.stronger.unwrap_or(*hit) };
                let pair = Some(crossing.pair(frame, hit.from_front));
                return Some(Seen { hit, pair, beyond: self.insides });
            }
        }
        None
    }

    /// True when a face that is met from the wrong side lies on what the ray left, or on what it has crossed last.
    fn is_crossed(&self, face: &Face, hit: &Hit) -> bool {
        face.holds(self.ray.origin)
            || self.last.as_ref().is_some_and(|last| last.coincides(face))
            || self.sample.is_met_by_rounding(self.ray, hit.t, hit)
    }
}
