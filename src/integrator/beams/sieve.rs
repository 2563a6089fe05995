//! A first look at triangles that may light a point, eight at a time in single precision.
//!
//! Rays from the middle of the disc leave the corners with slopes e_i. All others are within a margin of what is linear
//! between these ([`super::spread`]), so that a point which is farther than this, at its depth, from the triangle in which the
//! three rays cross its plane is not lit. Of the triangles that the index gives most are dropped so.

use glam::{DVec3, Vec2, Vec3};

use super::index::WIDTH;
use super::spread::Fan;
use crate::geometry::machine::{Eight, Lanes};

/// The rays at the corners of a piece.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sieve {
    corners: [Vec3; 3],
    slopes: [Vec2; 3],
    /// How far slopes are from what is linear between these, at most.
    margin: f32,
}

/// The rounding of coordinates and differences in single precision.
const ROUNDING: f32 = 16.0 * f32::EPSILON;

impl Sieve {
    /// Of corners and normals in the frame of the sun, all of which the fan holds.
    pub(super) fn new(corners: [DVec3; 3], normals: [DVec3; 3], fan: &Fan) -> Self {
        let ends = normals.map(|normal| fan.slopes_about(normal));
        let apart = ends.iter().map(|[a, b]| 0.5 * a.distance(*b)).fold(0.0, f64::max);
        let margin = (fan.loose() + apart) as f32;
        Self {
            corners: corners.map(|p| p.as_vec3()),
            slopes: ends.map(|[a, b]| (0.5 * (a + b)).as_vec2()),
            margin: margin + ROUNDING * (1.0 + margin),
        }
    }

    /// One that drops nothing.
    pub(super) const OPEN: Self =
        Self { corners: [Vec3::ZERO; 3], slopes: [Vec2::ZERO; 3], margin: f32::INFINITY };
}

/// Eight of them, or fewer.
#[derive(Clone, Debug)]
pub(super) struct Sieves {
    /// By corner and axis.
    corners: [[Eight; 3]; 3],
    slopes: [[Eight; 2]; 3],
    margin: Eight,
    /// A third of how much slopes differ, at most.
    turn: Eight,
    /// Those that drop nothing, a bit each.
    open: u32,
}

impl Sieves {
    /// Of eight at most.
    pub(super) fn new(all: &[Sieve]) -> Self {
        let lanes =
            |of: &dyn Fn(&Sieve) -> f32| Eight(std::array::from_fn(|lane| all.get(lane).map_or(0.0, of)));
        let turn = |sieve: &Sieve| {
            let [a, b, c] = sieve.slopes;
            a.distance(b).max(b.distance(c)).max(c.distance(a)) / 3.0
        };
        let is_open = |lane: &usize| all.get(*lane).is_some_and(|sieve| sieve.margin.is_infinite());
        Self {
            corners: [0, 1, 2].map(|i| [0, 1, 2].map(|axis| lanes(&|sieve| sieve.corners[i][axis]))),
            slopes: [0, 1, 2].map(|i| [0, 1].map(|axis| lanes(&|sieve| sieve.slopes[i][axis]))),
            margin: lanes(&|sieve| sieve.margin),
            turn: lanes(&turn),
            open: (0..WIDTH).filter(is_open).fold(0, |bits, lane| bits | 1 << lane),
        }
    }

    /// Those of which some ray may come to a point, a bit each.
    #[inline(always)]
    pub(super) fn held<L: Lanes>(&self, x: Vec3) -> u32 {
        let zero = L::splat(0.0);
        let mut slack = zero;
        for axis in 0..3 {
            let corner = L::load(&self.corners[0][axis]);
            slack = slack.max(L::splat(x[axis].abs()).add(corner.max(zero.sub(corner))));
        }
        let slack = slack.mul(L::splat(ROUNDING));
        let (a, deep_a) = self.miss::<L>(0, x);
        let (b, deep_b) = self.miss::<L>(1, x);
        let (c, deep_c) = self.miss::<L>(2, x);
        let least = deep_a.min(deep_b).min(deep_c);
        let most = deep_a.max(deep_b).max(deep_c);
        let deep = most.max(zero.sub(least));
        let margin = L::load(&self.margin).mul(deep).add(most.sub(least).mul(L::load(&self.turn))).add(slack);
        let side = cross(minus(b, a), minus(c, a));
        let is_behind = !most.add(slack).at_most(zero);
        let is_near = near(a, b, side, margin) & near(b, c, side, margin) & near(c, a, side, margin);
        is_behind & is_near | self.open
    }

    /// By how much the rays at a corner miss a point, and how far behind them it is.
    #[inline(always)]
    fn miss<L: Lanes>(&self, corner: usize, x: Vec3) -> ([L; 2], L) {
        let ([s, t, z], slope) = (&self.corners[corner], &self.slopes[corner]);
        let depth = L::splat(x.z).sub(L::load(z));
        let s = L::splat(x.x).sub(L::load(s)).sub(depth.mul(L::load(&slope[0])));
        let t = L::splat(x.y).sub(L::load(t)).sub(depth.mul(L::load(&slope[1])));
        ([s, t], depth)
    }
}

