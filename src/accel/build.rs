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
const REINSERTION_RATIO: f32 = 0.05;

/// Triangles more than this many times larger than the median have a tree of their own, and so on upwards.
const SCALE_STEP: f32 = 16.0;

/// Trees that the triangles are spread over, at most.
const MOST_SCALES: usize = 8;

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
        let scales = by_scale(&corners);
        let accel = Self::over_scales(&corners, &scales);
        if accel.depth() <= MAX_DEPTH { accel } else { Self::balanced(&corners, &scales.concat()) }
    }

    /// A tree for the triangles of each scale, one under the other, the largest on top.
    fn over_scales(corners: &[[Vec3; 3]], scales: &[Vec<u32>]) -> Self {
        let mut accel = Self { triangles: corners.len(), ..Self::default() };
        accel.nodes.push(Node::EMPTY);
        let mut top = 0;
        let mut bounds = around(corners, &scales.concat());
        accel.bounds = bounds;
        for (i, ids) in scales.iter().enumerate().rev() {
            let subtree = bvh2_of(corners, ids);
            if i == 0 {
                accel.fill(top, &subtree, corners, ids);
                break;
            }
            let own = accel.nodes.len();
            accel.nodes.push(Node::EMPTY);
            accel.hang(&Slot { node: top, lane: 0 }, bounds_of(&subtree.nodes[0].aabb), Child::node(own));
            accel.fill(own, &subtree, corners, ids);
            bounds = around(corners, &scales[..i].concat());
            let below = accel.nodes.len();
            accel.nodes.push(Node::EMPTY);
            accel.hang(&Slot { node: top, lane: 1 }, bounds, Child::node(below));
            top = below;
        }
        accel
    }

    /// Makes an empty node the root of a binary tree over `ids`.
    fn fill(&mut self, root: usize, binary: &Bvh2, corners: &[[Vec3; 3]], ids: &[u32]) {
        let members = if binary.nodes[0].is_leaf() { vec![0] } else { children_of(binary, 0) };
        let mut open = vec![(members, root)];
        while let Some((members, node)) = open.pop() {
            for (lane, &member) in members.iter().enumerate() {
                let source = &binary.nodes[member];
                let slot = Slot { node, lane };
                if source.is_leaf() {
                    let first = source.first_index as usize;
                    let run = &binary.primitive_indices[first..first + source.prim_count as usize];
                    let leaf: Vec<u32> = run.iter().map(|&i| ids[i as usize]).collect();
                    self.hang_leaf(&slot, corners, &leaf);
                } else {
                    let index = self.nodes.len();
                    self.nodes.push(Node::EMPTY);
                    self.hang(&slot, bounds_of(&source.aabb), Child::node(index));
                    open.push((children_of(binary, member), index));
                }
            }
        }
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

/// Triangles of like size, in rising order of size: those of a scene that reaches from ripples to the horizon do not
/// belong into one tree, whose cost measure would see the ripples as a point.
fn by_scale(corners: &[[Vec3; 3]]) -> Vec<Vec<u32>> {
    let extent = |v: &[Vec3; 3]| triangle_bounds(v).size().max_element();
    let mut extents: Vec<f32> = corners.iter().map(extent).collect();
    let middle = extents.len() / 2;
    let median = *extents.select_nth_unstable_by(middle, f32::total_cmp).1;
    let mut scales: Vec<Vec<u32>> = Vec::new();
    for (id, v) in corners.iter().enumerate() {
        let mut scale = 0;
        let mut limit = median * SCALE_STEP;
        while extent(v) > limit && limit > 0.0 && scale + 1 < MOST_SCALES {
            limit *= SCALE_STEP;
            scale += 1;
        }
        scales.resize_with(scales.len().max(scale + 1), Vec::new);
        scales[scale].push(id as u32);
    }
    scales.retain(|ids| !ids.is_empty());
    scales
}

fn bvh2_of(corners: &[[Vec3; 3]], ids: &[u32]) -> Bvh2 {
    let boxes: Vec<Aabb> = ids
        .iter()
        .map(|&id| {
            let b = triangle_bounds(&corners[id as usize]);
            Aabb::new(b.min.into(), b.max.into())
        })
        .collect();
    let order = (0..boxes.len() as u32).collect();
    let builder = PlocBuilder::with_capacity(boxes.len());
    let mut bvh = { builder }.build(PlocSearchDistance::Medium, &boxes, order, SortPrecision::U64, 1);
    ReinsertionOptimizer::default().run(&mut bvh, REINSERTION_RATIO, None);
    collapse(&mut bvh, LEAF_SIZE as u32, 3.0);
    bvh
}

fn around(corners: &[[Vec3; 3]], ids: &[u32]) -> Bounds {
    ids.iter().fold(Bounds::EMPTY, |all, &id| all.union(triangle_bounds(&corners[id as usize])))
}

fn bounds_of(aabb: &Aabb) -> Bounds {
    Bounds { min: aabb.min.into(), max: aabb.max.into() }
}
