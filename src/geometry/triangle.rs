//! Where a ray meets a triangle, without gaps between neighbours.
//!
//! The vertices are moved into a space in which the ray starts at the origin and runs along +z; the signs of the
//! three edge functions then decide. Two triangles that share an edge evaluate the same function there, so no ray
//! slips between them. An edge function that comes out as zero is evaluated again in double precision, where the
//! products of single-precision numbers are exact `[WOOP13 section 3]`.
//!
//! ```text
//! U = Cx By - Cy Bx,  V = Ax Cy - Ay Cx,  W = Bx Ay - By Ax,   t = (U Az + V Bz + W Cz) / (U + V + W)
//! ```
//!
//! Rounding never turns the sign of an edge function, it can only make it zero: of two products, the greater is
//! never rounded below the lesser. A test of many triangles at once may therefore drop those whose edge functions
//! differ in sign, and leave the others to [`RayCast::settle`], which alone decides.
//!
//! The numerator of t is a product of three lengths. Where it leaves the range of single precision, which it does among
//! lengths from about 1e12 m and to about 1e-10 m, it is taken in double precision; coordinates from 1e-15 m to 1e18 m
//! are valid.

use std::ops::RangeInclusive;

use glam::{BVec3A, DVec3, Vec3, Vec3A, Vec3Swizzles};

use super::{Bounds, Ray};

/// What of a ray the triangle test needs, computed once. Vectors are turned.
#[derive(Clone, Copy, Debug)]
pub struct RayCast {
    /// What makes z the axis along which the direction is greatest.
    pub turn: Turn,
    /// Where the ray starts.
    pub origin: Vec3A,
    /// The x and y components of the direction over the greatest, and one over the greatest.
    pub shear: Vec3A,
    /// Distances to the planes of boxes around others; not turned.
    pub outer: Slabs,
    /// Distances to the planes of triangles' boxes.
    slabs: Slabs,
}

/// A cyclic exchange of the axes: which one becomes z.
#[derive(Clone, Copy, Debug)]
pub struct Turn(usize);

/// The slab test of a ray: a plane at `p` along an axis is at the distance `(p - origin) inverse`.
#[derive(Clone, Copy, Debug)]
pub struct Slabs {
    /// One over the direction; components of zero become huge instead of infinite.
    pub inverse_direction: Vec3A,
    /// Where the direction is negative, so that the greater plane of a box is entered first.
    pub negative: BVec3A,
    origin: Vec3A,
    /// What the origin is moved by, away from the planes that are entered.
    away: Vec3A,
}

/// What the edge functions say of a ray and a triangle.
#[derive(Clone, Copy, Debug)]
pub struct EdgeHit {
    /// U, V and W: none has another sign than the others.
    pub edges: Vec3A,
    /// U Az + V Bz + W Cz, times the last component of the shear: t times the determinant.
    pub t_numerator: f32,
}

impl EdgeHit {
    #[inline(always)]
    fn determinant(&self) -> f32 {
        self.edges.x + self.edges.y + self.edges.z
    }
}

/// A ray that meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// Distance along the ray in metres, above zero.
    pub t: f32,
    /// Barycentric weights of the three vertices.
    pub barycentric: Vec3,
    /// True when the ray comes from the side that the right-hand normal points to.
    pub from_front: bool,
}

/// Relative rounding unit of `f32`.
const UNIT: f32 = f32::EPSILON * 0.5;
/// The sheared vertices are off by at most 5 rounding units of the largest coordinate relative to the ray's origin
/// (one for the difference, one each for shear factor and product, one for the last difference, one spare), and
/// a box has to hold what the triangle test accepts. That coordinate is at most the largest of the box plus the
/// largest of the origin; each of the two gets its part, with three units for the roundings of the padding itself.
const PADDING: f32 = 8.0 * UNIT;
/// 1 + 2 gamma(3): the slab distances carry three roundings each `[IZE13 section 3]`.
const FAR_WIDENING: f32 = 1.0 + 2.0 * (3.0 * UNIT / (1.0 - 3.0 * UNIT));
/// How much more, in units of `PADDING`, a box around others is padded than a triangle's own.
///
/// The distances to its planes may be computed as `p inverse - origin inverse`, fused or not, and are not widened:
/// against the triangle's own they may be off by 5 units of |p| (one for each of two roundings, three for the
/// triangle's), 5 of |origin|, and 6 of either for the widening. 11 of each, within the 16 that this adds.
pub const OUTER_PADDING: f32 = 3.0;

