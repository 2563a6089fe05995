//! How far it is from a point to the nearest triangle, at least.
//!
//! A random walk in a dense medium collides hundreds of times between two meetings with a surface. While it stays
//! within a ball that holds no triangle it need not ask what it meets.

use glam::Vec3;

use super::Accel;
use super::moving::{Moment, Moving, Standing};
use super::traverse::{nearest_first, pop};
use crate::geometry::machine::{Lanes, Stack, WithLanes, with_best};

/// Heights over planes are relatively off by the error of the normal; this much is left out.
const WITHIN_ROUNDING: f32 = 0.999;

impl Accel {
    /// The radius of a ball around `point` in which there is no triangle at a time in frames: a little less than the
    /// distance to the nearest, but for the rounding of coordinates; infinite without triangles.
    pub fn clearance(&self, point: Vec3, time: f32) -> f32 {
        match &self.motion {
            None => with_best(Clearance { accel: self, moment: Standing(self), point }),
            Some(motion) => {
                let moment = Moving { accel: self, motion, time };
                with_best(Clearance { accel: self, moment, point })
            }
        }
    }
}

struct Clearance<'a, M> {
    accel: &'a Accel,
    moment: M,
    point: Vec3,
}

impl<'a, M: Moment<'a>> WithLanes for Clearance<'a, M> {
    type Output = f32;

    #[inline(always)]
    fn run<L: Lanes>(self) -> f32 {
        let Self { accel, moment, point } = self;
        let coordinates = [L::splat(point.x), L::splat(point.y), L::splat(point.z)];
        let mut least = f32::INFINITY;
        let mut stack = Stack::new();
        let mut next = accel.root();
        while let Some(child) = next {
            if let Some(index) = child.as_node() {
                let (node, change) = moment.node(index);
                let squared = node.squared_distances(change, &coordinates);
                let nearer = squared.at_most(L::splat(least));
                if nearer != 0 {
                    next = Some(nearest_first(&mut stack, squared, nearer, &node.children));
                    continue;
                }
            } else if let Some(index) = child.as_leaf() {
                let (leaf, change) = moment.leaf(index);
                least = leaf.squared_distances(change, &coordinates).least_below(least);
            }
            next = pop(&mut stack, least);
        }
        least.sqrt() * WITHIN_ROUNDING
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::portable::Portable;
    use crate::sampling::{SampleSeed, SampleStream};

    fn number(i: u32) -> Vec3 {
        let u = SampleStream::new(SampleSeed::new(8), i, 0, 0).next4();
        Vec3::new(u[0], u[1], u[2]) * 2.0 - 1.0
    }

    #[test]
    fn no_triangle_is_within_the_ball_and_it_is_not_much_too_small() {
        let positions: Vec<Vec3> = (0..600).map(|i| number(i / 3) + 0.02 * number(1000 + i)).collect();
        let triangles: Vec<[u32; 3]> = (0..200).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let accel = Accel::build(&positions, &triangles);
        let on_triangles: Vec<Vec3> = positions
            .chunks(3)
            .flat_map(|v| {
                (0..=8)
                    .flat_map(|i| (0..=8 - i).map(move |j| (i as f32 / 8.0, j as f32 / 8.0)))
                    .map(|(a, b)| v[0] * a + v[1] * b + v[2] * (1.0 - a - b))
            })
            .collect();
        for point in (0..2000).map(|i| number(5000 + i) * 1.5) {
            let radius = accel.clearance(point, 0.0);
            let nearest = on_triangles.iter().map(|p| p.distance(point)).fold(f32::INFINITY, f32::min);
            assert!(radius <= nearest && radius > 0.99 * nearest - 0.01, "{radius} {nearest}");
            assert_eq!(
                radius,
                Clearance { accel: &accel, moment: Standing(&accel), point }.run::<Portable>()
            );
        }
        assert_eq!(Accel::default().clearance(Vec3::ZERO, 0.0), f32::INFINITY);
    }

    /// Over the middle of half a square, from 10 nm to a million kilometres. The thousandth that is left out is all
    /// that is missing, but for roundings.
    #[test]
    fn balls_over_triangles_of_any_size_touch_them() {
        for l in (-8..=9).flat_map(|e| [1.0, 2.3, 7.9].map(|digits: f32| digits * 10.0_f32.powi(e))) {
            let square = [[-l, -l], [l, -l], [l, l], [-l, l]].map(|[x, y]| Vec3::new(x, y, 0.0));
            for corners in [[0, 1, 2], [1, 2, 3], [2, 3, 0], [3, 0, 1]] {
                let accel = Accel::build(&square, &[corners]);
                let middle = corners.map(|corner| square[corner as usize] / 3.0).into_iter().sum::<Vec3>();
                for point in [middle + Vec3::Z * l, middle - Vec3::Z * l] {
                    let radius = accel.clearance(point, 0.0);
                    let portable = Clearance { accel: &accel, moment: Standing(&accel), point };
                    assert_eq!(radius.to_bits(), portable.run::<Portable>().to_bits());
                    assert!(radius < l && radius > 0.998 * l, "{radius} instead of {l}");
                }
            }
        }
    }
}
