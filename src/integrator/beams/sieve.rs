//! A first look at a triangle that may light a point, in single precision and one cache line.
//!
//! Rays from the middle of the disc leave the corners with slopes e_i. All others are within a margin of what is linear
//! between these ([`super::spread`]), so that a point which is farther than this, at its depth, from the triangle in which the
//! three rays cross its plane is not lit. Of the triangles that the index gives most are dropped so.

use glam::{DVec3, Vec2, Vec3};

use super::spread::Fan;

/// The rays at the corners of a piece.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
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

    /// False where no ray comes to a point.
    #[inline]
    pub(super) fn holds(&self, x: Vec3) -> bool {
        let ([p, q, r], [a, b, c]) = (self.corners, self.slopes);
        let depth = Vec3::new(x.z - p.z, x.z - q.z, x.z - r.z);
        let slack = ROUNDING * (x.abs() + p.abs()).max_element();
        let (least, most) = (depth.min_element(), depth.max_element());
        let miss = |corner: Vec3, slope: Vec2, depth: f32| (x - corner).truncate() - depth * slope;
        let [a_miss, b_miss, c_miss] = [miss(p, a, depth.x), miss(q, b, depth.y), miss(r, c, depth.z)];
        let turn = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a)).sqrt();
        let margin = self.margin * most.max(-least) + (most - least) * turn / 3.0 + slack;
        let side = (b_miss - a_miss).perp_dot(c_miss - a_miss);
        let beyond = |from: Vec2, to: Vec2| {
            let away = if side < 0.0 { to.perp_dot(from) } else { from.perp_dot(to) };
            away < 0.0 && away * away > margin * margin * from.distance_squared(to)
        };
        let is_outside = beyond(a_miss, b_miss) | beyond(b_miss, c_miss) | beyond(c_miss, a_miss);
        most + slack > 0.0 && !is_outside || self.margin.is_infinite()
    }
}

#[cfg(test)]
mod tests {
    use super::super::patch::{Aim, Patch, SunFrame};
    use super::*;
    use crate::sampling::{SampleSeed, SampleStream};
    use glam::DVec2;

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
                assert!(sieve.holds(x.as_vec3()), "{i} {uv}");
                held += 1;
                let beside = x + DVec3::new(s - 0.5, t - 0.5, 0.0) * (8.0 * f64::from(size));
                if lean < 0.2 {
                    of_others += u32::from(sieve.holds(beside.as_vec3()));
                    others += 1;
                }
            }
        }
        assert!(held > 30_000, "{held}");
        // Triangles in squares of 8 times their size.
        assert!(of_others * 4 < others, "{of_others} of {others}");
    }
}
