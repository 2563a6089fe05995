//! New positions in the tree that is there.

use glam::Vec3;

use super::{Accel, Child, Leaf};
use crate::geometry::Bounds;
use crate::geometry::triangle::triangle_bounds;

impl Accel {
    /// Moves the vertices; `triangles` are those that the hierarchy was built from.
    pub fn refit(&mut self, positions: &[Vec3], triangles: &[[u32; 3]]) {
        debug_assert_eq!(triangles.len(), self.triangles);
        for leaf in &mut self.leaves {
            for (lane, id) in leaf.ids.into_iter().enumerate() {
                if let Some(triangle) = triangles.get(id as usize) {
                    leaf.pack.set(lane, &triangle.map(|i| positions[i as usize]));
                }
            }
        }
        // Children stand after their parents, so the last node comes first.
        let mut around = vec![Bounds::EMPTY; self.nodes.len()];
        for index in (0..self.nodes.len()).rev() {
            for lane in 0..4 {
                let child = self.nodes[index].children[lane];
                let bounds = child.as_node().map_or_else(|| self.leaf_bounds(child), |node| around[node]);
                around[index] = around[index].union(bounds);
                if child != Child::NOTHING {
                    self.nodes[index].boxes.set(lane, bounds);
                }
            }
        }
        self.bounds = around.first().copied().unwrap_or_default();
    }

    /// The box around a leaf's triangles; empty for what is no leaf.
    pub(super) fn leaf_bounds(&self, child: Child) -> Bounds {
        let Some(leaf) = child.as_leaf().map(|index| &self.leaves[index]) else { return Bounds::EMPTY };
        let used = (0..4).filter(|&lane| leaf.ids[lane] != Leaf::NO_TRIANGLE);
        used.fold(Bounds::EMPTY, |all, lane| all.union(triangle_bounds(&leaf.pack.get(lane))))
    }
}
