//! New positions in the tree that is there.

use glam::Vec3;

use super::{Accel, Child, Node};
use crate::geometry::Bounds;
use crate::geometry::triangle::triangle_bounds;

impl Accel {
    /// Moves the vertices; `triangles` are those that the hierarchy was built from.
    pub fn refit(&mut self, positions: &[Vec3], triangles: &[[u32; 3]]) {
        debug_assert_eq!(triangles.len(), self.triangles);
        for (leaf, ids) in self.leaves.iter_mut().zip(&self.ids) {
            leaf.refit(ids, positions, triangles);
        }
        // Children stand after their parents, so the last node comes first.
        let mut around = vec![Bounds::EMPTY; self.nodes.len()];
        for index in (0..self.nodes.len()).rev() {
            for lane in 0..Node::WIDTH {
                let child = self.nodes[index].children[lane];
                if child == Child::NOTHING {
                    continue;
                }
                let bounds = child.as_node().map_or_else(|| self.leaf_bounds(child), |node| around[node]);
                around[index] = around[index].union(bounds);
                self.nodes[index].set_bounds(lane, bounds);
            }
        }
        self.bounds = around.first().copied().unwrap_or_default();
    }

    /// The box around a leaf's triangles; empty for what is no leaf.
    pub(super) fn leaf_bounds(&self, child: Child) -> Bounds {
        let Some(leaf) = child.as_leaf().map(|index| &self.leaves[index]) else { return Bounds::EMPTY };
        (0..leaf.len()).fold(Bounds::EMPTY, |all, lane| all.union(triangle_bounds(&leaf.triangle(lane))))
    }
}
