//! How far triangles are from a point, eight at a time.
//!
//! Over a triangle that is the height over its plane, elsewhere the distance to the nearest edge; so it holds for
//! triangles without area, too. With the corners a, b and c seen from the point, e = b - a and n = e x (c - a),
//!
//! ```text
//! over it:   n . (a x e) > 0, and so for the other edges      height^2 = (n . a)^2 / n^2
//! to edges:  |a + s e|^2,   s = -a . e / e^2, within [0, 1]
//! ```
//!
//! In single precision a sliver's normal has lost its digits, and products of six lengths leave the range of numbers
//! among kilometres and micrometres. Such triangles are looked at again, one by one, in double precision.

use glam::DVec3;

use super::machine::{Eight, Lanes};

/// Squares of doubled areas, relative to the fourth power of an edge, above which a normal has its digits in single
/// precision: those of slivers of more than ten times their width are less.
const ROUND: f32 = 1e-2;
/// Squares of doubled areas, in m^4, between which no product of four lengths leaves the range of single precision.
const LEAST_AREA: f32 = 1e-20;
const GREATEST_AREA: f32 = 1e24;

type Vector<L> = [L; 3];

/// Squares of the distances from the origin to triangles of these corners.
#[inline(always)]
pub(crate) fn squared_distances<L: Lanes>([a, b, c]: [Vector<L>; 3]) -> L {
    let (ab, bc, ca) = (difference(b, a), difference(c, b), difference(a, c));
    let n = cross(ca, ab);
    let within = dot(n, cross(a, ab)).min(dot(n, cross(b, bc))).min(dot(n, cross(c, ca)));
    let (height, area) = (dot(n, a), dot(n, n));
    let to_edges = to_segment(a, ab).min(to_segment(b, bc)).min(to_segment(c, ca));
    // No edge is nearer than the plane, however both are rounded.
    let squared_height = height.div(area).mul(height).min(to_edges);
    let zero = L::splat(0.0);
    // What is no number becomes 0: not over the triangle.
    let squares = zero.sub(within.max(zero)).negative(squared_height, to_edges);
    let longest = dot(ab, ab).max(dot(ca, ca));
    let plain = L::splat(ROUND).mul(longest).mul(longest).at_most(area)
        & L::splat(LEAST_AREA).at_most(area)
        & area.at_most(L::splat(GREATEST_AREA));
    if plain == ALL || cfg!(floe_without_guards) {
        squares
    } else {
        with_exact(squares, !plain & ALL, [a, b, c])
    }
}

/// One bit a lane.
const ALL: u32 = 0xff;

/// The squares with those of some lanes in double precision.
#[cold]
#[inline(never)]
fn with_exact<L: Lanes>(squares: L, odd: u32, corners: [Vector<L>; 3]) -> L {
    let stored = |lanes: L| {
        let mut all = Eight([0.0; 8]);
        lanes.store(&mut all);
        all
    };
    let mut squares = stored(squares);
    let corners = corners.map(|corner| corner.map(stored));
    for lane in (0..8).filter(|lane| odd >> lane & 1 == 1) {
        let seen =
            corners.each_ref().map(|c| DVec3::from_array(c.each_ref().map(|axis| f64::from(axis.0[lane]))));
        squares.0[lane] = exact_squared_distance(seen);
    }
    L::load(&squares)
}

/// Square of the distance from the origin to a triangle.
fn exact_squared_distance(from: [DVec3; 3]) -> f32 {
    let edges = [from[1] - from[0], from[2] - from[1], from[0] - from[2]];
    let n = edges[0].cross(edges[1]);
    if (0..3).all(|k| n.cross(edges[k]).dot(from[k]) < 0.0) {
        let height = n.dot(from[0]);
        return (height * height / n.length_squared()) as f32;
    }
    let to_edge = |k: usize| {
        let s = -from[k].dot(edges[k]) / edges[k].length_squared();
        // A segment without length gives no number, which clamps to its start.
        let s = if s > 0.0 { s.min(1.0) } else { 0.0 };
        (from[k] + edges[k] * s).length_squared()
    };
    (0..3).map(to_edge).fold(f64::INFINITY, f64::min) as f32
}

/// To the segment from `a` along `e`.
#[inline(always)]
fn to_segment<L: Lanes>(a: Vector<L>, e: Vector<L>) -> L {
    // A segment without length has a nearest point, too.
    let squared_length = dot(e, e).max(L::splat(f32::MIN_POSITIVE));
    let zero = L::splat(0.0);
    let s = zero.sub(dot(a, e)).div(squared_length).max(zero).min(L::splat(1.0));
    let nearest = [a[0].add(e[0].mul(s)), a[1].add(e[1].mul(s)), a[2].add(e[2].mul(s))];
    dot(nearest, nearest)
}

#[inline(always)]
fn difference<L: Lanes>(a: Vector<L>, b: Vector<L>) -> Vector<L> {
    [a[0].sub(b[0]), a[1].sub(b[1]), a[2].sub(b[2])]
}

#[inline(always)]
fn dot<L: Lanes>(a: Vector<L>, b: Vector<L>) -> L {
    a[0].mul(b[0]).add(a[1].mul(b[1])).add(a[2].mul(b[2]))
}