/// Numerators of t below this are computed again in double precision, since their parts may have underflowed: above it
/// underflow changes them by less than their rounding, and never their sign.
pub const LEAST_NUMERATOR: f32 = 1e-30;
/// Those above this too, since their parts may have overflowed.
pub const GREATEST_NUMERATOR: f32 = 1e38;

impl Turn {
    /// The one that makes the greatest component of a direction, the first of several, the last.
    #[inline]
    fn to_greatest(direction: Vec3) -> Self {
        let d = direction.abs();
        // Without branches: no one could predict them.
        let x_or_y = usize::from(d.y > d.x);
        Self(if d.z > d.x.max(d.y) { 2 } else { x_or_y })
    }

    /// The axes that become x, y and z.
    #[inline]
    pub fn axes(self) -> [usize; 3] {
        const AXES: [[usize; 3]; 3] = [[1, 2, 0], [2, 0, 1], [0, 1, 2]];
        AXES[self.0]
    }

    #[inline]
    fn apply(self, v: Vec3A) -> Vec3A {
        let is = |axis: usize| BVec3A::splat(self.0 == axis);
        Vec3A::select(is(0), v.yzx(), Vec3A::select(is(1), v.zxy(), v))
    }
}

impl RayCast {
    /// Prepares a ray.
    #[inline]
    pub fn new(ray: &Ray) -> Self {
        let turn = Turn::to_greatest(ray.direction);
        let outer = Slabs::new(ray.origin.into(), ray.direction.into());
        let slabs = outer.turned(turn);
        let inverse = slabs.inverse_direction.z;
        let shear = (turn.apply(ray.direction.into()) * inverse).with_z(inverse);
        Self { turn, origin: slabs.origin, shear, outer, slabs }
    }

    /// Meets a triangle before or at `t_max`.
    pub fn triangle(&self, v: &[Vec3; 3], t_max: f32) -> Option<TriangleHit> {
        let turned = v.map(|p| self.turn.apply(p.into()));
        let sheared = turned.map(|p| self.sheared(p));
        let edges = edge_functions(&sheared);
        let hit = EdgeHit { edges, t_numerator: self.t_numerator(edges, &sheared) };
        if differ_in_sign(edges) { None } else { self.settle(hit, turned, t_max) }
    }

    /// Meets a triangle at `t_max` or before, given the turned vertices, and edge functions that do not differ in sign.
    ///
    /// The distance is brought into the span of the triangle's own box, so that whether and where a triangle is
    /// hit depends on the triangle alone and never on the boxes of a hierarchy around it.
    #[inline(always)]
    pub fn settle(&self, hit: EdgeHit, turned: [Vec3A; 3], t_max: f32) -> Option<TriangleHit> {
        let is_in_range = (LEAST_NUMERATOR..=GREATEST_NUMERATOR).contains(&hit.t_numerator.abs());
        let (edges, t) = if is_in_range && !hit.edges.cmpeq(Vec3A::ZERO).any() {
            (hit.edges, hit.t_numerator / hit.determinant())
        } else {
            self.exact(&turned)?
        };
        let determinant = edges.x + edges.y + edges.z;
        let [a, b, c] = turned;
        let (near, far) = self.slabs.span(a.min(b).min(c), a.max(b).max(c));
        let clamped = t.max(near).min(far);
        // Without an area the determinant is zero and t no number or infinite.
        let is_hit = t > 0.0 && t < f32::INFINITY && near <= far && clamped > 0.0 && clamped <= t_max;
        is_hit.then(|| TriangleHit {
            t: clamped,
            barycentric: (edges / determinant).into(),
            from_front: (determinant > 0.0) == (self.shear.z > 0.0),
        })
    }

