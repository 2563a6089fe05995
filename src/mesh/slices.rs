//! The arrays of a simulator that keeps them, as a mesh.
//!
//! Preparing joins vertices and drops triangles in place, so it works on a mesh of its own: each array is copied once,
//! 24 bytes a vertex, 12 more with velocities, and 12 bytes a triangle, 8 more with labels.

use glam::{DVec3, Vec3};

use super::{Interface, RawMesh, Region};

/// Positions of vertices in the precision that the simulator has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Positions<'a> {
    /// Single precision.
    Single(&'a [[f32; 3]]),
    /// Double precision.
    Double(&'a [[f64; 3]]),
}

/// A mesh in the arrays of others. What they hold is checked by [`RawMesh::check`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshSlices<'a> {
    /// Vertex positions, in the units that `frames.scale` of the scene is about.
    pub positions: Positions<'a>,
    /// One velocity a vertex, in those units per second, if there are any.
    pub velocities: Option<&'a [[f32; 3]]>,
    /// Three vertex indices a triangle, counter-clockwise seen from the front.
    pub triangles: &'a [[u32; 3]],
    /// The labels in front of each triangle and behind it; a closed mesh may do without.
    pub labels: Option<&'a [[i32; 2]]>,
}

impl From<MeshSlices<'_>> for RawMesh {
    fn from(slices: MeshSlices<'_>) -> Self {
        let interface = |&[front, back]: &[i32; 2]| Interface { front: Region(front), back: Region(back) };
        Self {
            positions: match slices.positions {
                Positions::Single(all) => all.iter().map(|&p| Vec3::from_array(p).as_dvec3()).collect(),
                Positions::Double(all) => all.iter().map(|&p| DVec3::from_array(p)).collect(),
            },
            triangles: slices.triangles.to_vec(),
            interfaces: slices.labels.map(|labels| labels.iter().map(interface).collect()),
            normals: None,
            velocities: slices.velocities.map(|all| all.iter().map(|&v| Vec3::from_array(v)).collect()),
        }
    }
}
