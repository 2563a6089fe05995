//! Frames that a sequence leaves out.

use std::fmt;

use super::{FrameFile, FrameNumber};

/// A run of frames that are not there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gap {
    /// The first number that is missing.
    pub first: FrameNumber,
    /// The last number that is missing.
    pub last: FrameNumber,
    /// The distance between the numbers of the sequence, in whole frames.
    pub step: i64,
}

impl fmt::Display for Gap {
    /// Writes `3`, `5-9` or `30-50x10`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.first == self.last, self.step) {
            (true, _) => write!(f, "{}", self.first),
            (false, 1) => write!(f, "{}-{}", self.first, self.last),
            (false, step) => write!(f, "{}-{}x{step}", self.first, self.last),
        }
    }
}

/// The gaps of an ascending sequence.
///
/// The step of the sequence is the greatest common divisor of its distances, so that every tenth frame
/// without one in the middle has one gap. Sequences with decimal numbers follow the simulation's time steps
/// and have no gaps.
pub fn gaps(frames: &[FrameFile]) -> Vec<Gap> {
    let Some(numbers) = frames.iter().map(|frame| frame.number.integer()).collect::<Option<Vec<i64>>>()
    else {
        return Vec::new();
    };
    let step = numbers.windows(2).map(|pair| pair[1] - pair[0]).fold(0, greatest_common_divisor);
    let missing = |pair: &[i64]| {
        let (first, last) = (pair[0] + step, pair[1] - step);
        let gap =
            Gap { first: FrameNumber::from_integer(first)?, last: FrameNumber::from_integer(last)?, step };
        (first <= last).then_some(gap)
    };
    numbers.windows(2).filter_map(missing).collect()
}

/// Euclid's algorithm; 0 leaves the other number.
fn greatest_common_divisor(a: i64, b: i64) -> i64 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    fn gaps_of(numbers: &[&str]) -> Vec<String> {
        let frame = |n: &&str| FrameFile { number: n.parse().unwrap(), path: PathBuf::new() };
        gaps(&numbers.iter().map(frame).collect::<Vec<_>>()).iter().map(Gap::to_string).collect()
    }

    #[test]
    fn gaps_follow_the_step() {
        assert!(gaps_of(&[]).is_empty());
        assert!(gaps_of(&["5"]).is_empty());
        assert!(gaps_of(&["1", "2", "3"]).is_empty());
        assert!(gaps_of(&["10", "20", "30"]).is_empty());
        assert_eq!(gaps_of(&["1", "2", "4", "10"]), ["3", "5-9"]);
        assert_eq!(gaps_of(&["10", "20", "60"]), ["30-50x10"]);
        assert_eq!(gaps_of(&["-2", "-1", "1"]), ["0"]);
        assert!(gaps_of(&["0.5", "12.5", "100"]).is_empty());
    }
}
