//! Walks the tree: nearer children first, popped children culled again against the best hit so far.

use super::leaf::{Candidates, Leaf, LeafRay};
use super::moving::{Moment, Motion, Moving, Standing};
use super::node::{Child, Node, NodeRay};
use super::{Accel, Hit, MAX_DEPTH, TriangleId};
use crate::geometry::Ray;
use crate::geometry::machine::{Eight, Lanes, Stack, WithLanes, with_best};
use crate::geometry::triangle::{RayCast, TriangleHit};

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
pub(super) const STACK_SIZE: usize = (Node::WIDTH - 1) * MAX_DEPTH + 1;

/// A child that still has to be visited: the bits of the distance at which it is entered, which order like the
/// distances since none is negative, above those of the child.
type Entry = u64;

fn entry(near: f32, child: Child) -> Entry {
    u64::from(near.to_bits()) << 32 | u64::from(child.0)
}

/// The last pushed child that is entered before or at `t_max`.
#[inline(always)]
pub(super) fn pop(stack: &mut Stack<STACK_SIZE>, t_max: f32) -> Option<Child> {
    while let Some(entry) = stack.pop() {
        if f32::from_bits((entry >> 32) as u32) <= t_max {
            return Some(Child(entry as u32));
        }
    }
    None
}

/// Returns the nearest of the entered children and leaves the others on the stack, the farthest lowest.
#[inline(always)]
pub(super) fn nearest_first<L: Lanes>(
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
        self.ask(ray, ignored, Nearest)
    }

    /// True when anything but the ignored triangles lies at or before `ray.t_max`.
    pub fn occluded(&self, ray: &Ray, ignored: Ignored) -> bool {
        self.ask(ray, ignored, Anything)
    }

    /// Shows every hit at or before `ray.t_max` to `visit`, in no particular order, until that returns true.
    ///
    /// This is what a shadow ray through transparent sheets asks for: one walk instead of one a sheet.
    pub fn each_hit(&self, ray: &Ray, ignored: Ignored, visit: impl FnMut(Hit) -> bool) {
        self.ask(ray, ignored, Each(visit));
    }

    #[inline(always)]
    fn ask<S: Seeker>(&self, ray: &Ray, ignored: Ignored, seeker: S) -> S::Found {
        match &self.motion {
            None => with_best(Query { accel: self, moment: Standing(self), ray, ignored, seeker }),
            Some(motion) => self.ask_moving(motion, ray, ignored, seeker),
        }
    }

    #[inline(never)]
    fn ask_moving<S: Seeker>(&self, motion: &Motion, ray: &Ray, ignored: Ignored, seeker: S) -> S::Found {
        let moment = Moving { accel: self, motion, time: ray.time };
        with_best(Query { accel: self, moment, ray, ignored, seeker })
    }
}

/// What a ray looks for.
trait Seeker {
    /// What it has found; begins with nothing.
    type Found: Default;

    /// Takes a hit at or before `t_max`, which it may bring nearer; true when nothing else is looked for.
    fn take(&mut self, found: &mut Self::Found, hit: Hit, t_max: &mut f32) -> bool;
}

struct Nearest;

impl Seeker for Nearest {
    type Found = Option<Hit>;

    #[inline(always)]
    fn take(&mut self, found: &mut Option<Hit>, hit: Hit, t_max: &mut f32) -> bool {
        let is_tied = found.is_some_and(|best| hit.t == best.t && hit.triangle > best.triangle);
        if !is_tied {
            *t_max = hit.t;
            *found = Some(hit);
        }
        false
    }
}

struct Anything;

impl Seeker for Anything {
    type Found = bool;

    #[inline(always)]
    fn take(&mut self, found: &mut bool, _: Hit, _: &mut f32) -> bool {
        *found = true;
        true
    }
}

struct Each<V>(V);

impl<V: FnMut(Hit) -> bool> Seeker for Each<V> {
    type Found = ();

    #[inline(always)]
    fn take(&mut self, (): &mut (), hit: Hit, _: &mut f32) -> bool {
        (self.0)(hit)
    }
}

/// A walk through the tree.
struct Query<'a, M, S> {
    accel: &'a Accel,
    moment: M,
    ray: &'a Ray,
    ignored: Ignored,
    seeker: S,
}

