//! How far a frame is from the converged picture, from its own samples.
//!
//! The error is that of this very picture, not the one to be expected of its like:
//!
//! ```text
//! e^2 = 1 / P  sum_p g_p (m_p - mu_p)^2          g_p = 1 / (mu_p^2 + 0.02^2)           (1)
//! ```
//!
//! m_p is the luminance of pixel p and mu_p that of the mean of endlessly many such pictures, with other seeds. For
//! integrators without bias this is the converged picture; what is left out, or blurred by photons, is no part of e. The
//! constant keeps black pixels from counting without limit. The estimate of it is
//!
//! ```text
//! x_p = V_p / (L_p^2 + 0.02^2)                   E^2 = 1 / P  sum_p x_p                (2)
//! ```
//!
//! with the variance V_p from R replicates ([`super::accumulate`]) and the luminance L_p from the pixel and its
//! neighbours (`local_luminance.rs`). A pixel's own m_p would not do: where a rare bright sample is, V and m are too
//! large together, and the estimate is far too low.
//!
//! With the errors y_r of the replicates, weighted with g^(1/2), and R of one size, the difference is
//!
//! ```text
//! E^2 - e^2 = - 1 / (P R (R - 1))  sum_{r /= s} y_r . y_s                              (3)
//! Var(E^2 - e^2) = 2 / nu (1 + 1 / (R - 1)) e^4       nu = tr(K)^2 / tr(K^2)           (4)
//! ```
//!
//! K is the covariance of the pixels in a replicate, and nu the number of equally large, independent errors that the
//! picture amounts to. No fourth moment is in (4): a firefly is in E and in e alike. This holds of normal errors too,
//! of which e^2 / E^2 is F with nu and (R - 1) nu degrees of freedom (Satterthwaite's approximation
//! `[SATTERTHWAITE46]`), and this is the interval. tr(K)^2 is (P E^2)^2, and tr(K^2) has three parts:
//!
//! * Of each pixel, K_pp^2. From V^2 it is x^2 (R - 1) / (R + 1), exact for normal errors and too large for others;
//!   from products of differences of two pairs of replicates it is right for any, but blind to what is rare. The mean
//!   of both is taken.
//! * Of errors that pixels share, as those of photons: the replicates' inner products over the whole picture,
//!   B_rs = sum_p u_rp u_sp / (L_p^2 + 0.02^2). Of R - 1 = 3 contrasts of normal numbers,
//!
//! ```text
//! E (sum_rs B_rs^2 - (tr B)^2 / 3) = 10 / 9  tr(K^2)                                   (5)
//! ```
//!
//!   What that exceeds the pixels' own part by counts 1.7 times, (t / z)^2 of five degrees of freedom at 95 %, since
//!   no more tell it.
//! * Of L: (2) is off by some 3 Q / L^2 of itself where L may be off by Q^(1/2), as the curvature of 1 / L^2 says. Three
//!   times the mean of that over E^2 is [`ErrorEstimate::vagueness`] h; it joins (4) as (3 h)^2.
//!
//! Light that no sample of the picture has found is not in E.
#![doc = include_str!("estimate.md")]

use super::accumulate::{Pixel, REPLICATES};
use super::frame_image::FrameImage;
use super::local_luminance::for_each_pixel;
use super::variance_ratio;

/// Luminance below which errors count as absolute.
pub const LUMINANCE_FLOOR: f64 = 0.02;

/// Confidence of the interval unless the caller asks for another.
pub const DEFAULT_CONFIDENCE: f64 = 0.95;

/// How much more the shared part counts than it is estimated.
const SHARED_FACTOR: f64 = 1.7;

/// Share of the pixels whose part of the error is [`ErrorEstimate::concentration`].
const FEW: f64 = 0.001;

/// Parts of [`ErrorEstimate::concentration`] and [`ErrorEstimate::vagueness`] from which on there is a warning, and
/// the error.
const CONCENTRATED: f64 = 0.5;
const VAGUE: f64 = 0.1;
const WORTH_A_WARNING: f64 = 0.01;

/// A frame's relative error with its confidence interval.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ErrorEstimate {
    /// E, the root of (2).
    pub relative: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval; infinite where next to nothing is known.
    pub high: f64,
    /// Rate at which such intervals hold e.
    pub confidence: f64,
    /// Number nu of independent errors that the picture amounts to.
    pub independent: f64,
    /// Part of E^2 that the thousandth of the pixels with the largest errors has.
    pub concentration: f64,
    /// Relative variance of the luminances that errors are divided by, from 0 to 1.
    pub vagueness: f64,
}

