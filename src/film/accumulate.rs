//! The mean of a pixel's samples, and the variance of that mean from independent replicates.
//!
//! The samples of one low-discrepancy sequence are not independent, so their spread says little about the error of
//! their mean. A pixel therefore draws its N samples in R = [`REPLICATES`] independently scrambled replicates of n_r
//! samples each, and the spread of the replicates' means m_r gives the variance:
//!
//! ```text
//! w_r = n_r / N          m = sum_r w_r m_r
//! V = sum_r w_r^2 (m_r - m)^2 / (1 - sum_r w_r^2)                                   (1)
//! ```
//!
//! Derivation: with independent m_r of one mean and of variances s_r^2, E (m_r - m)^2 = (1 - 2 w_r) s_r^2 + v, where
//! v = sum_r w_r^2 s_r^2 is the variance of m. With s_r^2 = v / w_r (variance falls as 1 / n_r) the sum in (1) has the
//! expectation v sum_r (w_r - w_r^2) = v (1 - sum_r w_r^2), so V is unbiased. For equal n_r it is the familiar
//! sum (m_r - m)^2 / (R (R - 1)), and unbiased however fast the variance falls within a replicate. For unequal n_r and
//! a variance that falls as n^-2 or n^-3 it is off by less than 2 % (8 %) from 5 samples a replicate on.
//!
//! Of luminance the addends are kept, with their signs: errors that pixels share are those whose signs agree.
//!
//! ```text
//! u_r = w_r (m_r - m) / (1 - sum_r w_r^2)^(1/2)          V = sum_r u_r^2            (2)
//! ```
//!
//! Sums are exact and rounded once, to f64 (`exact.rs`), so that it is the same picture however samples are
//! grouped. A sample with a number that is not finite is left out and counted.

use std::ops::AddAssign;

use glam::{DVec3, Vec2, Vec3};
use serde::{Deserialize, Serialize};

use super::exact::ExactSums;
use super::sums::{Features, Replicate, filled, in_range, sum_of_squares, variance_of_mean};

/// Independent replicates of a pixel's samples.
pub const REPLICATES: usize = crate::sampling::REPLICATES as usize;

/// Depth of a pixel in which nothing is hit.
pub const FAR_DEPTH: f32 = 1e10;

/// What one sample of a pixel brings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmSample {
    /// Radiance in linear Rec. 709 RGB; the sky's too.
    pub radiance: Vec3,
    /// 1 where something is in the way of the sky, 0 where not.
    pub alpha: f32,
    /// Colour of the first surface.
    pub albedo: Vec3,
    /// Unit shading normal of the first surface, in world coordinates; 0 when nothing is hit.
    pub normal: Vec3,
    /// Position of the first surface in metres; ignored unless `hit`.
    pub position: Vec3,
    /// Depth of the first surface in metres; ignored unless `hit`.
    pub depth: f32,
    /// Where the first surface goes until the next frame, in pixels to the right and down; ignored unless `hit`.
    pub motion: Vec2,
    /// Whether there is a first surface.
    pub hit: bool,
}

impl FilmSample {
    /// A sample that sees nothing but the sky.
    pub fn of_sky(radiance: Vec3) -> Self {
        let nothing = Vec3::ZERO;
        Self {
            radiance,
            alpha: 0.0,
            albedo: nothing,
            normal: nothing,
            position: nothing,
            depth: 0.0,
            motion: Vec2::ZERO,
            hit: false,
        }
    }

    pub(super) fn is_finite(&self) -> bool {
        let always = self.radiance.is_finite()
            && self.alpha.is_finite()
            && self.albedo.is_finite()
            && self.normal.is_finite();
        always
            && (!self.hit || (self.position.is_finite() && self.depth.is_finite() && self.motion.is_finite()))
    }
}

