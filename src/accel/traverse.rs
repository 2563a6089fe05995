//! Walks the tree: nearer children first, popped children culled again against the best hit so far.

use super::leaf::{Candidates, Leaf, LeafRay};
use super::machine::{Eight, Lanes, Stack, WithLanes, with_best};
use super::node::{Child, Node, NodeRay};
use super::{Accel, Hit, MAX_DEPTH, TriangleId};
use crate::geometry::Ray;
use crate::geometry::triangle::RayCast;

/// Triangles that a ray must not meet: the one it starts on, the one it ends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ignored(pub [TriangleId; 2]);

impl Ignored {
    /// Every triangle counts.
    pub const NOTHING: Self = Self([Leaf::NO_TRIANGLE; 2]);

    /// All but one triangle count.
    pub fn one(triangle: TriangleId) -> Self {
        Self([triangle, Leaf::NO_TRIANGLE])
    }

    #[inline]
    fn contains(self, id: TriangleId) -> bool {
        self.0[0] == id || self.0[1] == id
    }
}

/// A node leaves at most seven children behind while the eighth is visited.
const STACK_SIZE: usize = (Node::WIDTH - 1) * MAX_DEPTH + 1;

/// A child that still has to be visited: the bits of the distance at which it is entered, which order like the
/// distances since none is negative, above those of the child.
type Entry = u64;

fn entry(near: f32, child: Child) -> Entry {
    u64::from(near.to_bits()) << 32 | u64::from(child.0)
}

/// The last pushed child that is entered before or at `t_max`.
#[inline(always)]
fn pop(stack: &mut Stack<STACK_SIZE>, t_max: f32) -> Option<Child> {
    while let Some(entry) = stack.pop() {
        if f32::from_bits((entry >> 32) as u32) <= t_max {
            return Some(Child(entry as u32));
        }
    }
    None
}

/// Returns the nearest of the entered children and leaves the others on the stack, the farthest lowest.
#[inline(always)]
fn nearest_first<L: Lanes>(
    stack: &mut Stack<STACK_SIZE>,
    near: L,
    mut entered: u32,
    children: &[Child; 8],
) -> Child {
    let first = entered.trailing_zeros() as usize & 7;
    entered &= entered - 1;
    if entered == 0 {
        return children[first];
    }
    let mut distances = Eight([0.0; 8]);
    near.store(&mut distances);
    let at = |lane: usize| entry(distances.0[lane], children[lane]);
    let second = entered.trailing_zeros() as usize & 7;
    entered &= entered - 1;
    let (a, b) = (at(first), at(second));
    let mut nearest = a.min(b);
    let base = stack.len();
    stack.push(a.max(b));
    while entered != 0 {
        let lane = entered.trailing_zeros() as usize & 7;
        entered &= entered - 1;
        let new = at(lane);
        stack.push(new.max(nearest));
        nearest = nearest.min(new);
        stack.sink(base);
    }
    Child(nearest as u32)
}

impl Accel {
    /// The nearest triangle at or before `ray.t_max`; the lower index among those at the same distance.
    pub fn closest(&self, ray: &Ray, ignored: Ignored) -> Option<Hit> {
        with_best(Closest { accel: self, ray, ignored })
    }

    /// True when anything but the ignored triangles lies at or before `ray.t_max`.
    pub fn occluded(&self, ray: &Ray, ignored: Ignored) -> bool {
        with_best(Occluded { accel: self, ray, ignored })
    }

    /// Shows every leaf that the ray may enter before `t_max`, and which of its triangles it may meet, to `visit`,
    /// until that returns true.
    #[inline(always)]
    fn walk<L: Lanes>(
        &self,
        cast: &RayCast,
        t_max: &mut f32,
        mut visit: impl FnMut(&Leaf, usize, Candidates, &mut f32) -> bool,
    ) -> bool {
        if self.nodes.is_empty() {
            return false;
        }
        let (node_ray, leaf_ray) = (NodeRay::<L>::new(&cast.outer), LeafRay::<L>::new(cast));
        let mut stack = Stack::new();
        let mut next = Some(Child::node(0));
        while let Some(child) = next {
            if let Some(index) = child.as_node() {
                let node = &self.nodes[index];
                let (near, entered) = node.enter(&node_ray, *t_max);
                if entered != 0 {
                    next = Some(nearest_first(&mut stack, near, entered, &node.children));
                    continue;
                }
            } else if let Some(index) = child.as_leaf() {
                let leaf = &self.leaves[index];
                if let Some(candidates) = leaf.candidates(&leaf_ray)
                    && visit(leaf, index, candidates, t_max)
                {
                    return true;
                }
            }
            next = pop(&mut stack, *t_max);
        }
        false
    }
}

struct Closest<'a> {
    accel: &'a Accel,
    ray: &'a Ray,
    ignored: Ignored,
}

impl WithLanes for Closest<'_> {
    type Output = Option<Hit>;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Option<Hit> {
        let Self { accel, ray, ignored } = self;
        let cast = RayCast::new(ray);
        let mut best: Option<Hit> = None;
        let mut t_max = ray.t_max;
        accel.walk::<L>(&cast, &mut t_max, |leaf, index, mut candidates, t_max| {
            while let Some((lane, edges)) = candidates.next() {
                let turned = leaf.turned_triangle(lane, cast.turn.axes());
                let Some(found) = cast.settle(edges, turned, *t_max) else { continue };
                let triangle = accel.ids[index][lane];
                let tied = best.is_some_and(|b| found.t == b.t && triangle > b.triangle);
                if !tied && !ignored.contains(triangle) {
                    *t_max = found.t;
                    let (t, barycentric, from_front) = (found.t, found.barycentric, found.from_front);
                    best = Some(Hit { triangle, t, barycentric, from_front });
                }
            }
            false
        });
        best
    }
}

struct Occluded<'a> {
    accel: &'a Accel,
    ray: &'a Ray,
    ignored: Ignored,
}

impl WithLanes for Occluded<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(self) -> bool {
        let Self { accel, ray, ignored } = self;
        let cast = RayCast::new(ray);
        let mut t_max = ray.t_max;
        accel.walk::<L>(&cast, &mut t_max, |leaf, index, mut candidates, t_max| {
            while let Some((lane, edges)) = candidates.next() {
                let turned = leaf.turned_triangle(lane, cast.turn.axes());
                if !ignored.contains(accel.ids[index][lane]) && cast.settle(edges, turned, *t_max).is_some() {
                    return true;
                }
            }
            false
        })
    }
}