impl ErrorEstimate {
    /// What the user should know of an estimate that hangs on few samples; errors below 1 % are not worth it.
    pub fn warning(&self) -> Option<String> {
        let percent = |part: f64| format!("{:.2} %", 100.0 * part);
        let what = if self.relative < WORTH_A_WARNING {
            return None;
        } else if self.concentration > CONCENTRATED {
            let share = 100.0 * self.concentration;
            format!("0.1 % of the pixels, one at least, carry {share:.0} % of the error (fireflies)")
        } else if self.vagueness > VAGUE {
            "much of the error is of light that few samples find (fireflies)".into()
        } else {
            return None;
        };
        let range = if self.high.is_finite() {
            format!("is between {} and {}", percent(self.low), percent(self.high))
        } else {
            format!("is at least {} and known no better", percent(self.low))
        };
        Some(format!("{what}: it {range}"))
    }
}

/// Estimates the relative error of a frame; `confidence` is in (0, 1).
///
/// Pixels of unknown variance (fewer than two replicates) are left out; `None` when there are no others.
pub fn estimate_error(image: &FrameImage, confidence: f64) -> Option<ErrorEstimate> {
    let mut sums = Sums::default();
    let mut errors = Vec::with_capacity(image.pixels.len());
    for_each_pixel(image, |pixel, local| {
        let square = local.luminance * local.luminance + LUMINANCE_FLOOR * LUMINANCE_FLOOR;
        let error = f64::from(pixel.luminance_variance) / square; // (2)
        sums.add(pixel, error, 1.0 / square, local.variance / square);
        errors.push(error);
    });
    if errors.is_empty() {
        return None;
    }
    let mean = sums.error / errors.len() as f64;
    if mean == 0.0 {
        return Some(ErrorEstimate { confidence, ..ErrorEstimate::default() });
    }
    let vagueness = sums.vague / sums.error;
    let freedom = sums.freedom / sums.error; // R - 1
    let independent = sums.error * sums.error / sums.covariance_squared();
    let variance = 2.0 / independent * (1.0 + 1.0 / freedom) + 9.0 * vagueness * vagueness; // (4)
    let degrees = 2.0 / variance * (1.0 + 1.0 / freedom);
    let (low, high) = variance_ratio::interval(degrees, freedom * degrees, confidence);
    Some(ErrorEstimate {
        relative: mean.sqrt(),
        low: (mean * low).sqrt(),
        high: (mean * high).sqrt(),
        confidence,
        independent,
        concentration: largest(&mut errors) / sums.error,
        vagueness,
    })
}

/// Sum of the errors of the worst pixels.
fn largest(errors: &mut [f64]) -> f64 {
    let few = ((errors.len() as f64 * FEW) as usize).max(1);
    let (above, least, _) = errors.select_nth_unstable_by(few - 1, |a, b| b.total_cmp(a));
    above.iter().sum::<f64>() + *least
}

/// Sums over pixels.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    /// Of x.
    error: f64,
    /// Of (R - 1) x, or of as many degrees of freedom as a pixel has.
    freedom: f64,
    /// Of x Q / (L^2 + 0.02^2).
    vague: f64,
    /// The pixels' part of tr(K^2).
    own: f64,
    /// The same from V^2 alone, of pixels with all replicates.
    own_by_square: f64,
    /// B of such pixels, which is symmetric: r <= s.
    products: [[f64; REPLICATES]; REPLICATES],
}

impl Sums {
    fn add(&mut self, pixel: &Pixel, error: f64, weight: f64, vague: f64) {
        let u = pixel.deviations.map(f64::from);
        let is_whole = pixel.replicates as usize == REPLICATES;
        // A pixel of two halves, each with a mean of its own, has none.
        let is_joined = is_whole && u == [0.0; REPLICATES];
        let freedom = f64::from(pixel.replicates) - if is_joined { 2.0 } else { 1.0 };
        self.error += error;
        self.freedom += freedom * error;
        self.vague += error * vague.min(1.0);
        let by_square = error * error * freedom / (freedom + 2.0);
        if !is_whole || is_joined {
            self.own += by_square;
            return;
        }
        self.own += 0.5 * (by_square + weight * weight * by_pairs(u));
        self.own_by_square += by_square;
        for r in 0..REPLICATES {
            for s in r..REPLICATES {
                self.products[r][s] += weight * u[r] * u[s];
            }
        }
    }

