//! New positions in the tree that is there.

use glam::Vec3;

use super::{Accel, Child};
use crate::geometry::Bounds;

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
        for index in (0..self.nodes.len()).rev() {
            for lane in 0..4 {
                let bounds = self.bounds_of(self.nodes[index].children[lane]);
                self.nodes[index].boxes.set(lane, bounds);
            }
        }
        self.bounds = self.nodes.first().map_or(Bounds::EMPTY, |root| root.boxes.union());
    }

    /// The box around what a child holds.
    pub(super) fn bounds_of(&self, child: Child) -> Bounds {
        if let Some(node) = child.as_node() {
            return self.nodes[node].boxes.union();
        }
        child.as_leaf().map_or(Bounds::EMPTY, |index| {
            let leaf = &self.leaves[index];
            let boxes = leaf.pack.bounds();
            let used = (0..4).filter(|&lane| leaf.ids[lane] != super::Leaf::NO_TRIANGLE);
            used.fold(Bounds::EMPTY, |all, lane| all.union(boxes.get(lane)))
        })
    }
}
