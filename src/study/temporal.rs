//! The error of a sequence as an eye sees it, which takes in several frames at a time.
//!
//! The error of pixel p in frame t of T is e_t(p); < > is the mean over pixels and frames:
//!
//! ```text
//! rmse       = <e^2>^(1/2)                                                               (1)
//! tcr        = 8^(1/2) <a^2>^(1/2) / rmse,   a_t = (e_t + .. + e_(t+7)) / 8              (2)
//! lag1       = <e_t e_(t+1)> / (<e_t^2> <e_(t+1)^2>)^(1/2)                               (3)
//! flicker    = (mean over p of  sum_t (e_t - mean of e(p))^2 / (T - 1))^(1/2)            (4)
//! jitter     = (sum_t (m_t - mean of m)^2 / (T - 1))^(1/2),   m_t = mean over p of e_t   (5)
//! fireflies  = share of the e with |e| > 8 s and |e| > 0.01                              (6)
//! ```
//!
//! (2) is the ratio of temporal convergence: 1 when errors of different frames are independent, 8^(1/2) when they stay the
//! same, less than 1 when they weaken each other. It is taken over all windows of eight frames, since an eye does not
//! know where a block begins. In (6) s is the root mean square of e over the pixels within 2 columns and rows, the pixel
//! itself left out; an error below a hundredth of white is not seen, however still its surroundings are.
//!
//! # Without a reference
//! With two pictures of each frame that differ in their seeds alone, of which a screen shows the luma A and B (from 0 to 1,
//! tone-mapped and sRGB-coded, so that a difference is about as visible in the dark as in bright light),
//!
//! ```text
//! e_t = (A_t - B_t) / 2^(1/2)                                                            (7)
//! ```
//!
//! has the second moments of the noise of either, within a frame and between frames: both have the same expectation and
//! do not depend on each other. Bias, which both share, is not seen. A firefly of one picture has to stand out by
//! 8 2^(1/2) of its own noise.
//!
//! Values are exact for what was rendered; how far they are from those of endless sequences is seen from other seeds.
//! The unit tests check each against signals for which it is known.

use std::collections::VecDeque;

use serde::Serialize;

use super::statistics::mean_and_variance;

/// Frames that an eye takes in at once: a third of a second.
pub const WINDOW: usize = 8;

/// Pixels to either side that are a pixel's surroundings.
const REACH: usize = 2;

/// Local standard deviations, and part of white, beyond which an error is a firefly.
const FIREFLY: (f64, f64) = (8.0, 0.01);

/// The measures (1) to (6).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TemporalMetrics {
    /// (1), of single frames.
    pub rmse: f64,
    /// (2).
    pub tcr: f64,
    /// (3).
    pub lag1: f64,
    /// (4).
    pub flicker: f64,
    /// (5).
    pub jitter: f64,
    /// (6).
    pub fireflies: f64,
}

/// Takes in the errors of one frame after the other. Memory does not grow with their number.
#[derive(Clone, Debug)]
pub struct TemporalErrors {
    width: usize,
    window: VecDeque<Vec<f32>>,
    /// Of each pixel: the sum over the window, over all frames, and of squares over all frames.
    window_sums: Vec<f64>,
    sums: Vec<f64>,
    squares: Vec<f64>,
    /// Sum of squares of each frame.
    frame_squares: Vec<f64>,
    /// Mean of each frame.
    frame_means: Vec<f64>,
    /// Sum of products of neighbours in time.
    products: f64,
    /// Sum of the squares of windows' means, and the number of windows.
    window_squares: (f64, usize),
    fireflies: usize,
}

impl TemporalErrors {
    /// Nothing yet, of frames of `width` x `height` pixels.
    pub fn new(width: usize, height: usize) -> Self {
        let zeros = vec![0.0; width * height];
        Self {
            width,
            window: VecDeque::with_capacity(WINDOW),
            window_sums: zeros.clone(),
            sums: zeros.clone(),
            squares: zeros,
            frame_squares: Vec::new(),
            frame_means: Vec::new(),
            products: 0.0,
            window_squares: (0.0, 0),
            fireflies: 0,
        }
    }

