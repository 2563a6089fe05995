//! Where a camera stands that sees all of some bounds.
//!
//! A corner c of the bounds, relative to their centre, is seen inside the margin m when the eye is at least
//! ```text
//! D = c.d + (1 + m) max(|c.x| / tan(w / 2), |c.y| / tan(h / 2))      (1)
//! ```
//! away from the centre in the direction d from there to the eye; x and y are the corner's coordinates across
//! the picture and w, h the angles of view.

use glam::{DVec3, Vec3};

use super::{FieldOfView, Placement};

/// What stays free around the bounds, relative to half the picture.
const MARGIN: f64 = 0.2;

/// Where a camera stands that sees all of some bounds with a fifth of margin, from the front, the right and
/// above.
///
/// Seen along z as up, the front is -y and the right is +x; with y up, the front is +z. Empty bounds are
/// taken as a box of two metres around the origin. `up` is a unit vector.
pub fn automatic_placement(
    bounds: (DVec3, DVec3),
    up: Vec3,
    fov: FieldOfView,
    resolution: [u32; 2],
) -> Placement {
    let (min, max) = usable(bounds);
    let up = up.as_dvec3();
    let across = if up.x.abs() > 0.9 { DVec3::Y } else { DVec3::X };
    let right = (across - up * across.dot(up)).normalize_or(DVec3::X);
    let towards_eye = (0.5 * right + right.cross(up) + 0.6 * up).normalize_or(DVec3::Z);
    let picture_right = up.cross(towards_eye).normalize_or(right);
    let picture_up = towards_eye.cross(picture_right);
    let (tan_x, tan_y) = half_tangents(fov, resolution);
    let target = 0.5 * (min + max);
    let distance = corners(min - target, max - target)
        .map(|c| {
            let across = (c.dot(picture_right).abs() / tan_x).max(c.dot(picture_up).abs() / tan_y);
            c.dot(towards_eye) + (1.0 + MARGIN) * across // (1)
        })
        .fold(0.0, f64::max);
    Placement { eye: target + distance * towards_eye, target }
}

/// Tangents of half the angles of view across the width and the height.
fn half_tangents(fov: FieldOfView, [width, height]: [u32; 2]) -> (f64, f64) {
    let aspect = f64::from(width) / f64::from(height);
    let half_tangent = |degrees: f32| libm::tan(0.5 * f64::from(degrees).to_radians());
    match fov {
        FieldOfView::Vertical(degrees) => (half_tangent(degrees) * aspect, half_tangent(degrees)),
        FieldOfView::Horizontal(degrees) => (half_tangent(degrees), half_tangent(degrees) / aspect),
    }
}

/// The bounds, or a box where they are empty; a single point gets a box of two metres.
pub(super) fn usable((min, max): (DVec3, DVec3)) -> (DVec3, DVec3) {
    if !(min.is_finite() && max.is_finite() && min.cmple(max).all()) {
        return (-DVec3::ONE, DVec3::ONE);
    }
    if min == max { (min - DVec3::ONE, max + DVec3::ONE) } else { (min, max) }
}

fn corners(min: DVec3, max: DVec3) -> impl Iterator<Item = DVec3> {
    let pick = move |i: usize, axis: usize| if i >> axis & 1 == 0 { min[axis] } else { max[axis] };
    (0..8).map(move |i| DVec3::new(pick(i, 0), pick(i, 1), pick(i, 2)))
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::Axis;
    use super::*;
    use proptest::prelude::*;

    /// The greatest extent of the corners in the picture, in half pictures.
    pub(crate) fn extent(
        bounds: (DVec3, DVec3),
        p: &Placement,
        up: DVec3,
        fov: FieldOfView,
        size: [u32; 2],
    ) -> f64 {
        let view = (p.target - p.eye).normalize();
        let right = view.cross(up).normalize();
        let (tan_x, tan_y) = half_tangents(fov, size);
        corners(bounds.0, bounds.1)
            .map(|c| c - p.eye)
            .map(|c| {
                assert!(c.dot(view) > 0.0, "behind the camera");
                (c.dot(right).abs() / tan_x).max(c.dot(right.cross(view)).abs() / tan_y) / c.dot(view)
            })
            .fold(0.0, f64::max)
    }

    proptest! {
        #[test]
        fn the_corners_fill_all_but_the_margin(
            min in prop::array::uniform3(-50.0f64..50.0), sides in prop::array::uniform3(0.001f64..100.0),
            axis in 0usize..3, negative: bool, degrees in 5f32..120.0, width in 1u32..2000, height in 1u32..2000,
            horizontal: bool,
        ) {
            let bounds = (DVec3::from(min), DVec3::from(min) + DVec3::from(sides));
            let up = Axis { index: axis, negative }.vector();
            let fov = if horizontal { FieldOfView::Horizontal(degrees) } else { FieldOfView::Vertical(degrees) };
            let p = automatic_placement(bounds, up, fov, [width, height]);
            let extent = extent(bounds, &p, up.as_dvec3(), fov, [width, height]);
            prop_assert!((extent - 1.0 / 1.2).abs() < 1e-6, "{}", extent);
        }
    }
}
