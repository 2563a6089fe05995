//! What of an OBJ file the parser gets to see.
//!
//! The parser starts a new mesh, with vertices of its own, at every group, makes up normals that are missing,
//! does not say on which line an error is, and computes with face indices before it checks them. The screen
//! lets through only `v`, `vn` and `f`, joins continued lines, checks indices, and knows the line.

use std::io::{self, BufRead, Read};
use std::str;

use crate::mesh::error::{Fault, Place, excerpt};
use crate::mesh::limits::MAX_TRIANGLES;

/// Statements that say nothing about the surface.
const PASSED_OVER: [&[u8]; 9] = [b"vt", b"vp", b"g", b"o", b"s", b"l", b"p", b"usemtl", b"mtllib"];

/// A reader of the lines that matter, each ending with a line break.
pub(super) struct Screen<'a> {
    rest: &'a [u8],
    /// The line that was read last, and its contents.
    line: usize,
    next_line: usize,
    text: &'a [u8],
    /// What is passed on of it, and how much of that is taken.
    out: Vec<u8>,
    taken: usize,
    positions: Counted,
    normals: Counted,
    corners: usize,
    corner_without_normal: bool,
    /// Some line is a statement of the format.
    any_statement: bool,
    /// The first line that is neither that nor a comment.
    first_foreign: Option<(usize, String)>,
    fault: Option<Fault>,
}

/// How many there are of a kind of line, and the greatest index that a face used, with its line.
#[derive(Default)]
struct Counted {
    count: usize,
    greatest: usize,
    line: usize,
}

impl Counted {
    /// Takes note of an index of a face; false when it is 0 or before the first.
    fn uses(&mut self, index: i64, line: usize) -> bool {
        let back = usize::try_from(index.unsigned_abs()).unwrap_or(usize::MAX);
        if index > 0 && back > self.greatest {
            (self.greatest, self.line) = (back, line);
        }
        index > 0 || (index < 0 && back <= self.count)
    }
}

const CORRECT: &str = "indices count from 1, or back from the last when negative; correct the line";

