//! Whether two pictures of independent noise differ by more than that.
//!
//! Each pixel p of a picture has a mean m_p and the variance V_p of that mean, which is estimated from k_p independent
//! replicates (four; fewer where there are fewer samples) and so has n_p = k_p - 1 degrees of freedom. Pixels are
//! independent, single values of V_p are worth little, but over a region S (a block of 16 x 16 pixels, or the whole
//! picture) of pictures A and B, for each channel,
//!
//! ```text
//! D = sum over S of (m_A - m_B)           V = sum over S of (V_A + V_B)                               (1)
//! t = max(0, |D| - r) / V^(1/2)           r = sum over S of (u_A |m_A| + u_B |m_B|)                   (2)
//! f = V^2 / Q - 2                         Q = sum over S of (V_A^2 / (n_A + 2) + V_B^2 / (n_B + 2))     (3)
//! P = probability of Student's t of f degrees of freedom to be further from 0 than t                  (4)
//! ```
//!
//! (3) is how Welch and Satterthwaite match the variance of V `[SATTERTHWAITE46 eq. 17]`, with squares of estimates in the
//! place of those of variances: E V_p^2 = sigma^4 (n + 2) / n. For one pixel f is n, for many of one variance n times
//! their number. r, with u the rounding of a picture's numbers, keeps pixels without noise from differing by their
//! last bits.
//!
//! With B blocks, and three channels each, all hypotheses together hold with the probability
//!
//! ```text
//! p = min(1, 6 min(least P of the whole picture, B times the least P of the blocks))                   (5)
//! ```
//!
//! in the sense of Bonferroni: whatever the channels and regions have to do with each other, p < alpha with a
//! probability of at most alpha if nothing but noise differs. The blocks find what differs in one place; the whole
//! picture finds a bias that is weak but everywhere. [`ZTest::detectable`] is how weak.
//!
//! # How far that holds
//! Where noise is normal, `the_test_is_wrong_as_often_as_it_says` finds the true size at alpha = 0.001 and 0.05. Noise
//! with rare great values makes the test wrong less often, not more: a pixel with one comes with a large V, so |t| stays
//! near 1. A difference of such noise alone is seldom found, and light that is so rare that one picture misses it is
//! taken for a difference if the other, with many more samples, does not. A picture without variances counts as exact.
//! Pictures of one seed share their noise, which makes the test wrong less often as well. Photons are shared by pixels:
//! such pictures have no such test.

use glam::DVec3;
use serde::Serialize;

use super::distributions::{student_quantile, student_two_sided};
use crate::film::REPLICATES;
use crate::film::exr_layers::StoredPicture;

/// Columns and rows of a block.
pub const BLOCK: usize = 16;

/// Significance unless another is asked for.
pub const SIGNIFICANCE: f64 = 0.001;

/// Hypotheses in the same region.
const CHANNELS: [&str; 3] = ["R", "G", "B"];

/// The halves of the significance for whole picture and blocks, and the channels.
const FAMILY: f64 = 2.0 * CHANNELS.len() as f64;

/// A region and how much it differs in a channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Deviation {
    /// Left column and upper row.
    pub at: [usize; 2],
    /// Columns and rows.
    pub size: [usize; 2],
    /// The channel.
    pub channel: &'static str,
    /// (2) with the sign of D.
    pub t: f64,
    /// (3).
    pub degrees_of_freedom: f64,
    /// D as a part of B's sum.
    pub relative: f64,
}

/// The outcome.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ZTest {
    /// (5).
    pub p: f64,
    /// The region that decided.
    pub worst: Deviation,
    /// The bias of the whole picture, as a part of it, that is found every other time at [`SIGNIFICANCE`].
    pub detectable: f64,
    /// Pixels left out: of unknown variance, or not finite.
    pub left_out: usize,
}

/// Why there is no test.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, thiserror::Error)]
#[serde(rename_all = "snake_case")]
pub enum NoTest {
    /// Neither has variances.
    #[error("neither picture has its variance (output.aovs = [\"variance\"])")]
    NoVariance,
    /// One has photons.
    #[error("the noise of photons is shared by pixels")]
    SharedNoise,
    /// No pixel has two replicates.
    #[error("no pixel has two samples")]
    TooFewSamples,
}

