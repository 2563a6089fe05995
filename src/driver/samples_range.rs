//! Some of the samples of each pixel, for frames that several machines draw: `--samples-range 0..64`.

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// Samples by their indices in the sequence of each pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct SamplesRange {
    /// The first one.
    pub first: u32,
    /// The one after the last.
    pub end: u32,
}

impl SamplesRange {
    /// How many.
    pub fn count(self) -> u32 {
        self.end.saturating_sub(self.first)
    }

    /// Those of two ranges, if there are any.
    pub fn shared(self, other: Self) -> Option<Self> {
        let shared = Self { first: self.first.max(other.first), end: self.end.min(other.end) };
        (shared.first < shared.end).then_some(shared)
    }

    /// Of `samples` those that are in none of the ranges.
    pub fn gaps(mut ranges: Vec<Self>, samples: u32) -> Vec<Self> {
        ranges.sort_unstable();
        let all = Self { first: samples, end: samples };
        let mut first = 0;
        let mut gaps = Vec::new();
        for range in ranges.into_iter().chain([all]) {
            gaps.extend((first < range.first).then_some(Self { first, end: range.first }));
            first = first.max(range.end);
        }
        gaps
    }

    /// Where these samples of a picture are: `frame_0007.0-64.partial` beside `frame_0007.exr`.
    pub fn partial_of(self, picture: &Path) -> PathBuf {
        let stem = picture.file_stem().unwrap_or_default().to_string_lossy();
        picture.with_file_name(format!("{stem}.{}-{}.partial", self.first, self.end))
    }

    /// The range in the name of a file that [`partial_of`](Self::partial_of) tells for a picture; `None` for others.
    pub fn of_partial(name: &str, picture: &Path) -> Option<Self> {
        let stem = picture.file_stem()?.to_str()?;
        let (first, end) =
            name.strip_prefix(stem)?.strip_prefix('.')?.strip_suffix(".partial")?.split_once('-')?;
        Some(Self { first: number(first)?, end: number(end)? })
    }
}

/// Digits and nothing else.
fn number(text: &str) -> Option<u32> {
    text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse().ok()).flatten()
}

impl fmt::Display for SamplesRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}..{}", self.first, self.end)
    }
}

impl FromStr for SamplesRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let range = text
            .split_once("..")
            .and_then(|(first, end)| Some(Self { first: number(first)?, end: number(end)? }));
        match range {
            Some(range) if range.first < range.end => Ok(range),
            Some(range) => Err(format!("there are no samples in {range}; write 0..64 for the first 64")),
            None => Err(format!("`{text}` is no range of samples; write 0..64 for the first 64")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(first: u32, end: u32) -> SamplesRange {
        SamplesRange { first, end }
    }

    #[test]
    fn ranges_are_half_open_and_hold_something() {
        assert_eq!("0..64".parse(), Ok(range(0, 64)));
        assert_eq!(range(7, 64).to_string().parse(), Ok(range(7, 64)));
        for wrong in
            ["", "64", "..", "0..", "..64", "0...64", "0..=63", "a..b", "-1..4", "+1..4", "0..4294967296"]
        {
            let error = wrong.parse::<SamplesRange>().unwrap_err();
            assert!(error.contains(&format!("`{wrong}`")) && error.contains("0..64"), "{error}");
        }
        for empty in ["4..4", "9..4"] {
            assert!(empty.parse::<SamplesRange>().unwrap_err().contains("no samples in"), "{empty}");
        }
    }

    #[test]
    fn gaps_are_what_no_range_has() {
        let gaps = |ranges: &[(u32, u32)]| {
            let ranges = ranges.iter().map(|&(first, end)| range(first, end)).collect();
            SamplesRange::gaps(ranges, 64)
        };
        assert_eq!(gaps(&[]), [range(0, 64)]);
        assert_eq!(gaps(&[(32, 64), (0, 32)]), []);
        assert_eq!(gaps(&[(40, 50), (8, 16), (8, 12)]), [range(0, 8), range(16, 40), range(50, 64)]);
        assert_eq!(range(0, 32).shared(range(32, 64)), None);
        assert_eq!(range(0, 40).shared(range(32, 64)), Some(range(32, 40)));
    }

    #[test]
    fn names_tell_the_range_and_the_picture() {
        let picture = Path::new("out/a.12.exr");
        let name = "a.12.0-64.partial";
        assert_eq!(range(0, 64).partial_of(picture), Path::new("out").join(name));
        assert_eq!(SamplesRange::of_partial(name, picture), Some(range(0, 64)));
        // Frame 12.5, another name, copies.
        for other in ["a.12.5.0-64.partial", "b.12.0-64.partial", "a.12.0-64 (1).partial", "a.12.0-64.exr"] {
            assert_eq!(SamplesRange::of_partial(other, picture), None, "{other}");
        }
    }
}
