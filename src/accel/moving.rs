//! Trees over what moves while the shutter is open: linearly, and so do their boxes.
//!
//! ```text
//! vertex:   p(t) = p + t m                              t in frames, m in metres a frame
//! box:      b(t) = b(0) + t (b(s) - b(0)) / s           0 <= t <= s, the time at which the shutter closes
//! ```
//! Of points that move linearly the least coordinate is never below the line between its values at both ends, so the
//! boxes hold them at any time between `[WOOP17]`. The tree is that of the opening; a second one of the same
//! form has what its numbers change by. Traversal is compiled once more for it, so that what stands still pays nothing.

use glam::Vec3;

use super::Accel;
use super::leaf::Leaf;
use super::node::{Child, Node};
use crate::geometry::Bounds;
use crate::geometry::machine::{Eight, Lanes};
use crate::geometry::triangle::{OUTER_PADDING, padding};

/// Vertices and planes that move are rounded thrice or four times more, each time by a unit of at most twice the greatest
/// coordinate: 10 units in all, where each of these is worth 8.
const MOVING_PADDING: f32 = OUTER_PADDING + 2.0;

/// What the numbers of a tree change by in one frame.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    /// The boxes when the shutter opens; they are wider than those of what stands still.
    nodes: Vec<Node>,
    node_changes: Vec<Node>,
    leaf_changes: Vec<Leaf>,
}

impl Motion {
    /// Bytes that it occupies.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.node_changes) + size_of_val(&*self.leaf_changes)
    }
}

/// How a part of a tree is read at the time of a ray.
pub(super) trait Change<T>: Copy {
    /// Eight of its numbers.
    fn lanes<L: Lanes>(self, start: &T, part: impl Fn(&T) -> &Eight) -> L;
    /// One of them.
    fn number(self, start: &T, part: impl Fn(&T) -> f32) -> f32;
}

/// It does not change.
#[derive(Clone, Copy)]
pub(super) struct Unchanged;

impl<T> Change<T> for Unchanged {
    #[inline(always)]
    fn lanes<L: Lanes>(self, start: &T, part: impl Fn(&T) -> &Eight) -> L {
        L::load(part(start))
    }

    #[inline(always)]
    fn number(self, start: &T, part: impl Fn(&T) -> f32) -> f32 {
        part(start)
    }
}

/// It changes so much in one frame.
pub(super) struct Changed<'a, T> {
    change: &'a T,
    time: f32,
}

impl<T> Clone for Changed<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Changed<'_, T> {}

impl<T> Change<T> for Changed<'_, T> {
    #[inline(always)]
    fn lanes<L: Lanes>(self, start: &T, part: impl Fn(&T) -> &Eight) -> L {
        L::load(part(start)).add(L::load(part(self.change)).mul(L::splat(self.time)))
    }

    /// Rounded as the lanes are: a vertex is in one place.
    #[inline(always)]
    fn number(self, start: &T, part: impl Fn(&T) -> f32) -> f32 {
        part(start) + part(self.change) * self.time
    }
}

/// A tree at the time of a ray.
pub(super) trait Moment<'a>: Copy {
    type OfNode: Change<Node>;
    type OfLeaf: Change<Leaf>;
    fn node(self, index: usize) -> (&'a Node, Self::OfNode);
    fn leaf(self, index: usize) -> (&'a Leaf, Self::OfLeaf);
}

/// A tree over what stands still.
#[derive(Clone, Copy)]
pub(super) struct Standing<'a>(pub &'a Accel);

impl<'a> Moment<'a> for Standing<'a> {
    type OfNode = Unchanged;
    type OfLeaf = Unchanged;

    #[inline(always)]
    fn node(self, index: usize) -> (&'a Node, Unchanged) {
        (&self.0.nodes[index], Unchanged)
    }

    #[inline(always)]
    fn leaf(self, index: usize) -> (&'a Leaf, Unchanged) {
        (&self.0.leaves[index], Unchanged)
    }
}

/// A tree over what moves.
#[derive(Clone, Copy)]
pub(super) struct Moving<'a> {
    pub accel: &'a Accel,
    pub motion: &'a Motion,
    pub time: f32,
}

impl<'a> Moment<'a> for Moving<'a> {
    type OfNode = Changed<'a, Node>;
    type OfLeaf = Changed<'a, Leaf>;

    #[inline(always)]
    fn node(self, index: usize) -> (&'a Node, Changed<'a, Node>) {
        (&self.motion.nodes[index], Changed { change: &self.motion.node_changes[index], time: self.time })
    }

    #[inline(always)]
    fn leaf(self, index: usize) -> (&'a Leaf, Changed<'a, Leaf>) {
        (&self.accel.leaves[index], Changed { change: &self.motion.leaf_changes[index], time: self.time })
    }
}

