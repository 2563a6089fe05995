//! Random walks in a ball through nearly grey media that scatter alike in all lanes: eight collisions at a time.
//!
//! There flights and angles depend on nothing that the path has been through. So those of the next collisions are
//! drawn together in wide registers, from the numbers that [`Sample::walk`] would take for them one after the other.
//! How far the path has come at collision k, and what is left of it, are
//!
//! ```text
//! l = sum of l_i,   w = (sigma_s / sigma_f)^k exp(-(sigma_t - sigma_f) l)     over i = 1 .. k
//! ```
//! with sigma_f, which the flights of all lanes are drawn with ([`MediumLanes::grey`]), and scattering and extinction
//! of each lane: the product of the weights sigma_s exp(-sigma_t l_i) over the densities sigma_f exp(-sigma_f l_i).
//! Russian roulette is played once for all of them, with the number of the last. Numbers have steps of 2^-24, and
//! chances are rounded to them by [`Branch::goes_on`], however little eight collisions leave.
//!
//! Where scattering is even, places are sums, too: p_k = p_0 + sum of l_i d_(i-1). Elsewhere the path takes a frame of
//! axes along, which a collision turns by the angles theta and phi,
//!
//! ```text
//! r = s cos phi + t sin phi,       d' = d cos theta + r sin theta,
//! t' = t cos phi - s sin phi,      s' = r cos theta - d sin theta
//! ```
//! and which is made anew after eight of them, so that no errors add up. None of these equations is quoted: they are
//! derived here, the latter as a turn by phi around d and one by theta around t'.

use glam::{Vec3, Vec3A};

use super::flight::Clearing;
use super::path::{Branch, Fate, Sample};
use super::roulette::LONG_WALK;
use crate::geometry::Frame;
use crate::geometry::machine::{Eight, Lanes as Wide, WithLanes, with_best};
use crate::geometry::wide::{minus_ln_of_rest, sin_cos_of_turn};
use crate::optics::medium::MediumLanes;
use crate::optics::phase::PhaseFunction;
use crate::spectrum::Lanes;

/// Collisions at a time.
const AHEAD: usize = 8;

impl Sample<'_> {
    /// False in coloured media, where phase functions differ by lane, from a walk's last collisions on, and from the roulette of long walks on.
    #[inline]
    pub(super) fn walks_ahead(&self, branch: &Branch) -> bool {
        let medium = &self.scratch.media[branch.medium.0 as usize];
        let is_alike = self.frame.medium(branch.medium).phase.one().is_some();
        medium.grey().is_some() && is_alike && branch.interactions < last_ahead(self.max_depth)
    }

    /// Goes on with a path as [`Sample::walk`] does.
    pub(super) fn walk_ahead(&mut self, branch: &mut Branch) -> Fate {
        let medium = self.scratch.media[branch.medium.0 as usize];
        let phase = self.frame.medium(branch.medium).phase.one();
        let (Some((mean_free_path, albedo)), Some(phase)) = (medium.grey(), phase) else {
            return Fate::GoesOn;
        };
        let (clearing, last) = (self.scratch.around.clearing, last_ahead(self.max_depth));
        let before = branch.interactions;
        let walk = Walk { medium, mean_free_path, albedo, clearing, last, branch };
        let fate = match phase {
            PhaseFunction::Isotropic(_) => with_best(Turning { walk, turns: Evenly }),
            phase => with_best(Turning { walk, turns: By(phase) }),
        };
        self.scratch.counters.untraced += u64::from(branch.interactions - before);
        fate
    }
}

/// The interactions from which on eight more might be too many, or meet the roulette of long walks.
#[inline]
fn last_ahead(max_depth: u32) -> u32 {
    max_depth.min(LONG_WALK).saturating_sub(AHEAD as u32)
}

struct Walk<'a> {
    medium: MediumLanes,
    mean_free_path: f32,
    /// Weight of a collision but for that of the way to it, by lane.
    albedo: Lanes,
    clearing: Clearing,
    /// As of [`last_ahead`].
    last: u32,
    branch: &'a mut Branch,
}