    /// tr(K^2).
    fn covariance_squared(&self) -> f64 {
        let (mut squares, mut trace) = (0.0, 0.0);
        for r in 0..REPLICATES {
            trace += self.products[r][r];
            squares += self.products[r][r] * self.products[r][r];
            squares += self.products[r][r + 1..].iter().map(|product| 2.0 * product * product).sum::<f64>();
        }
        let all = 0.9 * (squares - trace * trace / 3.0); // (5)
        self.own + SHARED_FACTOR * (all - self.own_by_square).max(0.0)
    }
}

/// The square of a variance, from the deviations of four replicates.
///
/// (u_r - u_s)^2 has the expectation 2/3 V, and that of two pairs without a replicate in common are independent.
fn by_pairs([a, b, c, d]: [f64; REPLICATES]) -> f64 {
    let square = |first: f64, second: f64| first * first * second * second;
    0.75 * (square(a - b, c - d) + square(a - c, b - d) + square(a - d, b - c))
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::film::accumulate::{FilmSample, PixelAccumulator};
    use crate::film::splitmix::SplitMix;

    fn sample(radiance: f64) -> FilmSample {
        FilmSample { alpha: 1.0, ..FilmSample::of_sky(Vec3::splat(radiance as f32)) }
    }

    /// A picture of luminances 0.1 to 2 whose samples have relative errors `noise(sample, pixel)`, and its error.
    fn synthetic(side: u32, samples: usize, mut noise: impl FnMut(usize, usize) -> f64) -> (FrameImage, f64) {
        let mut image = FrameImage::new(side, side);
        let pixels = image.pixels.len();
        let luminance = |p: usize| 0.1 + 1.9 * p as f64 / pixels as f64;
        let mut sums = vec![PixelAccumulator::new(); pixels];
        for s in 0..samples {
            for (p, sums) in sums.iter_mut().enumerate() {
                sums.add(s, &sample(luminance(p) * (1.0 + noise(s, p))));
            }
        }
        let mut square = 0.0;
        for (p, (pixel, sums)) in image.pixels.iter_mut().zip(&sums).enumerate() {
            *pixel = sums.finish();
            let truth = luminance(p);
            square += (f64::from(pixel.rgb.x) - truth).powi(2) / (truth * truth + 4e-4);
        }
        (image, (square / pixels as f64).sqrt())
    }

    /// Intervals of 400 pictures, at two confidences, that hold the errors of the pictures.
    fn held(mut picture: impl FnMut() -> (FrameImage, f64)) -> [i32; 2] {
        let mut held = [0; 2];
        for _ in 0..400 {
            let (image, truth) = picture();
            for (count, confidence) in held.iter_mut().zip([0.95, 0.68]) {
                let estimate = estimate_error(&image, confidence).unwrap();
                assert!(
                    estimate.low <= estimate.relative && estimate.relative <= estimate.high,
                    "{estimate:?}"
                );
                *count += i32::from(estimate.low <= truth && truth <= estimate.high);
            }
        }
        held
    }

    /// Of 400 intervals of 0.95, 380 +- 4.4 should hold the error, and of 0.68, 272 +- 9.3. The lower limits are four
    /// deviations below (3e-5). Intervals are a little wide by construction; what may be too many is said where it is used.
    fn assert_held(name: &str, held: [i32; 2], most: [i32; 2]) {
        assert!(held[0] >= 362 && held[1] >= 235, "{name}: {held:?} of 400 hold the error, too few");
        assert!(held[0] <= most[0] && held[1] <= most[1], "{name}: {held:?} of 400 hold the error, too many");
    }

    #[test]
    fn intervals_hold_normal_errors_as_often_as_they_say() {
        let mut random = SplitMix(11);
        let held = held(|| synthetic(16, 4, |_, _| 0.08 * random.normal()));
        assert_held("normal", held, [397, 330]);
    }

    /// One sample in a hundred has all the error: in 256 pixels of 4 samples are ten such.
    #[test]
    fn intervals_hold_fireflies() {
        let mut random = SplitMix(12);
        let held = held(|| synthetic(16, 4, |_, _| if random.uniform() < 0.01 { 1.98 } else { -0.02 }));
        assert_held("fireflies", held, [400, 400]);
    }

    /// Half of the variance is the same in all pixels. That one number is known from three degrees of freedom instead of
    /// five: 356 of 400 were measured, and 102 when the pixels were taken for independent.
    #[test]
    fn intervals_hold_an_error_that_all_pixels_share() {
        let mut random = SplitMix(13);
        let (mut last, mut shared) = (usize::MAX, 0.0);
        let held = held(|| {
            synthetic(16, 8, |s, _| {
                if s != last {
                    (last, shared) = (s, random.normal());
                }
                0.05 * shared + 0.05 * random.normal()
            })
        });
        assert!((340..=390).contains(&held[0]) && (235..=350).contains(&held[1]), "{held:?} of 400");
    }

    /// In a fifth of the pixels of an even picture a sample in twenty has all the light: their own mean says that there is
    /// none, or too much. Each pixel on its own would give a third of the error.
    #[test]
    fn rare_light_is_divided_by_what_the_neighbours_have() {
        let mut random = SplitMix(14);
        let (mut estimates, mut errors) = (0.0, 0.0);
        for _ in 0..40 {
            let rare = |random: &mut SplitMix| if random.uniform() < 0.05 { 19.0 } else { -1.0 };
            let (image, error) = synthetic(32, 4, |_, p| if p % 5 == 0 { rare(&mut random) } else { 0.0 });
            estimates += estimate_error(&image, 0.95).unwrap().relative.powi(2);
            errors += error * error;
        }
        // The mean of 8192 pixels with a fifth of 4 samples each is known to 5 %.
        assert!((0.7..1.2).contains(&(estimates / errors)), "{}", estimates / errors);
    }

    #[test]
    fn more_samples_halve_the_error_as_they_should() {
        let mut random = SplitMix(5);
        let mut estimate =
            |samples| estimate_error(&synthetic(64, samples, |_, _| 0.1 * random.normal()).0, 0.95).unwrap();
        let (few, many) = (estimate(4), estimate(16));
        // Each mean of 4096 chi-squares of 3 degrees is known to 1.3 %, its root to 0.65 %: 4 % is over four deviations.
        assert!((few.relative / many.relative - 2.0).abs() < 0.08, "{few:?} {many:?}");
    }

    #[test]
    fn what_a_few_pixels_carry_is_told() {
        let mut random = SplitMix(6);
        let even = estimate_error(&synthetic(64, 4, |_, _| 0.1 * random.normal()).0, 0.95).unwrap();
        assert!(even.concentration < 0.02 && even.independent > 2000.0, "{even:?}");
        let one = |s, p| if (s, p) == (1, 2100) { 800.0 } else { 0.1 * random.normal() };
        let one = estimate_error(&synthetic(64, 4, one).0, 0.95).unwrap();
        assert!(one.concentration > 0.5 && one.high > 1.5 * one.low, "{one:?}");
        assert_eq!(even.warning(), None);
        assert!(one.warning().unwrap().starts_with("0.1 % of the pixels, one at least, carry"), "{one:?}");
        let endless = ErrorEstimate { high: f64::INFINITY, ..one };
        assert!(endless.warning().unwrap().contains("at least"));
        assert_eq!(ErrorEstimate { relative: 0.009, ..one }.warning(), None);
    }

    #[test]
    fn unknown_variances_are_no_estimate() {
        let (one, _) = synthetic(4, 1, |_, _| 0.1);
        assert_eq!(estimate_error(&one, 0.95), None);
        assert_eq!(estimate_error(&FrameImage::new(0, 0), 0.95), None);

        let mut mixed = FrameImage::new(2, 1);
        mixed.pixels[0] =
            Pixel { rgb: Vec3::ONE, luminance_variance: 0.01, samples: 2, replicates: 2, ..Pixel::EMPTY };
        let estimate = estimate_error(&mixed, 0.95).unwrap();
        assert!((estimate.relative - (0.01_f64 / 1.0004).sqrt()).abs() < 1e-6);
        assert!(estimate.low < 0.03 && estimate.high > 0.4, "{estimate:?}");
    }

    #[test]
    fn a_picture_without_noise_has_no_error() {
        let (image, error) = synthetic(4, 4, |_, _| 0.0);
        let estimate = estimate_error(&image, 0.95).unwrap();
        assert!(error < 1e-6 && estimate.high < 1e-6, "{estimate:?}");
    }
}