#[inline(always)]
fn cross<L: Lanes>(a: Vector<L>, b: Vector<L>) -> Vector<L> {
    [
        a[1].mul(b[2]).sub(a[2].mul(b[1])),
        a[2].mul(b[0]).sub(a[0].mul(b[2])),
        a[0].mul(b[1]).sub(a[1].mul(b[0])),
    ]
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use proptest::prelude::*;

    use super::*;
    use crate::geometry::machine::{Eight, WithLanes, with_best};
    use crate::geometry::portable::Portable;

    /// Of a triangle's corners as they are seen from a point.
    struct Squared([Vec3; 3]);

    impl WithLanes for Squared {
        type Output = f32;

        #[inline(always)]
        fn run<L: Lanes>(self) -> f32 {
            let mut all = Eight([0.0; 8]);
            squared_distances(self.0.map(|corner| corner.to_array().map(L::splat))).store(&mut all);
            all.0[5]
        }
    }

    fn squared_distance(p: Vec3, corners: [Vec3; 3]) -> f32 {
        let seen = || Squared(corners.map(|corner| corner - p));
        let squared = with_best(seen());
        assert_eq!(squared.to_bits(), seen().run::<Portable>().to_bits(), "{p} {corners:?}");
        squared
    }

    /// What so many roundings to 2^-24 of the farthest corner's distance may amount to.
    fn roundings(count: f32, p: Vec3, corners: [Vec3; 3]) -> f32 {
        count * 0.5 * f32::EPSILON * corners.map(|corner| corner.distance(p)).into_iter().fold(0.0, f32::max)
    }

    /// Roundings of a distance at most. With the farthest corner at S, the normal's components have four roundings of
    /// |e|^2 each, which are 70 of |n| where that is 0.1 |e|^2, as it is in single precision; a height is n . a / |n|,
    /// off by as many of S and by three of the sum. A point is taken to be over a triangle, or not to be, if it is no
    /// farther from that. Nearest points of edges are off by three roundings a component, and along the edge by 13, and
    /// corners by one a component from the start.
    const ROUNDINGS: f32 = 100.0;

    fn vector() -> impl Strategy<Value = Vec3> {
        (-1.0_f32..1.0, -1.0_f32..1.0, -1.0_f32..1.0).prop_map(|(x, y, z)| Vec3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn the_distance_is_that_of_the_nearest_point(a in vector(), b in vector(), c in vector(), p in vector()) {
            let p = p * 2.0;
            let distance = squared_distance(p, [a, b, c]).sqrt();
            let points = (0..=64).flat_map(|i| (0..=64 - i).map(move |j| (i as f32 / 64.0, j as f32 / 64.0)));
            let sampled = points
                .map(|(s, t)| (a * s + b * t + c * (1.0 - s - t)).distance(p))
                .fold(f32::INFINITY, f32::min);
            // The nearest point is within the spacing of the samples.
            let spacing = (a - b).length().max((b - c).length()).max((c - a).length()) / 64.0;
            let off = roundings(ROUNDINGS, p, [a, b, c]);
            prop_assert!(distance <= sampled + off, "{distance} {sampled}");
            prop_assert!(distance >= sampled - spacing - off, "{distance} {sampled}");
        }

        /// In single precision among metres, in double among micrometres and thousands of kilometres. The scale is a
        /// power of two, which rounds nothing.
        #[test]
        fn the_distance_grows_with_the_scene(a in vector(), b in vector(), c in vector(), p in vector(), e in -30_i32..40) {
            let scale = 2.0_f32.powi(e);
            let here = squared_distance(p, [a, b, c]).sqrt();
            let there = squared_distance(p * scale, [a * scale, b * scale, c * scale]).sqrt() / scale;
            prop_assert!((there - here).abs() <= roundings(ROUNDINGS, p, [a, b, c]), "{there} {here}");
        }

        /// A sliver a micrometre wide is as far away as its plane.
        #[test]
        fn the_distance_over_slivers_is_the_height(x in 0.01_f32..0.99, width in 1e-7_f32..1e-3, height in 1e-4_f32..1.0) {
            let v = [Vec3::new(0.0, x, 0.0), Vec3::new(1.0, x, 0.0), Vec3::new(1.0, x + width, 0.0)];
            let over = (v[0] + v[1] + v[2]) / 3.0 + Vec3::Z * height;
            let found = squared_distance(over, v).sqrt();
            // The sum of three numbers below 1 is off by 2^-22 at most, and by so much the point may be beside the
            // sliver. The square, its root and the quotient are rounded once each.
            let beside = 2.0 * f32::EPSILON / height;
            prop_assert!((found / height - 1.0).abs() <= 2.0 * f32::EPSILON + 0.5 * beside * beside, "{found} {height}");
        }

        #[test]
        fn triangles_without_area_are_segments_and_points(a in vector(), b in vector(), p in vector()) {
            let [a64, b64, p64] = [a, b, p].map(Vec3::as_dvec3);
            let along = (p64 - a64).dot(b64 - a64) / (b64 - a64).length_squared();
            let nearest = a64 + (b64 - a64) * along.clamp(0.0, 1.0);
            for (corners, nearest) in [([a, b, b], nearest), ([a, b, a], nearest), ([a, a, a], a64)] {
                let distance = squared_distance(p, corners).sqrt();
                let off = (f64::from(distance) - p64.distance(nearest)).abs();
                // One of each component of the corners, one of the square and one of the root.
                prop_assert!(off <= f64::from(roundings(4.0, p, corners)), "{distance}");
            }
        }
    }
}
