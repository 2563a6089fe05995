//! Walks the tree: nearer children first, popped children culled again against the best hit so far.

use glam::Vec4;

use super::{Accel, Child, Hit, Leaf, MAX_DEPTH, TriangleId};
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

/// A node leaves at most three children behind while the fourth is visited.
const STACK_SIZE: usize = 3 * MAX_DEPTH + 1;

/// Children that still have to be visited, with the distances at which they are entered.
struct Stack {
    entries: [(f32, Child); STACK_SIZE],
    len: usize,
}

impl Stack {
    /// The last pushed child that is entered before or at `t_max`.
    #[inline(always)]
    fn pop(&mut self, t_max: f32) -> Option<Child> {
        while self.len > 0 {
            self.len -= 1;
            let (near, child) = self.entries[self.len];
            if near <= t_max {
                return Some(child);
            }
        }
        None
    }
}

impl Accel {
    /// The nearest triangle at or before `ray.t_max`; the lower index among those at the same distance.
    pub fn closest(&self, ray: &Ray, ignored: Ignored) -> Option<Hit> {
        let cast = RayCast::new(ray);
        match cast.axis {
            0 => self.closest_along::<0>(&cast, ray.t_max, ignored),
            1 => self.closest_along::<1>(&cast, ray.t_max, ignored),
            _ => self.closest_along::<2>(&cast, ray.t_max, ignored),
        }
    }

    /// True when anything but the ignored triangles lies at or before `ray.t_max`.
    pub fn occluded(&self, ray: &Ray, ignored: Ignored) -> bool {
        let cast = RayCast::new(ray);
        match cast.axis {
            0 => self.occluded_along::<0>(&cast, ray.t_max, ignored),
            1 => self.occluded_along::<1>(&cast, ray.t_max, ignored),
            _ => self.occluded_along::<2>(&cast, ray.t_max, ignored),
        }
    }

    fn closest_along<const K: usize>(&self, cast: &RayCast, t_max: f32, ignored: Ignored) -> Option<Hit> {
        let mut best: Option<Hit> = None;
        let mut t_max = t_max;
        self.walk(cast, &mut t_max, |leaf, t_max| {
            let Some(hits) = cast.pack::<K>(&leaf.pack, *t_max) else { return false };
            for lane in hits.lanes() {
                let Some(found) = cast.settle(&hits, &leaf.pack, lane, *t_max) else { continue };
                let triangle = leaf.ids[lane];
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

    fn occluded_along<const K: usize>(&self, cast: &RayCast, t_max: f32, ignored: Ignored) -> bool {
        let mut t_max = t_max;
        self.walk(cast, &mut t_max, |leaf, t_max| {
            cast.pack::<K>(&leaf.pack, *t_max).is_some_and(|hits| {
                hits.lanes().any(|lane| {
                    !ignored.contains(leaf.ids[lane])
                        && cast.settle(&hits, &leaf.pack, lane, *t_max).is_some()
                })
            })
        })
    }

    /// Shows every leaf that the ray may enter before `t_max` to `visit`, until that returns true.
    #[inline(always)]
    fn walk(&self, cast: &RayCast, t_max: &mut f32, mut visit: impl FnMut(&Leaf, &mut f32) -> bool) -> bool {
        if self.nodes.is_empty() {
            return false;
        }
        let mut stack = Stack { entries: [(0.0, Child::NOTHING); STACK_SIZE], len: 0 };
        let mut next = Some(Child::node(0));
        while let Some(child) = next {
            let Some(index) = child.as_node() else {
                if let Some(leaf) = child.as_leaf()
                    && visit(&self.leaves[leaf], t_max)
                {
                    return true;
                }
                next = stack.pop(*t_max);
                continue;
            };
            let node = &self.nodes[index];
            let (near, far) = cast.slabs(&node.boxes);
            let entered = near.cmple(far) & near.cmple(Vec4::splat(*t_max));
            next = nearest_first(&mut stack, near, entered.bitmask(), &node.children)
                .or_else(|| stack.pop(*t_max));
        }
        false
    }
}

/// Returns the nearest of the entered children and leaves the others on the stack, the farthest lowest.
#[inline(always)]
fn nearest_first(stack: &mut Stack, near: Vec4, entered: u32, children: &[Child; 4]) -> Option<Child> {
    if entered == 0 {
        return None;
    }
    let base = stack.len;
    let mut rest = entered;
    while rest != 0 {
        let lane = rest.trailing_zeros() as usize & 3;
        rest &= rest - 1;
        let entry = (near[lane], children[lane]);
        // Insertion into at most three entries, nearest on top.
        let mut place = stack.len;
        while place > base && stack.entries[place - 1].0 < entry.0 {
            stack.entries[place] = stack.entries[place - 1];
            place -= 1;
        }
        stack.entries[place] = entry;
        stack.len += 1;
    }
    stack.len -= 1;
    Some(stack.entries[stack.len].1)
}
