//! CPU seconds of the process, parted among the lines of its ledgers: their sum is what it has taken.
//!
//! Threads serve several frames at once, one being rendered and the next one made ready, so what a single one takes
//! cannot be told.

use std::sync::atomic::{AtomicU64, Ordering};

use cpu_time::ProcessTime;

/// Nanoseconds when it was last asked.
static LAST: AtomicU64 = AtomicU64::new(0);

/// CPU seconds since this was asked last, by whomever.
pub(super) fn since_last() -> f64 {
    let now = now();
    let last = LAST.fetch_max(now, Ordering::Relaxed);
    now.saturating_sub(last) as f64 * 1e-9
}

/// The same, which is still to be told.
pub(super) fn so_far() -> f64 {
    now().saturating_sub(LAST.load(Ordering::Relaxed)) as f64 * 1e-9
}

fn now() -> u64 {
    let now = ProcessTime::try_now().map(|time| time.as_duration().as_nanos()).unwrap_or_default();
    u64::try_from(now).unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests run side by side and all of them may ask: no second is told twice.
    #[test]
    fn no_second_is_told_twice() {
        let begin = ProcessTime::now();
        since_last();
        let told: f64 = (0..1000).map(|_| since_last()).sum();
        assert!(told >= 0.0 && told <= begin.elapsed().as_secs_f64() + 1e-6, "{told}");
    }
}