/// Tests a picture A against a reference B of its size.
///
/// # Errors
/// Why there is no test.
pub fn z_test(a: &StoredPicture, b: &StoredPicture) -> Result<ZTest, NoTest> {
    if a.variances.is_none() && b.variances.is_none() {
        return Err(NoTest::NoVariance);
    }
    if a.shares_noise || b.shares_noise {
        return Err(NoTest::SharedNoise);
    }
    let (columns, rows) = (a.width.div_ceil(BLOCK), a.height.div_ceil(BLOCK));
    let mut blocks = vec![Sums::default(); columns * rows];
    let mut whole = Sums::default();
    for p in 0..a.colours.len() {
        if let Some(pixel) = Sums::of_pixel(a, b, p) {
            blocks[p / a.width / BLOCK * columns + p % a.width / BLOCK].add(&pixel);
            whole.add(&pixel);
        }
    }
    if whole.pixels == 0 {
        return Err(NoTest::TooFewSamples);
    }
    let all = whole.deviations([0, 0], [a.width, a.height]).map(|(p, deviation)| (FAMILY * p, deviation));
    let each = blocks.iter().enumerate().filter(|(_, sums)| sums.pixels > 0).flat_map(|(i, sums)| {
        let at = [i % columns * BLOCK, i / columns * BLOCK];
        let size = [BLOCK.min(a.width - at[0]), BLOCK.min(a.height - at[1])];
        let family = FAMILY * blocks.len() as f64;
        sums.deviations(at, size).map(|(p, deviation)| (family * p, deviation))
    });
    let left_out = a.colours.len() - whole.pixels;
    let worst = all.into_iter().chain(each).min_by(|(p, _), (other, _)| p.total_cmp(other));
    let (p, worst) = worst.ok_or(NoTest::TooFewSamples)?;
    Ok(ZTest { p: p.min(1.0), worst, detectable: whole.detectable(), left_out }) // (5)
}

/// The sums of (1) to (3) over the pixels of a region.
#[derive(Clone, Debug, Default)]
struct Sums {
    difference: DVec3,
    variance: DVec3,
    rounding: DVec3,
    /// Q of (3).
    squares: DVec3,
    /// Of the reference.
    reference: DVec3,
    pixels: usize,
}

impl Sums {
    /// `None` for a pixel that cannot be tested.
    fn of_pixel(a: &StoredPicture, b: &StoredPicture, p: usize) -> Option<Self> {
        let [m_a, m_b] = [a, b].map(|picture| picture.colours[p].as_dvec3());
        let (v_a, n_a) = variance(a, p)?;
        let (v_b, n_b) = variance(b, p)?;
        let difference = m_a - m_b;
        (difference.is_finite() && v_a.is_finite() && v_b.is_finite()).then(|| Self {
            difference,
            variance: v_a + v_b,
            rounding: a.rounding * m_a.abs() + b.rounding * m_b.abs(),
            squares: v_a * v_a / (n_a + 2.0) + v_b * v_b / (n_b + 2.0),
            reference: m_b,
            pixels: 1,
        })
    }

    fn add(&mut self, other: &Self) {
        self.difference += other.difference;
        self.variance += other.variance;
        self.rounding += other.rounding;
        self.squares += other.squares;
        self.reference += other.reference;
        self.pixels += other.pixels;
    }

    /// (4) and what it is of, for each channel.
    fn deviations(&self, at: [usize; 2], size: [usize; 2]) -> [(f64, Deviation); 3] {
        std::array::from_fn(|c| {
            let excess = (self.difference[c].abs() - self.rounding[c]).max(0.0);
            let degrees_of_freedom = self.degrees_of_freedom(c);
            let t = if excess > 0.0 { excess / self.variance[c].sqrt() } else { 0.0 }; // (2)
            let p = if t.is_finite() { student_two_sided(t, degrees_of_freedom) } else { 0.0 }; // (4)
            let relative = self.difference[c] / self.reference[c].abs().max(f64::MIN_POSITIVE);
            let t = t.copysign(self.difference[c]);
            (p, Deviation { at, size, channel: CHANNELS[c], t, degrees_of_freedom, relative })
        })
    }

    /// (3); that of a single pixel where nothing has noise.
    fn degrees_of_freedom(&self, channel: usize) -> f64 {
        let f = self.variance[channel] * self.variance[channel] / self.squares[channel] - 2.0;
        if f.is_finite() { f.max(1.0) } else { 1.0 }
    }

    /// The least of the channels.
    fn detectable(&self) -> f64 {
        let of = |c: usize| {
            let quantile = student_quantile(1.0 - SIGNIFICANCE / FAMILY / 2.0, self.degrees_of_freedom(c));
            (quantile * self.variance[c].sqrt() + self.rounding[c]) / self.reference[c].abs()
        };
        (0..CHANNELS.len()).map(of).fold(f64::INFINITY, f64::min)
    }
}

/// The variances of a pixel with their degrees of freedom; 0 of a picture that says nothing of them.
fn variance(picture: &StoredPicture, p: usize) -> Option<(DVec3, f64)> {
    let Some(variances) = &picture.variances else { return Some((DVec3::ZERO, 1.0)) };
    let samples = picture.samples.as_ref().map_or(f64::INFINITY, |samples| f64::from(samples[p]));
    let degrees_of_freedom = samples.min(REPLICATES as f64) - 1.0;
    (degrees_of_freedom >= 1.0).then(|| (variances[p].as_dvec3(), degrees_of_freedom))
}

#[cfg(test)]
mod tests;
