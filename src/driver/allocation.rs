//! Which tiles get more samples in the next round, from what is known of each.
//!
//! A tile t of a_t pixels with n_t samples each, of the cost c_t, has the share e_t of the frame's squared relative error,
//! which falls as 1 / n_t. The least error for a given cost, sum a_t n_t c_t, has
//!
//! ```text
//! e^2 = sum_t e_t          e_t / (a_t n_t c_t) = lambda for all t,   n_t ~ sqrt(variance of a sample / c_t)   (1)
//! ```
//!
//! Counts are rungs of a ladder, so tiles go on one rung at a time, the one first that gains most for its cost,
//!
//! ```text
//! gain_t = e_t (1 - n_t / n'_t) / (a_t c_t (n'_t - n_t)) = e_t / (a_t c_t n'_t)                             (2)
//! ```
//!
//! which lowers lambda step by step until the error is expected to be small enough. A round is a quarter of what is there
//! at most, since shares are not known well before there are many samples, and a sixteenth at least, so that the last
//! steps are few. In (2) each tile has some of the mean share too: one in which nothing rare has happened so far is
//! not believed to be without error.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use super::ladder::Ladder;
use super::stopping::Target;
use crate::film::ErrorEstimate;

/// Most and least samples of a round, relative to those before it.
const MOST: f64 = 1.0 / 4.0;
const LEAST: f64 = 1.0 / 16.0;

/// Most rungs that a tile goes in one round: to twice the samples.
const STEPS: u32 = 2;

/// What each tile has of the mean variance of a sample besides its own.
const CAUTION: f64 = 1.0 / 64.0;

/// What is known of a tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TileShare {
    /// Its pixels.
    pub area: u32,
    /// The rung that they are on.
    pub rung: u32,
    /// Its share of the frame's squared relative error.
    pub share: f64,
    /// What a sample of a pixel costs.
    pub cost: f64,
}

/// What is to be done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Decision {
    /// Nothing: the frame is good enough.
    Reached,
    /// Nothing: all pixels have all their samples.
    Exhausted,
    /// The tiles go on to these rungs.
    Further(Vec<u32>),
}

/// Decides after a round; `estimate` is of the frame as it is, if there is one.
pub(super) fn decide(
    tiles: &[TileShare],
    estimate: Option<ErrorEstimate>,
    target: &Target,
    ladder: Ladder,
) -> Decision {
    if estimate.is_some_and(|estimate| estimate.high <= target.error) {
        return Decision::Reached;
    }
    if tiles.iter().all(|tile| ladder.is_last(tile.rung)) {
        return Decision::Exhausted;
    }
    // The interval keeps its width relative to the error, however many samples there are.
    let aim = estimate.map_or(0.0, |e| {
        let narrowed = target.error * e.relative / e.high;
        if narrowed.is_finite() { narrowed * narrowed } else { 0.0 }
    });
    Decision::Further(next_rungs(tiles, aim, ladder))
}

/// A step of a tile: what it gains for a sample, and which tile it is; the first of equal ones comes first.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Step {
    gain: f64,
    tile: Reverse<usize>,
}

impl Eq for Step {}

impl Ord for Step {
    fn cmp(&self, other: &Self) -> Ordering {
        self.gain.total_cmp(&other.gain).then(self.tile.cmp(&other.tile))
    }
}

impl PartialOrd for Step {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The rungs after a round that brings the squared error down to `aim`, or as far as a round may go.
fn next_rungs(tiles: &[TileShare], aim: f64, ladder: Ladder) -> Vec<u32> {
    let samples = |rung| f64::from(ladder.samples(rung));
    let total: f64 = tiles.iter().map(|t| f64::from(t.area) * samples(t.rung) * t.cost).sum();
    let pixels: f64 = tiles.iter().map(|t| f64::from(t.area)).sum();
    // Variance of a sample, in units of the frame's error times its pixels.
    let mean = tiles.iter().map(|t| t.share * samples(t.rung)).sum::<f64>() / pixels;
    let step = |tile: usize, rung: u32| {
        let TileShare { area, rung: now, share, cost } = tiles[tile];
        let own = share * samples(now) / f64::from(area) + CAUTION * mean;
        let gain = own / (cost * samples(rung) * samples(rung + 1)); // (2)
        (!ladder.is_last(rung)).then_some(Step { gain, tile: Reverse(tile) })
    };
    let mut rungs: Vec<u32> = tiles.iter().map(|tile| tile.rung).collect();
    let mut steps: BinaryHeap<Step> =
        rungs.iter().enumerate().filter_map(|(tile, &rung)| step(tile, rung)).collect();
    let (mut expected, mut added) = (tiles.iter().map(|t| t.share).sum::<f64>(), 0.0);
    while (expected > aim || added < LEAST * total) && added < MOST * total {
        let Some(Step { tile: Reverse(tile), .. }) = steps.pop() else { break };
        let TileShare { area, rung: begun, share, cost } = tiles[tile];
        let (rung, now) = (rungs[tile], samples(begun));
        added += f64::from(area) * cost * (samples(rung + 1) - samples(rung));
        expected -= share * now * (1.0 / samples(rung) - 1.0 / samples(rung + 1));
        rungs[tile] = rung + 1;
        if rung + 1 < begun + STEPS {
            steps.extend(step(tile, rung + 1));
        }
    }
    rungs
}

#[cfg(test)]
mod tests {
    use super::*;

