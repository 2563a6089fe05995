//! What the random numbers of each frame begin with: `render.seed_mode`.
//!
//! | mode | key of the frame | turn | errors of one frame and the next |
//! |---|---|---|---|
//! | `frame` | its number | 0 | have nothing to do with each other |
//! | `sequence` | 0 | its number | weaken each other: together, frames are sampled as one picture with more samples |
//! | `static` | 0 | 0 | are the same: a pattern that stays where it is on the screen |
//!
//! In `sequence` the stride is what the scene file says of samples, whatever the command line makes of it: a frame that
//! is rendered again with fewer samples fits in with the others. With more samples than the stride, frames would have
//! samples in common and noise that is alike. So a scene that does not say how takes `sequence` only up to the stride,
//! and for whole numbers; else `frame`.
//!
//! Measured in `src/study/temporal.md`.

use super::error::RenderError;
use crate::sampling::SampleSeed;
use crate::scene::description::{RenderDescription, SeedMode};
use crate::sequence::FrameNumber;

/// Gives each frame of a scene its seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameSeeds {
    seed: u64,
    mode: Option<SeedMode>,
    samples: u32,
    stride: u32,
}

impl FrameSeeds {
    /// The seeds of frames with so many samples a pixel; `scene` is what the scene file says.
    pub fn new(scene: &RenderDescription, seed: u64, samples: u32) -> Self {
        let stride = scene.samples.checked_next_power_of_two().unwrap_or(1 << 31);
        Self { seed, mode: scene.seed_mode, samples, stride }
    }

    /// How a frame is seeded, where the scene does not say too.
    pub fn mode(&self, number: FrameNumber) -> SeedMode {
        let can_share = number.integer().is_some() && self.samples <= self.stride;
        self.mode.unwrap_or(if can_share { SeedMode::Sequence } else { SeedMode::Frame })
    }

    /// The seed of a frame.
    ///
    /// # Errors
    /// [`RenderError::DecimalFrame`] for a frame that is not a whole number, when the scene asks for `sequence`.
    pub fn of_frame(&self, number: FrameNumber) -> Result<SampleSeed, RenderError> {
        let seed = SampleSeed::new(self.seed);
        Ok(match self.mode(number) {
            SeedMode::Static => seed,
            SeedMode::Frame => SampleSeed { frame: number.millionths(), ..seed },
            SeedMode::Sequence => {
                let turn = number.integer().ok_or(RenderError::DecimalFrame { number })?;
                SampleSeed { turn, stride: self.stride, ..seed }
            }
        })
    }

    /// What to tell when frames reach into the blocks of those after them.
    pub fn overlap(&self) -> Option<String> {
        let Self { samples, stride, .. } = *self;
        (self.mode == Some(SeedMode::Sequence) && samples > stride).then(|| {
            format!(
                "{samples} samples a pixel reach into those of the next frames, which begin {stride} apart, so that \
                 their noise is alike; write samples = {samples} into [render] of the scene file"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::SampleStream;

    /// Seeds of frames of `rendered` samples, of which the scene wants `samples`.
    fn seeds(mode: Option<SeedMode>, samples: u32, rendered: u32) -> FrameSeeds {
        let scene = RenderDescription { samples, seed_mode: mode, ..RenderDescription::default() };
        FrameSeeds::new(&scene, 9, rendered)
    }

    fn number(text: &str) -> FrameNumber {
        text.parse().unwrap()
    }

    #[test]
    fn each_mode_gives_its_key_and_turn() {
        let of = |mode, text| {
            let seed = seeds(mode, 50, 64).of_frame(number(text)).unwrap();
            assert_eq!(seed.seed, 9);
            (seed.frame, seed.turn)
        };
        assert_eq!(of(Some(SeedMode::Frame), "12"), (12_000_000, 0));
        assert_eq!(of(Some(SeedMode::Frame), "-0.5"), (-500_000, 0));
        assert_eq!(of(Some(SeedMode::Static), "12.5"), (0, 0));
        assert_eq!(of(Some(SeedMode::Sequence), "-12"), (0, -12));
        assert_eq!(of(None, "12"), (0, 12));
        assert_eq!(of(None, "12.5"), (12_500_000, 0));
        assert_eq!(seeds(None, 50, 65).of_frame(number("12")).unwrap().frame, 12_000_000);
    }

    #[test]
    fn the_stride_is_the_power_of_two_that_holds_the_samples_of_the_scene() {
        for (samples, stride) in [(1, 1), (3, 4), (64, 64), (65, 128), (u32::MAX, 1 << 31)] {
            let seed = seeds(Some(SeedMode::Sequence), samples, 1).of_frame(number("1")).unwrap();
            assert_eq!(seed.stride, stride);
        }
    }

    #[test]
    fn a_decimal_number_has_no_turn() {
        let error = seeds(Some(SeedMode::Sequence), 4, 4).of_frame(number("12.5")).unwrap_err().to_string();
        assert!(error.contains("12.5") && error.contains("seed_mode"), "{error}");
    }

    #[test]
    fn more_samples_than_the_stride_are_told() {
        assert_eq!(seeds(Some(SeedMode::Sequence), 50, 64).overlap(), None);
        assert_eq!(seeds(Some(SeedMode::Frame), 50, 65).overlap(), None);
        assert_eq!(seeds(None, 50, 65).overlap(), None);
        let text = seeds(Some(SeedMode::Sequence), 50, 65).overlap().unwrap();
        assert!(text.contains("65 samples") && text.contains("64 apart"), "{text}");
    }

    /// f = u + v from n points of a scrambled net has the variance 2 / (12 n^3): one point lies anywhere in each n-th of
    /// both axes. The mean of eight frames of n points has an eighth of that when the frames have nothing to do with each
    /// other, and that of 8 n points when they are one net: the ratio of the errors is (8^-3 / 8^-1)^(1/2) = 1/8. Over
    /// 4096 pixels each error is known to 1 / sqrt(2 4096) = 1.1 %, so 4 standard errors of their ratio are 6 %.
    #[test]
    fn the_mean_of_eight_frames_in_sequence_has_an_eighth_of_the_error() {
        let error = |mode| {
            let seeds = seeds(Some(mode), 16, 16);
            let squares = (0..4096_u32).map(|pixel| {
                let mut sum = 0.0;
                for frame in 8..16_u32 {
                    let seed = seeds.of_frame(FrameNumber::from(frame)).unwrap();
                    for sample in 0..16 {
                        let u = SampleStream::new(seed, pixel, 3, sample).next4();
                        sum += f64::from(u[0]) + f64::from(u[1]) - 1.0;
                    }
                }
                (sum / 128.0) * (sum / 128.0)
            });
            (squares.sum::<f64>() / 4096.0).sqrt()
        };
        let (frame, sequence) = (error(SeedMode::Frame), error(SeedMode::Sequence));
        // Four replicates of 4 points in each of 8 frames.
        let expected = (2.0_f64 / 12.0 / 64.0 / 4.0 / 8.0).sqrt();
        assert!((frame / expected - 1.0).abs() < 0.045, "{frame} for {expected}");
        assert!((8.0 * sequence / frame - 1.0).abs() < 0.06, "{sequence} against {frame}");
    }
}
