//! Builds binary trees with obvhs, one for each scale of triangles, and hangs them under one node.

use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use glam::Vec3;

use super::collapse::{Collapse, Soup};
use super::leaf::{Leaf, LeafIds};
use super::node::{Child, Node};
use super::{Accel, MAX_DEPTH, TriangleId};
use crate::geometry::Bounds;
use crate::geometry::triangle::triangle_bounds;

/// Parts of the tree that reinsertion tries to place better.
const REINSERTION_RATIO: f32 = 0.05;

/// Triangles more than this many times larger than the median have a tree of their own, and so on upwards.
const SCALE_STEP: f32 = 16.0;

/// Trees that the triangles are spread over, at most.
const MOST_SCALES: usize = Node::WIDTH;

impl Accel {
    /// Builds the hierarchy over `triangles` (index triples into `positions`, all finite and in range).
    pub fn build(positions: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let mut accel = Self { triangles: triangles.len(), ..Self::default() };
        if triangles.is_empty() {
            return accel;
        }
        let soup = Soup { positions, triangles };
        let scales = by_scale(soup);
        accel.over_scales(soup, &scales);
        if accel.depth() > MAX_DEPTH {
            accel.clear();
            accel.balanced(soup, &scales.concat());
        }
        accel
    }

    /// A tree for the triangles of each scale, all under one node.
    fn over_scales(&mut self, soup: Soup, scales: &[Vec<TriangleId>]) {
        if let [ids] = scales {
            let binary = bvh2_of(soup, ids);
            self.bounds = soup.around(ids);
            let top = Collapse::new(soup, &binary, ids).append_to(self);
            if top.as_leaf().is_some() {
                let root = self.push_node();
                self.nodes[root].hang(0, self.bounds, top);
            }
            return;
        }
        let root = self.push_node();
        for (lane, ids) in scales.iter().enumerate() {
            let binary = bvh2_of(soup, ids);
            let top = Collapse::new(soup, &binary, ids).append_to(self);
            let bounds = soup.around(ids);
            self.bounds = self.bounds.union(bounds);
            self.nodes[root].hang(lane, bounds, top);
        }
    }

    /// A tree that divides the given order by eight until leaves are small enough: its depth is log8 of the number
    /// of triangles whatever their geometry.
    fn balanced(&mut self, soup: Soup, order: &[TriangleId]) {
        let root = self.push_node();
        self.bounds = soup.around(order);
        let mut open = vec![(order, root)];
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
    }

    fn clear(&mut self) {
        self.nodes.clear();
        self.leaves.clear();
        self.ids.clear();
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
        let mut depths = vec![1; self.nodes.len()];
        for index in 0..self.nodes.len() {
            for node in self.nodes[index].children.iter().filter_map(|c| c.as_node()) {
                depths[node] = depths[index] + 1;
            }
        }
        depths.into_iter().max().unwrap_or(0)
    }
}

impl Soup<'_> {
    fn corners(&self, id: TriangleId) -> [Vec3; 3] {
        self.triangles[id as usize].map(|i| self.positions[i as usize])
    }

    fn around(&self, ids: &[TriangleId]) -> Bounds {
        ids.iter().fold(Bounds::EMPTY, |all, &id| all.union(triangle_bounds(&self.corners(id))))
    }

    fn leaf(&self, ids: &[TriangleId]) -> Option<(Leaf, LeafIds)> {
        let leaf = Leaf::over(ids, self.positions, self.triangles)?;
        let mut all = [Leaf::NO_TRIANGLE; Leaf::MOST];
        all[..ids.len()].copy_from_slice(ids);
        Some((leaf, all))
    }
}

/// Triangles of like size, in rising order of size: those of a scene that reaches from ripples to the horizon do not
/// belong into one tree, whose cost measure would see the ripples as a point.
fn by_scale(soup: Soup) -> Vec<Vec<TriangleId>> {
    let extent = |id: TriangleId| triangle_bounds(&soup.corners(id)).size().max_element();
    let mut extents: Vec<f32> = (0..soup.triangles.len() as u32).map(extent).collect();
    let middle = extents.len() / 2;
    let median = *extents.select_nth_unstable_by(middle, f32::total_cmp).1;
    let mut scales: Vec<Vec<TriangleId>> = Vec::new();
    for id in 0..soup.triangles.len() as u32 {
        let mut scale = 0;
        let mut limit = median * SCALE_STEP;
        while extent(id) > limit && limit > 0.0 && scale + 1 < MOST_SCALES {
            limit *= SCALE_STEP;
            scale += 1;
        }
        scales.resize_with(scales.len().max(scale + 1), Vec::new);
        scales[scale].push(id);
    }
    scales.retain(|ids| !ids.is_empty());
    scales
}

fn bvh2_of(soup: Soup, ids: &[TriangleId]) -> Bvh2 {
    let boxes: Vec<Aabb> = ids
        .iter()
        .map(|&id| {
            let b = triangle_bounds(&soup.corners(id));
            Aabb::new(b.min.into(), b.max.into())
        })
        .collect();
    let order = (0..boxes.len() as u32).collect();
    let builder = PlocBuilder::with_capacity(boxes.len());
    let mut bvh = { builder }.build(PlocSearchDistance::Medium, &boxes, order, SortPrecision::U64, 1);
    ReinsertionOptimizer::default().run(&mut bvh, REINSERTION_RATIO, None);
    bvh
}
