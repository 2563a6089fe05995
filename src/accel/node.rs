//! Boxes of eight children.

use super::moving::Change;
use crate::geometry::Bounds;
use crate::geometry::machine::{Eight, Lanes};
use crate::geometry::triangle::{OUTER_PADDING, Slabs, padded};

/// The boxes of eight children and where they are: four cache lines.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// Least and greatest coordinates, by axis.
    planes: [[Eight; 2]; 3],
    pub children: [Child; 8],
}

/// A node, a leaf, or nothing, in one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Child(pub u32);

/// A ray as nodes see it.
#[derive(Clone, Copy)]
pub(super) struct NodeRay<L> {
    inverse: [L; 3],
    /// Minus origin times inverse direction, for the planes entered and left.
    offsets: [[L; 2]; 3],
    signs: [usize; 3],
}

impl Node {
    pub const WIDTH: usize = 8;
    /// Boxes of nothing are never entered.
    pub const EMPTY: Self = Self {
        planes: [[Eight([f32::INFINITY; 8]), Eight([f32::NEG_INFINITY; 8])]; 3],
        children: [Child::NOTHING; 8],
    };

    /// What a node changes by whose children stand still.
    pub const UNMOVED: Self = Self { planes: [[Eight([0.0; 8]); 2]; 3], children: [Child::NOTHING; 8] };

    /// Puts a child into a lane.
    pub fn hang(&mut self, lane: usize, bounds: Bounds, child: Child) {
        self.children[lane] = child;
        self.set_bounds(lane, bounds);
    }

    /// Gives the child in a lane another box.
    pub fn set_bounds(&mut self, lane: usize, bounds: Bounds) {
        self.set_planes(lane, padded(bounds, OUTER_PADDING));
    }

    /// Sets the numbers of a lane, as they are.
    pub fn set_planes(&mut self, lane: usize, Bounds { min, max }: Bounds) {
        for axis in 0..3 {
            self.planes[axis][0].0[lane] = min[axis];
            self.planes[axis][1].0[lane] = max[axis];
        }
    }

    /// The box in a lane, padding included.
    pub fn bounds(&self, lane: usize) -> Bounds {
        let corner = |side: usize| glam::Vec3::from_array(self.planes.each_ref().map(|p| p[side].0[lane]));
        Bounds { min: corner(0), max: corner(1) }
    }

    // Not a closure: those are compiled without wide registers where they are not inlined.
    #[inline(always)]
    fn distance<L: Lanes>(&self, change: impl Change<Self>, ray: &NodeRay<L>, side: usize, a: usize) -> L {
        let planes: L = change.lanes(self, |node| &node.planes[a][ray.signs[a] ^ side]);
        planes.scaled(ray.inverse[a], ray.offsets[a][side])
    }

    /// Where the ray enters the boxes, and a bit for each that it enters before or at `t_max`.
    #[inline(always)]
    pub fn enter<L: Lanes>(&self, change: impl Change<Self>, ray: &NodeRay<L>, t_max: f32) -> (L, u32) {
        let near = self
            .distance(change, ray, 0, 0)
            .max(self.distance(change, ray, 0, 1))
            .max(self.distance(change, ray, 0, 2).max(L::splat(0.0)));
        let far = self
            .distance(change, ray, 1, 0)
            .min(self.distance(change, ray, 1, 1))
            .min(self.distance(change, ray, 1, 2).min(L::splat(t_max)));
        (near, near.at_most(far))
    }
}

impl Node {
    #[inline(always)]
    fn squared_along<L: Lanes>(&self, change: impl Change<Self>, point: &[L; 3], a: usize) -> L {
        let min: L = change.lanes(self, |node| &node.planes[a][0]);
        let max: L = change.lanes(self, |node| &node.planes[a][1]);
        let outside = min.sub(point[a]).max(point[a].sub(max)).max(L::splat(0.0));
        outside.mul(outside)
    }

    /// Squares of the distances from a point to the boxes.
    #[inline(always)]
    pub fn squared_distances<L: Lanes>(&self, change: impl Change<Self>, point: &[L; 3]) -> L {
        let xy = self.squared_along(change, point, 0).add(self.squared_along(change, point, 1));
        xy.add(self.squared_along(change, point, 2))
    }
}

impl<L: Lanes> NodeRay<L> {
    #[inline(always)]
    pub fn new(slabs: &Slabs) -> Self {
        let [entered, left] = slabs.outer_origins();
        let inverse = slabs.inverse_direction;
        let (entered, left) = (-(entered * inverse), -(left * inverse));
        let bits = slabs.negative.bitmask() as u8;
        Self {
            inverse: [L::splat(inverse.x), L::splat(inverse.y), L::splat(inverse.z)],
            offsets: [
                [L::splat(entered.x), L::splat(left.x)],
                [L::splat(entered.y), L::splat(left.y)],
                [L::splat(entered.z), L::splat(left.z)],
            ],
            signs: [usize::from(bits & 1), usize::from(bits >> 1 & 1), usize::from(bits >> 2 & 1)],
        }
    }
}

impl Child {
    const LEAF: u32 = 1 << 31;
    pub const NOTHING: Self = Self(u32::MAX);

    pub fn node(index: usize) -> Self {
        Self(index as u32)
    }

    pub fn leaf(index: usize) -> Self {
        Self(index as u32 | Self::LEAF)
    }

    /// The index of a leaf.
    #[inline(always)]
    pub fn as_leaf(self) -> Option<usize> {
        (self != Self::NOTHING && self.0 & Self::LEAF != 0).then_some((self.0 & !Self::LEAF) as usize)
    }

    /// The index of a node.
    #[inline(always)]
    pub fn as_node(self) -> Option<usize> {
        (self.0 & Self::LEAF == 0).then_some(self.0 as usize)
    }
}
