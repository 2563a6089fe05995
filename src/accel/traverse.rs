//! Walks the tree: nearer child first, popped nodes culled again against the best hit so far.

use super::{Accel, Child, Hit, MAX_DEPTH, TriangleId};
use crate::geometry::Ray;
use crate::geometry::triangle::RayCast;

/// Triangles that a ray must not meet: the one it starts on, the one it ends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ignored(pub [TriangleId; 2]);

impl Ignored {
    const NO_TRIANGLE: TriangleId = TriangleId::MAX;

    /// Every triangle counts.
    pub const NOTHING: Self = Self([Self::NO_TRIANGLE; 2]);

    /// All but one triangle count.
    pub fn one(triangle: TriangleId) -> Self {
        Self([triangle, Self::NO_TRIANGLE])
    }

    fn contains(self, id: TriangleId) -> bool {
        self.0[0] == id || self.0[1] == id
    }
}

/// Children that still have to be visited, with the distances at which they are entered.
struct Stack {
    entries: [(f32, u32); MAX_DEPTH],
    len: usize,
}

impl Stack {
    fn new() -> Self {
        Self { entries: [(0.0, 0); MAX_DEPTH], len: 0 }
    }

    #[inline(always)]
    fn push(&mut self, near: f32, node: u32) {
        self.entries[self.len] = (near, node);
        self.len += 1;
    }

    /// The last pushed node that is entered before `t_max`.
    #[inline(always)]
    fn pop(&mut self, t_max: f32) -> Option<u32> {
        while self.len > 0 {
            self.len -= 1;
            let (near, node) = self.entries[self.len];
            if near <= t_max {
                return Some(node);
            }
        }
        None
    }
}

impl Accel {
    /// The nearest triangle at or before `ray.t_max`; the lower index among those at the same distance.
    pub fn closest(&self, ray: &Ray, ignored: Ignored) -> Option<Hit> {
        let cast = RayCast::new(ray);
        let mut best: Option<Hit> = None;
        let mut t_max = ray.t_max;
        self.walk(&cast, &mut t_max, |child, t_max| {
            for slot in child.first as usize..(child.first + child.count) as usize {
                let Some(found) = cast.triangle(&self.vertices[slot], *t_max) else {
                    continue;
                };
                let triangle = self.ids[slot];
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

    /// True when anything but the ignored triangles lies at or before `ray.t_max`.
    pub fn occluded(&self, ray: &Ray, ignored: Ignored) -> bool {
        let cast = RayCast::new(ray);
        let mut t_max = ray.t_max;
        self.walk(&cast, &mut t_max, |child, t_max| {
            (child.first as usize..(child.first + child.count) as usize).any(|slot| {
                cast.triangle(&self.vertices[slot], *t_max).is_some() && !ignored.contains(self.ids[slot])
            })
        })
    }

    /// Shows every leaf that the ray may enter before `t_max` to `leaf`, until that returns true.
    #[inline(always)]
    fn walk(&self, cast: &RayCast, t_max: &mut f32, mut leaf: impl FnMut(&Child, &mut f32) -> bool) -> bool {
        if self.nodes.is_empty() {
            return false;
        }
        let mut stack = Stack::new();
        let mut next = Some(0);
        while let Some(index) = next {
            let children = &self.nodes[index as usize].children;
            let spans = [0, 1].map(|i| cast.slab(children[i].bounds.min, children[i].bounds.max));
            let order = if spans[1].0 < spans[0].0 { [1, 0] } else { [0, 1] };
            let mut inner = [None; 2];
            for (place, i) in order.into_iter().enumerate() {
                let (near, far) = spans[i];
                if near > far || near > *t_max || children[i].count == Child::ABSENT {
                    continue;
                }
                if children[i].count == 0 {
                    inner[place] = Some((near, children[i].first));
                } else if leaf(&children[i], t_max) {
                    return true;
                }
            }
            next = match inner {
                [Some((_, nearer)), Some((near, farther))] => {
                    stack.push(near, farther);
                    Some(nearer)
                }
                [Some((_, node)), None] | [None, Some((_, node))] => Some(node),
                [None, None] => stack.pop(*t_max),
            };
        }
        false
    }
}
