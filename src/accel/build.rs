//! Builds binary trees over clusters of triangles with obvhs, one for each scale, and hangs them under one node.
//!
//! Triangles that never change come first: their nodes and leaves do too, so that those of the others can be cut off
//! and made anew behind them.

use glam::Vec3;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use super::clusters::{Cluster, clusters};
use super::collapse::Collapse;
use super::leaf::{Leaf, LeafIds};
use super::node::{Child, Node};
use super::scales::Scale;
use super::soup::{Soup, bounds_of};
use super::{Accel, MAX_DEPTH, TriangleId};
use crate::geometry::Bounds;
use crate::geometry::machine::on_large_pages;

/// Part of the binary tree that reinsertion tries to place better, mostly at the top. Rays were as fast with 0.02 and
/// 0.2 to within what could be measured.
const REINSERTION_RATIO: f32 = 0.05;

/// Trees that still triangles are spread over, at most: the others have the rest of the root's places.
const STILL_SCALES: usize = 3;

/// The part of the hierarchy that stays when the rest is built anew.
#[derive(Clone, Debug)]
pub(super) struct Still {
    /// Numbers of triangles, nodes, and leaves, all of which come first.
    pub triangles: usize,
    pub nodes: usize,
    pub leaves: usize,
    /// The root without the others.
    pub root: Node,
    pub bounds: Bounds,
}

impl Accel {
    /// Builds the hierarchy over `triangles` (index triples into `positions`, all finite and in range).
    pub fn build(positions: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        Self::build_over(positions, triangles, 0)
    }

    /// Builds the hierarchy over triangles of which the first `still` are the same in every frame.
    pub fn build_over(positions: &[Vec3], triangles: &[[u32; 3]], still: usize) -> Self {
        let mut accel = Self::default();
        accel.rebuild(positions, triangles, still);
        accel
    }

    /// Builds the hierarchy over other triangles, the first `still` of which are those that it had: their part of it
    /// stays as it is.
    pub fn rebuild(&mut self, positions: &[Vec3], triangles: &[[u32; 3]], still: usize) {
        debug_assert!(still <= triangles.len());
        self.motion = None;
        let soup = Soup { positions, triangles };
        if still != self.still.triangles {
            self.still = Still::NOTHING;
            self.cut();
            self.add_still(soup, still);
        }
        self.cut();
        self.triangles = triangles.len();
        self.built_cost = None;
        let taken = self.still.lanes();
        let scales = Scale::all(soup, still..triangles.len(), Node::WIDTH - taken);
        match &*scales {
            [] => {}
            [scale] if taken == 0 => {
                let (bounds, top) = self.append(soup, scale);
                self.bounds = bounds;
                if top.as_leaf().is_some() {
                    let root = self.push_node();
                    self.nodes[root].hang(0, bounds, top);
                }
            }
            _ => self.hang_scales(soup, &scales, taken),
        }
        self.settle_memory();
    }

    /// For large hierarchies: where the arrays stay for the life of a frame.
    pub(super) fn settle_memory(&self) {
        on_large_pages(&self.nodes);
        on_large_pages(&self.leaves);
    }

    /// Leaves nothing but what is still.
    fn cut(&mut self) {
        self.nodes.truncate(self.still.nodes);
        self.leaves.truncate(self.still.leaves);
        self.ids.truncate(self.still.leaves);
        if let Some(root) = self.nodes.first_mut() {
            *root = self.still.root;
        }
        self.bounds = self.still.bounds;
    }

    fn add_still(&mut self, soup: Soup, still: usize) {
        let scales = Scale::all(soup, 0..still, STILL_SCALES);
        if scales.is_empty() {
            return;
        }
        self.hang_scales(soup, &scales, 0);
        self.still = Still {
            triangles: still,
            nodes: self.nodes.len(),
            leaves: self.leaves.len(),
            root: self.nodes[0],
            bounds: self.bounds,
        };
    }

