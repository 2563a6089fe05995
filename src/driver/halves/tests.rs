use glam::{Vec2, Vec3};

use super::*;
use crate::film::{DEFAULT_CONFIDENCE, Pixel, SplitMix};

struct Unwatched;
impl Control for Unwatched {}

/// What a pixel is made of: independent samples of these means.
#[derive(Clone, Copy)]
enum Noise {
    /// 10 times the mean with a probability of a tenth, else nothing.
    Rare,
    /// Normal, of a deviation of a quarter of the mean.
    Normal,
}

impl Noise {
    fn sample(self, random: &mut SplitMix) -> f64 {
        match self {
            Self::Rare => 10.0 * f64::from(u8::from(random.uniform() < 0.1)),
            Self::Normal => 1.0 + 0.25 * random.normal(),
        }
    }
}

/// A frame of noise that has stopped.
struct Frame {
    accumulation: Accumulation,
}

impl Frame {
    /// Pixels of mean 1.
    fn new(noise: Noise, [width, height]: [u32; 2], error: f64, seed: u64) -> Self {
        let sample = |_: &mut Scratch, (x, y): (u32, u32), index: u32| {
            let of_pixel = u64::from(y * width + x) << 32 | u64::from(index);
            let mut random = SplitMix(SplitMix(seed).bits() ^ SplitMix(of_pixel).bits());
            FilmSample {
                radiance: Vec3::splat(noise.sample(&mut random) as f32),
                alpha: 1.0,
                albedo: Vec3::ZERO,
                normal: Vec3::ZERO,
                position: Vec3::ZERO,
                depth: 0.0,
                motion: Vec2::ZERO,
                hit: false,
            }
        };
        let mut accumulation = Accumulation::new([width, height]);
        let ladder = Ladder { limit: 1 << 14 };
        let target = Target { error, confidence: DEFAULT_CONFIDENCE };
        let rounds = HalfRounds { target, ladder, control: &Unwatched, sample: &sample };
        assert_eq!(rounds.run(&mut accumulation), Some(StoppedBy::Target));
        Self { accumulation }
    }
}

/// Means over many pixels: of the mean's error, of its square, and of the variance that is reported.
#[derive(Default)]
struct Errors {
    pixels: f64,
    error: f64,
    squared: f64,
    fourth: f64,
    reported: f64,
}

impl Errors {
    fn add(&mut self, pixel: &Pixel) {
        let error = f64::from(pixel.rgb.x) - 1.0;
        self.pixels += 1.0;
        self.error += error;
        self.squared += error * error;
        self.fourth += error.powi(4);
        self.reported += f64::from(pixel.luminance_variance);
    }

    /// The mean error in standard errors.
    fn score(&self) -> f64 {
        self.error / self.squared.sqrt()
    }

    /// The mean square relative to what was reported, and its standard error.
    fn ratio(&self) -> (f64, f64) {
        let spread = (self.fourth - self.squared * self.squared / self.pixels).sqrt();
        (self.squared / self.reported, spread / self.reported)
    }
}

/// Frames of two pixels, so that each has a great say, of which nine samples in ten bring nothing. Those that decide by
/// their own samples stop when they happen to be alike: the mean is off by 9 standard errors, and the variance that they
/// report is a sixth of what it is. Where the halves decide for each other the mean is within four standard errors (6e-5),
/// and so is the reported variance: the covariance of the halves is below what 24,000 pixels show, 1 %.
#[test]
fn halves_that_decide_for_each_other_are_unbiased_and_such_that_decide_for_themselves_are_not() {
    let (mut crossed, mut alone) = (Errors::default(), Errors::default());
    for seed in 0..12_000 {
        let frame = Frame::new(Noise::Rare, [2, 1], 0.4, seed);
        frame.accumulation.image().pixels.iter().for_each(|pixel| crossed.add(pixel));
        for half in 0..HALVES {
            // A half foresees two of its kind, so its own variance is twice what it foresees.
            for pixel in frame.accumulation.image_of(|part| part.halves.foreseen(half)).pixels {
                let luminance_variance = pixel.luminance_variance * HALVES as f32;
                alone.add(&Pixel { luminance_variance, ..pixel });
            }
        }
    }
    assert!(crossed.score().abs() < 4.0, "{} standard errors", crossed.score());
    let (ratio, error) = crossed.ratio();
    assert!(error < 0.03 && (ratio - 1.0).abs() < 4.0 * error, "{ratio} +- {error}");
    assert!(alone.score().abs() > 6.0, "{} standard errors alone", alone.score());
    let (ratio, error) = alone.ratio();
    assert!(ratio > 4.0 + 4.0 * error, "{ratio} +- {error} alone");
}

/// 400 intervals of confidence 0.95 of the error that the very picture has: 380 +- 4.4 hold it. 362 is four deviations below (3e-5), and 398 four above: an
/// interval that always holds the truth says too little.
#[test]
fn intervals_hold_the_true_error_as_often_as_they_say() {
    let mut held = 0;
    for seed in 0..400 {
        let frame = Frame::new(Noise::Normal, [24, 24], 0.03, seed);
        let image = frame.accumulation.image();
        let estimate = estimate_error(&image, DEFAULT_CONFIDENCE).unwrap();
        let squares = image.pixels.iter().map(|p| (f64::from(p.rgb.x) - 1.0).powi(2)).sum::<f64>();
        let truth = (squares / image.pixels.len() as f64 / (1.0 + LUMINANCE_FLOOR * LUMINANCE_FLOOR)).sqrt();
        held += i32::from(estimate.low <= truth && truth <= estimate.high);
    }
    assert!((362..398).contains(&held), "{held} of 400 intervals hold the true error");
}