impl<'a> Screen<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self {
            rest: bytes,
            line: 1,
            next_line: 1,
            text: &[],
            out: Vec::new(),
            taken: 0,
            positions: Counted::default(),
            normals: Counted::default(),
            corners: 0,
            corner_without_normal: false,
            any_statement: false,
            first_foreign: None,
            fault: None,
        }
    }

    /// The line that was read last, from 1.
    pub fn line(&self) -> usize {
        self.line
    }

    /// What it says, for a message.
    pub fn text(&self) -> String {
        excerpt(self.text)
    }

    pub fn every_corner_has_normal(&self) -> bool {
        !self.corner_without_normal
    }

    /// The fault that was found on the way, if any.
    pub fn finish(&mut self) -> Result<(), Fault> {
        if let Some(fault) = self.fault.take() {
            return Err(fault);
        }
        match self.first_foreign.take() {
            Some((line, text)) if !self.any_statement => {
                let problem = format!("'{text}' is no statement of OBJ, and neither is any other line");
                Err(Fault::malformed(Place::Line(line), problem, "this is no OBJ file; rename or remove it"))
            }
            _ => Ok(()),
        }
    }

    /// Refuses an index beyond the end of its list. Only at the end of the file, since an index may be of
    /// something that follows; and before the parser, which computes with indices, sees that end.
    fn check_greatest(&self) -> Result<(), Fault> {
        for (list, name) in [(&self.positions, "vertices"), (&self.normals, "normals")] {
            if list.greatest > list.count {
                let problem = format!("index {}, but the file has {} {name}", list.greatest, list.count);
                let cure = "the file is truncated or its faces wrong; write it again";
                return Err(Fault::invalid(Place::Line(list.line), problem, cure));
            }
        }
        Ok(())
    }

    /// Reads on to the next line that matters; leaves `out` empty at the end.
    fn advance(&mut self) -> Result<(), Fault> {
        self.out.clear();
        self.taken = 0;
        while self.out.is_empty() && !self.rest.is_empty() {
            (self.text, self.rest) = logical_line(self.rest);
            self.line = self.next_line;
            self.next_line += self.text.iter().filter(|&&b| b == b'\n').count();
            self.pass_on(self.text)?;
        }
        if self.out.is_empty() { self.check_greatest() } else { Ok(()) }
    }

    fn pass_on(&mut self, line: &[u8]) -> Result<(), Fault> {
        let keyword = line.trim_ascii_start();
        let is = |name: &[u8]| {
            keyword.starts_with(name) && keyword.get(name.len()).is_none_or(u8::is_ascii_whitespace)
        };
        if !(is(b"v") || is(b"vn") || is(b"f")) {
            if PASSED_OVER.iter().any(|name| is(name)) {
                self.any_statement = true;
            } else if !keyword.is_empty() && !keyword.starts_with(b"#") && self.first_foreign.is_none() {
                self.first_foreign = Some((self.line, excerpt(line)));
            }
            return Ok(());
        }
        self.any_statement = true;
        let place = Place::Line(self.line);
        let text = str::from_utf8(line)
            .map_err(|_| Fault::malformed(place, "bytes that are no text", "write the file again"))?;
        let text = text.split('#').next().unwrap_or(text);
        // The backslash of a continued line parts words as the line break behind it does.
        let is_gap = |c: char| c.is_ascii_whitespace() || c == '\\';
        let words = || text.split(is_gap).filter(|word| !word.is_empty());
        match words().next() {
            Some("v") => {
                self.positions.count += 1;
                // Three coordinates, and a weight if it stands alone; colours are passed over.
                let count = if words().count() == 5 { 5 } else { 4 };
                self.send(words().take(count));
            }
            Some("vn") => {
                self.normals.count += 1;
                self.send(words().take(4));
            }
            _ => {
                self.check_face(words().skip(1))?;
                self.send(words());
            }
        }
        Ok(())
    }

    fn send<'w>(&mut self, words: impl Iterator<Item = &'w str>) {
        for word in words {
            self.out.extend_from_slice(word.as_bytes());
            self.out.push(b' ');
        }
        self.out.push(b'\n');
    }

    fn check_face<'w>(&mut self, corners: impl Iterator<Item = &'w str>) -> Result<(), Fault> {
        let mut count = 0;
        for corner in corners {
            count += 1;
            self.check_corner(corner)?;
        }
        let place = Place::Line(self.line);
        if count < 3 {
            let problem = format!("a face of {count} corners");
            return Err(Fault::invalid(
                place,
                problem,
                "a face needs three corners or more; leave this one out",
            ));
        }
        // A polygon of n corners becomes n - 2 triangles.
        self.corners += 3 * (count - 2);
        if self.corners / 3 > MAX_TRIANGLES {
            let problem = format!("more than {MAX_TRIANGLES} triangles");
            return Err(Fault::too_large(place, problem, "split the mesh into several files"));
        }
        Ok(())
    }

    fn check_corner(&mut self, corner: &str) -> Result<(), Fault> {
        let line = self.line;
        let mut has_normal = false;
        for (k, part) in corner.split('/').enumerate() {
            if part.is_empty() && k > 0 {
                continue;
            }
            let Some(index) = part.parse::<i64>().ok().filter(|_| k < 3) else {
                let problem = format!("'{}' is not a corner of a face", excerpt(corner.as_bytes()));
                return Err(Fault::malformed(
                    Place::Line(line),
                    problem,
                    "write corners as a, a/b, a//c or a/b/c",
                ));
            };
            let good = match k {
                0 => self.positions.uses(index, line),
                2 => {
                    has_normal = true;
                    self.normals.uses(index, line)
                }
                _ => true,
            };
            if !good {
                let problem = format!("index {index} in '{}'", excerpt(corner.as_bytes()));
                return Err(Fault::invalid(Place::Line(line), problem, CORRECT));
            }
        }
        self.corner_without_normal |= !has_normal;
        Ok(())
    }
}

impl Read for Screen<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let copied = self.fill_buf()?.read(buffer)?;
        self.consume(copied);
        Ok(copied)
    }
}

impl BufRead for Screen<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.taken == self.out.len()
            && let Err(fault) = self.advance()
        {
            self.fault = Some(fault);
            return Err(io::ErrorKind::InvalidData.into());
        }
        Ok(&self.out[self.taken..])
    }

    fn consume(&mut self, amount: usize) {
        self.taken += amount;
    }
}

/// The first line, with those that a backslash at its end appends, and what follows it.
fn logical_line(bytes: &[u8]) -> (&[u8], &[u8]) {
    let mut end = 0;
    for line in bytes.split_inclusive(|&b| b == b'\n') {
        end += line.len();
        if !line.trim_ascii_end().ends_with(b"\\") {
            break;
        }
    }
    bytes.split_at(end)
}

/// The fault of a position that is not finite, with its line if that can be found.
pub(super) fn not_finite(bytes: &[u8], position: glam::DVec3) -> Fault {
    let is_bad = |line: &[u8]| {
        let text = String::from_utf8_lossy(line);
        let mut words = text.split_ascii_whitespace();
        words.next() == Some("v")
            && words.any(|word| word.parse::<f64>().is_ok_and(|value| !value.is_finite()))
    };
    let line = bytes.split(|&b| b == b'\n').position(is_bad);
    let place = line.map_or(Place::File, |line| Place::Line(line + 1));
    let cure = "the simulation or its writer failed here; coordinates must be finite";
    Fault::invalid(place, format!("the coordinates {position} are not finite"), cure)
}