impl<'a, M: Moment<'a>, S: Seeker> WithLanes for Query<'a, M, S> {
    type Output = S::Found;

    #[inline(always)]
    fn run<L: Lanes>(self) -> S::Found {
        let Self { accel, moment, ray, ignored, mut seeker } = self;
        let mut found = S::Found::default();
        let Some(root) = accel.root() else { return found };
        let cast = RayCast::new(ray);
        let (node_ray, leaf_ray) = (NodeRay::<L>::new(&cast.outer), LeafRay::<L>::new(&cast));
        let mut t_max = ray.t_max;
        let mut stack = Stack::new();
        let mut next = Some(root);
        while let Some(child) = next {
            if let Some(index) = child.as_node() {
                let (node, change) = moment.node(index);
                let (near, entered) = node.enter(change, &node_ray, t_max);
                if entered != 0 {
                    next = Some(nearest_first(&mut stack, near, entered, &node.children));
                    continue;
                }
            } else if let Some(index) = child.as_leaf() {
                let (leaf, change) = moment.leaf(index);
                let mut candidates = leaf.candidates(change, &leaf_ray);
                while let Some((lane, edges)) = candidates.as_mut().and_then(Candidates::next) {
                    let turned = leaf.turned_triangle(lane, change, cast.turn.axes());
                    let Some(hit) = cast.settle(edges, turned, t_max) else { continue };
                    let triangle = accel.ids[index][lane];
                    let TriangleHit { t, barycentric, from_front } = hit;
                    if !ignored.contains(triangle)
                        && seeker.take(&mut found, Hit { triangle, t, barycentric, from_front }, &mut t_max)
                    {
                        return found;
                    }
                }
            }
            next = pop(&mut stack, t_max);
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use proptest::prelude::*;

    use super::*;
    use crate::geometry::portable::Portable;
    use crate::sampling::{SampleSeed, SampleStream, warp};

    /// A folded sheet with vertices at random places, and rays from and to everywhere.
    fn crumpled() -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let number = |i: u32| SampleStream::new(SampleSeed::new(5), i, 0, 0).next4();
        let at = |i: u32| {
            let u = number(i);
            Vec3::new((i % 41) as f32 + u[0], (i / 41) as f32 + u[1], 6.0 * u[2])
        };
        let cells = (0..40 * 40_u32).map(|i| i / 40 * 41 + i % 40);
        let triangles = cells.flat_map(|i| [[i, i + 1, i + 42], [i, i + 42, i + 41]]).collect();
        ((0..41 * 41).map(at).collect(), triangles)
    }

    fn rays() -> impl Iterator<Item = Ray> {
        (0..20_000).map(|i| {
            let mut stream = SampleStream::new(SampleSeed::new(6), i, 0, 0);
            let (u, v) = (stream.next4(), stream.next4());
            let mut direction = warp::sphere([u[0], u[1]]);
            if i % 8 == 0 {
                // Along an axis, and within a plane of the grid.
                direction = [Vec3::X, Vec3::NEG_Y, Vec3::Z][i as usize / 8 % 3];
            }
            let origin = Vec3::new(40.0 * u[2], 40.0 * u[3], 6.0 * v[0]);
            let origin = if i % 16 == 0 { origin.round() } else { origin };
            Ray { t_max: if i % 3 == 0 { 5.0 * v[1] } else { f32::INFINITY }, ..Ray::new(origin, direction) }
        })
    }

    /// Of a coarse lattice, on which ties and degenerate triangles are common.
    fn point() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(-4_i32..=4).prop_map(|i| Vec3::from_array(i.map(|i| i as f32 * 0.25)))
    }

    proptest! {
        #[test]
        fn the_lanes_of_any_machine_answer_like_the_best(
            positions in prop::collection::vec(point(), 3..150),
            rays in prop::collection::vec((point(), point()), 40),
            exponent in -15_i32..=17
        ) {
            let scale = 10.0_f32.powi(exponent);
            let positions: Vec<Vec3> = positions.into_iter().map(|p| p * scale).collect();
            let triangles: Vec<[u32; 3]> = (0..positions.len() as u32 - 2).map(|i| [i, i + 1, i + 2]).collect();
            let accel = &Accel::build(&positions, &triangles);
            for (origin, direction) in rays.into_iter().filter(|(_, direction)| *direction != Vec3::ZERO) {
                let ray = &Ray::new(origin * (3.0 * scale), direction.normalize());
                let ignored = Ignored::NOTHING;
                let closest = Query { accel, moment: Standing(accel), ray, ignored, seeker: Nearest }.run::<Portable>();
                prop_assert_eq!(closest, accel.closest(ray, ignored));
                let occluded = Query { accel, moment: Standing(accel), ray, ignored, seeker: Anything }.run::<Portable>();
                prop_assert_eq!(occluded, accel.occluded(ray, ignored));
            }
        }
    }

    #[test]
    fn each_hit_is_shown_once_until_told_to_stop() {
        let (positions, triangles) = crumpled();
        let accel = Accel::build(&positions, &triangles);
        for ray in rays().take(2_000) {
            let mut hits = Vec::new();
            accel.each_hit(&ray, Ignored::NOTHING, |hit| {
                hits.push(hit);
                false
            });
            hits.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.triangle.cmp(&b.triangle)));
            let cast = RayCast::new(&ray);
            let corners = |t: [u32; 3]| t.map(|i| positions[i as usize]);
            let alone = (0..)
                .zip(&triangles)
                .filter_map(|(id, &t)| Some((id, cast.triangle(&corners(t), ray.t_max)?)));
            let mut expected: Vec<_> =
                alone.map(|(id, hit)| (hit.t, id, hit.barycentric, hit.from_front)).collect();
            expected.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let found: Vec<_> = hits.iter().map(|h| (h.t, h.triangle, h.barycentric, h.from_front)).collect();
            assert_eq!(found, expected);
            assert_eq!(hits.first().copied(), accel.closest(&ray, Ignored::NOTHING));
            let mut shown = 0;
            accel.each_hit(&ray, Ignored::NOTHING, |_| {
                shown += 1;
                shown == 2
            });
            assert_eq!(shown, hits.len().min(2));
        }
    }
}