    /// Edge functions and t in double precision, whose range no product of three coordinates leaves; nothing where the
    /// edge functions differ in sign after all, which zeros among them had hidden.
    #[cold]
    fn exact(&self, turned: &[Vec3A; 3]) -> Option<(Vec3A, f32)> {
        let sheared = turned.map(|p| self.sheared(p));
        let edges = exact_edge_functions(&sheared);
        if differ_in_sign(edges) {
            return None;
        }
        let depths = DVec3::from(sheared.map(|p| f64::from(p.z)));
        let depth = edges.as_dvec3().dot(depths) / edges.as_dvec3().element_sum();
        Some((edges, depth as f32 * self.shear.z))
    }

    #[inline]
    fn t_numerator(&self, edges: Vec3A, [a, b, c]: &[Vec3A; 3]) -> f32 {
        (edges.x * a.z + edges.y * b.z + edges.z * c.z) * self.shear.z
    }

    /// A point relative to the origin, sheared so that the ray is the z axis.
    #[inline]
    fn sheared(&self, p: Vec3A) -> Vec3A {
        let p = p - self.origin;
        // z is left as it is.
        p - self.shear * Vec3A::new(p.z, p.z, 0.0)
    }
}

impl Slabs {
    #[inline]
    fn new(origin: Vec3A, direction: Vec3A) -> Self {
        let padding = Vec3A::splat(origin.abs().max_element() * PADDING);
        let negative = direction.cmplt(Vec3A::ZERO);
        Self {
            inverse_direction: safe_inverse(direction),
            negative,
            origin,
            away: Vec3A::select(negative, -padding, padding),
        }
    }

    #[inline]
    fn turned(&self, turn: Turn) -> Self {
        let inverse_direction = turn.apply(self.inverse_direction);
        let negative = inverse_direction.cmplt(Vec3A::ZERO);
        Self { inverse_direction, negative, origin: turn.apply(self.origin), away: turn.apply(self.away) }
    }

    /// The origins from which the planes that are entered, and those that are left, of a box that was padded
    /// [`OUTER_PADDING`] times are seen.
    #[inline]
    pub fn outer_origins(&self) -> [Vec3A; 2] {
        [self.origin + self.away * OUTER_PADDING, self.origin - self.away * OUTER_PADDING]
    }

    /// The distances at which the ray enters and leaves the box around a triangle; the second is less if it does not.
    #[inline]
    fn span(&self, min: Vec3A, max: Vec3A) -> (f32, f32) {
        let padding = min.abs().max(max.abs()).max_element() * PADDING;
        let (min, max) = (min - padding, max + padding);
        let (first, last) = (Vec3A::select(self.negative, max, min), Vec3A::select(self.negative, min, max));
        let near = (first - (self.origin + self.away)) * self.inverse_direction;
        let far = (last - (self.origin - self.away)) * self.inverse_direction;
        (near.max_element().max(0.0), far.min_element() * FAR_WIDENING)
    }
}

/// U, V and W.
#[inline]
fn edge_functions([a, b, c]: &[Vec3A; 3]) -> Vec3A {
    Vec3A::new(c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x)
}

fn differ_in_sign(edges: Vec3A) -> bool {
    edges.min_element() < 0.0 && edges.max_element() > 0.0
}

/// U, V and W in double precision, rounded away from zero: never zero unless exactly zero.
#[cold]
fn exact_edge_functions([a, b, c]: &[Vec3A; 3]) -> Vec3A {
    let edge = |p: &Vec3A, q: &Vec3A| {
        let (p, q) = (p.as_dvec3(), q.as_dvec3());
        let exact = p.x * q.y - p.y * q.x;
        let rounded = exact as f32;
        if rounded == 0.0 && exact != 0.0 { f32::MIN_POSITIVE.copysign(exact as f32) } else { rounded }
    };
    Vec3A::new(edge(c, b), edge(a, c), edge(b, a))
}

