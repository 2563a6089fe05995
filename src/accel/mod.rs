//! The hierarchy that finds what a ray meets first.
//!
//! [`Accel::build`] takes positions and index triples; [`Accel::refit`] takes new positions for the same triples, and
//! [`Accel::update`] decides between the two. [`Accel::set_in_motion`] lets the vertices move within a frame.
//! [`Accel::closest`] and [`Accel::occluded`] answer rays. Hits are decided by the triangle alone
//! ([`crate::geometry::triangle`]) and ties by the lower index, so the answer does not depend on the tree: built,
//! refitted, or built another way, it is the same to the last bit.
//!
//! The way of a ray: `node` has the boxes, `leaf` the triangles,
//! `traverse` the walk. The way of a mesh: `scales` parts it by size, `clusters` gathers triangles into leaves,
//! `build` has the binary tree over them made, `collapse` makes it wide; `connectivity`, `update`, `refit` and `cost`
//! lead from one frame to the next, and `moving` from the opening of the shutter to its closing.
#![doc = include_str!("measured.md")]

mod build;
mod clearance;
mod clusters;
mod collapse;
mod connectivity;
mod cost;
mod leaf;
mod moving;
mod node;
mod refit;
mod scales;
mod soup;
mod traverse;
mod update;
mod validate;

pub use connectivity::Connectivity;
pub use traverse::Ignored;
pub use update::{Hierarchy, REBUILD_ABOVE, Update};

use glam::Vec3;

use crate::geometry::Bounds;
use build::Still;
use leaf::{Leaf, LeafIds};
use moving::Motion;
use node::{Child, Node};

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

/// A bounding volume hierarchy of eight children a node and up to eight triangles a leaf.
#[derive(Clone, Debug, Default)]
pub struct Accel {
    /// Children stand after their parents; the root is the first, and what is still comes before what moves.
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
    /// Which triangles each leaf holds.
    ids: Vec<LeafIds>,
    bounds: Bounds,
    triangles: usize,
    /// The cost of the tree as it was built, once it is known.
    built_cost: Option<f32>,
    /// What stays when the rest is built anew.
    still: Still,
    /// What moves while the shutter is open; `None` where nothing does.
    motion: Option<Box<Motion>>,
}

/// Deepest tree that is ever traversed; the builder falls back to a balanced tree beyond it.
const MAX_DEPTH: usize = 24;

impl Accel {
    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.triangles
    }

    /// True without triangles: every ray misses.
    pub fn is_empty(&self) -> bool {
        self.triangles == 0
    }

    /// The box around everything.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Where every ray begins.
    #[inline]
    fn root(&self) -> Option<Child> {
        (!self.nodes.is_empty()).then(|| Child::node(0))
    }

    /// Bytes that the hierarchy occupies.
    pub fn bytes(&self) -> usize {
        let moving = self.motion.as_ref().map_or(0, |motion| motion.bytes());
        size_of_val(&*self.nodes) + size_of_val(&*self.leaves) + size_of_val(&*self.ids) + moving
    }
}