    /// Takes in the next frame: its errors row by row, as many as there are pixels.
    pub fn push(&mut self, errors: Vec<f32>) {
        if let Some(before) = self.window.back() {
            self.products +=
                before.iter().zip(&errors).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum::<f64>();
        }
        let oldest = (self.window.len() == WINDOW).then(|| self.window.pop_front()).flatten();
        for (p, &e) in errors.iter().enumerate() {
            let gone = oldest.as_ref().map_or(0.0, |errors| errors[p]);
            let e = f64::from(e);
            self.window_sums[p] += e - f64::from(gone);
            self.sums[p] += e;
            self.squares[p] += e * e;
        }
        let pixels = errors.len() as f64;
        self.frame_means.push(errors.iter().map(|&e| f64::from(e)).sum::<f64>() / pixels);
        self.frame_squares.push(errors.iter().map(|&e| f64::from(e) * f64::from(e)).sum());
        self.fireflies += fireflies(&errors, self.width);
        self.window.push_back(errors);
        if self.window.len() == WINDOW {
            let mean_square = |sum: &f64| (sum / WINDOW as f64) * (sum / WINDOW as f64);
            self.window_squares.0 += self.window_sums.iter().map(mean_square).sum::<f64>();
            self.window_squares.1 += 1;
        }
    }

    /// Frames so far.
    pub fn frames(&self) -> usize {
        self.frame_means.len()
    }

    /// The measures; `None` with fewer frames than a window has, or no pixels.
    ///
    /// Without any error the ratios (2) and (3) are 0.
    pub fn metrics(&self) -> Option<TemporalMetrics> {
        let (frames, pixels) = (self.frames() as f64, self.sums.len() as f64);
        if self.window_squares.1 == 0 || self.sums.is_empty() {
            return None;
        }
        let total: f64 = self.frame_squares.iter().sum();
        let rmse = (total / (pixels * frames)).sqrt();
        let windowed = (self.window_squares.0 / (pixels * self.window_squares.1 as f64)).sqrt();
        let (first, last) = (self.frame_squares[0], self.frame_squares[self.frames() - 1]);
        let spread: f64 =
            self.sums.iter().zip(&self.squares).map(|(s, q)| (q - s * s / frames).max(0.0)).sum();
        Some(TemporalMetrics {
            rmse,                                                                  // (1)
            tcr: ratio((WINDOW as f64).sqrt() * windowed, rmse),                   // (2)
            lag1: ratio(self.products, ((total - last) * (total - first)).sqrt()), // (3)
            flicker: (spread / (pixels * (frames - 1.0))).sqrt(),                  // (4)
            jitter: mean_and_variance(&self.frame_means).1.sqrt(),                 // (5)
            fireflies: self.fireflies as f64 / (pixels * frames),                  // (6)
        })
    }
}

fn ratio(a: f64, b: f64) -> f64 {
    if b > 0.0 { a / b } else { 0.0 }
}

/// A pixel and those around it, as many as lie within the frame.
fn neighbours(pixel: usize, width: usize, height: usize) -> impl Iterator<Item = usize> {
    let around = |at: usize, end: usize| at.saturating_sub(REACH)..(at + REACH + 1).min(end);
    around(pixel / width, height)
        .flat_map(move |row| around(pixel % width, width).map(move |column| row * width + column))
}