/// A finished pixel.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pixel {
    /// Mean radiance, linear Rec. 709 RGB.
    pub rgb: Vec3,
    /// Mean coverage.
    pub alpha: f32,
    /// Mean albedo.
    pub albedo: Vec3,
    /// Mean of the unit normals; shorter than 1 where they differ, as denoisers expect.
    pub normal: Vec3,
    /// Mean position of the samples that hit something; 0 when none did.
    pub position: Vec3,
    /// Mean depth of the samples that hit something; [`FAR_DEPTH`] when none did.
    pub depth: f32,
    /// Mean motion of the samples that hit something, in pixels a frame; 0 when none did.
    pub motion: Vec2,
    /// Variance of the mean of each channel; 0 when it is unknown.
    pub variance: Vec3,
    /// Variance of the mean luminance; 0 when it is unknown.
    pub luminance_variance: f32,
    /// What each replicate brings to it: equation (2). Their squares add up to it.
    pub deviations: [f32; REPLICATES],
    /// Samples in the mean.
    pub samples: u32,
    /// Replicates with samples. The variance is unknown below two.
    pub replicates: u32,
    /// Samples left out because a number in them was not finite.
    pub rejected: u32,
}

impl Pixel {
    /// A pixel without samples.
    pub const EMPTY: Self = Self {
        rgb: Vec3::ZERO,
        alpha: 0.0,
        albedo: Vec3::ZERO,
        normal: Vec3::ZERO,
        position: Vec3::ZERO,
        depth: FAR_DEPTH,
        motion: Vec2::ZERO,
        variance: Vec3::ZERO,
        luminance_variance: 0.0,
        deviations: [0.0; REPLICATES],
        samples: 0,
        replicates: 0,
        rejected: 0,
    };

    /// Whether the variances are known.
    pub fn has_variance(&self) -> bool {
        self.replicates >= 2
    }
}

impl Default for Pixel {
    fn default() -> Self {
        Self::EMPTY
    }
}

/// Sums over the samples of one pixel.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PixelAccumulator {
    /// Radiance of each replicate, and what [`Features`] are made of.
    sums: ExactSums,
    /// Samples of each replicate.
    samples: [u32; REPLICATES],
    hits: u32,
    rejected: u32,
}

/// Where the sums of features begin: those of all samples, and of samples with a first surface.
const FEATURES: usize = 3 * REPLICATES;
const SURFACES: usize = FEATURES + 7;

impl PixelAccumulator {
    /// An accumulator without samples.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a sample to a replicate; replicates are numbered from 0 and wrap at [`REPLICATES`].
    #[inline]
    pub fn add(&mut self, replicate: usize, sample: &FilmSample) {
        if !cfg!(floe_without_guards) && !sample.is_finite() {
            self.rejected += 1;
            return;
        }
        let replicate = replicate % REPLICATES;
        self.samples[replicate] += 1;
        self.sums.add(3 * replicate, sample.radiance.to_array());
        let ([r, g, b], [x, y, z]) = (sample.albedo.to_array(), sample.normal.to_array());
        self.sums.add(FEATURES, [sample.alpha, r, g, b, x, y, z]);
        if sample.hit {
            let ([x, y, z], [u, v]) = (sample.position.to_array(), sample.motion.to_array());
            self.hits += 1;
            self.sums.add(SURFACES, [x, y, z, sample.depth, u, v]);
        }
    }

    /// Samples in the sums so far.
    pub fn samples(&self) -> u32 {
        self.samples.iter().sum()
    }

    /// Whether so many samples have come, those included that were left out; of sums that may be anyone's.
    pub(crate) fn has_seen(&self, samples: u32) -> bool {
        let kept: u64 = self.samples.iter().map(|&n| u64::from(n)).sum();
        kept + u64::from(self.rejected) == u64::from(samples) && u64::from(self.hits) <= kept
    }