/// A walk whose collisions turn it in some way.
struct Turning<'a, T> {
    walk: Walk<'a>,
    turns: T,
}

/// How collisions turn a path.
trait Turns {
    /// Takes a path to the last of its next collisions in the ball, given how far it flies to each and what their
    /// angles are drawn from.
    fn go<L: Wide>(&self, branch: &mut Branch, clearing: &Clearing, flights: L, u: [L; 2]) -> Gone;
}

/// What a path has come through.
#[derive(Clone, Copy)]
struct Gone {
    collisions: usize,
    length: f32,
    /// Product of the angles' weights.
    weight: f32,
}

impl<T: Turns> WithLanes for Turning<'_, T> {
    type Output = Fate;

    #[inline(always)]
    fn run<L: Wide>(self) -> Fate {
        let Walk { medium, mean_free_path, albedo, clearing, last, branch: walked } = self.walk;
        let mut powers = [albedo; AHEAD];
        for i in 1..AHEAD {
            powers[i] = powers[i - 1] * albedo;
        }
        let mut branch = *walked;
        let mut fate = Fate::GoesOn;
        while branch.interactions < last {
            let u = branch.stream.ahead::<L>();
            let flights = minus_ln_of_rest(u[0]).mul(L::splat(mean_free_path));
            let gone = self.turns.go(&mut branch, &clearing, flights, [u[1], u[2]]);
            if gone.collisions == 0 {
                break;
            }
            let end = gone.collisions - 1;
            branch.stream.skip(gone.collisions);
            branch.throughput *= powers[end] * medium.relative_transmittance(gone.length) * gone.weight;
            branch.interactions += end as u32;
            fate = branch.goes_on(number(u[3], end));
            if fate == Fate::Ends || gone.collisions < AHEAD {
                break;
            }
        }
        *walked = branch;
        fate
    }
}

/// Into every direction alike.
#[derive(Clone, Copy)]
struct Evenly;

impl Turns for Evenly {
    #[inline(always)]
    fn go<L: Wide>(&self, branch: &mut Branch, clearing: &Clearing, flights: L, u: [L; 2]) -> Gone {
        let one_minus_cos = u[0].add(u[0]);
        let sine = one_minus_cos.mul(L::splat(2.0).sub(one_minus_cos)).sqrt();
        let (sin, cos) = sin_cos_of_turn(u[1]);
        let directions = [sine.mul(cos), sine.mul(sin), L::splat(1.0).sub(one_minus_cos)];
        let points = [
            collisions(branch.origin.x, branch.direction.x, directions[0], flights),
            collisions(branch.origin.y, branch.direction.y, directions[1], flights),
            collisions(branch.origin.z, branch.direction.z, directions[2], flights),
        ];
        let collisions = clearing.holds_first(&points);
        let Some(end) = collisions.checked_sub(1) else { return Gone::NOWHERE };
        branch.origin = vector(&points, end);
        branch.direction = vector(&directions, end);
        Gone { collisions, length: number(flights.running_sums(), end), weight: 1.0 }
    }
}

/// Coordinates of the ends of flights of which the first goes along `first`, the others along where the one before was
/// turned.
#[inline(always)]
fn collisions<L: Wide>(origin: f32, first: f32, turned: L, flights: L) -> L {
    L::splat(origin).add(turned.preceded_by(first).mul(flights).running_sums())
}

/// By the angles of a phase function.
#[derive(Clone, Copy)]
struct By<'a>(&'a PhaseFunction);