/// True where the origin is on the side of the triangle, or not farther than a margin from the line.
#[inline(always)]
fn near<L: Lanes>(from: [L; 2], to: [L; 2], side: L, margin: L) -> u32 {
    let (zero, turned, along) = (L::splat(0.0), cross(from, to), minus(to, from));
    let inwards = side.negative(zero.sub(turned), turned);
    let squared = along[0].mul(along[0]).add(along[1].mul(along[1]));
    zero.at_most(inwards) | inwards.mul(inwards).at_most(margin.mul(margin).mul(squared))
}

#[inline(always)]
fn cross<L: Lanes>(p: [L; 2], q: [L; 2]) -> L {
    p[0].mul(q[1]).sub(p[1].mul(q[0]))
}

#[inline(always)]
fn minus<L: Lanes>(p: [L; 2], q: [L; 2]) -> [L; 2] {
    [p[0].sub(q[0]), p[1].sub(q[1])]
}

#[cfg(test)]
mod tests {
    use super::super::patch::{Aim, Patch, SunFrame};
    use super::*;
    use crate::geometry::machine::{WithLanes, with_best};
    use crate::geometry::portable::Portable;
    use crate::sampling::{SampleSeed, SampleStream};
    use glam::DVec2;

    struct Held<'a>(&'a Sieves, Vec3);

    impl WithLanes for Held<'_> {
        type Output = u32;

        #[inline(always)]
        fn run<L: Lanes>(self) -> u32 {
            self.0.held::<L>(self.1)
        }
    }

    /// Points on rays through random places of random triangles, from random points of the disc, are held; most others are not.
    #[test]
    fn what_a_triangle_lights_is_held() {
        let numbers = |i: u32, k: u32| SampleStream::new(SampleSeed::new(17), i, k, 0).next4();
        let (mut held, mut of_others, mut others) = (0_u32, 0_u32, 0_u32);
        let alpha = 0.0046;
        for i in 0..4000 {
            let vector = |k: u32| {
                let [x, y, z, _] = numbers(i, k);
                Vec3::new(x, y, z) * 2.0 - 1.0
            };
            let frame = SunFrame::new(vector(0).normalize());
            let eta = [0.75, 0.9, 1.2][i as usize % 3];
            let lean = [0.02, 0.1, 0.4][i as usize / 3 % 3];
            let (size, far) = ([0.1, 1.0][i as usize % 2], 3.0 * vector(1));
            let normals = [2, 3, 4].map(|k| (vector(5).normalize() + lean * vector(k)).normalize());
            let corners = [6, 7, 8].map(|k| far + size * vector(k));
            let local = normals.map(|n| frame.local(n));
            let Some(fan) = Fan::new(&local, alpha, [eta * 0.995, eta * 1.005]).filter(Fan::is_lit) else {
                continue;
            };
            let sieve = Sieve::new(corners.map(|p| frame.local(p)), local, &fan);
            // It stands in any lane.
            let lane = i as usize % WIDTH;
            let mut all = [Sieve::OPEN; WIDTH];
            all[lane] = sieve;
            let sieves = Sieves::new(&all);
            let holds = |x: Vec3| {
                let held = with_best(Held(&sieves, x));
                assert!(held == Held(&sieves, x).run::<Portable>() && held | 1 << lane == 0xff);
                held & 1 << lane != 0
            };
            let patch = Patch::new(&frame, &corners, Some(normals), 1.0);
            for k in 10..40 {
                let [a, b, turn, out] = numbers(i, k).map(f64::from);
                let [depth, blend, s, t] = numbers(i, k + 100).map(f64::from);
                let uv = DVec2::new(a * (1.0 - b), b);
                let off = libm::tan(alpha * out.sqrt());
                let (sin, cos) = (libm::sin(6.3 * turn), libm::cos(6.3 * turn));
                let to_sun = DVec3::new(off * cos, off * sin, -1.0).normalize();
                let aim = Aim { patch: &patch, x: DVec3::ZERO, to_sun, eta: eta * (0.995 + 0.01 * blend) };
                let Some(pass) = aim.pass(uv).filter(|pass| pass.bent.is_lit()) else { continue };
                let d = pass.bent.direction;
                let x = patch.at(uv) + d * (3.0 * depth / d.z);
                assert!(holds(x.as_vec3()), "{i} {uv}");
                held += 1;
                let beside = x + DVec3::new(s - 0.5, t - 0.5, 0.0) * (8.0 * f64::from(size));
                if lean < 0.2 {
                    of_others += u32::from(holds(beside.as_vec3()));
                    others += 1;
                }
            }
        }
        assert!(held > 30_000, "{held}");
        // Triangles in squares of 8 times their size.
        assert!(of_others * 4 < others, "{of_others} of {others}");
    }
}
