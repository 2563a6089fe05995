//! Where in and around its pixel a sample falls: pixel filters, sampled in proportion to their value.
//!
//! All filters here are separable and nowhere negative. Offsets are drawn with the filter as their density, so that
//! every sample counts with weight one and only in its own pixel `[ERNST06]`. No pixel shares a sample with its
//! neighbours, errors of pixels stay independent, and tiles need no borders.
//!
//! ```text
//! box               f(x) = 1                                            |x| <= 1/2
//! gaussian          f(x) = exp(-x^2 / 2 sigma^2) - exp(-r^2 / 2 sigma^2)     sigma = 0.5, r = 1.5
//! blackman-harris   f(x) = a0 + a1 cos(pi x / r) + a2 cos(2 pi x / r) + a3 cos(3 pi x / r)      r = 2
//! ```
//!
//! x is in pixels from the pixel's centre. The Gaussian is shifted down to reach 0 at its radius, without a step. The
//! Blackman-Harris coefficients are those of the minimum 4-term window `[HARRIS78]`; it ends at 6e-5 of its
//! peak.
//!
//! The cumulative function is exact (closed form, f64) at 1025 nodes over half the support and linear in
//! between; it is off by less than 1e-6 anywhere. The other half is its mirror image, so the mean offset is 0.

use std::f64::consts::PI;

use glam::Vec2;

use crate::scene::description::FilterKind;

/// Cells of the table over half of the filter's support.
const CELLS: usize = 1024;

const GAUSSIAN_SIGMA: f64 = 0.5;
const GAUSSIAN_RADIUS: f64 = 1.5;

const BLACKMAN_HARRIS_RADIUS: f64 = 2.0;
const BLACKMAN_HARRIS: [f64; 4] = [0.35875, 0.48829, 0.14128, 0.01168];

/// A pixel filter, ready to be sampled.
#[derive(Clone, Debug)]
pub struct Filter {
    radius: f64,
    /// Probability of |offset| up to each node, from 0 to 1; empty for the box, whose inverse is linear.
    cumulative: Vec<f64>,
}

impl Filter {
    /// Builds the table of a filter.
    pub fn new(kind: FilterKind) -> Self {
        match kind {
            FilterKind::Box => Self { radius: 0.5, cumulative: Vec::new() },
            FilterKind::Gaussian => Self::tabulated(GAUSSIAN_RADIUS, gaussian_integral),
            FilterKind::BlackmanHarris => Self::tabulated(BLACKMAN_HARRIS_RADIUS, blackman_harris_integral),
        }
    }

    /// `integral` is the filter's from 0 to x, in any scale.
    fn tabulated(radius: f64, integral: fn(f64) -> f64) -> Self {
        let total = integral(radius);
        let node = |i: usize| integral(radius * i as f64 / CELLS as f64) / total;
        let mut cumulative: Vec<f64> = (0..=CELLS).map(node).collect();
        // Rounding near the flat end must not let the table fall.
        for i in 1..=CELLS {
            cumulative[i] = cumulative[i].clamp(cumulative[i - 1], 1.0);
        }
        Self { radius, cumulative }
    }

    /// Greatest offset along x and y, in pixels.
    pub fn radius(&self) -> f32 {
        self.radius as f32
    }

    /// Offset in pixels from the pixel's centre, for `u` uniform in the unit square `[0, 1)^2`.
    ///
    /// Rises with each component of `u`, so stratified numbers give stratified offsets.
    pub fn sample(&self, u: [f32; 2]) -> Vec2 {
        Vec2::new(self.offset(u[0]), self.offset(u[1]))
    }

    fn offset(&self, u: f32) -> f32 {
        let signed = 2.0 * f64::from(u) - 1.0;
        if self.cumulative.is_empty() {
            return (self.radius * signed) as f32;
        }
        let p = signed.abs();
        let cell = self.cumulative.partition_point(|&c| c <= p).clamp(1, CELLS) - 1;
        let (low, high) = (self.cumulative[cell], self.cumulative[cell + 1]);
        let within = if high > low { (p - low) / (high - low) } else { 1.0 };
        let distance = self.radius * (cell as f64 + within) / CELLS as f64;
        if signed < 0.0 { -distance as f32 } else { distance as f32 }
    }
}

fn gaussian_integral(x: f64) -> f64 {
    let scale = GAUSSIAN_SIGMA * std::f64::consts::SQRT_2;
    let at_radius = libm::exp(-(GAUSSIAN_RADIUS / scale) * (GAUSSIAN_RADIUS / scale));
    0.5 * PI.sqrt() * scale * libm::erf(x / scale) - x * at_radius
}

