//! One of several equal parts of a sequence, each for a machine of its own: `3/8` is the third of eight.
//!
//! ```text
//! in turns    position p of n belongs to part p mod N + 1 of N
//! in blocks   it belongs to part floor(p N / n) + 1
//! ```
//! Positions follow from what was asked for, not from what is there yet ([`FrameSelection::position`]): runs that see a
//! folder at different times leave no frame to nobody.
//!
//! [`FrameSelection::position`]: super::FrameSelection::position

use std::fmt;
use std::str::FromStr;

use super::SequenceError;

/// Which part of a sequence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// From 1.
    number: u32,
    of: u32,
    deal: Deal,
}

/// How frames are dealt out to parts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Deal {
    /// In turns: neighbours, which take about as long, are of different parts.
    #[default]
    Turns,
    /// In blocks: neighbours are of one part, so that what serves for both is made once.
    Blocks,
}

impl Shard {
    /// Which it is, from 1.
    pub fn number(self) -> u32 {
        self.number
    }

    /// The same with another way to deal out frames.
    #[must_use]
    pub fn dealt(self, deal: Deal) -> Self {
        Self { deal, ..self }
    }

    /// Whether a position of so many, from 0, is in it.
    pub fn holds(self, position: u128, of: u128) -> bool {
        let [parts, place] = [self.of, self.number - 1].map(u128::from);
        match self.deal {
            Deal::Turns => position % parts == place,
            Deal::Blocks => position * parts / of.max(1) == place,
        }
    }
}

impl FromStr for Shard {
    type Err = SequenceError;

    fn from_str(text: &str) -> Result<Self, SequenceError> {
        let wrong = |reason: String| SequenceError::Shard { text: text.to_owned(), reason };
        let numbers = text.split_once('/').map(|(number, of)| (number.trim().parse(), of.trim().parse()));
        match numbers {
            Some((Ok(_), Ok(0))) => Err(wrong("there is at least one shard: write 1/1".into())),
            Some((Ok(number), Ok(of))) if (1..=of).contains(&number) => {
                Ok(Self { number, of, deal: Deal::default() })
            }
            Some((Ok::<u32, _>(_), Ok(of))) => {
                Err(wrong(format!("shards count from 1: write one of 1/{of} to {of}/{of}")))
            }
            _ => Err(wrong("write for example 3/8, the third of eight".into())),
        }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn held(text: &str, deal: Deal, count: u128) -> Vec<u128> {
        let shard = text.parse::<Shard>().unwrap().dealt(deal);
        (0..count).filter(|&position| shard.holds(position, count)).collect()
    }

    #[test]
    fn turns_and_blocks() {
        assert_eq!(held("1/3", Deal::Turns, 8), [0, 3, 6]);
        assert_eq!(held("3/3", Deal::Turns, 8), [2, 5]);
        assert_eq!(held("1/3", Deal::Blocks, 8), [0, 1, 2]);
        assert_eq!(held("2/3", Deal::Blocks, 8), [3, 4, 5]);
        assert_eq!(held("3/3", Deal::Blocks, 8), [6, 7]);
        assert_eq!(held("5/8", Deal::Turns, 3), [0; 0]);
    }

    #[test]
    fn every_position_is_of_one_part_and_parts_differ_by_one_at_most() {
        for deal in [Deal::Turns, Deal::Blocks] {
            for (of, count) in (1..12).flat_map(|of| (0..40).map(move |count| (of, count))) {
                let parts = (1..=of).map(|number| held(&format!("{number}/{of}"), deal, count));
                let parts: Vec<Vec<u128>> = parts.collect();
                let mut all = parts.concat();
                all.sort_unstable();
                assert_eq!(all, (0..count).collect::<Vec<_>>(), "{deal:?} {of}");
                let sizes = || parts.iter().map(Vec::len);
                assert!(sizes().max() <= sizes().min().map(|least| least + 1), "{deal:?} {of} {count}");
            }
        }
    }

    #[test]
    fn wrong_texts_are_named_with_their_cure() {
        for (text, cure) in [
            ("0/8", "one of 1/8 to 8/8"),
            ("9/8", "one of 1/8 to 8/8"),
            ("0/0", "write 1/1"),
            ("3", "3/8"),
            ("", "3/8"),
            ("/", "3/8"),
            ("-1/8", "3/8"),
            ("1/2/3", "3/8"),
            ("1.5/8", "3/8"),
            ("1/99999999999", "3/8"),
        ] {
            let error = text.parse::<Shard>().unwrap_err().to_string();
            assert!(error.contains(&format!("`{text}`")) && error.contains(cure), "{error}");
        }
        assert_eq!(" 3 / 8 ".parse::<Shard>().unwrap().to_string(), "3/8");
    }
}
