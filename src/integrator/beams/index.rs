//! Which triangles may send light of the sun to a point.
//!
//! A tree of eight children a node, over boxes of where triangles are and how their refracted rays slope, in the frame of
//! the sun. Rays of a box come to the point x only if
//!
//! ```text
//! x_st in [p_st] + [h] [e],   [h] = x_z - [p_z],   [h] above 0
//! ```
//! in intervals. It holds as well with the mean slope of all rays taken from e and, times their depth, from places: what a sea
//! bends is then nearly straight along the third axis. So beams have no length, need not be cut into pieces, and nothing
//! depends on how the surface lies: it is the hierarchy of positions and normals of Walter, Zhao, Holzschuch and Bala
//! `[WALTER09]` for light of one direction, whose slopes say what normals do for a light at a point.

use glam::{DVec2, DVec3, Vec2, Vec3};
use rayon::prelude::*;

use super::sieve::Sieves;
use super::spread::Slopes;
use crate::geometry::machine::{Eight, Lanes, WithLanes, with_best};

/// Where the rays of something begin and how they slope.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// Least and greatest s, t, depth, and slope in s and t.
    least: [f32; AXES],
    most: [f32; AXES],
}

const AXES: usize = 5;
pub(super) const WIDTH: usize = 8;
/// The rounding of coordinates in single precision, twice over, for each side of a comparison.
const ROUNDING: f32 = 8.0 * f32::EPSILON;
/// Eight to the power of this is more than there are numbers of 32 bits.
const DEEPEST: usize = 11;

impl Reach {
    /// Of points and slopes, both less a slope that is common to all that is asked for.
    pub(super) fn new(points: impl Iterator<Item = DVec3>, slopes: &Slopes, shear: DVec2) -> Self {
        let e = ROUNDING;
        let mut own = Self::NOTHING;
        for p in points.map(|p| p - (shear * p.z).extend(0.0)) {
            for (axis, value) in p.as_vec3().to_array().into_iter().enumerate() {
                own.least[axis] = own.least[axis].min(value - e * value.abs());
                own.most[axis] = own.most[axis].max(value + e * value.abs());
            }
        }
        for axis in 0..2 {
            let [least, most] = [slopes.least, slopes.most].map(|slope| (slope - shear)[axis] as f32);
            own.least[3 + axis] = (least - e * least.abs()).max(f32::MIN);
            own.most[3 + axis] = (most + e * most.abs()).min(f32::MAX);
        }
        own
    }

    const NOTHING: Self = Self { least: [f32::INFINITY; AXES], most: [f32::NEG_INFINITY; AXES] };

    fn union(mut self, other: &Self) -> Self {
        for axis in 0..AXES {
            self.least[axis] = self.least[axis].min(other.least[axis]);
            self.most[axis] = self.most[axis].max(other.most[axis]);
        }
        self
    }

    /// False where none of its rays comes to a point.
    pub(super) fn reaches(&self, x: DVec3) -> bool {
        let far = x.z - f64::from(self.least[2]);
        let near = (x.z - f64::from(self.most[2])).max(0.0);
        let within = |axis: usize| {
            let [least, most] = [self.least, self.most].map(|ends| f64::from(ends[3 + axis]));
            let low = f64::from(self.least[axis]) + (near * least).min(far * least);
            let high = f64::from(self.most[axis]) + (near * most).max(far * most);
            low <= x[axis] && x[axis] <= high
        };
        far > 0.0 && within(0) && within(1)
    }

    fn middle(&self, axis: usize) -> f32 {
        0.5 * self.least[axis] + 0.5 * self.most[axis]
    }

    /// The area that its rays cover so far behind it.
    pub(super) fn area(&self, depth: f32) -> f32 {
        let wide = |k: usize| self.most[k] - self.least[k] + depth * (self.most[3 + k] - self.least[3 + k]);
        wide(0) * wide(1)
    }
}

/// A point less a slope that is common to all.
#[inline]
pub(super) fn sheared(x: Vec3, shear: Vec2) -> Vec3 {
    x - (shear * x.z).extend(0.0)
}

/// The tree. All nodes are full but those along its last branch.
#[derive(Clone, Debug, Default)]
pub(super) struct Index {
    nodes: Vec<Node>,
}

#[derive(Clone, Debug)]
struct Node {
    least: [Eight; AXES],
    most: [Eight; AXES],
    /// Nodes; of leaves the first has the place of all eight over eight, with [`LEAF`] set.
    children: [u32; WIDTH],
}

const LEAF: u32 = 1 << 31;

impl Index {
    /// Over all, of which it gives the order that it visits them by; light is looked for about so far behind them.
    pub(super) fn new(all: &[Reach], depth: f32) -> (Self, Vec<u32>) {
        let mut numbers: Vec<u32> = (0..all.len() as u32).collect();
        let grown = if all.is_empty() { Grown::default() } else { Builder { all, depth }.tree(&mut numbers) };
        (Self { nodes: grown.nodes }, grown.order)
    }