    /// Hangs a tree for each scale under the root, behind what hangs in the first lanes.
    fn hang_scales(&mut self, soup: Soup, scales: &[Scale], taken: usize) {
        if self.nodes.is_empty() {
            self.push_node();
        }
        for (scale, lane) in scales.iter().zip(taken..) {
            let (bounds, top) = self.append(soup, scale);
            self.bounds = self.bounds.union(bounds);
            self.nodes[0].hang(lane, bounds, top);
        }
    }

    /// Appends a tree; its box and its top.
    fn append(&mut self, soup: Soup, scale: &Scale) -> (Bounds, Child) {
        let (nodes, leaves) = (self.nodes.len(), self.leaves.len());
        let clusters = clusters(soup, scale);
        let binary = binary_tree(&clusters);
        let bounds = bounds_of(binary.nodes[0].aabb());
        let top = Collapse::new(soup, &clusters, &binary).append_to(self);
        // One is left for the root.
        if self.depth_from(nodes) < MAX_DEPTH {
            return (bounds, top);
        }
        self.nodes.truncate(nodes);
        self.leaves.truncate(leaves);
        self.ids.truncate(leaves);
        (bounds, self.append_balanced(soup, &scale.ids))
    }

    /// Appends a tree that divides the given order by eight until leaves are small enough: its depth is log8 of the
    /// number of triangles whatever their geometry.
    fn append_balanced(&mut self, soup: Soup, order: &[TriangleId]) -> Child {
        let top = self.push_node();
        let mut open = vec![(order, top)];
        while let Some((order, node)) = open.pop() {
            for (lane, part) in order.chunks(order.len().div_ceil(Node::WIDTH)).enumerate() {
                let child = match soup.leaf(part) {
                    Some(leaf) => self.push_leaf(leaf),
                    None => {
                        let index = self.push_node();
                        open.push((part, index));
                        Child::node(index)
                    }
                };
                self.nodes[node].hang(lane, soup.around(part), child);
            }
        }
        Child::node(top)
    }

    pub(super) fn push_node(&mut self) -> usize {
        self.nodes.push(Node::EMPTY);
        self.nodes.len() - 1
    }

    pub(super) fn push_leaf(&mut self, (leaf, ids): (Leaf, LeafIds)) -> Child {
        self.leaves.push(leaf);
        self.ids.push(ids);
        Child::leaf(self.leaves.len() - 1)
    }

    /// Number of nodes on the longest way down.
    pub(super) fn depth(&self) -> usize {
        self.depth_from(0)
    }

    /// Number of nodes on the longest way down among those from an index on.
    fn depth_from(&self, first: usize) -> usize {
        let nodes = &self.nodes[first..];
        let mut depths = vec![1; nodes.len()];
        for (index, node) in nodes.iter().enumerate() {
            for child in node.children.iter().filter_map(|c| c.as_node()) {
                depths[child - first] = depths[index] + 1;
            }
        }
        depths.into_iter().max().unwrap_or(0)
    }
}

impl Still {
    /// Everything moves.
    pub const NOTHING: Self =
        Self { triangles: 0, nodes: 0, leaves: 0, root: Node::EMPTY, bounds: Bounds::EMPTY };

    /// Number of the root's lanes that are taken: the first.
    pub fn lanes(&self) -> usize {
        self.root.children.iter().filter(|&&child| child != Child::NOTHING).count()
    }
}

impl Default for Still {
    fn default() -> Self {
        Self::NOTHING
    }
}

/// A binary tree whose leaves are single clusters, their indices being the first.
fn binary_tree(clusters: &[Cluster]) -> Bvh2 {
    let boxes: Vec<Aabb> = clusters.iter().map(Cluster::aabb).collect();
    let order = (0..boxes.len() as u32).collect();
    let mut binary = PlocBuilder::new().build(PlocSearchDistance::Low, &boxes, order, SortPrecision::U64, 1);
    ReinsertionOptimizer::default().run(&mut binary, REINSERTION_RATIO, None);
    binary
}