    /// Means and variances of what was added.
    pub fn finish(&self) -> Pixel {
        let samples = self.samples();
        if samples == 0 {
            return Pixel { rejected: self.rejected, ..Pixel::EMPTY };
        }
        let n = f64::from(samples);
        let sums = self.sums.values();
        let replicates: [Replicate; REPLICATES] = std::array::from_fn(|r| Replicate {
            radiance: DVec3::from_slice(&sums[3 * r..]),
            samples: self.samples[r],
        });
        let mean = replicates.iter().map(|r| r.radiance).sum::<DVec3>() / n;
        let (channels, deviations) = variance_of_mean(&replicates, mean, n).unwrap_or_default();
        let (variance, luminance_variance) = in_range(channels, sum_of_squares(deviations));
        Pixel {
            rgb: mean.as_vec3(),
            variance,
            luminance_variance,
            deviations: deviations.map(|d| d as f32),
            samples,
            replicates: filled(&replicates).count() as u32,
            rejected: self.rejected,
            ..Features::of(&sums[FEATURES..], self.hits).pixel(n)
        }
    }
}

impl AddAssign<&Self> for PixelAccumulator {
    fn add_assign(&mut self, other: &Self) {
        self.sums += &other.sums;
        for (own, other) in self.samples.iter_mut().zip(other.samples) {
            *own += other;
        }
        self.hits += other.hits;
        self.rejected += other.rejected;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::splitmix::SplitMix;

    fn grey(value: f64) -> FilmSample {
        FilmSample {
            radiance: Vec3::splat(value as f32),
            alpha: 1.0,
            albedo: Vec3::splat(0.5),
            normal: Vec3::Z,
            position: Vec3::ONE,
            depth: 2.0,
            motion: Vec2::X,
            hit: true,
        }
    }

    /// Ratio of the mean estimated variance to the true one, and the standard error of that ratio.
    fn variance_ratio(samples: usize, pixels: usize) -> (f64, f64) {
        let mut random = SplitMix(samples as u64);
        // Variance 1/12 a sample, from a uniform number.
        let truth = 1.0 / 12.0 / samples as f64;
        let (mut sum, mut squares) = (0.0, 0.0);
        for _ in 0..pixels {
            let mut pixel = PixelAccumulator::new();
            for i in 0..samples {
                pixel.add(i, &grey(random.uniform()));
            }
            let ratio = f64::from(pixel.finish().luminance_variance) / truth;
            sum += ratio;
            squares += ratio * ratio;
        }
        let n = pixels as f64;
        let mean = sum / n;
        (mean, ((squares / n - mean * mean) / n).sqrt())
    }

    /// Within four standard errors (significance 6e-5 each); 40,000 pixels see a bias of 2 %.
    #[test]
    fn the_variance_is_unbiased_for_independent_samples_whatever_their_number() {
        for samples in [2, 3, 4, 5, 6, 7, 16, 18] {
            let (ratio, error) = variance_ratio(samples, 40_000);
            assert!(error < 0.01, "too few pixels for {samples} samples: {error}");
            assert!((ratio - 1.0).abs() < 4.0 * error, "{samples} samples: {ratio} +- {error}");
        }
    }

    /// The closed form of the bias that the module's head states, for variance within a replicate ~ n^-power.
    #[test]
    fn unequal_replicates_of_a_faster_sequence_are_biased_little() {
        for (power, limit) in [(2.0, 0.02), (3.0, 0.08)] {
            for samples in 20..200_usize {
                let count = |r: usize| (samples / REPLICATES + usize::from(r < samples % REPLICATES)) as f64;
                let w: Vec<f64> = (0..REPLICATES).map(|r| count(r) / samples as f64).collect();
                let own: Vec<f64> = (0..REPLICATES).map(|r| count(r).powf(-power)).collect();
                let v: f64 = w.iter().zip(&own).map(|(w, s)| w * w * s).sum();
                let expectation: f64 =
                    w.iter().zip(&own).map(|(w, s)| w * w * ((1.0 - 2.0 * w) * s + v)).sum();
                let estimate = expectation / (1.0 - w.iter().map(|w| w * w).sum::<f64>());
                assert!((estimate / v - 1.0).abs() < limit, "n^-{power}, {samples}: {}", estimate / v);
            }
        }
    }

    #[test]
    fn equal_replicates_give_the_textbook_formula() {
        let mut pixel = PixelAccumulator::new();
        for (replicate, value) in [(0, 1.0), (1, 2.0), (2, 4.0), (3, 5.0)] {
            pixel.add(replicate, &grey(value));
            pixel.add(replicate, &grey(value));
        }
        let pixel = pixel.finish();
        // Mean 3, squared differences 4 + 1 + 1 + 4 = 10, over R (R - 1) = 12.
        assert_eq!(pixel.rgb, Vec3::splat(3.0));
        assert!((pixel.variance - Vec3::splat(10.0 / 12.0)).abs().max_element() < 1e-7);
        assert!((pixel.luminance_variance - 10.0 / 12.0).abs() < 1e-6);
        assert_eq!((pixel.samples, pixel.replicates), (8, 4));
    }

    #[test]
    fn luminance_variance_knows_that_channels_cancel() {
        let mut pixel = PixelAccumulator::new();
        for replicate in 0..REPLICATES {
            let t = replicate as f32;
            let radiance = Vec3::new(t, 3.0 - t * 0.2126 / 0.7152, 1.0);
            pixel.add(replicate, &FilmSample { radiance, ..grey(0.0) });
        }
        let pixel = pixel.finish();
        assert!(pixel.variance.x > 0.1 && pixel.variance.y > 0.01 && pixel.variance.z == 0.0);
        assert!(pixel.luminance_variance < 1e-12, "{}", pixel.luminance_variance);
    }

    #[test]
    fn one_replicate_leaves_the_variance_unknown() {
        let mut pixel = PixelAccumulator::new();
        pixel.add(2, &grey(1.0));
        pixel.add(2, &grey(3.0));
        let pixel = pixel.finish();
        assert!(!pixel.has_variance());
        assert_eq!((pixel.variance, pixel.luminance_variance), (Vec3::ZERO, 0.0));
        assert_eq!(pixel.rgb, Vec3::splat(2.0));
    }

    #[test]
    fn samples_that_are_not_finite_are_counted_and_left_out() {
        let mut pixel = PixelAccumulator::new();
        pixel.add(0, &grey(1.0));
        pixel.add(1, &FilmSample { radiance: Vec3::new(0.0, f32::NAN, 0.0), ..grey(1.0) });
        pixel.add(2, &FilmSample { radiance: Vec3::splat(f32::INFINITY), ..grey(1.0) });
        pixel.add(3, &FilmSample { normal: Vec3::splat(f32::NAN), ..grey(1.0) });
        let pixel = pixel.finish();
        assert_eq!((pixel.samples, pixel.replicates, pixel.rejected), (1, 1, 3));
        assert_eq!(pixel.rgb, Vec3::ONE);

        let mut nothing = PixelAccumulator::new();
        nothing.add(0, &FilmSample { alpha: f32::NAN, ..grey(1.0) });
        assert_eq!(nothing.finish(), Pixel { rejected: 1, ..Pixel::EMPTY });
    }

    #[test]
    fn position_and_depth_are_means_over_hits_only() {
        let sky = FilmSample {
            radiance: Vec3::ONE,
            alpha: 0.0,
            albedo: Vec3::ZERO,
            normal: Vec3::ZERO,
            position: Vec3::splat(f32::INFINITY),
            depth: f32::INFINITY,
            motion: Vec2::NAN,
            hit: false,
        };
        let mut pixel = PixelAccumulator::new();
        pixel.add(0, &grey(0.0));
        pixel.add(1, &FilmSample { depth: 4.0, motion: Vec2::Y, normal: Vec3::X, ..grey(0.0) });
        pixel.add(2, &sky);
        pixel.add(3, &sky);
        let pixel = pixel.finish();
        assert_eq!((pixel.alpha, pixel.depth, pixel.position), (0.5, 3.0, Vec3::ONE));
        assert_eq!((pixel.normal, pixel.motion), (Vec3::new(0.25, 0.0, 0.25), Vec2::splat(0.5)));
        assert_eq!(pixel.rejected, 0);

        let mut empty = PixelAccumulator::new();
        empty.add(0, &sky);
        let empty = empty.finish();
        assert_eq!((empty.depth, empty.position, empty.rgb), (FAR_DEPTH, Vec3::ZERO, Vec3::ONE));
    }
}
