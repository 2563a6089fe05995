//! From a binary tree over triangles to wide nodes and leaves of neighbouring triangles.

use glam::Vec3;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;

use super::leaf::{Leaf, LeafIds};
use super::node::{Child, Node};
use super::{Accel, TriangleId};
use crate::geometry::Bounds;

/// The triangles that a tree is made over.
#[derive(Clone, Copy)]
pub(super) struct Soup<'a> {
    pub positions: &'a [Vec3],
    pub triangles: &'a [[u32; 3]],
}

/// Collapses a binary tree whose leaves stand for single triangles: that with index i for `ids[i]`.
///
/// A node's surface area times the cost of a visit, summed over the tree, is the expected time of a ray. Which
/// binary nodes stay is chosen so that the sum is least `[YLITIE17]`: with c(n, i) the least cost of what
/// is below n when it takes at most i of the places in the node above,
///
/// ```text
/// c(n, 1) = area(n) LEAF                            where n becomes a leaf
/// c(n, 1) = area(n) NODE + d(n, 8)                  where n becomes a node
/// c(n, i) = min(c(n, i - 1), d(n, i))
/// d(n, i) = min over 0 < k < i of c(left, k) + c(right, i - k)
/// ```
pub(super) struct Collapse<'a> {
    soup: Soup<'a>,
    binary: &'a Bvh2,
    ids: &'a [TriangleId],
    /// Triangles below each binary node, at most [`TOO_MANY`]; 0 in a leaf of the wide tree.
    plans: Vec<Plan>,
}

/// How the tree below a binary node is best divided.
#[derive(Clone, Copy)]
struct Plan {
    /// The least cost with one place, two, ...
    costs: [f32; PLACES],
    /// How many of the places the left child gets; 0: the node stays whole.
    left: [u8; PLACES + 1],
    /// Triangles, at most [`TOO_MANY`].
    count: u8,
    is_leaf: bool,
}

/// Places that a node can take in the one above: one is left to its sibling.
const PLACES: usize = Node::WIDTH - 1;

/// More triangles than a leaf could hold.
const TOO_MANY: u8 = Leaf::MOST as u8 + 1;

/// Time of a node's test and of a leaf's.
const NODE_COST: f32 = 1.0;
const LEAF_COST: f32 = 1.0;

impl Plan {
    fn leaf(cost: f32, count: u8) -> Self {
        Self { costs: [cost; PLACES], left: [0; PLACES + 1], count, is_leaf: true }
    }

    /// The plan for a node that is too large for a leaf.
    fn inner(area: f32, count: u8, left: &Self, right: &Self) -> Self {
        let mut plan = Self { costs: [0.0; PLACES], left: [0; PLACES + 1], count, is_leaf: false };
        let divide = |places: usize| {
            let cost = |k: &usize| left.costs[k - 1] + right.costs[places - k - 1];
            let best = (1..places).min_by(|a, b| cost(a).total_cmp(&cost(b))).unwrap_or(1);
            (cost(&best), best as u8)
        };
        // In a node of its own.
        let (below, share) = divide(Node::WIDTH);
        plan.costs[0] = area * NODE_COST + below;
        plan.left[PLACES] = share;
        for places in 2..=PLACES {
            let (cost, share) = divide(places);
            let whole = plan.costs[places - 2];
            (plan.costs[places - 1], plan.left[places - 1]) =
                if cost < whole { (cost, share) } else { (whole, 0) };
        }
        plan
    }
}

impl<'a> Collapse<'a> {
    pub fn new(soup: Soup<'a>, binary: &'a Bvh2, ids: &'a [TriangleId]) -> Self {
        let mut collapse = Self { soup, binary, ids, plans: Vec::new() };
        collapse.plan();
        collapse
    }

    /// Plans every node, children before parents.
    fn plan(&mut self) {
        self.plans = vec![Plan::leaf(0.0, 1); self.binary.nodes.len()];
        let mut open = vec![(0, false)];
        while let Some((node, children_done)) = open.pop() {
            let source = &self.binary.nodes[node];
            let area = source.aabb.half_area();
            if source.is_leaf() {
                self.plans[node] = Plan::leaf(area * LEAF_COST, 1);
            } else if children_done {
                let [left, right] = self.pair(node);
                let (left, right) = (self.plans[left], self.plans[right]);
                let count = (left.count + right.count).min(TOO_MANY);
                let apart = left.costs[0] + right.costs[0];
                let may_be_leaf = left.is_leaf && right.is_leaf && area * LEAF_COST <= apart * 1.5;
                self.plans[node] = if may_be_leaf && count < TOO_MANY && self.leaf(node).is_some() {
                    Plan::leaf(area * LEAF_COST, count)
                } else {
                    Plan::inner(area, count, &left, &right)
                };
            } else {
                let [left, right] = self.pair(node);
                open.extend([(node, true), (left, false), (right, false)]);
            }
        }
    }

    /// Appends the tree to the hierarchy and returns its top.
    pub fn append_to(&self, accel: &mut Accel) -> Child {
        let mut open = Vec::new();
        let top = self.child(0, accel, &mut open);
        while let Some((binary, node)) = open.pop() {
            for (lane, member) in self.members(binary).into_iter().enumerate() {
                let child = self.child(member, accel, &mut open);
                accel.nodes[node].hang(lane, bounds_of(&self.binary.nodes[member].aabb), child);
            }
        }
        top
    }

    fn child(&self, binary: usize, accel: &mut Accel, open: &mut Vec<(usize, usize)>) -> Child {
        if self.plans[binary].is_leaf
            && let Some(leaf) = self.leaf(binary)
        {
            return accel.push_leaf(leaf);
        }
        let index = accel.push_node();
        open.push((binary, index));
        Child::node(index)
    }

    /// The descendants that take the places in the node that a binary node becomes.
    fn members(&self, node: usize) -> Vec<usize> {
        let mut members = Vec::new();
        let share = usize::from(self.plans[node].left[PLACES]);
        let [left, right] = self.pair(node);
        let mut open = vec![(left, share), (right, Node::WIDTH - share)];
        while let Some((node, mut places)) = open.pop() {
            let plan = &self.plans[node];
            // Fewer places may do as well.
            while places > 1 && plan.left[places - 1] == 0 {
                places -= 1;
            }
            if places == 1 {
                members.push(node);
                continue;
            }
            let share = usize::from(plan.left[places - 1]);
            let [left, right] = self.pair(node);
            open.extend([(right, places - share), (left, share)]);
        }
        members
    }

    fn pair(&self, node: usize) -> [usize; 2] {
        [0, 1].map(|side| self.binary.nodes[node].first_index as usize + side)
    }

    /// The leaf that a subtree becomes, if it fits.
    fn leaf(&self, node: usize) -> Option<(Leaf, LeafIds)> {
        let mut ids = [Leaf::NO_TRIANGLE; Leaf::MOST];
        let mut len = 0;
        let mut open = vec![node];
        while let Some(node) = open.pop() {
            let source = &self.binary.nodes[node];
            if source.is_leaf() {
                ids[len] = self.ids[self.binary.primitive_indices[source.first_index as usize] as usize];
                len += 1;
            } else {
                open.extend(self.pair(node));
            }
        }
        let leaf = Leaf::over(&ids[..len], self.soup.positions, self.soup.triangles)?;
        Some((leaf, ids))
    }
}

fn bounds_of(aabb: &Aabb) -> Bounds {
    Bounds { min: aabb.min.into(), max: aabb.max.into() }
}
