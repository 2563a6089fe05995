//! Builds the tree with obvhs and lays it out for traversal.

use glam::Vec3;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use super::{Accel, Child, MAX_DEPTH, Node};
use crate::geometry::Bounds;
use crate::geometry::triangle::triangle_bounds;

/// Triangles in a leaf, at most.
const LEAF_SIZE: usize = 4;

impl Accel {
    /// Builds the hierarchy over `triangles` (index triples into `positions`, all finite and in range).
    pub fn build(positions: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        if triangles.is_empty() {
            return Self::default();
        }
        let corners: Vec<[Vec3; 3]> = triangles.iter().map(|t| t.map(|i| positions[i as usize])).collect();
        let mut accel = Self::from_bvh2(&corners, &bvh2_of(&corners));
        if accel.depth() > MAX_DEPTH {
            accel = Self::balanced(&corners, std::mem::take(&mut accel.ids));
        }
        accel
    }

    /// Copies the tree of obvhs, node pairs becoming single nodes and single-triangle subtrees leaves of a run.
    fn from_bvh2(corners: &[[Vec3; 3]], bvh: &Bvh2) -> Self {
        let mut accel = Self { bounds: bounds_of(&bvh.nodes[0].aabb), ..Self::default() };
        accel.nodes.reserve(bvh.nodes.len() / 2 + 1);
        if bvh.nodes[0].is_leaf() {
            let leaf = accel.leaf(corners, &bvh.primitive_indices);
            accel.nodes.push(Node { children: [leaf, absent()] });
            return accel;
        }
        accel.nodes.push(Node { children: [absent(), absent()] });
        let mut open = vec![(0_usize, 0_usize)];
        while let Some((source, target)) = open.pop() {
            let first = bvh.nodes[source].first_index as usize;
            for side in 0..2 {
                let node = &bvh.nodes[first + side];
                accel.nodes[target].children[side] = if node.is_leaf() {
                    let start = node.first_index as usize;
                    accel.leaf(corners, &bvh.primitive_indices[start..start + node.prim_count as usize])
                } else {
                    let index = accel.nodes.len();
                    accel.nodes.push(Node { children: [absent(), absent()] });
                    open.push((first + side, index));
                    Child { bounds: bounds_of(&node.aabb), first: index as u32, count: 0 }
                };
            }
        }
        accel
    }

    /// A tree that halves the given order until a leaf's size is reached: depth log2(n) whatever the geometry.
    fn balanced(corners: &[[Vec3; 3]], order: Vec<u32>) -> Self {
        let mut accel = Self::default();
        accel.nodes.push(Node { children: [absent(), absent()] });
        let whole = accel.halve(corners, &order);
        accel.bounds = whole.bounds;
        accel.nodes[0] = Node { children: [whole, absent()] };
        accel
    }

    fn halve(&mut self, corners: &[[Vec3; 3]], order: &[u32]) -> Child {
        if order.len() <= LEAF_SIZE {
            return self.leaf(corners, order);
        }
        let index = self.nodes.len();
        self.nodes.push(Node { children: [absent(), absent()] });
        let (left, right) = order.split_at(order.len() / 2);
        let children = [self.halve(corners, left), self.halve(corners, right)];
        self.nodes[index] = Node { children };
        Child { bounds: children[0].bounds.union(children[1].bounds), first: index as u32, count: 0 }
    }

    fn leaf(&mut self, corners: &[[Vec3; 3]], ids: &[u32]) -> Child {
        let first = self.ids.len() as u32;
        let mut bounds = Bounds::EMPTY;
        for &id in ids {
            let v = corners[id as usize];
            bounds = bounds.union(triangle_bounds(&v));
            self.vertices.push(v);
            self.ids.push(id);
        }
        Child { bounds, first, count: ids.len() as u32 }
    }

    /// Number of nodes on the longest way down.
    pub(super) fn depth(&self) -> usize {
        let mut deepest = 0;
        let mut open = vec![(0_usize, 1_usize)];
        while let Some((index, depth)) = open.pop() {
            deepest = deepest.max(depth);
            open.extend(
                self.nodes[index]
                    .children
                    .iter()
                    .filter(|c| c.count == 0)
                    .map(|c| (c.first as usize, depth + 1)),
            );
        }
        deepest
    }
}

fn bvh2_of(corners: &[[Vec3; 3]]) -> Bvh2 {
    let boxes: Vec<Aabb> = corners
        .iter()
        .map(|v| {
            let b = triangle_bounds(v);
            Aabb::new(b.min.into(), b.max.into())
        })
        .collect();
    let mut bvh = PlocBuilder::with_capacity(boxes.len()).build(
        PlocSearchDistance::Medium,
        &boxes,
        (0..boxes.len() as u32).collect(),
        SortPrecision::U64,
        1,
    );
    obvhs::bvh2::reinsertion::ReinsertionOptimizer::default().run(&mut bvh, 0.02, None);
    obvhs::bvh2::leaf_collapser::collapse(&mut bvh, LEAF_SIZE as u32, 1.0);
    bvh
}

fn absent() -> Child {
    Child { bounds: Bounds::EMPTY, first: 0, count: Child::ABSENT }
}

fn bounds_of(aabb: &Aabb) -> Bounds {
    Bounds { min: aabb.min.into(), max: aabb.max.into() }
}
