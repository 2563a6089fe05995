//! Times several contenders in short turns, so that what else the machine does falls on all of them.

use std::ops::Range;
use std::time::Instant;

/// Rays of a turn.
const TURN: usize = 1 << 16;

/// Seconds that `work` takes, and what it made.
pub fn time<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let made = std::hint::black_box(work());
    (start.elapsed().as_secs_f64(), made)
}

/// Seconds of each contender in each of `passes` passes over `count` rays: `[contender][pass]`.
pub fn in_turns(
    count: usize,
    passes: usize,
    contenders: &mut [&mut dyn FnMut(Range<usize>) -> usize],
) -> Vec<Vec<f64>> {
    let mut seconds = vec![Vec::new(); contenders.len()];
    for pass in 0..passes {
        seconds.iter_mut().for_each(|passes| passes.push(0.0));
        for (turn, start) in (0..count).step_by(TURN).enumerate() {
            let range = start..(start + TURN).min(count);
            for i in 0..contenders.len() {
                // Nobody always follows the same one.
                let contender = (i + turn + pass) % contenders.len();
                seconds[contender][pass] += time(|| contenders[contender](range.clone())).0;
            }
        }
    }
    seconds
}

/// The middle of several values.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    if sorted.len() % 2 == 1 { sorted[middle] } else { 0.5 * (sorted[middle - 1] + sorted[middle]) }
}
