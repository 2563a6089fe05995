//! What must be true of a hierarchy; every test that makes one asks.

use glam::Vec3;

use super::moving::Unchanged;
use super::{Accel, MAX_DEPTH, Node};
use crate::geometry::Bounds;

impl Accel {
    /// Checks that each triangle is in exactly one leaf with its own vertices, that each leaf and each node but the root
    /// hangs in exactly one place, that boxes hold what is inside, that children stand after their parents, and that the
    /// depth is bounded.
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
                if leaf.triangle(lane, Unchanged) != triangles[id as usize].map(|i| positions[i as usize]) {
                    return Err(format!("triangle {id} has other vertices in its leaf"));
                }
            }
        }
        if let Some(missing) = seen.iter().position(|s| !s) {
            return Err(format!("triangle {missing} is in no leaf"));
        }
        self.validate_places()?;
        if self.depth() > MAX_DEPTH {
            return Err(format!("depth {} is over {MAX_DEPTH}", self.depth()));
        }
        self.nodes.iter().enumerate().try_for_each(|(index, node)| self.validate_node(index, node))
    }

    /// What hangs nowhere is never found, and what hangs twice is shown twice.
    fn validate_places(&self) -> Result<(), String> {
        let (mut nodes, mut leaves) = (vec![0; self.nodes.len()], vec![0; self.leaves.len()]);
        if let Some(root) = nodes.first_mut() {
            *root = 1;
        }
        for child in self.nodes.iter().flat_map(|node| node.children) {
            let place = match (child.as_node(), child.as_leaf()) {
                (Some(node), _) => nodes.get_mut(node),
                (None, Some(leaf)) => leaves.get_mut(leaf),
                (None, None) => continue,
            };
            *place.ok_or(format!("{child:?} points at nothing"))? += 1;
        }
        for (what, times) in [("node", &nodes), ("leaf", &leaves)] {
            if let Some(index) = times.iter().position(|&times| times != 1) {
                return Err(format!("{what} {index} hangs in {} places", times[index]));
            }
        }
        if self.ids.len() == leaves.len() {
            return Ok(());
        }
        Err(format!("{} leaves but indices for {}", leaves.len(), self.ids.len()))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::Child;

    /// Two quads far apart, so that there are two leaves, and their hierarchy.
    fn two_leaves() -> (Accel, Vec<Vec3>, Vec<[u32; 3]>) {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE];
        let positions: Vec<Vec3> = corners.into_iter().chain(corners.map(|p| p + 50.0)).collect();
        let triangles = vec![[0, 1, 2], [1, 3, 2], [4, 5, 6], [5, 7, 6]];
        (Accel::build(&positions, &triangles), positions, triangles)
    }

    #[test]
    fn what_hangs_nowhere_or_twice_is_found() {
        let (accel, positions, triangles) = two_leaves();
        let check = |accel: &Accel| accel.validate(&positions, &triangles);
        assert_eq!((check(&accel), accel.leaves.len()), (Ok(()), 2));
        let [mut lost, mut twice] = [accel.clone(), accel.clone()];
        lost.nodes[0].children[1] = Child::NOTHING;
        assert!(check(&lost).unwrap_err().contains("hangs in 0 places"));
        twice.nodes[0].hang(2, twice.bounds, accel.nodes[0].children[0]);
        assert!(check(&twice).unwrap_err().contains("hangs in 2 places"));
        let mut beyond = accel;
        beyond.nodes[0].children[0] = Child::leaf(2);
        assert!(check(&beyond).unwrap_err().contains("points at nothing"));
    }
}
