//! Chances of random numbers that are multiples of 2^-24, as all are here.

use super::path::Branch;

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
