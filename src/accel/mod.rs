//! The hierarchy that finds what a ray meets first.
//!
//! [`Accel::build`] takes positions and index triples; [`Accel::refit`] takes new positions for the same triples.
//! [`Accel::closest`] and [`Accel::occluded`] answer rays. Hits are decided by the triangle alone
//! ([`crate::geometry::triangle`]) and ties by the lower index, so the answer does not depend on the tree: built,
//! refitted, or built another way, it is the same to the last bit.

mod build;
mod refit;
mod traverse;
mod validate;

use glam::Vec3;

use crate::geometry::Bounds;
pub use traverse::Ignored;

/// Index of a triangle in the order it was given in.
pub type TriangleId = u32;

/// The nearest triangle along a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Which triangle.
    pub triangle: TriangleId,
    /// Distance in metres.
    pub t: f32,
    /// Barycentric weights of its vertices.
    pub barycentric: Vec3,
    /// True when the ray came from the side of the right-hand normal.
    pub from_front: bool,
}

/// A bounding volume hierarchy of two children a node.
///
/// A node is a cache line: both children's boxes and what they are. The triangles lie in the order of the leaves,
/// each with its three vertices, so a leaf is read in one run.
#[derive(Clone, Debug, Default)]
pub struct Accel {
    nodes: Vec<Node>,
    bounds: Bounds,
    vertices: Vec<[Vec3; 3]>,
    ids: Vec<TriangleId>,
}

/// Two boxes and what is in them.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Node {
    children: [Child; 2],
}

/// A box and the node or the run of triangles inside.
#[derive(Clone, Copy, Debug)]
struct Child {
    bounds: Bounds,
    /// Index of a node (`count` 0) or of the first triangle.
    first: u32,
    /// Number of triangles; 0 for a node; [`Child::ABSENT`] for nothing.
    count: u32,
}

impl Child {
    const ABSENT: u32 = u32::MAX;
}

/// Deepest tree that is ever traversed; the builder falls back to a balanced tree beyond it.
const MAX_DEPTH: usize = 64;

impl Accel {
    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// True without triangles: every ray misses.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    /// The box around everything.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Bytes that the hierarchy occupies.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.vertices) + size_of_val(&*self.ids)
    }
}
