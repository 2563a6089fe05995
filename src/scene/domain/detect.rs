//! Finding the box of a simulation from the caps that its fluid has there.
//!
//! The box is the mesh's bounds when one of its planes (the bottom, whichever way is up) is covered to 90 % by
//! faces lying on it, and each of the four planes beside it carries faces of at least a quarter of its area: the
//! walls of a tank are wet up to the surface only.

use glam::DVec3;

use super::Side;
use super::walls::{Planes, WallFaces, used_bounds};
use crate::mesh::RawMesh;
use crate::scene::description::Axis;

/// Part of the bottom that must carry faces.
const BOTTOM_COVER: f64 = 0.9;
/// Part of each side that must carry faces.
const SIDE_COVER: f64 = 0.25;

/// The least and the greatest corner of the simulated box, in the file's units; `None` when the faces on the
/// bounds do not look like walls. The top of the box is the highest point of the mesh.
pub fn detect_box(mesh: &RawMesh) -> Option<(DVec3, DVec3)> {
    let (min, max) = used_bounds(mesh);
    if !(min.cmplt(max).all() && (max - min).is_finite()) {
        return None;
    }
    let faces = WallFaces::find(mesh, Planes::new(min, max, Axis::Z));
    let mut cover = [0.0; 6];
    for (triangle, side) in mesh.triangles.iter().zip(&faces.sides) {
        if let Some(side) = side {
            let [a, b, c] = triangle.map(|index| mesh.positions[index as usize]);
            // Twice the area on the plane, as parts of its extents: a triangle that is half the plane has 1.
            let twice_area = ((b - a) / (max - min)).cross((c - a) / (max - min))[side.axis()].abs();
            cover[usize::from(side.0)] += 0.5 * twice_area;
        }
    }
    let covers = |side: Side, part: f64| cover[usize::from(side.0)] >= part;
    let stands_on = |bottom: &Side| {
        covers(*bottom, BOTTOM_COVER)
            && Side::ALL
                .iter()
                .filter(|side| side.axis() != bottom.axis())
                .all(|&side| covers(side, SIDE_COVER))
    };
    Side::ALL.iter().any(stands_on).then_some((min, max))
}
