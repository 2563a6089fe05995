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

pub use traverse::Ignored;

use glam::Vec3;

use crate::geometry::Bounds;
use crate::geometry::triangle::{BoundsPack, TrianglePack};

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

/// A bounding volume hierarchy of four children a node and four triangles a leaf.
#[derive(Clone, Debug, Default)]
pub struct Accel {
    /// Children stand after their parents; the root is the first.
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
    bounds: Bounds,
    triangles: usize,
}

/// The boxes of four children and where they are: two cache lines.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Node {
    boxes: BoundsPack,
    children: [Child; 4],
}

/// A node, a leaf, or nothing, in one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Child(u32);

/// Four triangles and their indices; unused lanes have [`Leaf::NO_TRIANGLE`].
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
struct Leaf {
    pack: TrianglePack,
    ids: [TriangleId; 4],
}

impl Leaf {
    const NO_TRIANGLE: TriangleId = TriangleId::MAX;
}

impl Node {
    const EMPTY: Self = Self { boxes: BoundsPack::EMPTY, children: [Child::NOTHING; 4] };
}

impl Child {
    const LEAF: u32 = 1 << 31;
    /// The box of nothing is empty, so that no ray ever gets there.
    const NOTHING: Self = Self(u32::MAX);

    fn node(index: usize) -> Self {
        Self(index as u32)
    }

    fn leaf(index: usize) -> Self {
        Self(index as u32 | Self::LEAF)
    }

    /// The index of a leaf.
    fn as_leaf(self) -> Option<usize> {
        (self != Self::NOTHING && self.0 & Self::LEAF != 0).then_some((self.0 & !Self::LEAF) as usize)
    }

    /// The index of a node.
    fn as_node(self) -> Option<usize> {
        (self.0 & Self::LEAF == 0).then_some(self.0 as usize)
    }
}

/// Deepest tree that is ever traversed; the builder falls back to a balanced tree beyond it.
const MAX_DEPTH: usize = 42;

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

    /// Bytes that the hierarchy occupies.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.leaves)
    }
}