impl Turns for By<'_> {
    #[inline(always)]
    fn go<L: Wide>(&self, branch: &mut Branch, clearing: &Clearing, flights: L, u: [L; 2]) -> Gone {
        let (cos_theta, sin_theta, weights) = self.0.eight(u[0]);
        let (sin_phi, cos_phi) = sin_cos_of_turn(u[1]);
        let (cos_theta, sin_theta) = (stored(cos_theta), stored(sin_theta));
        let (cos_phi, sin_phi) = (stored(cos_phi), stored(sin_phi));
        let (flights, weights) = (stored(flights), stored(weights));
        let Frame { s, t, n } = Frame::around(branch.direction);
        let (mut s, mut t, mut direction) = (Vec3A::from(s), Vec3A::from(t), Vec3A::from(n));
        let mut origin = Vec3A::from(branch.origin);
        let mut gone = Gone::NOWHERE;
        for i in 0..AHEAD {
            let point = origin + direction * flights.0[i];
            if !clearing.holds(point.into()) {
                break;
            }
            let r = s * cos_phi.0[i] + t * sin_phi.0[i];
            t = t * cos_phi.0[i] - s * sin_phi.0[i];
            s = r * cos_theta.0[i] - direction * sin_theta.0[i];
            direction = direction * cos_theta.0[i] + r * sin_theta.0[i];
            origin = point;
            gone.collisions += 1;
            gone.length += flights.0[i];
            gone.weight *= weights.0[i];
        }
        branch.origin = origin.into();
        let direction = Vec3::from(direction);
        // A step of Newton's method for 1 / sqrt(d . d).
        branch.direction = direction * (1.5 - 0.5 * direction.length_squared());
        gone
    }
}

impl Gone {
    const NOWHERE: Self = Self { collisions: 0, length: 0.0, weight: 1.0 };
}

#[inline(always)]
fn vector<L: Wide>(of: &[L; 3], lane: usize) -> Vec3 {
    Vec3::new(number(of[0], lane), number(of[1], lane), number(of[2], lane))
}

#[inline(always)]
fn number<L: Wide>(of: L, lane: usize) -> f32 {
    stored(of).0[lane & 7]
}