#[inline]
fn safe_inverse(d: Vec3A) -> Vec3A {
    let tiny = d.abs().cmplt(Vec3A::splat(1e-18));
    let huge = Vec3A::select(d.cmplt(Vec3A::ZERO), Vec3A::splat(-1e18), Vec3A::splat(1e18));
    Vec3A::select(tiny, huge, 1.0 / d)
}

/// A box a little larger than what it holds, by `times` the error of the triangle test.
pub fn padded(bounds: Bounds, times: f32) -> Bounds {
    let padding = padding(bounds, times);
    Bounds { min: bounds.min - padding, max: bounds.max + padding }
}

/// How much larger such a box is on each side.
pub fn padding(bounds: Bounds, times: f32) -> f32 {
    bounds.min.abs().max(bounds.max.abs()).max_element() * (PADDING * times)
}

/// The box around a triangle.
pub fn triangle_bounds(v: &[Vec3; 3]) -> Bounds {
    Bounds::of_points(*v)
}

/// Twice the area times the unit normal, by the right-hand rule.
pub fn scaled_normal(v: &[Vec3; 3]) -> Vec3 {
    (v[1] - v[0]).cross(v[2] - v[0])
}

/// Square of the distance from a point to a triangle.
///
/// Over the triangle that is the height over its plane, elsewhere the distance to the nearest edge; so it holds for
/// triangles without area, too.
#[inline]
pub fn squared_distance(p: Vec3, v: &[Vec3; 3]) -> f32 {
    let n = scaled_normal(v);
    let squared = n.length_squared();
    let longest = (v[1] - v[0]).length_squared().max((v[2] - v[0]).length_squared());
    if !(squared > ROUND * longest * longest && PLAIN_AREAS.contains(&squared)) {
        return exact_squared_distance(p, v);
    }
    let edges = [(v[0], v[1]), (v[1], v[2]), (v[2], v[0])];
    if edges.iter().all(|(a, b)| n.cross(b - a).dot(p - a) > 0.0) {
        let height = n.dot(p - v[0]);
        return height / squared * height;
    }
    edges.iter().map(|&(a, b)| squared_distance_to_segment(p, a, b)).fold(f32::INFINITY, f32::min)
}

fn squared_distance_to_segment(p: Vec3, a: Vec3, b: Vec3) -> f32 {
    let along = b - a;
    let s = (p - a).dot(along) / along.length_squared();
    // A segment without length gives no number, which clamps to its start.
    let s = if s > 0.0 { s.min(1.0) } else { 0.0 };
    (p - (a + along * s)).length_squared()
}

/// Squares of doubled areas, relative to the fourth power of an edge, above which a normal has its digits in single
/// precision: those of slivers of more than ten times their width are less.
const ROUND: f32 = 1e-2;
/// Squares of doubled areas, in m^4, for which no product of four lengths leaves the range of single precision.
const PLAIN_AREAS: RangeInclusive<f32> = 1e-20..=1e24;

