//! Words of a text, numbers among them, and where they stand.

use std::str;

use super::error::{Fault, Place, excerpt};

/// The words that are left of a file.
#[derive(Clone)]
pub(super) struct Words<'a> {
    rest: &'a [u8],
    length: usize,
    line: usize,
    /// Whether binary data was passed, after which lines mean nothing.
    binary: bool,
    /// What to do about a word that is wrong.
    cure: &'static str,
}

impl<'a> Words<'a> {
    pub fn new(bytes: &'a [u8], cure: &'static str) -> Self {
        Self { rest: bytes, length: bytes.len(), line: 1, binary: false, cure }
    }

    /// The line of the last word that was taken, or the byte behind it where binary data came before.
    pub fn place(&self) -> Place {
        if self.binary { Place::Byte(self.length - self.rest.len()) } else { Place::Line(self.line) }
    }

    /// The line of the last word that was taken.
    pub fn line(&self) -> usize {
        self.line
    }

    /// The bytes that are left.
    pub fn remaining(&self) -> usize {
        self.rest.len()
    }

    /// The next word; `None` at the end.
    pub fn next(&mut self) -> Option<&'a [u8]> {
        let mut start = 0;
        loop {
            match self.rest.get(start)? {
                b'\n' => self.line += 1,
                byte if byte.is_ascii_whitespace() => {}
                _ => break,
            }
            start += 1;
        }
        let word = &self.rest[start..];
        let length = word.iter().position(u8::is_ascii_whitespace).unwrap_or(word.len());
        let (word, rest) = word.split_at(length);
        self.rest = rest;
        Some(word)
    }

    /// Whether the next word is this one, in whatever case.
    pub fn next_is(&self, word: &str) -> bool {
        let rest = self.rest.trim_ascii_start();
        let end = rest.get(word.len()).is_none_or(u8::is_ascii_whitespace);
        end && rest.get(..word.len()).is_some_and(|head| head.eq_ignore_ascii_case(word.as_bytes()))
    }

    /// The next word of a record, which must not end the file.
    pub fn value(&mut self, expected: &str) -> Result<&'a [u8], Fault> {
        self.next().ok_or_else(|| {
            let problem = format!("the file ends where {expected} is expected");
            Fault::malformed(self.place(), problem, "the file is truncated; write it again")
        })
    }

    /// A number, which may be infinite or none.
    pub fn number(&mut self, expected: &str) -> Result<f64, Fault> {
        let word = self.value(expected)?;
        let value = str::from_utf8(word).ok().and_then(|word| word.parse::<f64>().ok());
        value.ok_or_else(|| self.not(expected, word))
    }

    /// A coordinate, which must be finite.
    pub fn coordinate(&mut self) -> Result<f64, Fault> {
        let value = self.number("a coordinate")?;
        if value.is_finite() {
            return Ok(value);
        }
        let cure = "the simulation or its writer failed here; coordinates must be finite";
        Err(Fault::invalid(self.place(), format!("coordinate '{value}' is not finite"), cure))
    }

    /// A whole number of at most 18 digits.
    pub fn integer(&mut self, expected: &str) -> Result<i64, Fault> {
        let word = self.value(expected)?;
        integer(word).ok_or_else(|| self.not(expected, word))
    }

    /// What is left of the line, without its end.
    pub fn rest_of_line(&mut self) -> &'a [u8] {
        let end = self.rest.iter().position(|&b| b == b'\n');
        let (line, rest) = self.rest.split_at(end.map_or(self.rest.len(), |at| at + 1));
        self.rest = rest;
        self.line += usize::from(end.is_some());
        line.trim_ascii()
    }

    /// Binary data; `None` where there is less.
    pub fn binary(&mut self, bytes: usize) -> Option<&'a [u8]> {
        let (data, rest) = self.rest.split_at_checked(bytes)?;
        self.rest = rest;
        self.binary = true;
        Some(data)
    }

    /// The fault of a word that is not what it ought to be.
    pub fn not(&self, expected: &str, word: &[u8]) -> Fault {
        Fault::malformed(self.place(), format!("'{}' is not {expected}", excerpt(word)), self.cure)
    }
}

/// A whole number of at most 18 digits.
fn integer(word: &[u8]) -> Option<i64> {
    let (digits, sign) = match word {
        [b'-', digits @ ..] => (digits, -1),
        [b'+', digits @ ..] => (digits, 1),
        digits => (digits, 1),
    };
    if digits.is_empty() || digits.len() > 18 || !digits.iter().all(u8::is_ascii_digit) {
        return None;
    }
    Some(sign * digits.iter().fold(0, |value, digit| 10 * value + i64::from(digit - b'0')))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_know_their_lines_and_bytes() {
        let mut words = Words::new(b"a  b\n\nc rest of it\r\nPoints\x00\x01 d", "mend it");
        assert_eq!(words.next(), Some(&b"a"[..]));
        assert_eq!((words.next(), words.place()), (Some(&b"b"[..]), Place::Line(1)));
        assert_eq!((words.next(), words.place()), (Some(&b"c"[..]), Place::Line(3)));
        assert_eq!(words.rest_of_line(), b"rest of it");
        assert!(!words.next_is("points") && !words.next_is("point"));
        assert_eq!((words.binary(6), words.binary(100)), (Some(&b"Points"[..]), None));
        assert_eq!(words.place(), Place::Byte(26));
        assert!(words.number("a number").is_err());
        assert!(words.next_is("D"));
        assert_eq!(words.integer("a count").unwrap_err().problem, "'d' is not a count");
        assert!(words.value("more").unwrap_err().problem.contains("ends where more"));
    }
}
