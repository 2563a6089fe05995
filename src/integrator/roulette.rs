//! Russian roulette.
//!
//! It acts on the throughput without the factors (n_a / n_b)^2 of the boundaries crossed, relative to the branch's share at
//! the splits, so that a path which loses nothing is never ended by it. Chances are those of random numbers that are
//! multiples of 2^-24, as all are here.

use super::path::{Branch, Fate};

/// From this meeting with a surface on, counted since the last particle, a path survives with [`LATE_SURVIVAL`],
/// whatever its throughput.
const LATE_ROULETTE: u32 = 1024;
/// Probability of going on at each meeting beyond [`LATE_ROULETTE`].
const LATE_SURVIVAL: f32 = 0.98;
/// Paths of a greater throughput, in the sense of the head, are not ended: one that left a diffuse wall would otherwise be
/// light or nothing. Turbid water under a sky takes 0.6 to 0.8 of the time to equal error that 1 takes, and 0.1 is worse.
pub(super) const UNTOUCHED: f32 = 0.25;
/// The same where particles show a glow around the sun: few of the paths that lead there bring most of its light, and what
/// survives roulette brings more. In the scene of `tests/bench/hero` this leaves 0.89 of the variance in 1.06 of the time, and
/// 0.6 of the fireflies.
pub(super) const UNTOUCHED_IN_GLOW: f32 = 0.12;
/// From this interaction n on a path survives with 1 - 1 / n, so that of those which have come so far a share of
/// `LONG_WALK / n` is left after n.
///
/// A walk that loses nothing leaves a half space after more than n steps with a chance like 1 / sqrt(n), and a slab after
/// as many as its optical depth in the mean. So the roulette hardly touches bodies of less than a thousand mean free
/// paths, and the mean length of walks without any way out is bounded.
pub(super) const LONG_WALK: u32 = 65_536;
/// No path goes on beyond this many interactions.
pub(super) const LONGEST_WALK: u32 = 1 << 24;

/// A probability as random numbers have it, which are multiples of 2^-24: those below it are rounded up.
///
/// Of a path of throughput 1e-9 one random number in 2^24, which is 0, is still below its chance to survive; if it were
/// weighted with that chance, paths through opaque media would bring more light than there is.
#[inline]
pub(super) fn at_random(probability: f32) -> f32 {
    /// From here on the rounding is below 2^-12 of the probability.
    const LIKELY: f32 = 1.0 / 4096.0;
    const NUMBERS: f32 = 16_777_216.0;
    if probability >= LIKELY || cfg!(floe_without_guards) {
        probability
    } else {
        (probability * NUMBERS).ceil() / NUMBERS
    }
}

/// The chance with which light is looked for that takes long to find, for a path of a weight ([`Branch::weight`]).
#[inline]
pub(super) fn chance_of_a_look(weight: f32) -> f32 {
    /// Below this a look costs more than it brings: it is taken with a chance in proportion.
    const WORTH_A_LOOK: f32 = 0.05;
    at_random((weight / WORTH_A_LOOK).min(1.0))
}

impl Branch {
    /// How much of the light that arrives counts, without the factors of the boundaries; 1 at the eye.
    #[inline]
    pub(super) fn weight(&self) -> f32 {
        self.throughput.max_element() / self.index_factor
    }

    /// Counts an interaction with a surface and plays Russian roulette with `u`.
    pub(super) fn interacted(&mut self, u: f32) -> Fate {
        self.bounces += 1;
        self.goes_on(u)
    }

    /// Counts an interaction and plays Russian roulette with `u`.
    #[inline]
    pub(super) fn goes_on(&mut self, u: f32) -> Fate {
        self.interactions += 1;
        let is_early = self.bounces < LATE_ROULETTE && self.interactions < LONG_WALK;
        if is_early && self.throughput.max_element() > self.untouched * (self.index_factor * self.share) {
            return Fate::GoesOn;
        }
        let kept = self.throughput.max_element() / (self.index_factor * self.share);
        let late = self.late_survival();
        // Not `min`, which would make 1 of a throughput that is not a number, or of a branch without any share.
        let survival = at_random(if kept >= self.untouched { late } else { kept / self.untouched * late });
        if survival >= 1.0 {
            return Fate::GoesOn;
        }
        if u < survival {
            self.throughput /= survival;
            Fate::GoesOn
        } else {
            Fate::Ends
        }
    }

