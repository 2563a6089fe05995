//! The pictures of one budget: what each is measured to be, and what they are together.

use glam::Vec3;
use serde::Serialize;

use super::bias::{Bias, bias, luminances, region_means};
use super::reference::{Noise, Reference, Spread};
use super::run::Run;
use crate::film::{DEFAULT_CONFIDENCE, estimate_error};
use crate::study::flip::{PIXELS_PER_DEGREE, hdr_flip};
use crate::study::metrics::{RelativeMse, mean, relative_differences, relative_squared_errors, rmse};
use crate::study::statistics::Estimate;

/// One picture against the reference; squared errors without what the reference's own noise adds.
#[derive(Clone, Copy, Debug)]
struct Measured {
    seconds: f64,
    cpu_seconds: f64,
    rays: f64,
    mse: f64,
    relative: RelativeMse,
    /// The square of what [`estimate_error`] estimates, and its estimate.
    true_square: f64,
    estimated: f64,
    flip: f64,
}

/// The pictures of a budget so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Tally {
    measured: Vec<Measured>,
    spread: Spread,
    regions: Vec<Vec<f64>>,
}

/// A budget of a series.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BudgetPoint {
    /// Samples a pixel.
    pub samples: u32,
    /// Pictures, each with its own seed.
    pub repeats: usize,
    /// CPU seconds of a picture.
    pub cpu_seconds: Estimate,
    /// Seconds of a picture on the clock.
    pub seconds: f64,
    /// Rays of a picture.
    pub rays: f64,
    /// (1) of [`super`].
    pub rmse: Estimate,
    /// (2) of [`super`].
    pub relative_mse: Estimate,
    /// The same without the worst hundredth of the pixels, reference's noise and all.
    pub trimmed: f64,
    /// The median over pixels, reference's noise and all.
    pub median: f64,
    /// Mean FLIP.
    pub flip: f64,
    /// (3) of [`super`].
    pub variance: f64,
    /// (4) of [`super`].
    pub efficiency: f64,
    /// (5) of [`super`], and of the trimmed mean and the median.
    pub cost: [f64; 3],
    /// The relative error that rendering itself estimates.
    pub estimated_error: f64,
    /// What that is an estimate of.
    pub true_error: f64,
    /// How the pictures' mean differs from the reference.
    pub bias: Bias,
}

impl Tally {
    /// Measures a picture.
    pub fn add(&mut self, run: &Run, reference: &Reference, noise: &Noise) {
        let colours: Vec<Vec3> = run.image.pixels.iter().map(|pixel| pixel.rgb).collect();
        let errors = relative_squared_errors(&colours, &reference.colours);
        let Some(relative) = RelativeMse::of(&errors) else { return };
        let differences = relative_differences(&colours, &reference.colours);
        let square = differences.iter().map(|d| d * d).sum::<f64>() / differences.len() as f64;
        let root = rmse(&colours, &reference.colours);
        let flips = hdr_flip(&colours, &reference.colours, reference.width, PIXELS_PER_DEGREE);
        self.measured.push(Measured {
            seconds: run.seconds,
            cpu_seconds: run.cpu_seconds,
            rays: run.rays as f64,
            mse: root * root - noise.mse,
            relative: RelativeMse { mean: relative.mean - noise.relative_mse, ..relative },
            true_square: square - noise.luminance,
            estimated: estimate_error(&run.image, DEFAULT_CONFIDENCE).map_or(f64::NAN, |e| e.relative),
            flip: mean(&flips.iter().map(|f| f64::from(*f)).collect::<Vec<_>>()).unwrap_or(0.0),
        });
        self.spread.add(colours.into_iter());
        self.regions.push(region_means(reference.width, &luminances(&run.image)));
    }

    /// Pictures so far.
    pub fn repeats(&self) -> usize {
        self.measured.len()
    }

    /// What they are together; `None` of fewer than two.
    pub fn point(&self, samples: u32, reference: &Reference) -> Option<BudgetPoint> {
        if self.repeats() < 2 {
            return None;
        }
        let cpu_seconds = Estimate::of_mean(&self.all(|m| m.cpu_seconds));
        let of_mean = |value: fn(&Measured) -> f64| Estimate::of_mean(&self.all(value)).value;
        let relative_mse = Estimate::of_mean(&self.all(|m| m.relative.mean));
        let (trimmed, median) = (of_mean(|m| m.relative.trimmed), of_mean(|m| m.relative.median));
        let variances: Vec<f64> = self.spread.variances().map(|v| v.element_sum() / 3.0).collect();
        let variance = mean(&variances).unwrap_or(f64::NAN);
        Some(BudgetPoint {
            samples,
            repeats: self.repeats(),
            cpu_seconds,
            seconds: of_mean(|m| m.seconds),
            rays: of_mean(|m| m.rays),
            rmse: root(Estimate::of_mean(&self.all(|m| m.mse))),
            relative_mse,
            trimmed,
            median,
            flip: of_mean(|m| m.flip),
            variance,
            efficiency: 1.0 / (variance * cpu_seconds.value),
            cost: [relative_mse.value, trimmed, median].map(|error| error * cpu_seconds.value),
            estimated_error: of_mean(|m| m.estimated),
            true_error: of_mean(|m| m.true_square).max(0.0).sqrt(),
            bias: bias(&self.regions, reference),
        })
    }