#[inline(always)]
fn stored<L: Wide>(lanes: L) -> Eight {
    let mut all = Eight([0.0; 8]);
    lanes.store(&mut all);
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::portable::Portable;
    use crate::optics::density::Density;
    use crate::optics::medium::Medium;
    use crate::optics::phase::{EXAMPLES, HenyeyGreenstein, Isotropic};
    use crate::sampling::{SampleSeed, SampleStream};
    use crate::spectrum::{LaneCurve, Wavelengths};

    /// Nearly grey, of a little absorption or of so much that the albedo is 0.9.
    fn milk(absorbed: f32) -> MediumLanes {
        let medium = Medium {
            name: "milk".into(),
            n: 1.3,
            index: LaneCurve::Constant(1.3),
            sigma_a: LaneCurve::Rgb(Lanes::new(0.1, 0.02, 0.002, 0.0) + absorbed),
            sigma_s: LaneCurve::Constant(120.0),
            emission: LaneCurve::Constant(0.0),
            phase: PhaseFunction::Isotropic(Isotropic).into(),
            density: Density::Homogeneous,
        };
        medium.lanes(&Wavelengths::RGB)
    }

    const ABSORBED: [f32; 2] = [0.0, 13.3];

    fn walk<T>(medium: MediumLanes, clearing: Clearing, turns: T, branch: &mut Branch) -> Turning<'_, T> {
        let (mean_free_path, albedo) = medium.grey().unwrap();
        let walk = Walk { medium, mean_free_path, albedo, clearing, last: 1000, branch };
        Turning { walk, turns }
    }

    fn start(i: u32) -> Branch {
        Branch::new(Vec3::ZERO, Vec3::X, SampleStream::new(SampleSeed::new(3), i, 0, 0))
    }

    /// A walk of any machine, which has the same bits as this one's.
    fn ahead<T: Turns + Copy>(
        medium: MediumLanes,
        clearing: Clearing,
        turns: T,
        start: &Branch,
    ) -> (Fate, Branch) {
        let (mut best, mut portable) = (*start, *start);
        let fate = with_best(walk(medium, clearing, turns, &mut best));
        let same = walk(medium, clearing, turns, &mut portable).run::<Portable>();
        assert_eq!((fate, format!("{best:?}")), (same, format!("{portable:?}")));
        (fate, best)
    }

    /// The same drawn one after the other, with roulette at the eighth collision or the last in the ball.
    fn one_by_one(
        medium: &MediumLanes,
        clearing: &Clearing,
        phase: &PhaseFunction,
        branch: &mut Branch,
    ) -> Fate {
        let mut fate = Fate::GoesOn;
        while branch.interactions < 1000 && fate == Fate::GoesOn {
            let (mut collisions, mut for_roulette) = (0, 0.0);
            while collisions < 8 {
                let mut stream = branch.stream;
                let u = stream.next4();
                let flight = medium.free_flight(branch.throughput, u[0]);
                let point = branch.origin + branch.direction * flight.distance;
                if !clearing.holds(point) {
                    break;
                }
                let (direction, weight) = phase.turn(branch.direction, [u[1], u[2]]);
                (branch.stream, branch.origin, branch.direction) = (stream, point, direction.normalize());
                branch.throughput *= medium.scatter_weight(&flight) * weight;
                (collisions, for_roulette) = (collisions + 1, u[3]);
            }
            if collisions == 0 {
                break;
            }
            branch.interactions += collisions - 1;
            fate = branch.goes_on(for_roulette);
            if collisions < 8 {
                break;
            }
        }
        fate
    }

    /// Of any two throughputs, relative to them.
    fn difference(a: &Branch, b: &Branch) -> f32 {
        (a.throughput / b.throughput - 1.0).truncate().abs().max_element()
    }

    /// Differences of places, relative to the ball's radius, and of throughputs are measured, at most 4e-7 and 1.5e-6;
    /// twice as much is allowed. Directions are brought to unit length one after the other, by four roundings.
    #[test]
    fn even_collisions_are_those_that_are_drawn_one_after_the_other() {
        let phase = PhaseFunction::Isotropic(Isotropic);
        let mut most = [0.0_f32; 3];
        let mut ended = 0;
        for (i, absorbed) in (0..200).flat_map(|i| ABSORBED.map(|absorbed| (i, absorbed))) {
            let radius = 0.02 * (1 + i % 5) as f32;
            let (medium, clearing) = (milk(absorbed), Clearing::of_radius(radius));
            let (fate, ahead) = ahead(medium, clearing, Evenly, &start(i));
            let mut one = start(i);
            assert_eq!(fate, one_by_one(&medium, &clearing, &phase, &mut one), "{i}");
            assert_eq!(ahead.interactions, one.interactions, "{i}");
            most[0] = most[0].max(ahead.origin.distance(one.origin) / radius);
            most[1] = most[1].max(ahead.direction.distance(one.direction));
            most[2] = most[2].max(difference(&ahead, &one));
            ended += u32::from(fate == Fate::Ends);
        }
        let roundings = 4.0 * 0.5 * f32::EPSILON;
        assert!(most[0] < 8e-7 && most[1] <= roundings && most[2] < 3e-6, "{most:?}");
        assert!(ended > 20, "{ended}");
    }

    /// A thousand collisions, each with the roundings of its weight: 2.3e-5 is measured, and twice as much allowed.
    #[test]
    fn other_collisions_weigh_what_those_weigh_that_are_drawn_one_after_the_other() {
        let (mut most, mut ended, mut weighted) = (0.0_f32, 0, 0);
        // Nothing but the number of collisions ends a walk here: directions are turned around other axes in either.
        let clearing = Clearing::of_radius(1e6);
        for ((i, (name, phase)), absorbed) in
            (0..).zip(EXAMPLES.iter()).flat_map(|example| ABSORBED.map(|absorbed| (example, absorbed)))
        {
            let medium = milk(absorbed);
            for k in 0..8 {
                let start = start(100 * i + k);
                let (fate, ahead) = ahead(medium, clearing, By(phase), &start);
                let mut one = start;
                assert_eq!(fate, one_by_one(&medium, &clearing, phase, &mut one), "{name}");
                assert_eq!(ahead.interactions, one.interactions, "{name}");
                most = most.max(difference(&ahead, &one));
                ended += u32::from(fate == Fate::Ends);
                weighted += u32::from(absorbed == 0.0 && !phase.is_sampled_exactly());
            }
        }
        assert!(most < 5e-5, "{most}");
        assert!(ended > 20 && weighted > 20);
    }

    #[test]
    fn other_collisions_have_the_same_bits_on_all_machines() {
        let mut collisions = 0;
        for (i, (_, phase)) in (0..).zip(EXAMPLES.iter()) {
            for (k, absorbed) in (0..20).flat_map(|k| ABSORBED.map(|absorbed| (k, absorbed))) {
                let clearing = Clearing::of_radius(0.02 * (1 + k % 5) as f32);
                collisions += ahead(milk(absorbed), clearing, By(phase), &start(100 * i + k)).1.interactions;
            }
        }
        assert!(collisions > 1000, "{collisions}");
    }

    #[test]
    fn no_walk_has_more_collisions_than_it_may_have() {
        for max_depth in (0..40).chain([LONG_WALK - 1, LONG_WALK, LONG_WALK + 1, u32::MAX]) {
            let last = last_ahead(max_depth);
            // Eight more than have been before the last.
            assert!(last == 0 || last - 1 + 8 < max_depth.min(LONG_WALK), "{max_depth}");
            assert!(last + 8 >= max_depth.min(LONG_WALK), "{max_depth}");
            let (medium, mut branch) = (milk(0.0), start(max_depth));
            let mut turning = walk(medium, Clearing::of_radius(1e6), Evenly, &mut branch);
            turning.walk.last = last;
            with_best(turning);
            assert!(
                branch.interactions >= last && branch.interactions <= max_depth.saturating_sub(1),
                "{max_depth}"
            );
        }
    }

    /// The path that has turned k times, k = 0 .. 8, shows the angles between its directions, and those between the
    /// planes of two turns: d_(k+1) . (d_k cos theta_k - d_(k-1)) = sin theta_k sin theta_(k+1) cos phi_(k+1).
    ///
    /// Up to four roundings of 2^-24 are measured of each of these, of lengths, too; twice as many are allowed.
    #[test]
    fn other_collisions_turn_the_path_by_the_angles_that_are_drawn() {
        const OFF: f32 = 8.0 * 0.5 * f32::EPSILON;
        for (g, seed) in [0.0, 0.86, -0.5].into_iter().flat_map(|g| (0..50).map(move |seed| (g, seed))) {
            let phase = PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g });
            let stream = SampleStream::new(SampleSeed::new(4), seed, 0, 0);
            let [_, u, v, _] = stream.ahead::<Portable>();
            let forward = phase.turn(Vec3::Z, [stored(v).0[0], stored(u).0[0]]).0.normalize();
            let directions: Vec<Vec3> = (0..=AHEAD)
                .map(|turns| {
                    let flights = Eight(std::array::from_fn(|i| if i < turns { 0.1 } else { 10.0 }));
                    let mut branch = Branch::new(Vec3::ZERO, forward, stream);
                    let clearing = Clearing::of_radius(1.0);
                    let gone = By(&phase).go(&mut branch, &clearing, Portable::load(&flights), [u, v]);
                    assert_eq!(gone.collisions, turns);
                    assert!((gone.length - 0.1 * turns as f32).abs() <= OFF);
                    branch.direction
                })
                .collect();
            let (cos, sin, _) = phase.eight(u);
            let (cos, sin, cos_phi) = (stored(cos).0, stored(sin).0, stored(sin_cos_of_turn(v).1).0);
            for k in 0..AHEAD {
                let d = |turns: usize| directions[turns];
                assert!((d(k).dot(d(k + 1)) - cos[k]).abs() <= OFF, "{g}: turn {k}");
                assert!((d(k + 1).length() - 1.0).abs() <= OFF);
                if k > 0 {
                    let across = d(k + 1).dot(d(k) * cos[k - 1] - d(k - 1));
                    assert!((across - sin[k - 1] * sin[k] * cos_phi[k]).abs() <= OFF, "{g}: plane {k}");
                }
            }
        }
    }
}
