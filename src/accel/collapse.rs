//! From a binary tree over clusters of triangles to wide nodes.
//!
//! A node's surface area, summed over the tree, is the expected number of nodes that a ray visits. Which binary nodes
//! stay is chosen so that the sum is least `[YLITIE17]`: with c(n, i) the least sum of what is below n when it takes at
//! most i of the places in the node above,
//!
//! ```text
//! c(n, i) = 0                                       where n is a leaf
//! c(n, 1) = area(n) + d(n, 8)                       elsewhere
//! c(n, i) = min(c(n, i - 1), d(n, i))
//! d(n, i) = min over 0 < k < i of c(left, k) + c(right, i - k)
//! ```
//!
//! The leaves are clusters of triangles, gathered before: they are the same whatever is chosen. Time is linear; memory
//! is seven bytes a binary node.

use obvhs::bvh2::Bvh2;

use super::Accel;
use super::clusters::Cluster;
use super::node::{Child, Node};
use super::soup::{Soup, bounds_of};

/// Places that a node can take in the one above: one is left to its sibling.
const PLACES: usize = Node::WIDTH - 1;

/// Collapses a binary tree whose leaves stand for single clusters, their indices being the first.
pub(super) struct Collapse<'a> {
    soup: Soup<'a>,
    clusters: &'a [Cluster],
    binary: &'a Bvh2,
    plans: Vec<Shares>,
}

/// How many of two places, three, ..., eight the left child gets; 0: the node does with one less.
type Shares = [u8; PLACES];

/// The least cost of what is below a binary node with one place, two, ...
#[derive(Clone, Copy)]
struct Subtree {
    costs: [f32; PLACES],
}

impl Subtree {
    /// Becomes what holds both; how it is divided.
    fn join(&mut self, area: f32, right: &Self) -> Shares {
        let left = self.costs;
        let mut shares = [0; PLACES];
        let divide = |places: usize| {
            let mut best = (left[0] + right.costs[places - 2], 1);
            for k in 2..places {
                let cost = left[k - 1] + right.costs[places - k - 1];
                if cost < best.0 {
                    best = (cost, k as u8);
                }
            }
            best
        };
        // In a node of its own.
        let (below, share) = divide(Node::WIDTH);
        self.costs[0] = area + below;
        shares[Node::WIDTH - 2] = share;
        for places in 2..=PLACES {
            let (cost, share) = divide(places);
            self.costs[places - 1] = self.costs[places - 2];
            if cost < self.costs[places - 1] {
                self.costs[places - 1] = cost;
                shares[places - 2] = share;
            }
        }
        shares
    }
}

impl<'a> Collapse<'a> {
    pub fn new(soup: Soup<'a>, clusters: &'a [Cluster], binary: &'a Bvh2) -> Self {
        let plans = vec![[0; PLACES]; binary.nodes.len()];
        let mut collapse = Self { soup, clusters, binary, plans };
        collapse.plan();
        collapse
    }

    /// Plans every node, children before parents.
    fn plan(&mut self) {
        let mut done: Vec<Subtree> = Vec::new();
        let mut open = vec![(0, false)];
        while let Some((node, children_done)) = open.pop() {
            let source = &self.binary.nodes[node];
            if source.is_leaf() {
                done.push(Subtree { costs: [0.0; PLACES] });
            } else if !children_done {
                let [left, right] = self.pair(node);
                open.extend([(node, true), (right, false), (left, false)]);
            } else if let Some(right) = done.pop()
                && let Some(left) = done.last_mut()
            {
                self.plans[node] = left.join(source.aabb().half_area(), &right);
            }
        }
    }

    /// Appends the tree to the hierarchy and returns its top.
    pub fn append_to(&self, accel: &mut Accel) -> Child {
        accel.leaves.reserve(self.clusters.len());
        accel.ids.reserve(self.clusters.len());
        let mut open = Vec::new();
        let top = self.child(0, accel, &mut open);
        while let Some((binary, node)) = open.pop() {
            let (members, count) = self.members(binary);
            for (lane, &member) in members[..count].iter().enumerate() {
                let child = self.child(member, accel, &mut open);
                accel.nodes[node].hang(lane, bounds_of(self.binary.nodes[member].aabb()), child);
            }
        }
        top
    }

    fn child(&self, binary: usize, accel: &mut Accel, open: &mut Vec<(usize, usize)>) -> Child {
        let source = &self.binary.nodes[binary];
        if source.is_leaf() {
            let ids = self.clusters[source.first_index as usize].ids();
            // Gathered within the limits of a leaf.
            return self.soup.leaf(ids).map_or(Child::NOTHING, |leaf| accel.push_leaf(leaf));
        }
        let index = accel.push_node();
        open.push((binary, index));
        Child::node(index)
    }

    /// The descendants that take the places in the node that a binary node becomes, and how many they are.
    fn members(&self, node: usize) -> ([usize; Node::WIDTH], usize) {
        let mut members = [0; Node::WIDTH];
        let mut count = 0;
        let mut open = [(0, 0); Node::WIDTH];
        open[0] = (node, Node::WIDTH);
        let mut len = 1;
        while len > 0 {
            len -= 1;
            let (node, places) = open[len];
            if let Some(shares) = self.shares(node, places) {
                let [left, right] = self.pair(node);
                // Each has a place at least, so they are never more than the places.
                open[len] = (right, shares[1]);
                open[len + 1] = (left, shares[0]);
                len += 2;
            } else {
                members[count] = node;
                count += 1;
            }
        }
        (members, count)
    }

    /// The places of the left and the right child; none where the node stays whole.
    fn shares(&self, node: usize, places: usize) -> Option<[usize; 2]> {
        let shares = &self.plans[node];
        // Fewer places may do as well.
        let fewer = shares[..places - 1].iter().rposition(|&share| share > 0)?;
        let left = usize::from(shares[fewer]);
        Some([left, fewer + 2 - left])
    }

    fn pair(&self, node: usize) -> [usize; 2] {
        let first = self.binary.nodes[node].first_index as usize;
        [first, first + 1]
    }
}
