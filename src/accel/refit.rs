//! New positions in the tree that is there.

use glam::Vec3;

use super::{Accel, Child, Node};
use crate::geometry::Bounds;

impl Accel {
    /// Moves the vertices; `triangles` are those that the hierarchy was built from. Still ones are left alone.
    pub fn refit(&mut self, positions: &[Vec3], triangles: &[[u32; 3]]) {
        debug_assert_eq!(triangles.len(), self.triangles);
        self.motion = None;
        let still = self.still.leaves;
        for (leaf, ids) in self.leaves[still..].iter_mut().zip(&self.ids[still..]) {
            leaf.refit(ids, positions, triangles);
        }
        self.refit_nodes();
    }

    /// Fits the boxes of what moves to the leaves.
    pub(super) fn refit_nodes(&mut self) {
        // Children stand after their parents, so the last node comes first.
        let mut around = vec![Bounds::EMPTY; self.nodes.len()];
        for index in (self.still.nodes..self.nodes.len()).rev() {
            around[index] = self.refit_node(index, 0, &around);
        }
        if self.still.nodes > 0 {
            self.bounds = self.still.bounds.union(self.refit_node(0, self.still.lanes(), &around));
        } else {
            self.bounds = around.first().copied().unwrap_or_default();
        }
    }

    /// Fits the boxes of a node from a lane on, given those around nodes behind it; the box around them.
    fn refit_node(&mut self, index: usize, first: usize, around: &[Bounds]) -> Bounds {
        let mut all = Bounds::EMPTY;
        for lane in first..Node::WIDTH {
            let child = self.nodes[index].children[lane];
            if child == Child::NOTHING {
                break;
            }
            let bounds = child.as_node().map_or_else(|| self.leaf_bounds(child), |node| around[node]);
            all = all.union(bounds);
            self.nodes[index].set_bounds(lane, bounds);
        }
        all
    }

    /// The box around a leaf's triangles; empty for what is no leaf.
    pub(super) fn leaf_bounds(&self, child: Child) -> Bounds {
        child.as_leaf().map_or(Bounds::EMPTY, |index| self.leaves[index].bounds())
    }
}