    const LADDER: Ladder = Ladder { limit: 4096 };
    const TARGET: Target = Target { error: 0.02, confidence: 0.95 };

    fn estimate(relative: f64) -> Option<ErrorEstimate> {
        Some(ErrorEstimate {
            relative,
            low: 0.9 * relative,
            high: 1.1 * relative,
            confidence: 0.95,
            independent: 1e4,
            concentration: 0.0,
            vagueness: 0.0,
        })
    }

    /// Tiles whose samples have these variances, on their rungs.
    fn shares(variances: &[f64], rungs: &[u32]) -> Vec<TileShare> {
        let share = |(v, &rung): (&f64, &u32)| TileShare {
            area: 256,
            rung,
            share: v / f64::from(LADDER.samples(rung)) / variances.len() as f64,
            cost: 1.0,
        };
        variances.iter().zip(rungs).map(share).collect()
    }

    /// What a sample costs in a tile: as much as four others, or as one.
    fn cost(tile: usize) -> f64 {
        f64::from(1 + 3 * u8::from(tile.is_multiple_of(3)))
    }

    /// Goes on from the first rung until the error is small enough.
    fn run(variances: &[f64]) -> (Vec<u32>, u32) {
        let mut rungs = vec![1; variances.len()];
        for rounds in 0.. {
            let mut tiles = shares(variances, &rungs);
            (0..).zip(&mut tiles).for_each(|(i, tile)| tile.cost = cost(i));
            let error = tiles.iter().map(|t| t.share).sum::<f64>().sqrt();
            match decide(&tiles, estimate(error), &TARGET, LADDER) {
                Decision::Further(next) => rungs = next,
                Decision::Reached => return (rungs, rounds),
                Decision::Exhausted => panic!("exhausted"),
            }
        }
        unreachable!()
    }

    /// The optimum of (1) with real numbers in place of rungs costs (mean of sqrt(v c))^2 / e^2. Rungs are apart by
    /// up to a half, which costs up to (sqrt(1.5) + sqrt(1/1.5)) / 2 - 1 = 2 %; the last round costs up to a sixteenth,
    /// and caution 1 % where variances are as uneven as here.
    #[test]
    fn samples_go_where_the_optimum_has_them() {
        let variances: Vec<f64> = (0..64).map(|t| 0.0001 * f64::from(1 + t * t)).collect();
        let (rungs, rounds) = run(&variances);
        let error = TARGET.error / 1.1;
        let mean_root = (0..).zip(&variances).map(|(i, v)| (v * cost(i)).sqrt()).sum::<f64>() / 64.0;
        let optimum = mean_root * mean_root / (error * error);
        let samples = |&rung: &u32| f64::from(LADDER.samples(rung));
        let used = (0..).zip(&rungs).map(|(i, rung)| samples(rung) * cost(i)).sum::<f64>() / 64.0;
        assert!((0.99..1.1).contains(&(used / optimum)), "{used} for {optimum}");
        let mean_cost = (0..64).map(cost).sum::<f64>() / 64.0;
        let uniform = mean_cost * variances.iter().sum::<f64>() / 64.0 / (error * error);
        assert!(used < 0.8 * uniform, "{used} against {uniform} uniformly");
        assert!(rounds < 30, "{rounds} rounds");
    }

    #[test]
    fn a_frame_that_is_good_enough_stops_and_one_that_has_all_does_too() {
        let tiles = shares(&[1.0, 2.0], &[1, 1]);
        assert_eq!(decide(&tiles, estimate(0.018), &TARGET, LADDER), Decision::Reached);
        let last = Ladder { limit: 16 };
        assert_eq!(decide(&tiles, estimate(0.2), &TARGET, last), Decision::Exhausted);
        assert_eq!(decide(&tiles, None, &TARGET, last), Decision::Exhausted);
        // Of a single pixel nothing is known but that it has to go on.
        let one = Some(ErrorEstimate {
            relative: 0.1,
            low: 0.0,
            high: f64::INFINITY,
            confidence: 0.95,
            independent: 1e4,
            concentration: 0.0,
            vagueness: 0.0,
        });
        assert_eq!(decide(&tiles, one, &TARGET, LADDER), Decision::Further(vec![1, 2]));
    }

    #[test]
    fn a_tile_without_error_so_far_is_not_forgotten() {
        let mut rungs = vec![1; 64];
        for _ in 0..16 {
            let mut variances = vec![1.0; 64];
            variances[7] = 0.0;
            match decide(&shares(&variances, &rungs), estimate(0.1), &TARGET, LADDER) {
                Decision::Further(next) => rungs = next,
                other => panic!("{other:?}"),
            }
        }
        assert!(rungs[7] > 1 && rungs[7] < rungs[6], "{rungs:?}");
    }

    #[test]
    fn a_round_adds_a_quarter_at_most_and_a_sixteenth_at_least() {
        for (error, least, most) in [(1.0, 0.24, 0.26), (0.0183, 0.06, 0.08)] {
            let variances = vec![error * error * 16.0; 256];
            let tiles = shares(&variances, &[1; 256]);
            let Decision::Further(next) = decide(&tiles, estimate(error), &TARGET, LADDER) else {
                panic!("it stopped");
            };
            let added = next.iter().filter(|&&rung| rung == 2).count() as f64 * 8.0 / (256.0 * 16.0);
            assert!((least..most).contains(&added), "{added}");
        }
    }
}