    /// Russian roulette for a path far outside; one that ends has no throughput.
    ///
    /// A walk without losses in a medium without end comes back from r times a body's size with a chance like 1 / r, after
    /// like r^2 steps. Those that go on with 1 / r of the chance weigh r times as much, so that what comes back varies little.
    #[inline]
    pub(super) fn wander_off(&mut self, survival: f32) {
        if survival < 1.0 {
            let u = self.stream.next4()[0];
            self.keep(survival, u);
        }
    }

    /// Leaves no throughput, or that of all whose `u` is not below the probability.
    pub(super) fn keep(&mut self, survival: f32, u: f32) {
        let survival = at_random(survival);
        self.throughput *= if u < survival { survival.recip() } else { 0.0 };
    }

    /// False where the path has to be cut.
    #[inline]
    pub(super) fn is_below_the_longest(&self) -> bool {
        self.interactions < LONGEST_WALK
    }

    /// Probability of going on for paths that lose nothing.
    #[inline]
    fn late_survival(&self) -> f32 {
        let mut survival = if self.bounces >= LATE_ROULETTE { LATE_SURVIVAL } else { 1.0 };
        if self.interactions >= LONG_WALK {
            survival *= 1.0 - 1.0 / self.interactions as f32;
        }
        survival
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use crate::integrator::path::{Branch, Fate};
    use crate::sampling::{SampleSeed, SampleStream};
    use crate::spectrum::Lanes;

    /// The mean over all random numbers is the throughput, up to the roundings of the quotient, and of probabilities above
    /// 2^-12: half of 2^-24 of 2^-12. Every number below 2^-10 is tried; above it no path of these survives.
    #[test]
    fn roulette_keeps_the_light_of_the_darkest_paths() {
        for throughput in [1e-4, 3e-5, 1.1e-6, 2e-8, 1e-9, 1e-20, 1e-37] {
            let stream = SampleStream::new(SampleSeed::new(0), 0, 0, 0);
            let start =
                Branch { throughput: Lanes::splat(throughput), ..Branch::new(Vec3::ZERO, Vec3::X, stream) };
            let kept = (0..1 << 14).filter_map(|i| {
                let mut branch = start;
                let fate = branch.goes_on(i as f32 / 16_777_216.0);
                (fate == Fate::GoesOn).then(|| f64::from(branch.throughput.x))
            });
            let mean = kept.sum::<f64>() / 16_777_216.0;
            let ratio = mean / f64::from(throughput);
            assert!((ratio - 1.0).abs() < 1.3e-4, "{throughput}: {ratio}");
        }
        // A path in thin air may be 1e9 widths of all there is away at once.
        for survival in [1e-4, 3e-5, 1.1e-6, 1e-9] {
            let stream = SampleStream::new(SampleSeed::new(0), 0, 0, 0);
            let kept = (0..1 << 14).map(|i| {
                let mut branch = Branch::new(Vec3::ZERO, Vec3::X, stream);
                branch.keep(survival, i as f32 / 16_777_216.0);
                f64::from(branch.throughput.x)
            });
            let mean = kept.sum::<f64>() / 16_777_216.0;
            assert!((mean - 1.0).abs() < 1.3e-4, "{survival}: {mean}");
        }
        let nothing = Branch {
            throughput: Lanes::ZERO,
            ..Branch::new(Vec3::ZERO, Vec3::X, SampleStream::new(SampleSeed::new(0), 0, 0, 0))
        };
        assert_eq!({ nothing }.goes_on(0.0), Fate::Ends);
        let spoilt = Branch { throughput: Lanes::NAN, ..nothing };
        assert_eq!({ spoilt }.goes_on(0.0), Fate::Ends);
    }
}
