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
//! Four triangles are tested at once, one a lane; a lane's result does not depend on the other three.

use glam::{Vec3, Vec4};

use super::{Bounds, Ray};

/// What of a ray the triangle and box tests need, computed once.
#[derive(Clone, Copy, Debug)]
pub struct RayCast {
    origin: Vec3,
    /// The origin moved away from the planes where a ray enters boxes, and from those where it leaves them.
    origins: [Vec3; 2],
    /// One over the direction; components of zero become huge instead of infinite.
    inverse_direction: Vec3,
    /// 1 where the direction is negative: which plane of a box is entered first.
    signs: [usize; 3],
    /// The axis along which the direction is greatest; the other two follow in cyclic order.
    pub axis: usize,
    /// The other two components of the direction over the greatest, and one over the greatest.
    shear: Vec3,
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

/// Four triangles: for each vertex and axis the coordinates of all four.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrianglePack {
    coordinates: [[Vec4; 3]; 3],
}

/// The lanes of a pack that a ray meets.
#[derive(Clone, Copy, Debug)]
pub struct PackHits {
    mask: u32,
    t: Vec4,
    edges: [Vec4; 3],
    determinant: Vec4,
}

/// Four boxes, a little larger than what they hold: least and greatest corners, by axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundsPack {
    planes: [[Vec4; 3]; 2],
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

impl RayCast {
    /// Prepares a ray.
    pub fn new(ray: &Ray) -> Self {
        let d = ray.direction;
        let axis = d.abs().max_position();
        let inverse = 1.0 / d[axis];
        let padding = Vec3::splat(ray.origin.abs().max_element() * PADDING);
        let negative = d.cmplt(Vec3::ZERO);
        let away = Vec3::select(negative, -padding, padding);
        Self {
            origin: ray.origin,
            origins: [ray.origin + away, ray.origin - away],
            inverse_direction: safe_inverse(d),
            signs: [0, 1, 2].map(|a| usize::from(negative.test(a))),
            axis,
            shear: Vec3::new(d[(axis + 1) % 3] * inverse, d[(axis + 2) % 3] * inverse, inverse),
        }
    }

    /// The distances at which the ray enters and leaves four boxes, widened so that no triangle inside is lost.
    ///
    /// Monotone: a box that holds another is entered no later and left no earlier, to the last bit.
    #[inline(always)]
    pub fn slabs(&self, boxes: &BoundsPack) -> (Vec4, Vec4) {
        let (mut near, mut far) = (Vec4::ZERO, Vec4::INFINITY);
        for a in 0..3 {
            let sign = self.signs[a];
            let inverse = self.inverse_direction[a];
            near = near.max((boxes.planes[sign][a] - self.origins[0][a]) * inverse);
            far = far.min((boxes.planes[1 - sign][a] - self.origins[1][a]) * inverse);
        }
        (near, far * FAR_WIDENING)
    }

    /// The triangles of a pack that the ray meets before or at `t_max`. `K` is [`RayCast::axis`].
    #[inline(always)]
    pub fn pack<const K: usize>(&self, pack: &TrianglePack, t_max: f32) -> Option<PackHits> {
        let (kx, ky) = ((K + 1) % 3, (K + 2) % 3);
        let z = [0, 1, 2].map(|v| pack.coordinates[v][K] - self.origin[K]);
        let x = [0, 1, 2].map(|v| pack.coordinates[v][kx] - self.origin[kx] - z[v] * self.shear.x);
        let y = [0, 1, 2].map(|v| pack.coordinates[v][ky] - self.origin[ky] - z[v] * self.shear.y);
        let mut edges = [(2, 1), (0, 2), (1, 0)].map(|(p, q)| x[p] * y[q] - y[p] * x[q]);
        let on_edge = edges.map(|e| e.cmpeq(Vec4::ZERO).bitmask());
        if on_edge != [0; 3] {
            exact_edges(&mut edges, on_edge[0] | on_edge[1] | on_edge[2], &x, &y);
        }
        let [u, v, w] = edges;
        let negative = u.cmplt(Vec4::ZERO) | v.cmplt(Vec4::ZERO) | w.cmplt(Vec4::ZERO);
        let positive = u.cmpgt(Vec4::ZERO) | v.cmpgt(Vec4::ZERO) | w.cmpgt(Vec4::ZERO);
        let determinant = u + v + w;
        let inside = !(negative & positive) & determinant.cmpne(Vec4::ZERO);
        if !inside.any() {
            return None;
        }
        let t = (u * z[0] + v * z[1] + w * z[2]) * self.shear.z / determinant;
        let mask = (inside & t.cmpgt(Vec4::ZERO) & t.cmple(Vec4::splat(t_max))).bitmask();
        (mask != 0).then_some(PackHits { mask, t, edges, determinant })
    }

