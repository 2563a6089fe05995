//! Which sun a photon is of, and where on the disc across its light it starts.
//!
//! One number chooses the sun and, by where in the sun's share it lies, is one of the two for the point too: photons of each
//! sun are as even as those of all.
//!
//! ```text
//! p(i, x) = p_i q_i(x)      over the suns i and the unit square from which the points are drawn
//! ```
//! Without a pilot p_i goes with the irradiance across the light, which is met by the same disc whatever the sun, and q_i is 1.

use crate::light::Sun;
use crate::sampling::{Distribution1d, Distribution2d};

/// How photons are shared out among suns.
#[derive(Clone, Debug)]
pub(in crate::integrator) struct SunStarts {
    choice: Distribution1d,
    /// By sun; none where points are drawn evenly.
    across: Vec<Distribution2d>,
}

/// A sun, and a point of the unit square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::integrator) struct SunStart {
    pub(in crate::integrator) sun: usize,
    pub(in crate::integrator) place: [f32; 2],
    /// p of the head.
    pub(in crate::integrator) density: f32,
}

impl SunStarts {
    /// By their power; `None` without suns.
    pub(super) fn by_power(suns: &[Sun]) -> Option<Self> {
        let choice = Distribution1d::new(suns.iter().map(|sun| sun.power().into()));
        choice.map(|choice| Self { choice, across: Vec::new() }).or_else(|| Self::even(suns.len()))
    }

    /// As many photons of each of so many, evenly over the square; `None` of none.
    pub(in crate::integrator) fn even(suns: usize) -> Option<Self> {
        let choice = Distribution1d::new(std::iter::repeat_n(1.0, suns))?;
        Some(Self { choice, across: Vec::new() })
    }

    /// By what the cells of a grid over the square are worth, sun by sun and in each row by row, none of them nothing.
    pub(in crate::integrator) fn by_worth(worth: &[f64], cells: usize) -> Option<Self> {
        let of_suns = || worth.chunks_exact(cells * cells);
        let choice = Distribution1d::new(of_suns().map(|own| own.iter().sum()))?;
        let across = of_suns().map(|own| Distribution2d::new(cells, own)).collect::<Option<_>>()?;
        Some(Self { choice, across })
    }

    pub(in crate::integrator) fn sample(&self, u: [f32; 2]) -> SunStart {
        let (sun, rest) = self.choice.sample(u[1]);
        let u = [u[0], rest];
        let (place, density) = self.across.get(sun).map_or((u, 1.0), |across| across.sample(u));
        SunStart { sun, place, density: density * self.choice.probability(sun) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Shares of a fine grid of numbers follow the density: a cell holds what it says to within a row and a column of the
    /// grid, and the density is constant in it.
    #[test]
    fn photons_start_with_the_density_that_they_state() {
        let worth = [1.0, 2.0, 3.0, 4.0, 20.0, 10.0, 5.0, 5.0, 0.1, 0.1, 0.1, 0.2];
        let starts = SunStarts::by_worth(&worth, 2).unwrap();
        let (n, mut counts) = (1000, [0.0_f64; 12]);
        for i in 0..n * n {
            let u = [i % n, i / n].map(|k| (k as f32 + 0.5) / n as f32);
            let start = starts.sample(u);
            let [x, y] = start.place.map(|x| (2.0 * x) as usize);
            let cell = 4 * start.sun + 2 * y + x;
            counts[cell] += 1.0 / f64::from(n * n);
            let expected = 4.0 * worth[cell] / worth.iter().sum::<f64>();
            assert!((f64::from(start.density) / expected - 1.0).abs() < 1e-6, "{start:?} for {expected}");
        }
        for (count, worth_of) in counts.iter().zip(worth) {
            let expected = worth_of / worth.iter().sum::<f64>();
            assert!((count - expected).abs() < 2.0 / f64::from(n), "{count} for {expected}");
        }
    }

    /// Alone, a sun has the two numbers as they are.
    #[test]
    fn one_sun_takes_numbers_as_they_are() {
        let alone = SunStarts::even(1).unwrap();
        for i in 0..100_000 {
            let u = [0.3, i as f32 * 1e-5];
            assert_eq!(alone.sample(u), SunStart { sun: 0, place: u, density: 1.0 });
        }
        assert!(SunStarts::even(0).is_none());
    }
}
