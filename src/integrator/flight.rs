//! The flight of a path from one event to the next: to a particle of its medium, or to a surface.
//!
//! In media that only absorb the transmittance is exact; in media that scatter the free flight is drawn in one lane and
//! weighted over all (one-sample spectral multiple importance sampling). Where the density changes from place to place,
//! its integral along the ray stands in for the distance. What a medium adds between one event and the next surface, by
//! emission or out of an ambient radiance, is added as its expectation, exactly.

use glam::{DVec3, Vec3};

use super::path::{Branch, Sample};
use crate::accel::{Accel, Hit, Ignored};
use crate::geometry::Ray;
use crate::geometry::machine::Lanes as Wide;
use crate::optics::dwivedi::LedFlight;
use crate::optics::medium::{MediumId, MediumLanes};
use crate::scene::surface::Surface;
use crate::spectrum::Lanes;

/// Sheets within a rounding error of each other that a path looks through for the one it has jumped over.
const MOST_SHEETS: u32 = 4;

/// A ball without surfaces around a path in a medium that scatters: while the path stays in it nothing has to be
/// traced.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clearing {
    centre: Vec3,
    /// Negative without a ball.
    radius: f32,
    /// Collisions since the last surface or ball, and how many there must be before the next is looked for.
    collisions: u32,
    patience: u32,
    /// The greatest radius so far over the width of all there is, 1 at least.
    widths: f32,
}

impl Clearing {
    pub(super) const NONE: Self =
        Self { centre: Vec3::ZERO, radius: -1.0, collisions: 0, patience: Self::FIRST_PATIENCE, widths: 1.0 };
    /// Paths that collide a few times only are not worth the search.
    const FIRST_PATIENCE: u32 = 4;
    /// A ball of fewer mean free paths is soon left: the next is looked for later.
    const WORTH_A_SEARCH: f32 = 4.0;

    #[cfg(test)]
    pub(super) fn of_radius(radius: f32) -> Self {
        Self { radius, ..Self::NONE }
    }

    /// False without a ball.
    #[inline]
    pub(super) fn holds(&self, point: Vec3) -> bool {
        self.radius > 0.0 && point.distance_squared(self.centre) < self.radius * self.radius
    }

    /// How many of eight points, by axis, lie in the ball before the first that does not. There must be a ball.
    #[inline(always)]
    pub(super) fn holds_first<L: Wide>(&self, points: &[L; 3]) -> usize {
        debug_assert!(self.is_there());
        let x = points[0].sub(L::splat(self.centre.x));
        let y = points[1].sub(L::splat(self.centre.y));
        let z = points[2].sub(L::splat(self.centre.z));
        let squares = x.mul(x).add(y.mul(y)).add(z.mul(z));
        let within = squares.at_most(L::splat(self.radius * self.radius));
        within.trailing_ones() as usize
    }

    #[inline]
    pub(super) fn is_there(&self) -> bool {
        self.radius > 0.0
    }

    /// The path has collided at a point outside of the ball. Tells the probability with which it should go on: less
    /// than 1 where it is farther than before from all there is, measured by how wide that is, in a medium without end.
    #[inline]
    fn traced_to(&mut self, point: Vec3, sigma_t: f32, accel: &Accel, time: f32) -> f32 {
        self.radius = -1.0;
        self.collisions += 1;
        if self.collisions < self.patience {
            return 1.0;
        }
        self.centre = point;
        self.radius = accel.clearance(point, time) - rounding(point, 0.0);
        self.collisions = 0;
        let is_large = self.radius * sigma_t >= Self::WORTH_A_SEARCH;
        // Who has left a large ball is deep in the medium still.
        self.patience = if is_large { 1 } else { 2 * self.patience };
        if cfg!(floe_without_guards) {
            return 1.0;
        }
        let widths =
            if accel.is_empty() { f32::INFINITY } else { self.radius / accel.bounds().size().length() };
        if widths > self.widths { std::mem::replace(&mut self.widths, widths) / widths } else { 1.0 }
    }
}

/// What the path that is followed knows of the medium around it; forgotten where another branch is taken up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Around {
    pub(super) clearing: Clearing,
    /// Out of the medium at the interface of it that the path has met last; zero before any.
    pub(super) outward: Vec3,
    /// The flight that the last particle has drawn.
    pub(super) flight: LedFlight,
}

impl Around {
    pub(super) const NOTHING: Self =
        Self { clearing: Clearing::NONE, outward: Vec3::ZERO, flight: LedFlight::NONE };
}

impl Default for Around {
    fn default() -> Self {
        Self::NOTHING
    }
}

/// What a flight ends at. The path's throughput is already that of getting there.
pub(super) enum Event {
    /// A surface.
    Surface(Hit),
    /// A particle of the medium, at this distance.
    Particle(f32),
    /// The path meets nothing any more.
    Nothing,
}