    /// Bytes that it occupies.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.nodes)
    }

    /// Lists the places in the order of all whose rays may come to a point, once less the slope that is common to all and
    /// once as it is, and that the sieves, eight of that order each, hold.
    pub(super) fn find(&self, sheared: Vec3, point: Vec3, sieves: &[Sieves], found: &mut Vec<u32>) {
        found.clear();
        with_best(Search { index: self, x: sheared, point, sieves, found });
    }
}

struct Search<'a> {
    index: &'a Index,
    x: Vec3,
    point: Vec3,
    sieves: &'a [Sieves],
    found: &'a mut Vec<u32>,
}

impl WithLanes for Search<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { index, x, point, sieves, found } = self;
        let mut waiting = [0_u32; DEEPEST * WIDTH];
        let mut count = usize::from(!index.nodes.is_empty());
        while count > 0 {
            count -= 1;
            let node = &index.nodes[waiting[count] as usize];
            let mut met = node.met::<L>(x);
            if met == 0 {
                continue;
            }
            let first = node.children[0];
            if first & LEAF == 0 {
                while met != 0 {
                    waiting[count] = node.children[met.trailing_zeros() as usize];
                    met &= met - 1;
                    count += 1;
                }
            } else {
                let eight = first & !LEAF;
                met &= sieves[eight as usize].held::<L>(point);
                while met != 0 {
                    found.push(eight * WIDTH as u32 + met.trailing_zeros());
                    met &= met - 1;
                }
            }
        }
    }
}

impl Node {
    const EMPTY: Self = Self {
        least: [Eight([f32::INFINITY; WIDTH]); AXES],
        most: [Eight([f32::NEG_INFINITY; WIDTH]); AXES],
        children: [0; WIDTH],
    };

    fn hold(&mut self, slot: usize, reach: &Reach) {
        for axis in 0..AXES {
            self.least[axis].0[slot] = reach.least[axis];
            self.most[axis].0[slot] = reach.most[axis];
        }
    }

    /// The children whose rays may come to a point, a bit each.
    #[inline(always)]
    fn met<L: Lanes>(&self, x: Vec3) -> u32 {
        let slack = ROUNDING * x.abs();
        let zero = L::splat(0.0);
        let near = L::splat(x.z - slack.z).sub(L::load(&self.most[2])).max(zero);
        let far = L::splat(x.z + slack.z).sub(L::load(&self.least[2]));
        let mut met = !far.at_most(zero);
        for (axis, (at, slack)) in [(x.x, slack.x), (x.y, slack.y)].into_iter().enumerate() {
            let (least, most) = (L::load(&self.least[3 + axis]), L::load(&self.most[3 + axis]));
            let low = L::load(&self.least[axis]).add(near.mul(least).min(far.mul(least)));
            let high = L::load(&self.most[axis]).add(near.mul(most).max(far.mul(most)));
            let slack = L::splat(slack).add(far.mul(L::splat(ROUNDING)));
            let at = L::splat(at);
            met &= low.at_most(at.add(slack)) & at.sub(slack).at_most(high);
        }
        met
    }
}

#[derive(Clone, Copy)]
struct Builder<'a> {
    all: &'a [Reach],
    depth: f32,
}

/// A tree, or a part of one, and what it visits.
#[derive(Default)]
struct Grown {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

/// From so many on the parts of a node are built side by side.
const MANY: usize = 4096;
/// Of more than so many about as many tell along which axis they are cut.
const TELLING: usize = 128;

impl Grown {
    /// Appends a part that was built alone; tells its place as a child. Leaves before it are full.
    fn take(&mut self, part: Self) -> u32 {
        let (nodes, eights) = (self.nodes.len() as u32, (self.order.len() / WIDTH) as u32);
        self.order.extend(part.order);
        let moved = |child: u32| if child & LEAF == 0 { child + nodes } else { child + eights };
        self.nodes.extend(part.nodes.into_iter().map(|mut node| {
            node.children = node.children.map(moved);
            node
        }));
        nodes
    }
}

impl Builder<'_> {
    /// A tree over these, whose order it may change.
    fn tree(&self, numbers: &mut [u32]) -> Grown {
        let count = numbers.len();
        // What a full child holds: all before the last one are full.
        let mut room = 1;
        while room * WIDTH < count {
            room *= WIDTH;
        }
        let mut parts = vec![numbers];
        while let Some(at) = parts.iter().position(|part| part.len() > room) {
            let (left, right) = self.cut(parts.remove(at), room);
            parts.splice(at..at, [left, right]);
        }
        let mut grown = Grown { nodes: vec![Node::EMPTY], order: Vec::with_capacity(count) };
        for (slot, part) in parts.iter().enumerate() {
            grown.nodes[0].hold(slot, &self.around(part));
        }
        if room == 1 {
            grown.nodes[0].children[0] = LEAF;
            grown.order.extend(parts.into_iter().flat_map(|part| part.iter().copied()));
            return grown;
        }
        let children: Vec<Grown> = if count < MANY {
            parts.into_iter().map(|part| self.tree(part)).collect()
        } else {
            parts.into_par_iter().map(|part| self.tree(part)).collect()
        };
        for (slot, part) in children.into_iter().enumerate() {
            grown.nodes[0].children[slot] = grown.take(part);
        }
        grown
    }

