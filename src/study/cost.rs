//! What a whole sequence will cost, by a trial of a few of its frames.
//!
//! k frames, spread evenly over the sequence, are rendered twice each, with s and with t > s samples a pixel. What does not
//! grow with samples (reading, building, writing, beams) falls out of the difference:
//!
//! ```text
//! b_i = (c_i(t) - c_i(s)) / (t - s)              CPU seconds a sample
//! y_i = c_i(t) + b_i (N - t)                     of frame i with all its N samples
//! total = F mean(y) +- F t(0.975, k - 1) sd(y) / k^(1/2)
//! ```
//! The interval is that of frames drawn at random. Frames of a sequence that changes slowly are told better by an even
//! spread, so that it is rather too wide; what is too short to be timed well is in it as well. A target for the error may end
//! frames before they have all their samples: then this is what they cost at most.

use cpu_time::ProcessTime;

use super::distributions::student_quantile;
use super::error::StudyError;
use crate::driver::job::Job;
use crate::driver::{RenderError, RenderOptions, render};
use crate::sequence::{FrameNumber, FrameSelection};

/// Frames of a trial, or renderings where there are fewer frames.
const FRAMES: usize = 5;

/// Of the intervals.
const CONFIDENCE: f64 = 0.95;

/// What rendering some frames costs.
#[derive(Clone, Debug, PartialEq)]
pub struct CostEstimate {
    /// How many frames there are.
    pub frames: usize,
    /// Samples a pixel that they are to have.
    pub samples: u32,
    /// The two numbers of samples of the trial.
    pub tried_samples: [u32; 2],
    /// The frames of the trial; one that is alone is tried several times.
    pub trials: Vec<FrameCost>,
    /// CPU seconds that the trial itself took.
    pub trial_seconds: f64,
}

/// What a frame costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameCost {
    /// Its number.
    pub number: FrameNumber,
    /// CPU seconds whatever its samples.
    pub fixed_seconds: f64,
    /// CPU seconds of a sample of all pixels.
    pub seconds_per_sample: f64,
}

impl FrameCost {
    fn between(number: FrameNumber, samples: [u32; 2], seconds: [f64; 2]) -> Self {
        let [few, more] = samples.map(f64::from);
        let seconds_per_sample = (seconds[1] - seconds[0]) / (more - few);
        Self { number, fixed_seconds: seconds[1] - more * seconds_per_sample, seconds_per_sample }
    }

    /// CPU seconds with so many samples.
    pub fn seconds(&self, samples: u32) -> f64 {
        self.fixed_seconds + self.seconds_per_sample * f64::from(samples)
    }
}

impl CostEstimate {
    /// CPU seconds of a frame, in the mean.
    pub fn seconds_per_frame(&self) -> f64 {
        self.trials.iter().map(|trial| trial.seconds(self.samples)).sum::<f64>() / self.trials.len() as f64
    }

    /// CPU seconds of a frame that do not depend on its samples, in the mean.
    pub fn fixed_seconds(&self) -> f64 {
        let sum: f64 = self.trials.iter().map(|trial| trial.fixed_seconds).sum();
        (sum / self.trials.len() as f64).max(0.0)
    }

    /// CPU seconds of all frames.
    pub fn total_seconds(&self) -> f64 {
        self.frames as f64 * self.seconds_per_frame()
    }

    /// Half of the interval of 95 % around [`CostEstimate::total_seconds`].
    pub fn total_margin(&self) -> f64 {
        let count = self.trials.len() as f64;
        let mean = self.seconds_per_frame();
        let squares = self.trials.iter().map(|trial| (trial.seconds(self.samples) - mean).powi(2));
        let variance = squares.sum::<f64>() / (count - 1.0);
        let quantile = student_quantile(0.5 + CONFIDENCE / 2.0, count - 1.0);
        self.frames as f64 * quantile * (variance / count).sqrt()
    }
}

