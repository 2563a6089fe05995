//! What must be true of a hierarchy; every test that makes one asks.

use glam::Vec3;

use super::{Accel, MAX_DEPTH, Node};
use crate::geometry::Bounds;

impl Accel {
    /// Checks that each triangle is in exactly one leaf with its own vertices, that boxes hold what is inside, that
    /// children stand after their parents, and that the depth is bounded.
    ///
    /// # Errors
    /// The first thing that is not so.
    pub fn validate(&self, positions: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), String> {
        if self.triangles != triangles.len() {
            return Err(format!("{} triangles in the tree, {} given", self.triangles, triangles.len()));
        }
        let mut seen = vec![false; triangles.len()];
        for (leaf, ids) in self.leaves.iter().zip(&self.ids) {
            for (lane, &id) in ids.iter().enumerate().take(leaf.len()) {
                if std::mem::replace(&mut seen[id as usize], true) {
                    return Err(format!("triangle {id} is in two leaves"));
                }
                if leaf.triangle(lane) != triangles[id as usize].map(|i| positions[i as usize]) {
                    return Err(format!("triangle {id} has other vertices in its leaf"));
                }
            }
        }
        if let Some(missing) = seen.iter().position(|s| !s) {
            return Err(format!("triangle {missing} is in no leaf"));
        }
        if self.depth() > MAX_DEPTH {
            return Err(format!("depth {} is over {MAX_DEPTH}", self.depth()));
        }
        self.nodes.iter().enumerate().try_for_each(|(index, node)| self.validate_node(index, node))
    }

    fn validate_node(&self, index: usize, node: &Node) -> Result<(), String> {
        for (lane, &child) in node.children.iter().enumerate() {
            if child.as_node().is_some_and(|c| c <= index) {
                return Err(format!("child {lane} of node {index} does not follow it"));
            }
            let stated = node.bounds(lane);
            let inside = |bounds: Bounds| stated.union(bounds) == stated;
            let sound = match child.as_node() {
                Some(c) => (0..Node::WIDTH).all(|l| inside(self.nodes[c].bounds(l))),
                None => inside(self.leaf_bounds(child)),
            };
            if !sound {
                return Err(format!("child {lane} of node {index} sticks out of its box"));
            }
        }
        Ok(())
    }
}