    /// Meets one triangle before or at `t_max`.
    pub fn triangle(&self, v: &[Vec3; 3], t_max: f32) -> Option<TriangleHit> {
        let mut pack = TrianglePack::EMPTY;
        pack.set(0, v);
        let hits = match self.axis {
            0 => self.pack::<0>(&pack, t_max),
            1 => self.pack::<1>(&pack, t_max),
            _ => self.pack::<2>(&pack, t_max),
        };
        hits.and_then(|hits| self.settle(&hits, &pack, 0, t_max))
    }

    /// The hit in a lane of [`PackHits`].
    ///
    /// The distance is brought into the span of the triangle's own box, so that whether and where a triangle is
    /// hit depends on the triangle alone and never on the boxes of a hierarchy around it.
    #[inline]
    pub fn settle(
        &self,
        hits: &PackHits,
        pack: &TrianglePack,
        lane: usize,
        t_max: f32,
    ) -> Option<TriangleHit> {
        let mut own = BoundsPack::EMPTY;
        own.set(0, triangle_bounds(&pack.get(lane)));
        let (near, far) = self.slabs(&own);
        let (near, far) = (near.x, far.x);
        if near > far {
            return None;
        }
        let t = hits.t[lane].max(near).min(far);
        let determinant = hits.determinant[lane];
        let [u, v, w] = hits.edges;
        (t > 0.0 && t <= t_max).then(|| TriangleHit {
            t,
            barycentric: Vec3::new(u[lane], v[lane], w[lane]) / determinant,
            from_front: (determinant > 0.0) == (self.shear.z > 0.0),
        })
    }
}

impl PackHits {
    /// The lanes that are met, lowest first.
    #[inline]
    pub fn lanes(&self) -> impl Iterator<Item = usize> {
        let mask = self.mask;
        (0..4).filter(move |lane| mask >> lane & 1 == 1)
    }
}

impl TrianglePack {
    /// No triangle in any lane: every comparison with what is not a number fails.
    pub const EMPTY: Self = Self { coordinates: [[Vec4::NAN; 3]; 3] };

    /// Puts a triangle into a lane.
    pub fn set(&mut self, lane: usize, v: &[Vec3; 3]) {
        for (vertex, p) in v.iter().enumerate() {
            for axis in 0..3 {
                self.coordinates[vertex][axis][lane] = p[axis];
            }
        }
    }

    /// The triangle in a lane.
    pub fn get(&self, lane: usize) -> [Vec3; 3] {
        self.coordinates.map(|axes| Vec3::from_array(axes.map(|c| c[lane])))
    }
}

impl BoundsPack {
    /// Four boxes that hold nothing.
    pub const EMPTY: Self = Self { planes: [[Vec4::INFINITY; 3], [Vec4::NEG_INFINITY; 3]] };

    /// Puts the box around `bounds` into a lane.
    pub fn set(&mut self, lane: usize, bounds: Bounds) {
        let padding = bounds.min.abs().max(bounds.max.abs()).max_element() * PADDING;
        for axis in 0..3 {
            self.planes[0][axis][lane] = bounds.min[axis] - padding;
            self.planes[1][axis][lane] = bounds.max[axis] + padding;
        }
    }

    /// The box in a lane, padding included.
    pub fn get(&self, lane: usize) -> Bounds {
        let corner = |axes: [Vec4; 3]| Vec3::from_array(axes.map(|c| c[lane]));
        Bounds { min: corner(self.planes[0]), max: corner(self.planes[1]) }
    }
}

/// The edge functions of some lanes in double precision, rounded away from zero: never zero unless exactly zero.
#[cold]
fn exact_edges(edges: &mut [Vec4; 3], lanes: u32, x: &[Vec4; 3], y: &[Vec4; 3]) {
    for lane in (0..4).filter(|lane| lanes >> lane & 1 == 1) {
        for (edge, (p, q)) in edges.iter_mut().zip([(2, 1), (0, 2), (1, 0)]) {
            let [xp, yp, xq, yq] = [x[p], y[p], x[q], y[q]].map(|c| f64::from(c[lane]));
            let exact = xp * yq - yp * xq;
            let rounded = exact as f32;
            edge[lane] = if rounded == 0.0 && exact != 0.0 {
                f32::MIN_POSITIVE.copysign(exact as f32)
            } else {
                rounded
            };
        }
    }
}

fn safe_inverse(d: Vec3) -> Vec3 {
    let one = |x: f32| match x {
        _ if x.abs() >= 1e-18 => 1.0 / x,
        _ if x < 0.0 => -1e18,
        _ => 1e18,
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
            let mut boxes = BoundsPack::EMPTY;
            boxes.set(0, inner);
            boxes.set(1, inner.including(e));
            let (near, far) = ray.slabs(&boxes);
            prop_assert!(near.y <= near.x && far.y >= far.x);
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
