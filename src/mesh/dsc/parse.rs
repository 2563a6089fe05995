//! The text of a `.dsc` file.

use std::str;

use glam::DVec3;

use super::Complex;
use crate::mesh::Region;
use crate::mesh::error::{Fault, Place, excerpt};

/// The label of the shell around the domain.
const SHELL: i32 = 999;

const CURE: &str = "a file has records 'v x y z' and 't i0 i1 i2 i3 label'; write it again";

/// Most tetrahedra: their faces are numbered with 32 bits.
const MAX_TETRAHEDRA: usize = (u32::MAX / 4) as usize;

/// Reads the vertices and tetrahedra of a file.
pub(super) fn parse(bytes: &[u8]) -> Result<Complex, Fault> {
    if bytes.is_empty() {
        return Err(Fault::malformed(
            Place::File,
            "the file is empty",
            "wait for its writer or write it again",
        ));
    }
    let mut complex = Complex::default();
    let mut words = Words::new(bytes);
    while let Some(word) = words.next() {
        match word {
            b"v" => complex.positions.push(vertex(&mut words)?),
            b"t" => {
                let (tetrahedron, label) = tetrahedron(&mut words)?;
                complex.tetrahedra.push(tetrahedron);
                complex.labels.push(label);
            }
            _ => {
                let problem = format!("'{}' where a record begins", excerpt(word));
                return Err(Fault::malformed(Place::Line(words.line), problem, CURE));
            }
        }
    }
    drop_repeated_last(&mut complex);
    check_indices(&complex, bytes)?;
    Ok(complex)
}

/// The line on which tetrahedron `index` begins.
pub(super) fn line_of_tetrahedron(bytes: &[u8], index: usize) -> usize {
    let mut words = Words::new(bytes);
    let mut left = index;
    while let Some(word) = words.next() {
        if word == b"t" {
            if left == 0 {
                break;
            }
            left -= 1;
        }
    }
    words.line
}

fn vertex(words: &mut Words) -> Result<DVec3, Fault> {
    let mut position = DVec3::ZERO;
    for axis in 0..3 {
        let word = words.value("a coordinate")?;
        let value = str::from_utf8(word).ok().and_then(|word| word.parse::<f64>().ok());
        position[axis] = match value {
            Some(value) if value.is_finite() => value,
            Some(_) => {
                let problem = format!("coordinate '{}' is not finite", excerpt(word));
                let cure = "the simulation or its writer failed here; coordinates must be finite";
                return Err(Fault::invalid(Place::Line(words.line), problem, cure));
            }
            None => return Err(words.not("a coordinate", word)),
        };
    }
    Ok(position)
}

fn tetrahedron(words: &mut Words) -> Result<([u32; 4], i32), Fault> {
    let mut indices = [0; 4];
    for index in &mut indices {
        let word = words.value("a vertex index")?;
        let value = integer(word).ok_or_else(|| words.not("a vertex index", word))?;
        *index = u32::try_from(value).map_err(|_| {
            let problem = format!("vertex index {value}");
            Fault::invalid(Place::Line(words.line), problem, "indices count from 0 and have 32 bits")
        })?;
    }
    let word = words.value("a label")?;
    let value = integer(word).ok_or_else(|| words.not("a label", word))?;
    let label = i32::try_from(value).map_err(|_| {
        let problem = format!("label {value} does not fit in 32 bits with a sign");
        Fault::invalid(Place::Line(words.line), problem, "use labels up to 2147483647")
    })?;
    Ok((indices, if label == SHELL { Region::OUTSIDE.0 } else { label }))
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

fn drop_repeated_last(complex: &mut Complex) {
    if let [.., before, last] = complex.tetrahedra[..]
        && let [.., label_before, label_last] = complex.labels[..]
        && (before, label_before) == (last, label_last)
    {
        complex.tetrahedra.pop();
        complex.labels.pop();
    }
}

fn check_indices(complex: &Complex, bytes: &[u8]) -> Result<(), Fault> {
    let count = complex.positions.len();
    if complex.tetrahedra.len() > MAX_TETRAHEDRA {
        let problem = format!("more than {MAX_TETRAHEDRA} tetrahedra");
        return Err(Fault::too_large(Place::File, problem, "split the mesh into several files"));
    }
    let place = |t| Place::Line(line_of_tetrahedron(bytes, t));
    for (t, tetrahedron) in complex.tetrahedra.iter().enumerate() {
        if let Some(index) = tetrahedron.iter().find(|&&index| index as usize >= count) {
            let problem = format!("vertex index {index}, but the file has {count} vertices");
            return Err(Fault::invalid(
                place(t),
                problem,
                "the file is truncated or its indices do not count from 0",
            ));
        }
        let [a, b, c, d] = *tetrahedron;
        if a == b || a == c || a == d || b == c || b == d || c == d {
            let problem = format!("tetrahedron {a} {b} {c} {d} uses a vertex twice");
            return Err(Fault::invalid(place(t), problem, "leave such tetrahedra out"));
        }
    }
    Ok(())
}

/// The words of a text and the line that the last of them stands on.
struct Words<'a> {
    rest: &'a [u8],
    line: usize,
}

impl<'a> Words<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes, line: 1 }
    }

    fn next(&mut self) -> Option<&'a [u8]> {
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

    /// The next word of a record, which must not end the file.
    fn value(&mut self, expected: &str) -> Result<&'a [u8], Fault> {
        self.next().ok_or_else(|| {
            let problem = format!("the file ends where {expected} is expected");
            Fault::malformed(Place::Line(self.line), problem, "the file is truncated; write it again")
        })
    }

    fn not(&self, expected: &str, word: &[u8]) -> Fault {
        Fault::malformed(Place::Line(self.line), format!("'{}' is not {expected}", excerpt(word)), CURE)
    }
}