/// The same in double precision, for slivers and for triangles of kilometres or micrometres.
#[cold]
fn exact_squared_distance(p: Vec3, v: &[Vec3; 3]) -> f32 {
    let p = p.as_dvec3();
    let from = v.map(|corner| corner.as_dvec3() - p);
    let edges = [from[1] - from[0], from[2] - from[1], from[0] - from[2]];
    let n = edges[0].cross(edges[1]);
    if (0..3).all(|k| n.cross(edges[k]).dot(from[k]) < 0.0) {
        let height = n.dot(from[0]);
        return (height * height / n.length_squared()) as f32;
    }
    let to_edge = |k: usize| {
        let s = -from[k].dot(edges[k]) / edges[k].length_squared();
        let s = if s > 0.0 { s.min(1.0) } else { 0.0 };
        (from[k] + edges[k] * s).length_squared()
    };
    (0..3).map(to_edge).fold(f64::INFINITY, f64::min) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = Vec3> {
        (-1.0_f32..1.0, -1.0_f32..1.0, -1.0_f32..1.0).prop_map(|(x, y, z)| Vec3::new(x, y, z))
    }

    fn cast(origin: Vec3, direction: Vec3) -> RayCast {
        RayCast::new(&Ray::new(origin, direction.normalize()))
    }

    /// The distances as hierarchies compute them.
    fn outer_span(slabs: &Slabs, bounds: Bounds, fused: bool) -> (f32, f32) {
        let bounds = padded(bounds, OUTER_PADDING);
        let planes = [bounds.min, bounds.max];
        let distance = |side: usize, a: usize| {
            let (inverse, plane) =
                (slabs.inverse_direction[a], planes[usize::from(slabs.negative.test(a)) ^ side][a]);
            let offset = -(slabs.outer_origins()[side][a] * inverse);
            if fused { plane.mul_add(inverse, offset) } else { plane * inverse + offset }
        };
        let near = (0..3).fold(0.0_f32, |t, a| t.max(distance(0, a)));
        (near, (0..3).fold(f32::INFINITY, |t, a| t.min(distance(1, a))))
    }

    #[test]
    fn front_is_the_side_of_the_right_hand_normal() {
        let v = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let inside = Vec3::new(0.2, 0.3, 0.0);
        for axis in [Vec3::Z, Vec3::new(0.9, 0.3, 0.4), Vec3::new(-0.9, 0.3, 0.4), Vec3::new(0.1, -0.8, 0.4)]
        {
            let above = cast(inside + axis, -axis).triangle(&v, f32::INFINITY).unwrap();
            let below = cast(inside - axis, axis).triangle(&v, f32::INFINITY).unwrap();
            assert!(above.from_front && !below.from_front);
            assert!((above.t - axis.length()).abs() < 1e-6);
            assert!((above.barycentric - Vec3::new(0.5, 0.2, 0.3)).length() < 1e-6);
        }
    }

    proptest! {
        #[test]
        fn a_ray_at_a_point_of_the_shared_edge_hits_a_side(
            a in vector(), b in vector(), c in vector(), d in vector(), o in vector(), s in 0.0_f32..1.0
        ) {
            // c and d on opposite sides of the edge ab as seen from o, else the ray may pass outside of both.
            let n = (a - o).cross(b - o);
            prop_assume!(n.dot(c - o) * n.dot(d - o) < -1e-4);
            let target = a + (b - a) * s;
            prop_assume!((target - o).length() > 1e-2);
            let ray = cast(o, target - o);
            let hit = |v: [Vec3; 3]| ray.triangle(&v, f32::INFINITY).is_some();
            prop_assert!(hit([a, b, c]) || hit([b, a, d]));
        }

        #[test]
        fn a_box_around_others_is_entered_before_and_left_after_them(
            a in vector(), b in vector(), c in vector(), e in vector(), o in vector(), d in vector(), far in -3_i32..3
        ) {
            prop_assume!(d.length() > 1e-3);
            let away = Vec3::splat(10.0_f32.powi(far) - 1e-3);
            let slabs = Slabs::new((o + away).into(), d.normalize().into());
            let inner = Bounds::of_points([a + away, b + away, c + away]);
            let (near, far) = slabs.span(inner.min.into(), inner.max.into());
            if near <= far {
                for outer in [inner, inner.including(e + away)] {
                    for fused in [false, true] {
                        let (outer_near, outer_far) = outer_span(&slabs, outer, fused);
                        prop_assert!(outer_near <= near && outer_far >= far);
                    }
                }
            }
        }

        /// In their plane edge functions are rounding errors, many of them zero, and only exact ones tell.
        #[test]
        fn what_is_met_in_its_plane_is_met_within_the_triangle(
            p in prop::array::uniform9(-8_i32..=8), at in prop::array::uniform4(-3.0_f32..3.0), far in -2_i32..3
        ) {
            let scale = 10.0_f32.powi(far) / 8.0;
            let corner = |i: usize| Vec3::new(p[i] as f32, p[i + 1] as f32, p[i + 2] as f32) * scale;
            let v = [corner(0), corner(3), corner(6)];
            let within = |s: f32, t: f32| v[0] + (v[1] - v[0]) * s + (v[2] - v[0]) * t;
            let (origin, target) = (within(at[0], at[1]), within(at[2], at[3]));
            prop_assume!((target - origin).length() > 1e-2 * scale);
            if let Some(hit) = cast(origin, target - origin).triangle(&v, f32::INFINITY) {
                prop_assert!(hit.barycentric.min_element() >= 0.0 && hit.barycentric.max_element() < 1.0001, "{hit:?}");
            }
        }

        #[test]
        fn the_distance_is_that_of_the_nearest_point(a in vector(), b in vector(), c in vector(), p in vector()) {
            let squared = squared_distance(p * 2.0, &[a, b, c]);
            let points = (0..=64).flat_map(|i| (0..=64 - i).map(move |j| (i as f32 / 64.0, j as f32 / 64.0)));
            let sampled = points
                .map(|(s, t)| (a * s + b * t + c * (1.0 - s - t)).distance_squared(p * 2.0))
                .fold(f32::INFINITY, f32::min);
            // The nearest point is within the spacing of the samples.
            let spacing = (a - b).length().max((b - c).length()).max((c - a).length()) / 64.0;
            prop_assert!(squared.sqrt() <= sampled.sqrt() + 1e-5);
            prop_assert!(squared.sqrt() >= sampled.sqrt() - spacing - 1e-5);
        }

        /// In single precision among metres, in double among micrometres and thousands of kilometres.
        #[test]
        fn the_distance_grows_with_the_scene(a in vector(), b in vector(), c in vector(), p in vector(), e in -30_i32..40) {
            let scale = 2.0_f32.powi(e);
            let here = squared_distance(p, &[a, b, c]);
            let there = squared_distance(p * scale, &[a * scale, b * scale, c * scale]);
            // The height of a triangle with a tenth of an equal one's area is off by some units of its size.
            let sizes = [a, b, c].map(|v| v.distance(p)).iter().sum::<f32>();
            prop_assert!((there / (scale * scale) - here).abs() <= 1e-5 * sizes * here.sqrt() + 1e-10, "{there} {here}");
        }

        /// A sliver a micrometre wide is as far away as its plane.
        #[test]
        fn the_distance_over_slivers_is_the_height(x in 0.01_f32..0.99, width in 1e-7_f32..1e-3, height in 1e-4_f32..1.0) {
            let v = [Vec3::new(0.0, x, 0.0), Vec3::new(1.0, x, 0.0), Vec3::new(1.0, x + width, 0.0)];
            let over = (v[0] + v[1] + v[2]) / 3.0 + Vec3::Z * height;
            let found = squared_distance(over, &v).sqrt();
            // As long as the point is over the sliver at all, in single precision; else it is a width beside it.
            prop_assert!((found / height - 1.0).abs() < 1e-5 + (width / height).powi(2), "{found} {height}");
        }

        #[test]
        fn agrees_with_double_precision(a in vector(), b in vector(), c in vector(), o in vector(), d in vector()) {
            prop_assume!(d.length() > 1e-3);
            let direction = d.normalize();
            let (e1, e2) = ((b - a).as_dvec3(), (c - a).as_dvec3());
            let p = direction.as_dvec3().cross(e2);
            let det = e1.dot(p);
            prop_assume!(det.abs() > 1e-3);
            let s = (o - a).as_dvec3();
            let u = s.dot(p) / det;
            let q = s.cross(e1);
            let v = direction.as_dvec3().dot(q) / det;
            let t = e2.dot(q) / det;
            let margin = u.min(v).min(1.0 - u - v);
            prop_assume!(margin.abs() > 1e-4 && t.abs() > 1e-3);
            let got = RayCast::new(&Ray::new(o, direction)).triangle(&[a, b, c], f32::INFINITY);
            prop_assert_eq!(got.is_some(), margin > 0.0 && t > 0.0);
            if let Some(hit) = got {
                prop_assert!((f64::from(hit.t) - t).abs() < 1e-3 * (1.0 + t.abs()));
                prop_assert_eq!(hit.from_front, det > 0.0);
            }
        }
    }
}
