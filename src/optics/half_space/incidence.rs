//! Draws the cosine under which light comes in that a half space reflects along a given one.
//!
//! The density is that of what is reflected in one lane, with H bounded by its own chord:
//!
//! ```text
//! p(x) ~ x H(x) / (mu + x)  on [0, 1],     H(x) <= BOUND (1 + c x),   c = 2 (1 - s) / (1 + 2 s)
//! G(x) = integral from 0 of x (1 + c x) / (mu + x) = c x^2 / 2 + (1 - c mu) (x - mu ln(1 + x / mu))
//! ```
//! 1 + c x joins the ends of H ~ (1 + 2 x) / (1 + 2 s x) `[HAPKE81]`, which is within 5 % of H. A candidate x solves
//! G(x) = u G(1) and is taken with the probability H(x) / (BOUND (1 + c x)), which is 0.79 at least. G bends upwards, so
//! Newton's method comes to x from above, and from sqrt(u) it takes 3 to 8 steps.

use crate::sampling::SampleStream;

/// H is at most so many times its chord: 1.1121 (at s = 0.325), measured.
const BOUND: f32 = 1.12;
/// The least cosine, and the least random number: below them light that grazes decides on nothing.
const LEAST: f32 = 1e-7;
/// Steps of Newton's method at most.
const MOST_STEPS: u32 = 40;

/// Candidates that have the density x (1 + c x) / (mu + x).
#[derive(Clone, Copy, Debug)]
pub(super) struct Incidence {
    mu: f64,
    slope: f64,
    whole: f64,
}

impl Incidence {
    /// Of what leaves along `mu` in a lane of `s` = sqrt(1 - albedo).
    pub(super) fn new(s: f32, mu: f32) -> Self {
        let s = f64::from(s);
        let slope = 2.0 * (1.0 - s) / (1.0 + 2.0 * s);
        let unscaled = Self { mu: f64::from(mu.max(LEAST)), slope, whole: 1.0 };
        Self { whole: unscaled.below(1.0), ..unscaled }
    }

    /// A cosine drawn with `u` and what more the stream gives; `h` is H in the lane.
    pub(super) fn draw(&self, u: f32, stream: &mut SampleStream, h: impl Fn(f32) -> f32) -> f32 {
        let mut candidate = self.candidate(u);
        loop {
            let [first, again, second, last] = stream.next4();
            if self.takes(candidate, first, &h) {
                return candidate;
            }
            candidate = self.candidate(again);
            if self.takes(candidate, second, &h) {
                return candidate;
            }
            candidate = self.candidate(last);
        }
    }

    fn takes(&self, x: f32, u: f32, h: impl Fn(f32) -> f32) -> bool {
        u * BOUND * (1.0 + self.slope as f32 * x) < h(x)
    }

    /// G(x).
    fn below(&self, x: f64) -> f64 {
        let rest = x - self.mu * libm::log1p(x / self.mu);
        0.5 * self.slope * x * x + (1.0 - self.slope * self.mu) * rest
    }

    /// The x of which G is `u` times that of 1.
    fn candidate(&self, u: f32) -> f32 {
        let wanted = f64::from(u.max(LEAST)) * self.whole;
        let mut x = f64::from(u.max(LEAST)).sqrt();
        for _ in 0..MOST_STEPS {
            let density = x * (1.0 + self.slope * x) / (self.mu + x);
            let step = (self.below(x) - wanted) / density;
            x = (x - step).min(1.0);
            if step.abs() < 1e-8 * x {
                break;
            }
        }
        x as f32
    }
}

#[cfg(test)]
mod tests {
    use super::super::table::HTable;
    use super::*;
    use crate::spectrum::Lanes;

    /// What is taken with a probability above 1 would be drawn too rarely.
    #[test]
    fn no_h_is_above_its_bound() {
        let mut worst = 0.0_f32;
        for s in (0..=200).map(|i| i as f32 / 200.0) {
            let incidence = Incidence::new(s, 0.5);
            for x in (1..=200).map(|i| i as f32 / 200.0) {
                let h = HTable::get().at(Lanes::splat(s), x).x;
                worst = worst.max(h / (1.0 + incidence.slope as f32 * x));
            }
        }
        println!("H is at most {worst:.4} of its chord");
        assert!((1.1..BOUND).contains(&worst), "{worst}");
    }

    #[test]
    fn candidates_invert_their_integral() {
        for (s, mu) in [0.0, 0.3, 1.0].into_iter().flat_map(|s| [0.0, 1e-5, 0.01, 0.5, 1.0].map(|mu| (s, mu)))
        {
            let incidence = Incidence::new(s, mu);
            let mut before = 0.0;
            for u in [0.0, 1e-7, 1e-4, 0.01, 0.3, 0.7, 0.999, 0.999_999_9] {
                let x = incidence.candidate(u);
                assert!((before..=1.0).contains(&x), "s {s}, mu {mu}: {x} at {u}");
                // G goes like x^2 where mu is great: twice the half unit of f32 in x.
                let share = incidence.below(x.into()) / incidence.whole;
                let wanted = f64::from(u.max(LEAST));
                assert!((share / wanted - 1.0).abs() < 3e-7, "s {s}, mu {mu}: {share} at {u}");
                before = x;
            }
        }
    }
}
