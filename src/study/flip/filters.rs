//! The filters of FLIP, all of them sums of products of a filter along rows and one along columns.
//!
//! p is the number of pixels a degree and t = x / p an angle in degrees. Contrast sensitivity blurs the channels of
//! opponent colours, each with one or two Gaussians
//!
//! ```text
//! sum_i a_i (pi / b_i)^(1/2) exp(-pi^2 t^2 / b_i), made to sum to 1                                      (1)
//!   Y_y: a = 1, b = 0.0047      C_x: a = 1, b = 0.0053      C_z: a = 34.1, 13.5, b = 0.04, 0.025
//! ```
//!
//! out to 3 standard deviations of the widest; and edges and points are found by derivatives of a Gaussian of the
//! deviation s = 0.041 p pixels, out to 3 s:
//!
//! ```text
//! edge = -x g(x) g(y)         point = (x^2 / s^2 - 1) g(x) g(y)                                          (2)
//! ```
//!
//! and both with x and y exchanged. Their positive weights sum to 1, their negative ones to -1. `[ANDERSSON20 sec. 4.1]`
//! and `[ANDERSSON20 sec. 4.2]`. Features are what is left of the orientation: the length of the two.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use crate::geometry::elementary::exp;

/// The Gaussians (a, b) of each channel.
const SENSITIVITY: [&[(f32, f32)]; 3] = [&[(1.0, 0.0047)], &[(1.0, 0.0053)], &[(34.1, 0.04), (13.5, 0.025)]];

/// The greatest b.
const WIDEST: f32 = 0.04;

/// s of (2) in degrees.
const FEATURE_DEVIATION: f32 = 0.041;

/// Numbers of a picture, row after row.
#[derive(Clone, Debug)]
pub struct Plane {
    width: usize,
    values: Vec<f32>,
}

impl Plane {
    /// Of rows of a width.
    pub fn new(width: usize, values: Vec<f32>) -> Self {
        Self { width: width.max(1), values }
    }

    /// The sum of weighted neighbours in each row.
    fn along_rows(&self, weights: &[f32]) -> Self {
        let radius = weights.len() / 2;
        let filtered = |(sums, row): (&mut [f32], &[f32])| {
            let mut wide = vec![row[0]; radius];
            wide.extend_from_slice(row);
            wide.resize(row.len() + 2 * radius, row[row.len() - 1]);
            for (weight, shifted) in weights.iter().zip(wide.windows(row.len())) {
                add(sums, *weight, shifted);
            }
        };
        let mut values = vec![0.0; self.values.len()];
        values.par_chunks_mut(self.width).zip(self.values.par_chunks(self.width)).for_each(filtered);
        Self { width: self.width, values }
    }

    /// The sum of weighted neighbours in each column.
    fn along_columns(&self, weights: &[f32]) -> Self {
        let radius = weights.len() / 2;
        let rows: Vec<&[f32]> = self.values.chunks(self.width).collect();
        let filtered = |(y, sums): (usize, &mut [f32])| {
            for (i, weight) in weights.iter().enumerate() {
                add(sums, *weight, rows[(y + i).saturating_sub(radius).min(rows.len() - 1)]);
            }
        };
        let mut values = vec![0.0; self.values.len()];
        values.par_chunks_mut(self.width).enumerate().for_each(filtered);
        Self { width: self.width, values }
    }
}

fn add(sums: &mut [f32], weight: f32, values: &[f32]) {
    sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value);
}

/// Opponent colours as contrast sensitivity (1) blurs them.
pub fn blurred(opponent: &[Vec3], width: usize, pixels_per_degree: f32) -> Vec<Vec3> {
    let mut blurred = vec![Vec3::ZERO; opponent.len()];
    for (channel, gaussians) in SENSITIVITY.iter().enumerate() {
        let plane = Plane::new(width, opponent.iter().map(|c| c[channel]).collect());
        for (share, weights) in sensitivity(gaussians, pixels_per_degree) {
            let sums = plane.along_rows(&weights).along_columns(&weights);
            blurred.iter_mut().zip(sums.values).for_each(|(c, sum)| c[channel] += share * sum);
        }
    }
    blurred
}

/// The Gaussians (1): the share of each, and its weights, which sum to 1.
fn sensitivity(gaussians: &[(f32, f32)], pixels_per_degree: f32) -> Vec<(f32, Vec<f32>)> {
    let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil();
    let gaussian = |&(a, b): &(f32, f32)| {
        let mut weights: Vec<f32> = offsets(radius)
            .map(|x| exp(-(PI * x / pixels_per_degree) * (PI * x / pixels_per_degree) / b))
            .collect();
        let sum: f32 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight /= sum);
        (a * (PI / b).sqrt() * sum * sum, weights)
    };
    let mut parts: Vec<(f32, Vec<f32>)> = gaussians.iter().map(gaussian).collect();
    let whole: f32 = parts.iter().map(|(share, _)| share).sum();
    parts.iter_mut().for_each(|(share, _)| *share /= whole);
    parts
}

