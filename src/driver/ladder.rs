//! The numbers of samples that a pixel may have: 16, 24, 32, 48, 64, ... up to a limit.
//!
//! Each rung is a multiple of the replicates in a pixel, so that a half has as many samples in each of its replicates,
//! and a power of two of them or three times one, at which low-discrepancy sequences are as even as they get.

/// Samples of the first rung: with fewer, two replicates of a half tell little.
const FIRST: u64 = 16;

/// The rungs up to a limit, which is the last one whatever it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Ladder {
    pub limit: u32,
}

impl Ladder {
    /// Samples of a pixel that is on rung `rung`, counted from 1; 0 before the first.
    pub fn samples(self, rung: u32) -> u32 {
        let Some(doubled) = rung.checked_sub(1) else { return 0 };
        let base = if doubled % 2 == 0 { FIRST } else { FIRST + FIRST / 2 };
        let shift = (doubled / 2).min(32);
        u32::try_from(base << shift).map_or(self.limit, |samples| samples.min(self.limit))
    }

    /// Whether a rung is the last one.
    pub fn is_last(self, rung: u32) -> bool {
        self.samples(rung) == self.limit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rungs_grow_up_to_the_limit() {
        let rungs = |limit| {
            let ladder = Ladder { limit };
            let last = (0..).find(|&rung| ladder.is_last(rung)).unwrap();
            (0..=last).map(|rung| ladder.samples(rung)).collect::<Vec<_>>()
        };
        assert_eq!(rungs(128), [0, 16, 24, 32, 48, 64, 96, 128]);
        assert_eq!(rungs(50), [0, 16, 24, 32, 48, 50]);
        assert_eq!(rungs(3), [0, 3]);
        let all = rungs(u32::MAX);
        assert!(all.windows(2).all(|pair| pair[0] < pair[1]) && all.len() < 60, "{all:?}");
    }
}
