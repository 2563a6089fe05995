//! How good the pictures of a sequence are, and what other errors would take.
//!
//! ```text
//! E = (sum_i e_i^2 / n)^(1/2)                                                            (1)
//! T(e) = sum_i T_i (1 - r_i + r_i e_i^2 / e^2)                                           (2)
//! ```
//! (1) is the error of the sequence as one picture. (2) is the CPU time with which every frame has the error e: T_i is what
//! frame i took to come to e_i, r_i the share of rendering in it, and squared errors fall as the number of samples grows.
//! Low-discrepancy samples are somewhat better, and photons fall more slowly; `floe study` measures that.

use serde::Serialize;

use super::FrameReport;
use super::slow::median;

/// The errors that are told: those in each decade that stand on an axis.
const STEPS: [f64; 15] =
    [1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5];

/// How many below that of the sequence.
const BELOW: usize = 3;

/// Estimated relative errors.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// (1).
    pub root_mean_square: f64,
    /// The middle one.
    pub median: f64,
    /// The greatest.
    pub greatest: f64,
    /// Whose it is.
    pub greatest_frame: String,
    /// Pictures whose error nobody knows.
    pub unknown: usize,
    /// Pictures of whose error only the lower end is known.
    pub unsure: usize,
    /// CPU seconds that pictures of known errors took.
    pub cpu_seconds: f64,
    /// What other errors would take: the next one that is greater, and some that are smaller.
    pub costs: Vec<ErrorCost>,
}

/// What an error takes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorCost {
    /// Of every frame.
    pub relative_error: f64,
    /// (2).
    pub cpu_seconds: f64,
}

impl Errors {
    pub(super) fn of(frames: &[FrameReport]) -> Option<Self> {
        let done = || frames.iter().filter(|frame| frame.state.is_there());
        let known: Vec<(&FrameReport, f64)> =
            done().filter_map(|frame| Some((frame, frame.relative_error?.estimate))).collect();
        let errors: Vec<f64> = known.iter().map(|(_, error)| *error).collect();
        let root_mean_square = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
        let (frame, greatest) = known.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let greater = STEPS.iter().rev().find(|step| **step > root_mean_square);
        let smaller = STEPS.iter().filter(|step| **step < root_mean_square).take(BELOW);
        let cost = |error: &f64| ErrorCost {
            relative_error: *error,
            cpu_seconds: known.iter().map(|known| seconds_to(*known, *error)).sum(),
        };
        let is_unsure = |frame: &&FrameReport| frame.relative_error.is_some_and(|e| e.high.is_infinite());
        Some(Self {
            root_mean_square,
            median: median(errors)?,
            greatest: *greatest,
            greatest_frame: frame.frame.clone(),
            unknown: done().count() - known.len(),
            unsure: done().filter(is_unsure).count(),
            cpu_seconds: known.iter().map(|(frame, _)| frame.effort.cpu_seconds).sum(),
            costs: greater.into_iter().chain(smaller).map(cost).collect(),
        })
    }
}

/// A term of (2).
fn seconds_to((frame, error): (&FrameReport, f64), target: f64) -> f64 {
    let rendering = match frame.effort.seconds {
        seconds if seconds > 0.0 => (frame.render_seconds / seconds).min(1.0),
        _ => 1.0,
    };
    frame.effort.cpu_seconds * (1.0 - rendering + rendering * (error / target) * (error / target))
}
