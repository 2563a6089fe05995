//! Which triangles may send light of the sun to a point.
//!
//! A tree of eight children a node over boxes of where triangles are and how their refracted rays slope, in the frame of the
//! sun. Rays of a box come to the point x only if
//!
//! ```text
//! x_st in [p_st] + [h] [e],   [h] = x_z - [p_z],   [h] above 0
//! ```
//! in intervals. It holds as well with the mean slope of all rays taken from e and, times their depth, from places: what a sea
//! bends is then nearly straight along the third axis. So beams have no length, need not be cut into pieces, and nothing depends on how the surface lies: it is the
//! hierarchy of positions and normals of Walter, Zhao, Holzschuch and Bala `[WALTER09]` for light of one direction, whose
//! slopes say what normals do for a light at a point.

use glam::{DVec2, DVec3, Vec2, Vec3};
use rayon::prelude::*;

use super::spread::Slopes;
use crate::geometry::machine::{Work, in_wide_registers};

/// Where the rays of something begin and how they slope.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// Least and greatest s, t, depth, and slope in s and t.
    least: [f32; AXES],
    most: [f32; AXES],
}

const AXES: usize = 5;
const WIDTH: usize = 8;
/// The rounding of coordinates in single precision, twice over, for each side of a comparison.
const ROUNDING: f32 = 8.0 * f32::EPSILON;
/// Eight to the power of this is more than any mesh has triangles, were every node as lopsided as halving allows.
const DEEPEST: usize = 16;

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

/// The tree.
#[derive(Clone, Debug, Default)]
pub(super) struct Index {
    nodes: Vec<Node>,
}

#[derive(Clone, Debug)]
struct Node {
    least: [[f32; WIDTH]; AXES],
    most: [[f32; WIDTH]; AXES],
    /// A node, or a leaf with [`LEAF`] set.
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

    /// Lists the places in the order of all whose rays may come to a point.
    pub(super) fn find(&self, x: Vec3, found: &mut Vec<u32>) {
        found.clear();
        in_wide_registers(Search { index: self, x, found });
    }
}

struct Search<'a> {
    index: &'a Index,
    x: Vec3,
    found: &'a mut Vec<u32>,
}

impl Work for Search<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { index, x, found } = self;
        let mut waiting = [0_u32; DEEPEST * WIDTH];
        let mut count = usize::from(!index.nodes.is_empty());
        while count > 0 {
            count -= 1;
            let node = &index.nodes[waiting[count] as usize];
            let mut met = node.met(x);
            while met != 0 {
                let child = node.children[met.trailing_zeros() as usize];
                met &= met - 1;
                if child & LEAF == 0 {
                    waiting[count] = child;
                    count += 1;
                } else {
                    found.push(child & !LEAF);
                }
            }
        }
    }
}

impl Node {
    const EMPTY: Self = Self {
        least: [[f32::INFINITY; WIDTH]; AXES],
        most: [[f32::NEG_INFINITY; WIDTH]; AXES],
        children: [0; WIDTH],
    };

    fn hold(&mut self, slot: usize, reach: &Reach, child: u32) {
        self.children[slot] = child;
        for axis in 0..AXES {
            self.least[axis][slot] = reach.least[axis];
            self.most[axis][slot] = reach.most[axis];
        }
    }