impl Accel {
    /// Lets the vertices move until the shutter closes: each by its motion in a frame. `triangles` are those that the
    /// hierarchy was made for; it forgets the motion when it is made for others.
    pub fn set_in_motion(&mut self, motions: &[Vec3], triangles: &[[u32; 3]], shutter: f32) {
        let mut leaf_changes = self.leaves.clone();
        for (leaf, ids) in leaf_changes.iter_mut().zip(&self.ids) {
            leaf.refit(ids, motions, triangles);
        }
        let (mut nodes, mut node_changes) = (self.nodes.clone(), vec![Node::UNMOVED; self.nodes.len()]);
        // Children stand after their parents, so the last node comes first.
        let mut around = vec![[Bounds::EMPTY; 2]; nodes.len()];
        for index in (0..nodes.len()).rev() {
            for lane in
                (0..Node::WIDTH).take_while(|&lane| self.nodes[index].children[lane] != Child::NOTHING)
            {
                let child = self.nodes[index].children[lane];
                let ends = match (child.as_node(), child.as_leaf()) {
                    (Some(node), _) => around[node],
                    (_, Some(leaf)) => [0.0, shutter].map(|time| {
                        self.leaves[leaf].bounds_at(Changed { change: &leaf_changes[leaf], time })
                    }),
                    _ => continue,
                };
                around[index] = [0, 1].map(|end| around[index][end].union(ends[end]));
                let margin = padding(ends[0].union(ends[1]), MOVING_PADDING);
                let [open, close] = ends.map(|b| Bounds { min: b.min - margin, max: b.max + margin });
                nodes[index].set_planes(lane, open);
                let change = |from: Vec3, to: Vec3| (to - from) / shutter;
                let change = Bounds { min: change(open.min, close.min), max: change(open.max, close.max) };
                node_changes[index].set_planes(lane, change);
            }
        }
        self.motion = Some(Box::new(Motion { nodes, node_changes, leaf_changes }));
    }

    /// True when the vertices move while the shutter is open.
    pub fn is_in_motion(&self) -> bool {
        self.motion.is_some()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::accel::Ignored;
    use crate::geometry::Ray;

    /// Of a coarse lattice, on which ties and degenerate triangles are common.
    fn point() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(-4_i32..=4).prop_map(|i| Vec3::from_array(i.map(|i| i as f32 * 0.25)))
    }

    proptest! {
        /// A vertex is in one place, so a tree over what moves answers to the last bit like one over where it has got to.
        #[test]
        fn a_moving_tree_answers_like_one_that_is_built_for_the_moment(
            vertices in prop::collection::vec((point(), point()), 3..120),
            rays in prop::collection::vec((point(), point(), 0.0_f32..=1.0), 40),
            shutter in 0.01_f32..=1.0, exponent in -12_i32..=12, reach in 0..3_i32
        ) {
            let scale = 10.0_f32.powi(exponent);
            let positions: Vec<Vec3> = vertices.iter().map(|v| v.0 * scale).collect();
            // From less than the size of a triangle to many times that of the whole.
            let motions: Vec<Vec3> = vertices.iter().map(|v| v.1 * (scale * 0.03 * 20.0_f32.powi(reach))).collect();
            let triangles: Vec<[u32; 3]> = (0..positions.len() as u32 - 2).map(|i| [i, i + 1, i + 2]).collect();
            let mut moving = Accel::build(&positions, &triangles);
            moving.set_in_motion(&motions, &triangles, shutter);
            for (origin, direction, part) in rays.into_iter().filter(|ray| ray.1 != Vec3::ZERO) {
                let time = part * shutter;
                let there: Vec<Vec3> = positions.iter().zip(&motions).map(|(p, m)| *p + *m * time).collect();
                let still = Accel::build(&there, &triangles);
                let ray = Ray::new(origin * (3.0 * scale), direction.normalize()).at_time(time);
                let closest = moving.closest(&ray, Ignored::NOTHING);
                prop_assert_eq!(closest, still.closest(&ray, Ignored::NOTHING));
                prop_assert_eq!(moving.occluded(&ray, Ignored::NOTHING), closest.is_some());
                let all = |accel: &Accel| {
                    let mut hits = Vec::new();
                    accel.each_hit(&ray, Ignored::NOTHING, |hit| { hits.push((hit.triangle, hit.t)); false });
                    hits.sort_by_key(|hit| hit.0);
                    hits
                };
                prop_assert_eq!(all(&moving), all(&still));
                // Squares of areas must neither under- nor overflow.
                if exponent.abs() <= 4 {
                    prop_assert_eq!(moving.clearance(ray.origin, time), still.clearance(ray.origin, time));
                }
            }
        }
    }

    #[test]
    fn another_mesh_stands_still_again() {
        let (positions, triangles) = ([Vec3::ZERO, Vec3::X, Vec3::Y], [[0, 1, 2]]);
        let mut accel = Accel::build(&positions, &triangles);
        let still = accel.bytes();
        accel.set_in_motion(&[Vec3::Z; 3], &triangles, 0.5);
        assert!(accel.is_in_motion() && accel.bytes() > still);
        let mut copy = Accel::default();
        copy.copy_from(&accel);
        accel.refit(&positions, &triangles);
        assert!(!accel.is_in_motion() && !copy.is_in_motion());
    }
}
