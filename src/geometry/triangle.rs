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

use glam::{BVec3, Vec3, Vec3Swizzles};

use super::{Bounds, Ray};

/// What of a ray the triangle and box tests need, computed once.
#[derive(Clone, Copy, Debug)]
pub struct RayCast {
    /// Start of the ray.
    pub origin: Vec3,
    /// One over the direction; components of zero become huge instead of infinite.
    pub inverse_direction: Vec3,
    axes: Axes,
    shear: Vec3,
}

/// The cyclic order of axes that makes the dominant one the last, mirrored to keep the winding.
#[derive(Clone, Copy, Debug)]
enum Axes {
    Yzx,
    Zyx,
    Zxy,
    Xzy,
    Xyz,
    Yxz,
}

impl Axes {
    fn of(direction: Vec3) -> Self {
        let a = direction.abs();
        if a.x >= a.y && a.x >= a.z {
            if direction.x >= 0.0 { Self::Yzx } else { Self::Zyx }
        } else if a.y >= a.z {
            if direction.y >= 0.0 { Self::Zxy } else { Self::Xzy }
        } else if direction.z >= 0.0 {
            Self::Xyz
        } else {
            Self::Yxz
        }
    }

    #[inline(always)]
    fn permute(self, v: Vec3) -> Vec3 {
        match self {
            Self::Yzx => v.yzx(),
            Self::Zyx => v.zyx(),
            Self::Zxy => v.zxy(),
            Self::Xzy => v.xzy(),
            Self::Xyz => v,
            Self::Yxz => v.yxz(),
        }
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
/// a box has to hold what the triangle test accepts.
const BOX_PADDING: f32 = 6.0 * UNIT;
/// 1 + 2 gamma(3): the slab distances carry three roundings each `[IZE13 section 3]`.
const FAR_WIDENING: f32 = 1.0 + 2.0 * (3.0 * UNIT / (1.0 - 3.0 * UNIT));

impl RayCast {
    /// Prepares a ray.
    pub fn new(ray: &Ray) -> Self {
        let axes = Axes::of(ray.direction);
        let d = axes.permute(ray.direction);
        Self {
            origin: ray.origin,
            inverse_direction: safe_inverse(ray.direction),
            axes,
            shear: Vec3::new(d.x / d.z, d.y / d.z, 1.0 / d.z),
        }
    }

    /// The distances at which the ray enters and leaves a box, widened so that no triangle inside is lost.
    ///
    /// Monotone: a box that holds another is entered no later and left no earlier, to the last bit.
    #[inline(always)]
    pub fn slab(&self, min: Vec3, max: Vec3) -> (f32, f32) {
        let low = min - self.origin;
        let high = max - self.origin;
        let padding = low.abs().max(high.abs()).max_element() * BOX_PADDING;
        let t0 = (low - padding) * self.inverse_direction;
        let t1 = (high + padding) * self.inverse_direction;
        let near = t0.min(t1).max_element();
        let far = t0.max(t1).min_element() * FAR_WIDENING;
        (near.max(0.0), far)
    }

    /// Meets the triangle `v` before or at `t_max`.
    ///
    /// The distance is brought into the span of the triangle's own box, so that whether and where a triangle is
    /// hit depends on the triangle alone and never on the boxes of a hierarchy around it.
    #[inline(always)]
    pub fn triangle(&self, v: &[Vec3; 3], t_max: f32) -> Option<TriangleHit> {
        let [a, b, c] = v.map(|p| self.axes.permute(p - self.origin));
        let (ax, ay) = (a.x - self.shear.x * a.z, a.y - self.shear.y * a.z);
        let (bx, by) = (b.x - self.shear.x * b.z, b.y - self.shear.y * b.z);
        let (cx, cy) = (c.x - self.shear.x * c.z, c.y - self.shear.y * c.z);
        let mut edges = Vec3::new(cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax);
        if edges.cmpeq(Vec3::ZERO).any() {
            edges = exact_edges([ax, ay, bx, by, cx, cy]);
        }
        let negative: BVec3 = edges.cmplt(Vec3::ZERO);
        if negative.any() && edges.cmpgt(Vec3::ZERO).any() {
            return None;
        }
        let determinant = edges.x + edges.y + edges.z;
        if determinant == 0.0 {
            return None;
        }
        let depth = Vec3::new(a.z, b.z, c.z) * self.shear.z;
        let inverse = 1.0 / determinant;
        let t = edges.dot(depth) * inverse;
        if !(t > 0.0 && t <= t_max) {
            return None;
        }
        let (near, far) = self.slab(v[0].min(v[1]).min(v[2]), v[0].max(v[1]).max(v[2]));
        if near > far {
            return None;
        }
        let t = t.max(near).min(far);
        (t <= t_max).then(|| TriangleHit { t, barycentric: edges * inverse, from_front: determinant > 0.0 })
    }
}

/// The edge functions in double precision, rounded towards their sign: never zero unless exactly zero.
#[cold]
fn exact_edges(sheared: [f32; 6]) -> Vec3 {
    let [ax, ay, bx, by, cx, cy] = sheared.map(f64::from);
    let edge = |e: f64| {
        let rounded = e as f32;
        if rounded == 0.0 && e != 0.0 { f32::MIN_POSITIVE.copysign(e as f32) } else { rounded }
    };
    Vec3::new(edge(cx * by - cy * bx), edge(ax * cy - ay * cx), edge(bx * ay - by * ax))
}

fn safe_inverse(d: Vec3) -> Vec3 {
    let one = |x: f32| {
        if x.abs() < 1e-18 { 1e18_f32.copysign(x) } else { 1.0 / x }
    };
    Vec3::new(one(d.x), one(d.y), one(d.z))
}

/// The box around a triangle.
pub fn triangle_bounds(v: &[Vec3; 3]) -> Bounds {
    Bounds::of_points(*v)
}

/// Twice the area times the unit normal, by the right-hand rule.
pub fn scaled_normal(v: &[Vec3; 3]) -> Vec3 {
    (v[1] - v[0]).cross(v[2] - v[0])
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
        fn boxes_are_monotone(a in vector(), b in vector(), c in vector(), e in vector(), o in vector(), d in vector()) {
            prop_assume!(d.length() > 1e-3);
            let ray = cast(o, d);
            let inner = Bounds::of_points([a, b, c]);
            let outer = inner.including(e);
            let (near, far) = ray.slab(inner.min, inner.max);
            let (outer_near, outer_far) = ray.slab(outer.min, outer.max);
            prop_assert!(outer_near <= near && outer_far >= far);
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