    /// The children whose rays may come to a point, a bit each.
    #[inline(always)]
    fn met(&self, x: Vec3) -> u32 {
        let slack = ROUNDING * x.abs();
        let mut near = [0.0_f32; WIDTH];
        let mut far = [0.0_f32; WIDTH];
        let mut met = [true; WIDTH];
        for k in 0..WIDTH {
            near[k] = (x.z - slack.z - self.most[2][k]).max(0.0);
            far[k] = x.z + slack.z - self.least[2][k];
            met[k] = far[k] > 0.0;
        }
        for (axis, (at, slack)) in [(x.x, slack.x), (x.y, slack.y)].into_iter().enumerate() {
            for k in 0..WIDTH {
                let (least, most) = (self.least[3 + axis][k], self.most[3 + axis][k]);
                let low = self.least[axis][k] + (near[k] * least).min(far[k] * least);
                let high = self.most[axis][k] + (near[k] * most).max(far[k] * most);
                let slack = slack + ROUNDING * far[k];
                met[k] &= (at + slack >= low) & (at - slack <= high);
            }
        }
        met.iter().enumerate().fold(0, |bits, (k, met)| bits | u32::from(*met) << k)
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
/// Of more than so many about as many tell along which axis they are halved.
const TELLING: usize = 128;

impl Grown {
    /// Appends a part that was built alone; tells its place as a child.
    fn take(&mut self, part: Self) -> u32 {
        let (nodes, order) = (self.nodes.len() as u32, self.order.len() as u32);
        self.order.extend(part.order);
        let moved = |child: u32| if child & LEAF == 0 { child + nodes } else { child + order };
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
        let mut grown = Grown::default();
        if numbers.len() < MANY {
            self.node(numbers, &mut grown);
            return grown;
        }
        grown.nodes.push(Node::EMPTY);
        let parts = self.parts(numbers).into_par_iter();
        let parts: Vec<(Reach, Grown)> = parts.map(|part| (self.around(part), self.tree(part))).collect();
        for (slot, (reach, part)) in parts.into_iter().enumerate() {
            let child = grown.take(part);
            grown.nodes[0].hold(slot, &reach, child);
        }
        grown
    }

    /// Appends a node over these and all below it; tells its place.
    fn node(&self, numbers: &mut [u32], grown: &mut Grown) -> u32 {
        let number = grown.nodes.len() as u32;
        grown.nodes.push(Node::EMPTY);
        for (slot, part) in self.parts(numbers).into_iter().enumerate() {
            let reach = self.around(part);
            let child = if let [number] = part {
                grown.order.push(*number);
                (grown.order.len() as u32 - 1) | LEAF
            } else {
                self.node(part, grown)
            };
            grown.nodes[number as usize].hold(slot, &reach, child);
        }
        number
    }

    /// The children of a node over these.
    fn parts<'o>(&self, numbers: &'o mut [u32]) -> Vec<&'o mut [u32]> {
        let mut parts = vec![numbers];
        while parts.len() < WIDTH {
            let (at, largest) =
                parts.iter().map(|part| part.len()).enumerate().max_by_key(|p| p.1).unwrap_or((0, 1));
            if largest < 2 {
                break;
            }
            let part = parts.swap_remove(at);
            let axis = match part.len() / TELLING {
                0 | 1 => self.axis(part),
                step => self.axis(&mut part.iter().copied().step_by(step).collect::<Vec<_>>()),
            };
            self.sort_halves(part, axis);
            let (left, right) = part.split_at_mut(part.len() / 2);
            parts.extend([left, right]);
        }
        parts
    }

    fn around(&self, part: &[u32]) -> Reach {
        part.iter().fold(Reach::NOTHING, |all, i| all.union(&self.all[*i as usize]))
    }

    /// The axis on which halves by number cover least.
    fn axis(&self, part: &mut [u32]) -> usize {
        let half = part.len() / 2;
        let mut best = (f32::INFINITY, 0);
        for axis in 0..AXES {
            self.sort_halves(part, axis);
            let [left, right] = [&part[..half], &part[half..]].map(|side| self.around(side).area(self.depth));
            if left + right < best.0 {
                best = (left + right, axis);
            }
        }
        best.1
    }

    /// Puts the lower half along an axis first.
    fn sort_halves(&self, part: &mut [u32], axis: usize) {
        let middle = |i: &u32| self.all[*i as usize].middle(axis);
        let half = part.len() / 2;
        part.select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)).then(a.cmp(b)));
    }
}

#[cfg(test)]
mod tests {
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
        let (mut visited, mut places) = (0, Vec::new());
        for i in 0..BOXES {
            let [u, v, h, e] = numbers(i, 2);
            let (p, slopes) = all[i as usize];
            let c = corner(p);
            let from = c[0] + (c[1] - c[0]) * u * (1.0 - v) + (c[2] - c[0]) * v;
            let slope = slopes.least + (slopes.most - slopes.least) * DVec2::new(e, h);
            let x = from + slope.extend(1.0) * (4.0 * h);
            index.find(sheared(x.as_vec3(), SHEAR.as_vec2()), &mut places);
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
        Index::new(&[], 1.0).0.find(Vec3::ZERO, &mut found);
        assert!(found.is_empty());
    }
}