fn blackman_harris_integral(x: f64) -> f64 {
    let harmonic = |k: f64, a: f64| {
        let frequency = k * PI / BLACKMAN_HARRIS_RADIUS;
        a * libm::sin(frequency * x) / frequency
    };
    let [a0, a1, a2, a3] = BLACKMAN_HARRIS;
    a0 * x + harmonic(1.0, a1) + harmonic(2.0, a2) + harmonic(3.0, a3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::splitmix::SplitMix;

    const KINDS: [FilterKind; 3] = [FilterKind::Box, FilterKind::Gaussian, FilterKind::BlackmanHarris];

    /// The filters as the module's head defines them, written out independently of the table.
    fn value(kind: FilterKind, x: f64) -> f64 {
        match kind {
            FilterKind::Box => f64::from(u8::from(x.abs() <= 0.5)),
            FilterKind::Gaussian => ((-2.0 * x * x).exp() - (-4.5_f64).exp()).max(0.0),
            FilterKind::BlackmanHarris => {
                let t = PI * x / 2.0;
                0.35875 + 0.48829 * t.cos() + 0.14128 * (2.0 * t).cos() + 0.01168 * (3.0 * t).cos()
            }
        }
    }

    /// Midpoint rule; with 20,000 steps exact to far below the tests' tolerances.
    fn integrate(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
        let h = (to - from) / 20_000.0;
        (0..20_000).map(|i| f(from + (f64::from(i) + 0.5) * h)).sum::<f64>() * h
    }

    fn pearson(kind: FilterKind, counts: &[u32], radius: f64, n: f64) -> (f64, f64) {
        let total = integrate(-radius, radius, |x| value(kind, x));
        let width = 2.0 * radius / counts.len() as f64;
        let (mut statistic, mut cells) = (0.0, 0.0);
        let (mut pooled_count, mut pooled_expected) = (0.0, 0.0);
        for (i, &count) in counts.iter().enumerate() {
            let from = -radius + i as f64 * width;
            pooled_count += f64::from(count);
            pooled_expected += n * integrate(from, from + width, |x| value(kind, x)) / total;
            // The statistic follows chi-square only where some samples are expected.
            if pooled_expected > 5.0 {
                statistic +=
                    (pooled_count - pooled_expected) * (pooled_count - pooled_expected) / pooled_expected;
                cells += 1.0;
                (pooled_count, pooled_expected) = (0.0, 0.0);
            }
        }
        (statistic, cells - 1.0)
    }

    /// Significance 1e-4 for each of six tests; the quantile is Wilson and Hilferty's.
    #[test]
    fn offsets_follow_the_filter() {
        let n = 200_000;
        for kind in KINDS {
            let filter = Filter::new(kind);
            let mut random = SplitMix(7);
            let mut counts = [[0_u32; 64]; 2];
            for _ in 0..n {
                let offset = filter.sample([random.uniform_f32(), random.uniform_f32()]);
                for (axis, counts) in counts.iter_mut().enumerate() {
                    let place = (f64::from(offset[axis]) / filter.radius + 1.0) * 32.0;
                    counts[place as usize] += 1;
                }
            }
            for counts in &counts {
                let (statistic, freedom) = pearson(kind, counts, filter.radius, f64::from(n));
                let a = 2.0 / (9.0 * freedom);
                let limit = freedom * (1.0 - a + 3.719 * a.sqrt()).powi(3);
                assert!(statistic < limit, "{kind:?}: chi-square {statistic} above {limit}");
            }
        }
    }

    #[test]
    fn moments_are_the_filters() {
        for kind in KINDS {
            let filter = Filter::new(kind);
            let n = 1 << 20;
            let (mut sum, mut squares) = (0.0, 0.0);
            for i in 0..n {
                // Multiples of 2^-21: exact in f32, and symmetric about 1/2.
                let u = (2 * i + 1) as f32 / (2 * n) as f32;
                let x = f64::from(filter.sample([u, 0.5]).x);
                sum += x;
                squares += x * x;
            }
            let r = filter.radius;
            let expected =
                integrate(-r, r, |x| x * x * value(kind, x)) / integrate(-r, r, |x| value(kind, x));
            assert!((sum / f64::from(n)).abs() < 1e-12, "{kind:?}: mean {}", sum / f64::from(n));
            // The table's cells are 2e-3 wide; the error of a second moment goes with their square.
            assert!((squares / f64::from(n) - expected).abs() < 4e-6, "{kind:?}: variance");
        }
    }

    #[test]
    fn the_cumulative_function_is_accurate_between_nodes() {
        for kind in [FilterKind::Gaussian, FilterKind::BlackmanHarris] {
            let filter = Filter::new(kind);
            let half = integrate(0.0, filter.radius, |x| value(kind, x));
            for i in 1..400 {
                let u = 0.5 + f64::from(i) / 800.0;
                let x = f64::from(filter.sample([u as f32, 0.5]).x);
                let reached = integrate(0.0, x, |t| value(kind, t)) / half;
                assert!((reached - (2.0 * f64::from(u as f32) - 1.0)).abs() < 1e-6, "{kind:?} at {u}");
            }
        }
    }

    #[test]
    fn offsets_rise_with_u_mirror_at_the_centre_and_stay_within_the_radius() {
        for kind in KINDS {
            let filter = Filter::new(kind);
            let mut last = f32::NEG_INFINITY;
            for i in 0..(1 << 16) {
                let u = i as f32 / (1 << 16) as f32;
                let x = filter.sample([u, 0.0]).x;
                assert!(x >= last && x.abs() <= filter.radius(), "{kind:?} at {u}");
                if i > 0 {
                    assert_eq!(x, -filter.sample([1.0 - u, 0.0]).x, "{kind:?} at {u}");
                }
                last = x;
            }
            let greatest = filter.sample([1.0_f32.next_down(), 0.0]).x;
            assert!(greatest <= filter.radius(), "{kind:?}");
            assert_eq!(filter.sample([0.5, 0.5]), Vec2::ZERO);
        }
    }

    #[test]
    fn the_box_is_exactly_the_pixel() {
        let filter = Filter::new(FilterKind::Box);
        let mut random = SplitMix(3);
        for _ in 0..10_000 {
            let u = [random.uniform_f32(), random.uniform_f32()];
            assert_eq!(filter.sample(u), Vec2::new(u[0] - 0.5, u[1] - 0.5));
        }
        assert_eq!(filter.sample([0.0, 0.0]), Vec2::splat(-0.5));
        assert!(filter.sample([1.0_f32.next_down(); 2]).x < 0.5);
    }
}
