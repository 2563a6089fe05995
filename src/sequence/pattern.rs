//! The place of the frame number in the name of a file or a folder: `####`, `%04d`, `%d`, `$F4` or `$F`.

use super::name::is_time;
use super::{FrameNumber, SequenceError};

/// A name with a place for the number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct NamePattern {
    /// What stands before the number.
    pub prefix: String,
    /// Digits that the number is padded to.
    pub width: usize,
    /// What stands after the number.
    pub suffix: String,
}

impl NamePattern {
    /// Finds the place in one name (no separators); `None` when there is none.
    ///
    /// # Errors
    /// [`SequenceError::Pattern`] when there are two places.
    pub fn find(name: &str) -> Result<Option<Self>, SequenceError> {
        let Some((start, end, width)) = next_place(name, 0) else {
            return Ok(None);
        };
        if next_place(name, end).is_some() {
            return Err(SequenceError::Pattern {
                pattern: name.to_owned(),
                reason: "it has two places for the frame number: keep one of them".to_owned(),
            });
        }
        Ok(Some(Self { prefix: name[..start].to_owned(), width, suffix: name[end..].to_owned() }))
    }

    /// What stands at the place of the number in `name`, when that looks like a number.
    pub fn number_text<'n>(&self, name: &'n str) -> Option<&'n str> {
        let text = name.strip_prefix(self.prefix.as_str())?.strip_suffix(self.suffix.as_str())?;
        is_time(text.strip_prefix('-').unwrap_or(text)).then_some(text)
    }

    /// The name of one frame.
    pub fn expand(&self, number: FrameNumber) -> String {
        format!("{}{}{}", self.prefix, number.padded(self.width), self.suffix)
    }
}

/// The first place at or after byte `from`: its start, its end and its width.
fn next_place(name: &str, from: usize) -> Option<(usize, usize, usize)> {
    name.char_indices().filter(|&(start, _)| start >= from).find_map(|(start, c)| {
        let rest = &name[start..];
        let (length, width) = match c {
            '#' => hashes(rest),
            '%' => printf(rest)?,
            '$' => houdini(rest)?,
            _ => return None,
        };
        Some((start, start + length, width))
    })
}

/// `####`: as many digits as marks.
fn hashes(rest: &str) -> (usize, usize) {
    let length = rest.bytes().take_while(|&b| b == b'#').count();
    (length, length)
}

/// `%d`, `%4d` or `%04d`, of at most 99 digits.
fn printf(rest: &str) -> Option<(usize, usize)> {
    let digits = rest[1..].bytes().take_while(u8::is_ascii_digit).count();
    if rest.as_bytes().get(1 + digits) != Some(&b'd') {
        return None;
    }
    let width = rest[1..=digits].trim_start_matches('0');
    match width.len() {
        0 => Some((digits + 2, 1)),
        1 | 2 => Some((digits + 2, width.parse().ok()?)),
        _ => None,
    }
}

/// `$F` or `$F4`; `$FPS` and other variables are ordinary text.
fn houdini(rest: &str) -> Option<(usize, usize)> {
    let tail = rest.strip_prefix("$F")?;
    let digits = tail.bytes().take_while(u8::is_ascii_digit).count();
    let next_is_letter = tail[digits..].chars().next().is_some_and(char::is_alphabetic);
    match digits {
        0 if !next_is_letter => Some((2, 1)),
        1 | 2 if !next_is_letter => Some((2 + digits, tail[..digits].parse::<usize>().ok()?.max(1))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn pattern(name: &str) -> Option<(String, usize, String)> {
        NamePattern::find(name).unwrap().map(|p| (p.prefix, p.width, p.suffix))
    }

    #[test]
    fn every_spelling_of_the_place() {
        for (name, width) in [
            ("f_####.ply", 4),
            ("f_#.ply", 1),
            ("f_%04d.ply", 4),
            ("f_%4d.ply", 4),
            ("f_%d.ply", 1),
            ("f_%012d.ply", 12),
            ("f_$F4.ply", 4),
            ("f_$F.ply", 1),
        ] {
            assert_eq!(pattern(name), Some(("f_".to_owned(), width, ".ply".to_owned())), "{name}");
        }
        assert_eq!(pattern("blåbær_##_é.ply"), Some(("blåbær_".to_owned(), 2, "_é.ply".to_owned())));
        for name in [
            "frame.ply",
            "100%.ply",
            "f_%s.ply",
            "f_%d",
            "$FPS.ply",
            "$HIP.ply",
            "f_%0999d.ply",
            "f_$F999.ply",
            "",
        ] {
            assert_eq!(pattern(name).is_some(), name == "f_%d", "{name}");
        }
        assert!(NamePattern::find("a_##_##.ply").is_err());
        assert!(NamePattern::find("a_%d_$F.ply").is_err());
    }

    #[test]
    fn the_number_stands_at_its_place_and_nowhere_else() {
        let p = NamePattern::find("run2_####.ply").unwrap().unwrap();
        for (name, number) in [
            ("run2_0001.ply", Some("0001")),
            ("run2_1.ply", Some("1")),
            ("run2_12345.ply", Some("12345")),
            ("run2_-3.ply", Some("-3")),
            ("run2_12.5.ply", Some("12.5")),
            ("run2_1e-05.ply", Some("1e-05")),
            ("run2_.ply", None),
            ("run2_1a.ply", None),
            ("run2_1.ply.gz", None),
            ("run2_1.5.2.ply", None),
            ("run3_1.ply", None),
            ("run2_--1.ply", None),
        ] {
            assert_eq!(p.number_text(name), number, "{name}");
        }
        // The prefix and the suffix may not share characters of the name.
        let p = NamePattern::find("aa#aa").unwrap().unwrap();
        assert_eq!(p.number_text("aaa"), None);
        // A dash that belongs to the prefix is not a sign.
        let p = NamePattern::find("frame-####.ply").unwrap().unwrap();
        assert_eq!(p.number_text("frame-0005.ply"), Some("0005"));
    }

    proptest! {
        #[test]
        fn any_name_is_searched_without_panic(name in "[#%$F0-9dé_.\\-]{0,16}") {
            let _ = NamePattern::find(&name);
        }

        #[test]
        fn expansion_is_read_back(millionths in -10_000_000_000i64..10_000_000_000, width in 1usize..8) {
            let p = NamePattern { prefix: "a_".to_owned(), width, suffix: ".ply".to_owned() };
            let number = FrameNumber::from_millionths(millionths).unwrap();
            let name = p.expand(number);
            prop_assert_eq!(p.number_text(&name).unwrap().parse(), Ok(number));
        }
    }
}
