//! Builds a binary tree with obvhs and collapses it to four children a node.

use glam::Vec3;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use super::{Accel, Child, Leaf, MAX_DEPTH, Node};
use crate::geometry::Bounds;
use crate::geometry::triangle::{TrianglePack, triangle_bounds};

/// Triangles in a leaf, at most.
const LEAF_SIZE: usize = 4;

/// Parts of the tree that reinsertion tries to place better.
const REINSERTION_RATIO: f32 = 0.02;

/// A place for a subtree: the node and the lane that it hangs from.
struct Slot {
    node: usize,
    lane: usize,
}

impl Accel {
    /// Builds the hierarchy over `triangles` (index triples into `positions`, all finite and in range).
    pub fn build(positions: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        if triangles.is_empty() {
            return Self::default();
        }
        let corners: Vec<[Vec3; 3]> = triangles.iter().map(|t| t.map(|i| positions[i as usize])).collect();
        let binary = bvh2_of(&corners);
        let accel = Self::collapsed(&corners, &binary);
        if accel.depth() <= MAX_DEPTH { accel } else { Self::balanced(&corners, &binary.primitive_indices) }
    }

    fn collapsed(corners: &[[Vec3; 3]], binary: &Bvh2) -> Self {
        let mut accel = Self { triangles: corners.len(), ..Self::default() };
        accel.nodes.push(Node::EMPTY);
        let root = if binary.nodes[0].is_leaf() { vec![0] } else { children_of(binary, 0) };
        let mut open = vec![(root, 0)];
        while let Some((members, node)) = open.pop() {
            for (lane, &member) in members.iter().enumerate() {
                let source = &binary.nodes[member];
                let slot = Slot { node, lane };
                if source.is_leaf() {
                    let first = source.first_index as usize;
                    let ids = &binary.primitive_indices[first..first + source.prim_count as usize];
                    accel.hang_leaf(&slot, corners, ids);
                } else {
                    let index = accel.nodes.len();
                    accel.nodes.push(Node::EMPTY);
                    accel.hang(&slot, bounds_of(&source.aabb), Child::node(index));
                    open.push((children_of(binary, member), index));
                }
            }
        }
        accel.bounds = around(corners, &binary.primitive_indices);
        accel
    }

    /// A tree that quarters the given order until a leaf's size is reached: depth log4(n) whatever the geometry.
    fn balanced(corners: &[[Vec3; 3]], order: &[u32]) -> Self {
        let mut accel = Self { triangles: corners.len(), ..Self::default() };
        accel.nodes.push(Node::EMPTY);
        let whole = around(corners, order);
        let mut open = vec![(order, 0)];
        while let Some((order, node)) = open.pop() {
            let share = order.len().div_ceil(4).next_multiple_of(LEAF_SIZE);
            for (lane, part) in order.chunks(share).enumerate() {
                let slot = Slot { node, lane };
                if part.len() <= LEAF_SIZE {
                    accel.hang_leaf(&slot, corners, part);
                } else {
                    let index = accel.nodes.len();
                    accel.nodes.push(Node::EMPTY);
                    accel.hang(&slot, around(corners, part), Child::node(index));
                    open.push((part, index));
                }
            }
        }
        accel.bounds = whole;
        accel
    }

    fn hang(&mut self, slot: &Slot, bounds: Bounds, child: Child) {
        let node = &mut self.nodes[slot.node];
        node.boxes.set(slot.lane, bounds);
        node.children[slot.lane] = child;
    }

    fn hang_leaf(&mut self, slot: &Slot, corners: &[[Vec3; 3]], ids: &[u32]) {
        let mut leaf = Leaf { pack: TrianglePack::EMPTY, ids: [Leaf::NO_TRIANGLE; 4] };
        for (lane, &id) in ids.iter().enumerate() {
            leaf.pack.set(lane, &corners[id as usize]);
            leaf.ids[lane] = id;
        }
        let index = self.leaves.len();
        self.leaves.push(leaf);
        self.hang(slot, around(corners, ids), Child::leaf(index));
    }

    /// Number of nodes on the longest way down.
    pub(super) fn depth(&self) -> usize {
        let mut depths = vec![1; self.nodes.len()];
        for index in 0..self.nodes.len() {
            for node in self.nodes[index].children.iter().filter_map(|c| c.as_node()) {
                depths[node] = depths[index] + 1;
            }
        }
        depths.into_iter().max().unwrap_or(0)
    }
}

/// Up to four descendants that take the place of a node's two children: the largest are opened first.
fn children_of(binary: &Bvh2, node: usize) -> Vec<usize> {
    let pair = |node: usize| [0, 1].map(|side| binary.nodes[node].first_index as usize + side);
    let mut members = Vec::from(pair(node));
    while members.len() < 4 {
        let area = |m: usize| binary.nodes[m].aabb.half_area();
        let inner = (0..members.len()).filter(|&i| !binary.nodes[members[i]].is_leaf());
        let Some(largest) = inner.max_by(|&a, &b| area(members[a]).total_cmp(&area(members[b]))) else {
            break;
        };
        let opened = members.swap_remove(largest);
        members.extend(pair(opened));
    }
    members
}

fn bvh2_of(corners: &[[Vec3; 3]]) -> Bvh2 {
    let boxes: Vec<Aabb> = corners
        .iter()
        .map(|v| {
            let b = triangle_bounds(v);
            Aabb::new(b.min.into(), b.max.into())
        })
        .collect();
    let ids = (0..boxes.len() as u32).collect();
    let builder = PlocBuilder::with_capacity(boxes.len());
    let mut bvh = { builder }.build(PlocSearchDistance::Medium, &boxes, ids, SortPrecision::U64, 1);
    ReinsertionOptimizer::default().run(&mut bvh, REINSERTION_RATIO, None);
    collapse(&mut bvh, LEAF_SIZE as u32, 1.0);
    bvh
}

fn around(corners: &[[Vec3; 3]], ids: &[u32]) -> Bounds {
    ids.iter().fold(Bounds::EMPTY, |all, &id| all.union(triangle_bounds(&corners[id as usize])))
}

fn bounds_of(aabb: &Aabb) -> Bounds {
    Bounds { min: aabb.min.into(), max: aabb.max.into() }
}
