//! Where a ray may start that leaves a surface: on the right side of it, and no farther off than rounding demands.
//!
//! A point computed as b0 v0 + b1 v1 + b2 v2 is off by at most gamma(7) (|b0 v0| + |b1 v1| + |b2 v2|) in each
//! coordinate. The start is moved along the normal until the whole error box lies on one side of the plane, then
//! rounded away from it `[PHARR23 section 6.8]`. The shift scales with the coordinates, never with a fixed epsilon.

use glam::Vec3;

/// gamma(7): bound of seven roundings.
const GAMMA_7: f32 = 7.0 * f32::EPSILON * 0.5 / (1.0 - 7.0 * f32::EPSILON * 0.5);

/// A point on a triangle and how far off each coordinate may be.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// The point.
    pub position: Vec3,
    /// Bound of the error of each coordinate.
    pub error: Vec3,
}

impl SurfacePoint {
    /// The point of the triangle `v` with barycentric weights `b`.
    pub fn on_triangle(v: &[Vec3; 3], b: Vec3) -> Self {
        let terms = [v[0] * b.x, v[1] * b.y, v[2] * b.z];
        Self {
            position: terms[0] + terms[1] + terms[2],
            error: (terms[0].abs() + terms[1].abs() + terms[2].abs()) * GAMMA_7,
        }
    }

    /// Start of a ray that leaves along `direction`, off the plane with unit normal `ng`.
    pub fn spawn(&self, ng: Vec3, direction: Vec3) -> Vec3 {
        let side = if direction.dot(ng) < 0.0 { -ng } else { ng };
        let offset = side * ng.abs().dot(self.error);
        let moved = self.position + offset;
        let away = |value: f32, by: f32| match by {
            _ if by > 0.0 => value.next_up(),
            _ if by < 0.0 => value.next_down(),
            _ => value,
        };
        Vec3::new(away(moved.x, offset.x), away(moved.y, offset.y), away(moved.z, offset.z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::triangle::scaled_normal;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_start_lies_on_the_side_of_the_direction(
            p in prop::array::uniform9(-10.0_f32..10.0), u in 0.0_f32..1.0, w in 0.0_f32..1.0, up in any::<bool>()
        ) {
            let v = [Vec3::new(p[0], p[1], p[2]), Vec3::new(p[3], p[4], p[5]), Vec3::new(p[6], p[7], p[8])];
            let n = scaled_normal(&v);
            prop_assume!(n.length() > 1e-2);
            let ng = n.normalize();
            let (b1, b2) = if u + w > 1.0 { (1.0 - u, 1.0 - w) } else { (u, w) };
            let point = SurfacePoint::on_triangle(&v, Vec3::new(1.0 - b1 - b2, b1, b2));
            let direction = if up { ng } else { -ng };
            let start = point.spawn(ng, direction).as_dvec3();
            let exact = v.map(|q| q.as_dvec3());
            let plane = (exact[1] - exact[0]).cross(exact[2] - exact[0]).normalize();
            let height = (start - exact[0]).dot(plane);
            let towards = if up { height } else { -height };
            prop_assert!(towards > 0.0);
            prop_assert!(towards < 1e-4);
        }
    }
}
