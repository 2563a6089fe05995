//! What must be true of a hierarchy; every test that makes one asks.

use glam::Vec3;

use super::{Accel, Child, MAX_DEPTH};
use crate::geometry::Bounds;
use crate::geometry::triangle::triangle_bounds;

impl Accel {
    /// Checks that each triangle is in exactly one leaf with its own vertices, that boxes hold what is inside, that
    /// children stand after their parents, and that the depth is bounded.
    ///
    /// # Errors
    /// The first thing that is not so.
    pub fn validate(&self, positions: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), String> {
        if self.ids.len() != triangles.len() {
            return Err(format!("{} triangles in leaves, {} given", self.ids.len(), triangles.len()));
        }
        if self.is_empty() {
            return Ok(());
        }
        let mut seen = vec![false; triangles.len()];
        for (slot, &id) in self.ids.iter().enumerate() {
            if std::mem::replace(&mut seen[id as usize], true) {
                return Err(format!("triangle {id} is in two leaves"));
            }
            if self.vertices[slot] != triangles[id as usize].map(|i| positions[i as usize]) {
                return Err(format!("triangle {id} has other vertices in its leaf"));
            }
        }
        if self.depth() > MAX_DEPTH {
            return Err(format!("depth {} is over {MAX_DEPTH}", self.depth()));
        }
        for (index, node) in self.nodes.iter().enumerate() {
            for child in &node.children {
                self.validate_child(index, child)?;
            }
        }
        Ok(())
    }

    fn validate_child(&self, index: usize, child: &Child) -> Result<(), String> {
        let holds = |inner: Bounds| child.bounds.union(inner) == child.bounds;
        match child.count {
            Child::ABSENT => Ok(()),
            0 if child.first as usize <= index => {
                Err(format!("node {} does not follow its parent", child.first))
            }
            0 if self.nodes[child.first as usize].children.iter().all(|c| holds(c.bounds)) => Ok(()),
            0 => Err(format!("node {} sticks out of its box", child.first)),
            count => {
                let leaf = &self.vertices[child.first as usize..(child.first + count) as usize];
                if leaf.iter().all(|v| holds(triangle_bounds(v))) {
                    Ok(())
                } else {
                    Err(format!("the leaf at {} sticks out of its box", child.first))
                }
            }
        }
    }
}
