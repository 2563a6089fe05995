//! New positions in the tree that is there.

use glam::Vec3;

use super::{Accel, Child};
use crate::geometry::Bounds;
use crate::geometry::triangle::triangle_bounds;

impl Accel {
    /// Moves the vertices; `triangles` are those that the hierarchy was built from.
    pub fn refit(&mut self, positions: &[Vec3], triangles: &[[u32; 3]]) {
        debug_assert_eq!(triangles.len(), self.ids.len());
        for (v, &id) in self.vertices.iter_mut().zip(&self.ids) {
            *v = triangles[id as usize].map(|i| positions[i as usize]);
        }
        // Children stand after their parents, so the last node comes first.
        for index in (0..self.nodes.len()).rev() {
            for side in 0..2 {
                let child = self.nodes[index].children[side];
                self.nodes[index].children[side].bounds = self.bounds_of(&child);
            }
        }
        self.bounds = self.nodes.first().map_or(Bounds::EMPTY, |root| both(root.children));
    }

    fn bounds_of(&self, child: &Child) -> Bounds {
        match child.count {
            Child::ABSENT => Bounds::EMPTY,
            0 => both(self.nodes[child.first as usize].children),
            count => self.vertices[child.first as usize..(child.first + count) as usize]
                .iter()
                .fold(Bounds::EMPTY, |bounds, v| bounds.union(triangle_bounds(v))),
        }
    }
}

fn both(children: [Child; 2]) -> Bounds {
    children[0].bounds.union(children[1].bounds)
}