/// Renders the trial into a temporary folder; `tried` hears of each frame of it.
///
/// # Errors
/// When one of its frames cannot be rendered, or there is no temporary folder.
pub fn estimate_cost(
    job: &Job,
    options: &RenderOptions,
    numbers: &[FrameNumber],
    mut tried: impl FnMut(FrameNumber),
) -> Result<CostEstimate, StudyError> {
    let samples = options.settings(&job.world.description.render).samples;
    let tried_samples = tried_samples(samples);
    let folder = tempfile::tempdir()
        .map_err(|source| RenderError::CannotCreate { path: std::env::temp_dir(), source })?;
    let output = folder.path().join("frame_####.exr").to_str().map(str::to_owned);
    let trial = RenderOptions { output, look: true, resume: false, time_budget: None, ..options.clone() };
    let start = ProcessTime::now();
    let mut trials = Vec::new();
    for number in spread(numbers) {
        let mut seconds = [0.0; 2];
        for (seconds, samples) in seconds.iter_mut().zip(tried_samples) {
            *seconds = cost(job, &RenderOptions { samples: Some(samples), ..trial.clone() }, number)?;
        }
        trials.push(FrameCost::between(number, tried_samples, seconds));
        tried(number);
    }
    let trial_seconds = start.elapsed().as_secs_f64();
    Ok(CostEstimate { frames: numbers.len(), samples, tried_samples, trials, trial_seconds })
}

/// CPU seconds of a frame, from its file to its picture.
fn cost(job: &Job, options: &RenderOptions, number: FrameNumber) -> Result<f64, StudyError> {
    let only = FrameSelection::parse(&number.to_string()).map_err(RenderError::from)?;
    let options = RenderOptions { frames: (!job.files.is_empty()).then_some(only), ..options.clone() };
    let start = ProcessTime::now();
    let report = render(job, &options, &())?;
    match report.failures.into_iter().next() {
        Some((_, error)) => Err(error.into()),
        None => Ok(start.elapsed().as_secs_f64()),
    }
}

/// A sixteenth of the samples, 4 to 16, and three times as many: both in whole replicates where there are as many.
fn tried_samples(samples: u32) -> [u32; 2] {
    if samples < 12 {
        [samples.div_ceil(3), samples.max(2)]
    } else {
        [1, 3].map(|times| times * (samples / 64 * 4).clamp(4, 16))
    }
}

/// The middles of as many equal parts of the sequence; of fewer frames all, again and again.
fn spread(numbers: &[FrameNumber]) -> impl Iterator<Item = FrameNumber> {
    let count = numbers.len();
    let place = move |i: usize| if count < FRAMES { i % count } else { (2 * i + 1) * count / (2 * FRAMES) };
    (0..FRAMES).filter_map(move |i| numbers.get(place(i)).copied())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn estimate(costs: &[f64]) -> CostEstimate {
        let of = |&cost: &f64| FrameCost::between(FrameNumber::ONE, [4, 12], [cost + 4.0, cost + 12.0]);
        CostEstimate {
            frames: 100,
            samples: 64,
            tried_samples: [4, 12],
            trials: costs.iter().map(of).collect(),
            trial_seconds: 0.0,
        }
    }

    /// By hand: frames of 64 + 1 .. 64 + 5 seconds have mean 67 and deviation 2.5^(1/2), so that the margin of 100 of them
    /// is 100 t 2^(-1/2), with t = 2.776 of Abramowitz and Stegun, table 26.10, for four degrees of freedom.
    #[test]
    fn the_interval_is_that_of_a_mean() {
        let estimate = estimate(&[1.0, 2.0, 3.0, 4.0, 5.0]);
        assert!((estimate.total_seconds() - 6700.0).abs() < 1e-9, "{}", estimate.total_seconds());
        assert!((estimate.fixed_seconds() - 3.0).abs() < 1e-12);
        let margin = 100.0 * 2.776 / 2f64.sqrt();
        assert!((estimate.total_margin() / margin - 1.0).abs() < 5e-4, "{}", estimate.total_margin());
        let exact = super::tests::estimate(&[2.0; 5]);
        assert!(exact.total_margin() < 1e-9);
    }

    #[test]
    fn there_are_always_two_numbers_of_samples_and_seldom_more_than_are_wanted() {
        for samples in 1..5000 {
            let [few, more] = tried_samples(samples);
            assert!(1 <= few && few < more && more <= samples.max(2), "{samples}: {few}, {more}");
        }
        assert_eq!(
            [1, 8, 32, 64, 128, 4096].map(tried_samples),
            [[1, 2], [3, 8], [4, 12], [4, 12], [8, 24], [16, 48]]
        );
    }

    #[test]
    fn frames_of_a_trial_are_spread() {
        let numbers: Vec<FrameNumber> = (1..=24).map(FrameNumber::from).collect();
        let chosen =
            |count: usize| spread(&numbers[..count]).map(|n| n.to_string()).collect::<Vec<_>>().join(",");
        assert_eq!(chosen(24), "3,8,13,17,22");
        assert_eq!(chosen(5), "1,2,3,4,5");
        assert_eq!(chosen(2), "1,2,1,2,1");
    }
}