/// How many errors of a frame are those of fireflies.
fn fireflies(errors: &[f32], width: usize) -> usize {
    let square = |p: usize| f64::from(errors[p]) * f64::from(errors[p]);
    let is_one = |&p: &usize| {
        let others = || neighbours(p, width, errors.len() / width).filter(|&other| other != p);
        let limit = FIREFLY.0 * FIREFLY.0 * others().map(square).sum::<f64>() / others().count() as f64;
        square(p) > FIREFLY.1 * FIREFLY.1 && square(p) > limit // (6)
    };
    (0..errors.len()).filter(is_one).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: usize = 64;

    /// The measures of a signal of the frame and the pixel.
    fn measured(frames: usize, signal: impl Fn(usize, usize) -> f64) -> TemporalMetrics {
        let mut errors = TemporalErrors::new(SIDE, SIDE);
        for t in 0..frames {
            errors.push((0..SIDE * SIDE).map(|p| signal(t, p) as f32).collect());
        }
        errors.metrics().unwrap()
    }

    /// Independent numbers of mean 0 and variance 1, uniform.
    fn noise(t: usize, p: usize) -> f64 {
        use crate::sampling::seed::{hash_pair, unit_float};
        let bits = hash_pair(hash_pair(0x1234_5678, t as u32), p as u32);
        (f64::from(unit_float(bits)) - 0.5) * f64::sqrt(12.0)
    }

    /// Root mean squares of n independent numbers of kurtosis 1.8 are off by sqrt(0.8 / n) / 2, correlations by
    /// 1 / sqrt(n). With n = 4096 x 64 the former is 0.0009 and the latter 0.002; the overlapping windows hold 4096 x 8
    /// independent ones, normal by then: sqrt(2 / n) / 2 = 0.004, at most. Four standard errors each.
    #[test]
    fn independent_errors_have_ratio_one_and_no_correlation() {
        let m = measured(64, |t, p| 0.1 * noise(t, p));
        assert!((m.rmse / 0.1 - 1.0).abs() < 0.0036, "{m:?}");
        assert!((m.flicker / 0.1 - 1.0).abs() < 0.0036, "{m:?}");
        assert!((m.tcr - 1.0).abs() < 0.016 && m.lag1.abs() < 0.008, "{m:?}");
        // The mean of 4096 errors; a standard deviation of 64 numbers is off by 1 / sqrt(2 63) = 0.09.
        assert!((m.jitter / (0.1 / 64.0) - 1.0).abs() < 0.36, "{m:?}");
        // A uniform number is never beyond sqrt(3) deviations.
        assert_eq!(m.fireflies, 0.0);
    }

    #[test]
    fn errors_that_stay_have_no_flicker_and_the_greatest_ratio() {
        let m = measured(16, |_, p| noise(0, p));
        assert!((m.tcr - f64::sqrt(8.0)).abs() < 1e-6 && (m.lag1 - 1.0).abs() < 1e-6, "{m:?}");
        // Rounding of sums of squares in f64, under a root.
        assert!(m.flicker < 1e-6 && m.jitter < 1e-6, "{m:?}");
    }

    /// e_t = n_t - n_(t-1): correlation -1/2; a window keeps its two ends, (2 / 64) over a variance of 2.
    #[test]
    fn errors_that_weaken_each_other_have_a_ratio_below_one() {
        let m = measured(64, |t, p| noise(t + 1, p) - noise(t, p));
        assert!((m.tcr - f64::sqrt(1.0 / 8.0)).abs() < 0.008, "{m:?}");
        assert!((m.lag1 + 0.5).abs() < 0.008, "{m:?}");
    }

    /// An even and an odd frame take turns: the whole frame jumps by 2, as sqrt(16 / 15) over 16 frames.
    #[test]
    fn a_frame_that_jumps_as_a_whole_jitters() {
        let m = measured(16, |t, _| if t % 2 == 0 { 1.0 } else { -1.0 });
        let expected = f64::sqrt(16.0 / 15.0);
        assert!((m.jitter - expected).abs() < 1e-6 && (m.flicker - expected).abs() < 1e-6, "{m:?}");
        assert!(m.tcr < 1e-6 && (m.lag1 + 1.0).abs() < 1e-6, "{m:?}");
    }

    /// Twelve errors of twelve deviations, in the noise, at an edge and where all is still; one more that nobody sees.
    #[test]
    fn fireflies_are_counted_wherever_they_are() {
        let m = measured(12, |t, p| match (p % SIDE, p / SIDE) {
            (20, 20) if t == 3 => 0.009,
            (x, 40) if x == 4 * t => 12.0,
            (x, y) if x < 30 && y < 30 => 0.0,
            _ => noise(t, p),
        });
        assert_eq!((m.fireflies * (12 * SIDE * SIDE) as f64).round() as usize, 12, "{m:?}");
        let m = measured(8, |t, p| if (t, p) == (5, 0) { 0.02 } else { 0.0 });
        assert_eq!(m.fireflies * (8 * SIDE * SIDE) as f64, 1.0);
    }

    #[test]
    fn too_few_frames_have_no_measures_and_perfect_ones_no_error() {
        let mut errors = TemporalErrors::new(2, 1);
        for _ in 0..WINDOW - 1 {
            errors.push(vec![0.0; 2]);
        }
        assert_eq!(errors.metrics(), None);
        errors.push(vec![0.0; 2]);
        let m = errors.metrics().unwrap();
        assert_eq!((m.rmse, m.tcr, m.lag1, m.flicker, m.jitter, m.fireflies), (0.0, 0.0, 0.0, 0.0, 0.0, 0.0));
    }
}
