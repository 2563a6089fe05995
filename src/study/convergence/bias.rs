//! Whether the pictures of a budget have the reference as their expectation.
//!
//! The luminance of the whole picture and of each of B blocks is averaged in every picture. Of R repeats it has a mean m
//! and a variance s^2; of the reference a mean m* and the variance v:
//!
//! ```text
//! t = (m - m*) / (s^2 / R + v)^(1/2)                                                           (1)
//! f = (s^2 / R + v)^2 / ((s^2 / R)^2 / (R - 1))                                                (2)
//! p = min(1, 2 min(P of the whole, B times the least P of the blocks))                         (3)
//! ```
//!
//! P is the probability of Student's t of f degrees of freedom to be further from 0; (2) is of `[SATTERTHWAITE46 eq. 17]`,
//! with a variance of the reference that is known. (3) holds whatever regions have to do with each other, so also where pixels
//! share their noise, as those of one pass of photons do; a reference that was not rendered here counts as one whose pixels
//! do not, which makes p too small if they do. Repeats have to be about normal: where a block's light comes in
//! rare great values, p is too small.

use serde::{Deserialize, Serialize};

use super::reference::Reference;
use crate::film::FrameImage;
use crate::spectrum::luminance::luminance_f64;
use crate::study::distributions::student_two_sided;
use crate::study::statistics::mean_and_variance;

/// Columns and rows of blocks, where there are as many pixels. Few and large ones are about normal sooner.
const GRID: usize = 4;

/// Colours are single precision: means of numbers that are the same may differ by so much of themselves.
const ROUNDING: f64 = 1e-6;

/// The mean of the whole picture, then of each block.
pub(super) fn region_means(width: usize, values: &[f64]) -> Vec<f64> {
    region_sums(width, values).into_iter().map(|(sum, count)| sum / count).collect()
}

/// The pixels of the whole picture, then of each block.
pub(super) fn region_counts(width: usize, pixels: usize) -> Vec<f64> {
    region_sums(width, &vec![0.0; pixels]).into_iter().map(|(_, count)| count).collect()
}

fn region_sums(width: usize, values: &[f64]) -> Vec<(f64, f64)> {
    let height = values.len() / width.max(1);
    let (columns, rows) = (GRID.min(width), GRID.min(height));
    let mut sums = vec![(0.0, 0.0); 1 + columns * rows];
    for (p, value) in values.iter().enumerate() {
        let (column, row) = (p % width * columns / width, p / width * rows / height);
        for region in [0, 1 + row * columns + column] {
            sums[region].0 += value;
            sums[region].1 += 1.0;
        }
    }
    sums
}

/// Luminances of a picture.
pub(super) fn luminances(image: &FrameImage) -> Vec<f64> {
    image.pixels.iter().map(|pixel| luminance_f64(pixel.rgb.as_dvec3())).collect()
}

/// How the mean of some pictures differs from the reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bias {
    /// The difference of the whole as a part of the reference.
    pub relative: f64,
    /// (1) of the whole.
    pub t: f64,
    /// (3).
    pub p: f64,
}

/// Compares the mean of repeats, of which `repeats` are the [`region_means`], with the reference.
pub(super) fn bias(repeats: &[Vec<f64>], reference: &Reference) -> Bias {
    let (means, variances) = (reference.region_means(), reference.region_variances());
    let blocks = means.len() as f64 - 1.0;
    let mut found = Bias { relative: 0.0, t: 0.0, p: 1.0 };
    for (region, (expected, variance)) in means.iter().zip(&variances).enumerate() {
        let values: Vec<f64> = repeats.iter().map(|means| means[region]).collect();
        let n = values.len() as f64;
        let (mean, spread) = mean_and_variance(&values);
        let own = spread / n;
        let rounding = ROUNDING * expected;
        let all = own + variance + rounding * rounding;
        let degrees_of_freedom = (all / own) * (all / own) * (n - 1.0); // (2)
        let t = (mean - expected) / all.sqrt(); // (1)
        let beyond = student_two_sided(t, degrees_of_freedom.min(1e6));
        let family = if region == 0 { 2.0 } else { 2.0 * blocks };
        found.p = found.p.min(family * beyond); // (3)
        if region == 0 {
            (found.relative, found.t) = ((mean - expected) / expected, t);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::reference::tests::{picture, reference, regions};
    use super::*;
    use crate::film::SplitMix;

    /// p of 8 pictures against a reference, both with noise that pixels have alone and that they share.
    fn tested(random: &mut SplitMix, own: f64, shared: f64, gain: f64) -> Bias {
        let reference = reference(random, own, shared);
        let pictures: Vec<Vec<f64>> = (0..8).map(|_| regions(&picture(random, own, shared, gain))).collect();
        bias(&pictures, &reference)
    }

    /// 400 pairs of one expectation, of which at most 5 % may fall below p = 0.05: 20 +- 4.4, so fewer than 38 in all but
    /// 3e-5 of all cases. Where pixels share noise, c is known by seven degrees of freedom, which (2) takes as endless: up to
    /// 7.6 % by the quantiles of Student's t for 14 and 7, so fewer than 52.
    #[test]
    fn what_is_the_same_is_seldom_found_to_differ() {
        let mut random = SplitMix(1);
        for (shared, most) in [(0.0, 38), (0.05, 52)] {
            let found = (0..400).filter(|_| tested(&mut random, 0.1, shared, 1.0).p < 0.05).count();
            assert!(found < most, "{found} of 400 with {shared}");
        }
    }

    /// Over the whole of 576 pixels the difference has an error of 0.1 (2 / 8 / 576)^(1/2) = 0.0021, and a bias of 5 % of 0.7
    /// is 17 of these.
    #[test]
    fn what_differs_is_found() {
        let mut random = SplitMix(2);
        let found = tested(&mut random, 0.1, 0.0, 1.05);
        assert!(found.p < 1e-6 && (found.relative - 0.05).abs() < 0.02 && found.t > 8.0, "{found:?}");
    }

    #[test]
    fn pictures_without_noise_are_the_same_or_not() {
        let mut random = SplitMix(3);
        assert_eq!(tested(&mut random, 0.0, 0.0, 1.0).p, 1.0);
        assert!(tested(&mut random, 0.0, 0.0, 1.001).p < 1e-9);
    }

    #[test]
    fn regions_cover_the_picture_once() {
        for (width, height) in [(24, 24), (3, 5), (17, 9), (1, 1)] {
            let counts = region_counts(width, width * height);
            assert_eq!(counts[0], (width * height) as f64);
            assert_eq!(counts[1..].iter().sum::<f64>(), counts[0], "{width} x {height}");
            assert!(counts.iter().all(|count| *count > 0.0));
        }
    }
}