    fn around(&self, part: &[u32]) -> Reach {
        part.iter().fold(Reach::NOTHING, |all, i| all.union(&self.all[*i as usize]))
    }

    /// Two parts, along the axis on which they cover least: as many children full on the left as on the right, but for one.
    fn cut<'o>(&self, part: &'o mut [u32], room: usize) -> (&'o mut [u32], &'o mut [u32]) {
        let half = part.len().div_ceil(room) / 2 * room;
        let axis = match part.len() / TELLING {
            0 | 1 => self.axis(part, half),
            step => {
                let mut some: Vec<u32> = part.iter().copied().step_by(step).collect();
                self.axis(&mut some, half / step)
            }
        };
        self.sort(part, half, axis);
        part.split_at_mut(half)
    }

    /// The axis on which the parts before and from a place on cover least.
    fn axis(&self, part: &mut [u32], half: usize) -> usize {
        let mut best = (f32::INFINITY, 0);
        for axis in 0..AXES {
            self.sort(part, half, axis);
            let [left, right] = [&part[..half], &part[half..]].map(|side| self.around(side).area(self.depth));
            if left + right < best.0 {
                best = (left + right, axis);
            }
        }
        best.1
    }

    /// Puts as many of the lowest along an axis first.
    fn sort(&self, part: &mut [u32], half: usize, axis: usize) {
        let middle = |i: &u32| self.all[*i as usize].middle(axis);
        part.select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)).then(a.cmp(b)));
    }
}

#[cfg(test)]
mod tests {
    use super::super::sieve::Sieve;
    use super::*;
    use crate::sampling::{SampleSeed, SampleStream};

    const SHEAR: DVec2 = DVec2::new(0.1, -0.2);

    /// Points on rays from within the boxes: all boxes that they come from are found, and of the others but those which the
    /// intervals cannot tell.
    #[test]
    fn everything_that_reaches_a_point_is_found() {
        // As many as are built side by side, twice over.
        const BOXES: u32 = 2 * MANY as u32;
        let numbers = |i: u32, k: u32| SampleStream::new(SampleSeed::new(9), i, k, 0).next4().map(f64::from);
        let all: Vec<(DVec3, Slopes)> = (0..BOXES)
            .map(|i| {
                let ([x, y, z, _], [a, b, wide, _]) = (numbers(i, 0), numbers(i, 1));
                let (middle, wide) = (DVec2::new(a, b) - 0.5, DVec2::splat(0.02 * wide));
                (
                    DVec3::new(10.0 * x, 10.0 * y, 0.3 * z),
                    Slopes { least: middle - wide, most: middle + wide },
                )
            })
            .collect();
        let corner = |p: DVec3| [p, p + DVec3::new(0.1, 0.0, 0.01), p + DVec3::new(0.0, 0.1, -0.01)];
        let reaches: Vec<Reach> =
            all.iter().map(|(p, slopes)| Reach::new(corner(*p).into_iter(), slopes, SHEAR)).collect();
        let (index, order) = Index::new(&reaches, 2.0);
        let sieves = vec![Sieves::new(&[Sieve::OPEN; WIDTH]); order.len().div_ceil(WIDTH)];
        let (mut visited, mut places) = (0, Vec::new());
        for i in 0..BOXES {
            let [u, v, h, e] = numbers(i, 2);
            let (p, slopes) = all[i as usize];
            let c = corner(p);
            let from = c[0] + (c[1] - c[0]) * u * (1.0 - v) + (c[2] - c[0]) * v;
            let slope = slopes.least + (slopes.most - slopes.least) * DVec2::new(e, h);
            let x = from + slope.extend(1.0) * (4.0 * h);
            let x = x.as_vec3();
            index.find(sheared(x, SHEAR.as_vec2()), x, &sieves, &mut places);
            let mut found: Vec<u32> = places.iter().map(|k| order[*k as usize]).collect();
            assert!(found.contains(&i), "{i}");
            visited += found.len();
            found.sort_unstable();
            found.dedup();
            assert!(found.len() <= BOXES as usize);
        }
        assert!(visited < 8192 * 100 * 3, "{visited} of 67 million");
    }

    #[test]
    fn nothing_is_found_in_nothing() {
        let mut found = vec![1];
        Index::new(&[], 1.0).0.find(Vec3::ZERO, Vec3::ZERO, &[], &mut found);
        assert!(found.is_empty());
    }
}