impl Sample<'_> {
    /// Draws the next event of a path with the random number `u`.
    ///
    /// `VARIED` is for media of varying density and for those that add light.
    pub(super) fn fly<const SCATTERING: bool, const VARIED: bool>(
        &mut self,
        branch: &mut Branch,
        u: f32,
    ) -> Event {
        let medium = self.scratch.media[branch.medium.0 as usize];
        let turns = SCATTERING && self.turns(branch);
        let flight = turns.then(|| medium.free_flight(branch.throughput, u));
        let endless = self.ray(branch.origin, branch.direction);
        let to_particle = flight.map_or(f32::INFINITY, |f| match VARIED {
            true => self.frame.medium(branch.medium).density.distance(&endless, f.distance),
            false => f.distance,
        });
        if SCATTERING
            && !VARIED
            && let Some(flight) = &flight
            && self.scratch.around.clearing.holds(endless.at(to_particle))
        {
            self.scratch.counters.untraced += 1;
            branch.throughput *= medium.scatter_weight(flight);
            return Event::Particle(to_particle);
        }
        let t_max = to_particle + rounding(branch.origin, to_particle);
        let strays = if SCATTERING { self.strays_in(branch) } else { None };
        let asks_whole = strays.is_some() && branch.arrival.specular_from_eye;
        let reach = if asks_whole { f32::INFINITY } else { t_max };
        let found = self.nearest_on_way::<VARIED>(branch, &medium, reach);
        if let Some(strays) = strays {
            let to_surface = found.map_or(f32::INFINITY, |hit| hit.t);
            match &flight {
                Some(flight) if !asks_whole => {
                    let up_to = (to_surface.min(to_particle), found);
                    self.add_strays(strays, branch, up_to, |length| medium.pass_weight(flight, length));
                }
                _ => {
                    let up_to = (to_surface, found);
                    self.add_strays(strays, branch, up_to, |length| medium.transmittance(length));
                }
            }
        }
        let found = found.filter(|hit| hit.t <= t_max);
        if found.is_none()
            && let Some(flight) = &flight
            && to_particle.is_finite()
        {
            let point = endless.at(to_particle);
            if !VARIED {
                self.collided_at(branch, point, &medium);
            }
            branch.throughput *= medium.scatter_weight(flight);
            return Event::Particle(to_particle);
        }
        let length = self.length::<VARIED>(branch, found.map_or(f32::INFINITY, |hit| hit.t));
        branch.throughput *= match &flight {
            Some(flight) => medium.pass_weight(flight, length),
            None => medium.transmittance(length),
        };
        let Some(hit) = found else { return Event::Nothing };
        if SCATTERING {
            self.scratch.around.clearing = Clearing::NONE;
        }
        Event::Surface(hit)
    }

    /// Where the particle is that a path has flown to: in its medium, no nearer than rounding to the plane that it left.
    ///
    /// A flight shorter than that, or along the surface, may end on the plane or beyond; whoever turns outwards from there
    /// would meet nothing and walk on through a medium that is not there.
    #[inline]
    pub(super) fn particle(&self, branch: &Branch, distance: f32) -> Vec3 {
        let point = branch.origin + branch.direction * distance;
        if branch.leaves == u32::MAX {
            return point;
        }
        let normal = self.frame.geometry.normal(branch.leaves, self.time);
        let cos = normal.dot(branch.direction);
        let missing = rounding(branch.origin, distance) - cos.abs() * distance;
        if missing > 0.0 { point + normal * missing.copysign(cos) } else { point }
    }

    /// The path has collided at a point that it was traced to: looks for a ball around it, and lets those go on that are
    /// not too far from all there is. One that is farther than its medium reaches has slipped out at an edge, and is counted.
    #[inline]
    pub(super) fn collided_at(&mut self, branch: &mut Branch, point: Vec3, medium: &MediumLanes) {
        let clearing = &mut self.scratch.around.clearing;
        let was_near = clearing.widths == 1.0;
        let survival = clearing.traced_to(point, medium.sigma_t.max_element(), &self.frame.accel, self.time);
        if clearing.is_there() && self.strays.is_some() {
            let radius = self.clear_of_strays(point, self.scratch.around.clearing.radius);
            self.scratch.around.clearing.radius = if radius > 0.0 { radius } else { -1.0 };
        }
        if survival < 1.0 && was_near && self.ends_somewhere(branch.medium) {
            self.scratch.counters.escaped_inside += 1;
        }
        branch.wander_off(survival);
    }

    /// True of media whose paths cannot come farther from all there is than that is wide.
    pub(super) fn ends_somewhere(&self, medium: MediumId) -> bool {
        !cfg!(floe_without_guards) && medium != MediumId(0) && !self.frame.endless[medium.0 as usize]
    }

    /// True when a particle of its medium may turn the path.
    #[inline]
    pub(super) fn turns(&self, branch: &Branch) -> bool {
        branch.scatterings_left > 0
            && self.scratch.media[branch.medium.0 as usize].scatters
            && self.photons.is_none_or(|pass| {
                pass.walks || (branch.lookups_left > 0 && pass.peaked[branch.medium.0 as usize])
            })
    }

    /// The next surface if it is nearer than `t_max`; what the medium adds on the way to it is added.
    #[inline]
    pub(super) fn nearest_on_way<const VARIED: bool>(
        &mut self,
        branch: &Branch,
        medium: &MediumLanes,
        t_max: f32,
    ) -> Option<Hit> {
        if VARIED {
            return self.nearest_and_glow(branch, medium, t_max);
        }
        self.nearest(branch, &Ray { t_max, ..self.ray(branch.origin, branch.direction) })
    }

    /// The next surface if it is nearer than `t_max`, and what the medium adds on the way to it, however far it is.
    fn nearest_and_glow(&mut self, branch: &Branch, medium: &MediumLanes, t_max: f32) -> Option<Hit> {
        let source = self.scratch.sources.get(branch.medium.0 as usize).copied().unwrap_or(Lanes::ZERO);
        let glows = source != Lanes::ZERO;
        let photons = self.photons.filter(|_| medium.scatters && branch.lookups_left > 0);
        let reach = if glows || photons.is_some() { f32::INFINITY } else { t_max };
        let ray = Ray { t_max: reach, ..self.ray(branch.origin, branch.direction) };
        let found = self.nearest(branch, &ray);
        if glows {
            let length = self.length::<true>(branch, found.map_or(f32::INFINITY, |hit| hit.t));
            self.radiance += branch.throughput * source * medium.opacity(length);
        }
        if let Some(pass) = photons {
            let way = Ray { t_max: found.map_or(f32::INFINITY, |hit| hit.t), ..ray };
            let end = found.and_then(|hit| self.visible_end(branch, &hit));
            self.radiance += branch.throughput * self.scattered_in(pass, branch, &way, end);
        }
        found.filter(|hit| hit.t <= t_max)
    }

    /// Metres of density 1 along the path's ray up to a distance.
    #[inline]
    pub(super) fn length<const VARIED: bool>(&self, branch: &Branch, distance: f32) -> f32 {
        if !VARIED {
            return distance;
        }
        let ray = Ray { t_max: distance, ..self.ray(branch.origin, branch.direction) };
        self.frame.medium(branch.medium).density.length(&ray)
    }

    /// The surface that the path meets next.
    ///
    /// A ray that leaves an interface starts at the very point, so that it cannot jump over a sheet in the wedge where
    /// several meet. Rounding may put the point on the wrong side of a neighbour, or the ray on the wrong side of an
    /// edge, and at the edges of wedges it decides which sheet seems nearest; the labels tell which is meant. One that
    /// does not belong to the path's medium is looked through where rounding alone may have made it be met, and gives
    /// way elsewhere to one that does belong and is as far away.
    pub(super) fn nearest(&mut self, branch: &Branch, ray: &Ray) -> Option<Hit> {
        self.scratch.counters.rays += 1;
        let (mut from, mut passed) = (*ray, 0.0);
        let mut ignored = Ignored::one(branch.leaves);
        let mut found = self.frame.accel.closest(&from, ignored);
        for _ in 0..MOST_SHEETS {
            let is_met = |hit: &Hit| self.frame.is_boundary_of(branch.medium, branch.insides, hit);
            let Some(hit) = found.filter(|hit| !is_met(hit)) else { break };
            if let Surface::Layer(_) = self.frame.surface(hit.triangle) {
                return self.nearest_among_layers(branch, ray);
            }
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

    /// True when a ray begins on the plane of the triangle that it meets at `t`, or meets it at an edge, but for
    /// rounding.
    pub(super) fn is_met_by_rounding(&self, ray: &Ray, t: f32, hit: &Hit) -> bool {
        let slack = 4.0 * rounding(ray.origin, t);
        // In double precision: the squares of areas leave the range of single precision among lengths that are valid.
        let v = self.frame.geometry.vertices_at(hit.triangle, self.time).map(|p| p.as_dvec3());
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
        self.frame.is_boundary_of(branch.medium, branch.insides, &other).then_some(other)
    }
}

/// How far a point at `distance` from `origin` may be off; where a surface is that near, the path meets it.
///
/// Without this slack a particle next to a surface comes to lie beyond it, and its path goes on in the wrong medium.
pub(super) fn rounding(origin: Vec3, distance: f32) -> f32 {
    8.0 * f32::EPSILON * (origin.abs().max_element() + distance)
}