    /// ln CPU seconds, ln rmse, and ln of the true error of each picture; `None` when the reference is not good enough for
    /// one of them.
    pub fn logarithms(&self) -> Option<Vec<[f64; 3]>> {
        let logarithms = self.measured.iter().map(|m| {
            let all = [m.cpu_seconds, m.mse.max(0.0).sqrt(), m.true_square.max(0.0).sqrt()].map(libm::log);
            all.iter().all(|l| l.is_finite()).then_some(all)
        });
        logarithms.collect()
    }

    fn all(&self, value: impl Fn(&Measured) -> f64) -> Vec<f64> {
        self.measured.iter().map(value).collect()
    }
}

/// The root of a mean square; its interval follows from the derivative.
fn root(square: Estimate) -> Estimate {
    let value = square.value.max(0.0).sqrt();
    Estimate { value, half_width: 0.5 * square.half_width / value }
}

#[cfg(test)]
mod tests {
    use super::super::reference::tests::{SIZE, picture, reference};
    use super::*;
    use crate::film::SplitMix;
    use crate::film::{FrameImage, Pixel};

    fn run(colours: &[Vec3], cpu_seconds: f64) -> Run {
        let pixels = colours.iter().map(|rgb| Pixel { rgb: *rgb, samples: 1, ..Pixel::EMPTY }).collect();
        let image = FrameImage { width: SIZE as u32, height: SIZE as u32, pixels };
        Run { image, seconds: 2.0 * cpu_seconds, cpu_seconds, rays: 7 }
    }

    /// Pictures of noise 0.05 against 40 references of noise 0.1 / 8^(1/2), which adds half as much again to each mean
    /// square: without its variance they are as far off as they are noisy. A reference's mean square over 576 grey
    /// pixels is known to (2 / 576 (1 + 1 / 7))^(1/2) of itself, its own variance being of 7 degrees of freedom, a picture's to
    /// (2 / 576)^(1/2), their product to 2 (0.5 / 576)^(1/2): 0.1 of 0.05^2 in all, 1.6 % in the mean of 40, of which there
    /// are four.
    #[test]
    fn the_references_noise_is_taken_off() {
        let mut random = SplitMix(9);
        let (mut mse, mut relative, mut expected) = (0.0, 0.0, 0.0);
        for _ in 0..40 {
            let reference = reference(&mut random, 0.1, 0.0);
            let mut tally = Tally::default();
            for _ in 0..2 {
                tally.add(
                    &run(&picture(&mut random, 0.05, 0.0, 1.0), 0.5),
                    &reference,
                    &reference.corrections(),
                );
            }
            let point = tally.point(4, &reference).unwrap();
            mse += point.rmse.value * point.rmse.value / 40.0;
            relative += point.relative_mse.value / 40.0;
            // |R|^2 of noisy greys, of which the truth would have 3 (0.2 ..)^2.
            let weights = reference.colours.iter().map(|c| 3.0 / (f64::from(c.length_squared()) + 4e-4));
            expected += 0.0025 * weights.sum::<f64>() / reference.colours.len() as f64 / 40.0;
        }
        assert!((mse / 0.0025 - 1.0).abs() < 0.064, "{mse}");
        // Dark pixels count most: about a quarter of them tell, so twice the error.
        assert!((relative / expected - 1.0).abs() < 0.13, "{relative} for {expected}");
    }

    #[test]
    fn a_point_adds_up() {
        let reference = reference(&mut SplitMix(1), 0.0, 0.0);
        let mut tally = Tally::default();
        assert_eq!(tally.point(4, &reference), None);
        for gain in [1.0, 3.0] {
            let colours: Vec<Vec3> =
                reference.colours.iter().map(|c| *c + Vec3::splat(0.1 * (gain - 2.0))).collect();
            tally.add(&run(&colours, 0.5), &reference, &reference.corrections());
        }
        let point = tally.point(4, &reference).unwrap();
        // Two pictures, 0.1 below and above: a mean square of 0.01 and a variance of 0.02. Colours are single precision.
        let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-5;
        assert!(close(point.rmse.value, 0.1) && close(point.variance, 0.02), "{point:?}");
        assert!(close(point.efficiency, 1.0 / (0.02 * 0.5)) && close(point.seconds, 1.0), "{point:?}");
        assert!(close(point.cost[0], 0.5 * point.relative_mse.value) && point.rays == 7.0, "{point:?}");
        assert!(point.bias.relative.abs() < 1e-6 && point.bias.p > 0.9 && point.flip > 0.0, "{point:?}");
        assert!(point.estimated_error.is_nan() && point.true_error > 0.0, "{point:?}");
        assert_eq!(tally.logarithms().map(|l| l.len()), Some(2));
    }
}
