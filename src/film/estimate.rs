//! How far a frame is from the converged picture, from its own samples.
//!
//! ```text
//! e^2 = mean over pixels of  V / (L^2 + 0.02^2)                                     (1)
//! ```
//!
//! L is the luminance of a pixel's mean and V the estimated variance of that luminance. The constant keeps black pixels
//! from counting without limit. The confidence interval is the normal one for the mean in (1) over pixels, mapped
//! through the root; it is clamped at 0.
//!
//! Valid where pixels have independent errors and there are many of them (a thousand are plenty). Errors that all
//! pixels share make the interval too narrow. L is itself noisy, which biases e^2 by about 3 V / L^2 of itself, and
//! the interval includes the variety of the pixels, which makes it wide rather than narrow. The unit test
//! `the_interval_holds_the_true_error_as_often_as_it_says` checks its rate.

use super::frame_image::FrameImage;
use crate::spectrum::luminance::luminance_f64;

/// Luminance below which errors count as absolute.
pub const LUMINANCE_FLOOR: f64 = 0.02;

/// Confidence of the interval unless the caller asks for another.
pub const DEFAULT_CONFIDENCE: f64 = 0.95;

/// A frame's relative error with its confidence interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorEstimate {
    /// The root of (1).
    pub relative: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval; infinite for a single pixel.
    pub high: f64,
    /// Rate at which such intervals hold the true error.
    pub confidence: f64,
}

/// Estimates the relative error of a frame; `confidence` is in (0, 1).
///
/// Pixels of unknown variance (fewer than two replicates) are left out; `None` when there are no others.
pub fn estimate_error(image: &FrameImage, confidence: f64) -> Option<ErrorEstimate> {
    let (mut n, mut mean, mut spread) = (0.0, 0.0, 0.0);
    for pixel in image.pixels.iter().filter(|p| p.has_variance()) {
        let luminance = luminance_f64(pixel.rgb.as_dvec3());
        let floor = LUMINANCE_FLOOR * LUMINANCE_FLOOR;
        let relative = f64::from(pixel.luminance_variance) / (luminance * luminance + floor); // (1)
        // Welford's update: no cancellation when the pixels are alike.
        n += 1.0;
        let difference = relative - mean;
        mean += difference / n;
        spread += difference * (relative - mean);
    }
    if n == 0.0 {
        return None;
    }
    let half_width = match n {
        1.0 => f64::INFINITY,
        _ => two_sided_normal_quantile(confidence) * (spread / (n - 1.0) / n).sqrt(),
    };
    Some(ErrorEstimate {
        relative: mean.sqrt(),
        low: (mean - half_width).max(0.0).sqrt(),
        high: (mean + half_width).sqrt(),
        confidence,
    })
}

/// z such that a standard normal number lies within +-z with the given probability, by bisection.
///
/// Probabilities are clamped to [0, 1 - 1e-12].
fn two_sided_normal_quantile(probability: f64) -> f64 {
    let outside = 1.0 - probability.clamp(0.0, 1.0 - 1e-12);
    let (mut low, mut high) = (0.0, 10.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if libm::erfc(middle * std::f64::consts::FRAC_1_SQRT_2) > outside {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3};

    use super::*;
    use crate::film::accumulate::{FilmSample, Pixel, PixelAccumulator};
    use crate::film::splitmix::SplitMix;

    fn sample(radiance: f64) -> FilmSample {
        FilmSample {
            radiance: Vec3::splat(radiance as f32),
            alpha: 1.0,
            albedo: Vec3::ZERO,
            normal: Vec3::ZERO,
            position: Vec3::ZERO,
            depth: 0.0,
            motion: Vec2::ZERO,
            hit: false,
        }
    }

    /// Noise of relative deviation `noise` a sample on pixels of luminance 0.1 to 2.
    fn synthetic(random: &mut SplitMix, side: u32, samples: u32, noise: f64) -> (FrameImage, f64) {
        let mut image = FrameImage::new(side, side);
        let mut truth = 0.0;
        let n = f64::from(side * side);
        for (i, pixel) in image.pixels.iter_mut().enumerate() {
            let luminance = 0.1 + 1.9 * i as f64 / n;
            let mut sums = PixelAccumulator::new();
            for s in 0..samples {
                sums.add(s as usize, &sample(luminance * (1.0 + noise * random.normal())));
            }
            *pixel = sums.finish();
            let variance = luminance * luminance * noise * noise / f64::from(samples);
            truth += variance / (luminance * luminance + 4e-4) / n;
        }
        (image, truth.sqrt())
    }

    /// 400 intervals of confidence 0.95: 380 +- 4.4 hold the truth. 362 is four deviations below (3e-5), and 398
    /// four above: an interval that always holds the truth says too little.
    #[test]
    fn the_interval_holds_the_true_error_as_often_as_it_says() {
        let mut random = SplitMix(11);
        let mut held = 0;
        for _ in 0..400 {
            let (image, truth) = synthetic(&mut random, 32, 4, 0.04);
            let estimate = estimate_error(&image, DEFAULT_CONFIDENCE).unwrap();
            assert!(estimate.low < estimate.relative && estimate.relative < estimate.high);
            held += i32::from(estimate.low <= truth && truth <= estimate.high);
        }
        assert!((362..398).contains(&held), "{held} of 400 intervals hold the true error");
    }

    #[test]
    fn more_samples_halve_the_error_as_they_should() {
        let mut random = SplitMix(5);
        let few = estimate_error(&synthetic(&mut random, 64, 4, 0.1).0, 0.95).unwrap();
        let many = estimate_error(&synthetic(&mut random, 64, 16, 0.1).0, 0.95).unwrap();
        // Each mean of 4096 chi-squares of 3 degrees is known to 1.3 %, its root to 0.65 %: 4 % is over four deviations.
        assert!((few.relative / many.relative - 2.0).abs() < 0.08, "{few:?} {many:?}");
    }

    #[test]
    fn unknown_variances_are_no_estimate() {
        let mut random = SplitMix(5);
        let (one, _) = synthetic(&mut random, 4, 1, 0.1);
        assert_eq!(estimate_error(&one, 0.95), None);
        assert_eq!(estimate_error(&FrameImage::new(0, 0), 0.95), None);

        let mut mixed = FrameImage::new(2, 1);
        mixed.pixels[0] =
            Pixel { rgb: Vec3::ONE, luminance_variance: 0.01, samples: 4, replicates: 4, ..Pixel::EMPTY };
        let estimate = estimate_error(&mixed, 0.95).unwrap();
        assert!((estimate.relative - (0.01_f64 / 1.0004).sqrt()).abs() < 1e-6);
        assert_eq!((estimate.low, estimate.high), (0.0, f64::INFINITY));
    }

    #[test]
    fn quantiles_are_the_tables() {
        // Abramowitz and Stegun, table 26.5.
        for (p, z) in [(0.0, 0.0), (0.5, 0.674_489_75), (0.95, 1.959_963_98), (0.99, 2.575_829_30)] {
            assert!((two_sided_normal_quantile(p) - z).abs() < 1e-8, "{p}");
        }
        assert!(two_sided_normal_quantile(1.0).is_finite());
    }
}