fn offsets(radius: f32) -> impl Iterator<Item = f32> {
    let radius = radius as i32;
    (-radius..=radius).map(|x| x as f32)
}

/// How much of an edge and of a point there is at a pixel, from 0 to about 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Features {
    edge: f32,
    point: f32,
}

impl Features {
    /// e_f of [`super`]: how much features differ, from 0 to 1.
    pub fn difference(a: Self, b: Self) -> f32 {
        let greater = (a.edge - b.edge).abs().max((a.point - b.point).abs());
        (std::f32::consts::FRAC_1_SQRT_2 * greater).sqrt()
    }
}

/// The features (2) of the grey of a picture, from 0 to 1.
pub fn features(grey: &Plane, pixels_per_degree: f32) -> Vec<Features> {
    let deviation = FEATURE_DEVIATION * pixels_per_degree;
    let radius = (3.0 * deviation).ceil();
    let along = |weight: fn(f32) -> f32| -> Vec<f32> {
        offsets(radius)
            .map(|x| weight(x / deviation) * exp(-0.5 * (x / deviation) * (x / deviation)))
            .collect()
    };
    let smooth = made_one(along(|_| 1.0));
    let [edge, point] = [made_one(along(|x| -x)), made_one(along(|x| x * x - 1.0))].map(|weights| {
        let by_rows = grey.along_rows(&weights).along_columns(&smooth).values;
        let by_columns = grey.along_columns(&weights).along_rows(&smooth).values;
        by_rows.into_iter().zip(by_columns).map(|(x, y)| Vec2::new(x, y).length()).collect::<Vec<f32>>()
    });
    edge.into_iter().zip(point).map(|(edge, point)| Features { edge, point }).collect()
}

/// Scales positive weights to a sum of 1 and negative ones to one of -1.
fn made_one(mut weights: Vec<f32>) -> Vec<f32> {
    let positive: f32 = weights.iter().filter(|w| **w > 0.0).sum();
    let negative: f32 = -weights.iter().filter(|w| **w < 0.0).sum::<f32>();
    weights.iter_mut().for_each(|w| *w /= if *w > 0.0 { positive } else { negative.max(f32::MIN_POSITIVE) });
    weights
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::flip::PIXELS_PER_DEGREE;

    #[test]
    fn what_is_flat_stays_and_has_no_features() {
        let flat = blurred(&[Vec3::new(50.0, 3.0, -7.0); 12 * 5], 12, PIXELS_PER_DEGREE);
        // Some 20 weights, rounded each: 1e-6 of the value.
        assert!(
            flat.iter().all(|c| (*c - Vec3::new(50.0, 3.0, -7.0)).abs().max_element() < 5e-5),
            "{flat:?}"
        );
        let nothing = features(&Plane::new(12, vec![0.5; 12 * 5]), PIXELS_PER_DEGREE);
        assert!(nothing.iter().all(|f| f.edge < 1e-6 && f.point < 1e-6), "{nothing:?}");
    }

    /// At a step from 0 to 1 between two pixels the edge filter, whose weights of one sign sum to 1, gives all but the
    /// weights that lie beyond: 1 at each side, its central weight being 0.
    #[test]
    fn a_step_is_an_edge_in_either_direction() {
        let side = 40;
        let step = |along: fn(usize, usize) -> usize| {
            Plane::new(side, (0..side * side).map(|p| f32::from(along(p % side, p / side) >= 20)).collect())
        };
        for plane in [step(|x, _| x), step(|_, y| y)] {
            let found = features(&plane, PIXELS_PER_DEGREE);
            assert!((found[20 * side + 20].edge - 1.0).abs() < 1e-5, "{:?}", found[20 * side + 20]);
            assert!(found[5 * side + 5].edge < 1e-6);
        }
    }

    /// A Gaussian of the variance b / (2 pi^2) degrees^2: within 3 deviations of the widest nearly all of it is there.
    #[test]
    fn a_dot_is_spread_by_the_variance_of_the_filter() {
        for (channel, variance) in [(0, 0.0047 / (2.0 * PI * PI)), (1, 0.0053 / (2.0 * PI * PI))] {
            let side = 41;
            let mut dot = vec![Vec3::ZERO; side * side];
            dot[20 * side + 20] = Vec3::ONE;
            let spread = blurred(&dot, side, PIXELS_PER_DEGREE);
            let moment: f32 = (0..side * side)
                .map(|p| (p % side) as f32 - 20.0)
                .zip(&spread)
                .map(|(x, c)| x * x * c[channel])
                .sum();
            let expected = variance * PIXELS_PER_DEGREE * PIXELS_PER_DEGREE;
            // A Gaussian of a deviation of one pixel, summed over whole pixels, has its own variance within 1e-6.
            assert!((moment / expected - 1.0).abs() < 1e-4, "{moment} {expected}");
        }
    }
}
