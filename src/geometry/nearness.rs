//! How far triangles are from a point, eight at a time.
//!
//! Over a triangle that is the height over its plane, elsewhere the distance to the nearest edge; so it holds for
//! triangles without area, too. With the corners a, b and c seen from the point, e = b - a and n = e x (c - a),
//!
//! ```text
//! over it:   n . (a x e) > 0, and so for the other edges      height^2 = (n . a)^2 / n^2
//! to edges:  |a + s e|^2,   s = -a . e / e^2, within [0, 1]
//! ```

use super::machine::Lanes;

type Vector<L> = [L; 3];

/// Squares of the distances from the origin to triangles of these corners.
#[inline(always)]
pub(crate) fn squared_distances<L: Lanes>([a, b, c]: [Vector<L>; 3]) -> L {
    let (ab, bc, ca) = (difference(b, a), difference(c, b), difference(a, c));
    let n = cross(ca, ab);
    let within = dot(n, cross(a, ab)).min(dot(n, cross(b, bc))).min(dot(n, cross(c, ca)));
    let height = dot(n, a);
    let squared_height = height.mul(height).div(dot(n, n));
    let to_edges = to_segment(a, ab).min(to_segment(b, bc)).min(to_segment(c, ca));
    L::splat(0.0).sub(within).negative(squared_height, to_edges)
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
    use crate::geometry::machine::Eight;
    use crate::geometry::portable::Portable;

    fn squared_distance(p: Vec3, corners: [Vec3; 3]) -> f32 {
        let seen = corners.map(|corner| (corner - p).to_array().map(Portable::splat));
        let mut all = Eight([0.0; 8]);
        squared_distances(seen).store(&mut all);
        all.0[0]
    }

    fn vector() -> impl Strategy<Value = Vec3> {
        (-1.0_f32..1.0, -1.0_f32..1.0, -1.0_f32..1.0).prop_map(|(x, y, z)| Vec3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn the_distance_is_that_of_the_nearest_point(a in vector(), b in vector(), c in vector(), p in vector()) {
            let squared = squared_distance(p * 2.0, [a, b, c]);
            let points = (0..=64).flat_map(|i| (0..=64 - i).map(move |j| (i as f32 / 64.0, j as f32 / 64.0)));
            let sampled = points
                .map(|(s, t)| (a * s + b * t + c * (1.0 - s - t)).distance_squared(p * 2.0))
                .fold(f32::INFINITY, f32::min);
            // The nearest point is within the spacing of the samples.
            let spacing = (a - b).length().max((b - c).length()).max((c - a).length()) / 64.0;
            prop_assert!(squared.sqrt() <= sampled.sqrt() + 1e-5);
            prop_assert!(squared.sqrt() >= sampled.sqrt() - spacing - 1e-5);
        }

        #[test]
        fn triangles_without_area_are_segments_and_points(a in vector(), b in vector(), p in vector()) {
            let nearest = a + (b - a) * ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            for (corners, nearest) in [([a, b, b], nearest), ([a, b, a], nearest), ([a, a, a], a)] {
                let distance = squared_distance(p, corners).sqrt();
                prop_assert!((distance - p.distance(nearest)).abs() < 1e-5, "{distance}");
            }
        }
    }
}
