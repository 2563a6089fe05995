//! Legacy files, versions 1 to 5.1, as text and binary.
//!
//! ```text
//! # vtk DataFile Version 4.2
//! TITLE
//! ASCII | BINARY                                     the greatest byte first
//! DATASET POLYDATA | UNSTRUCTURED_GRID
//! POINTS n TYPE          3 n numbers
//! POLYGONS n size        before 5: n times a count and so many indices, int32
//! POLYGONS n + 1 size    from 5 on: OFFSETS TYPE, n + 1 numbers; CONNECTIVITY TYPE, size numbers
//! CELL_TYPES n           n int32
//! POINT_DATA n           and CELL_DATA n: arrays in the sections that `attributes` knows
//! ```
//! Keywords come in any case, sections in any order that makes sense. `METADATA` lasts to an empty line.

mod attributes;

use std::str;

use self::attributes::Stored;
use super::arrays::{Association, Chosen, wholes};
use super::number::{ByteOrder, NumberType};
use super::{CellLists, Cells, Dataset};
use crate::mesh::VelocityName;
use crate::mesh::error::{Fault, Place, excerpt};
use crate::mesh::limits::check_count;
use crate::mesh::words::Words;

const CURE: &str = "the file does not follow the legacy VTK format; write it again";

/// Reads what a mesh needs of a legacy file.
pub(super) fn read(bytes: &[u8], velocity: &VelocityName) -> Result<Dataset, Fault> {
    let mut parser = Parser::of(bytes)?;
    while let Some(keyword) = parser.words.next() {
        parser.section(keyword)?;
    }
    if let Some(missing) = parser.missing() {
        let problem = format!("the file ends without a section {missing}");
        let cure = "the file is truncated or holds no surface; write it again";
        return Err(Fault::malformed(Place::File, problem, cure));
    }
    let declared = Vec::from_iter(parser.arrays.iter().map(|array| array.declared.clone()));
    let arrays = Chosen::of(&declared, velocity, |index| parser.values(index))?;
    let cells = match parser.kind {
        Kind::Poly => CellLists::Poly(parser.lists.map(Option::unwrap_or_default)),
        Kind::Unstructured => CellLists::Typed(parser.cells, parser.types.unwrap_or_default()),
    };
    Ok(Dataset { coordinates: parser.coordinates, cells, arrays })
}

/// The datasets that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Poly,
    Unstructured,
}

struct Parser<'a> {
    words: Words<'a>,
    binary: bool,
    /// Whether cells have offsets.
    offsets: bool,
    kind: Kind,
    /// What the arrays that follow belong to; `None` for those of the file as a whole.
    association: Option<Association>,
    points: Option<usize>,
    coordinates: Vec<f64>,
    /// Vertices, lines, polygons and strips.
    lists: [Option<Cells>; 4],
    cells: Cells,
    types: Option<Vec<i64>>,
    arrays: Vec<Stored<'a>>,
}

impl<'a> Parser<'a> {
    /// Reads the head of a file.
    fn of(bytes: &'a [u8]) -> Result<Self, Fault> {
        let mut words = Words::new(bytes, CURE);
        let first = words.rest_of_line();
        let version =
            str::from_utf8(first).ok().and_then(|line| line.strip_prefix("# vtk DataFile Version "));
        let major = version.and_then(|version| version.trim().split('.').next()?.parse::<u32>().ok());
        let Some(major) = major else {
            let problem = format!("the file begins with '{}'", excerpt(first));
            let cure = "this is no legacy VTK file, which begins with '# vtk DataFile Version'";
            return Err(Fault::malformed(Place::Line(1), problem, cure));
        };
        words.rest_of_line();
        let encoding = words.value("ASCII or BINARY")?;
        let binary = encoding.eq_ignore_ascii_case(b"binary");
        if !binary && !encoding.eq_ignore_ascii_case(b"ascii") {
            return Err(words.not("ASCII or BINARY", encoding));
        }
        let mut parser = Self {
            words,
            binary,
            offsets: major >= 5,
            kind: Kind::Poly,
            association: None,
            points: None,
            coordinates: Vec::new(),
            lists: Default::default(),
            cells: Cells::default(),
            types: None,
            arrays: Vec::new(),
        };
        parser.find_dataset()?;
        Ok(parser)
    }

    /// Reads up to the line that says what the file holds; fields of the whole file may stand before it.
    fn find_dataset(&mut self) -> Result<(), Fault> {
        loop {
            let keyword = self.words.value("DATASET")?;
            if keyword.eq_ignore_ascii_case(b"dataset") {
                break;
            }
            match keyword.to_ascii_lowercase().as_slice() {
                b"field" | b"metadata" => self.section(keyword)?,
                _ => return Err(self.words.not("DATASET", keyword)),
            }
        }
        let kind = self.words.value("the kind of dataset")?;
        self.kind = match kind.to_ascii_lowercase().as_slice() {
            b"polydata" => Kind::Poly,
            b"unstructured_grid" => Kind::Unstructured,
            _ => {
                let problem = format!("a dataset of kind '{}'", excerpt(kind));
                let cure = "write the surface as POLYDATA (ParaView: Contour, Extract Surface)";
                return Err(Fault::unsupported(self.words.place(), problem, cure));
            }
        };
        Ok(())
    }

    /// The first section that every file of this kind has and this one lacks.
    fn missing(&self) -> Option<&'static str> {
        match self.kind {
            _ if self.points.is_none() => Some("POINTS"),
            Kind::Poly if self.points > Some(0) && self.lists[2..].iter().all(Option::is_none) => {
                Some("POLYGONS or TRIANGLE_STRIPS")
            }
            Kind::Unstructured if self.types.is_none() => Some("CELL_TYPES"),
            _ => None,
        }
    }

    fn section(&mut self, keyword: &[u8]) -> Result<(), Fault> {
        let place = self.words.place();
        let lower = String::from_utf8_lossy(keyword).to_ascii_lowercase();
        let header = Header::of(self.words.rest_of_line(), place.clone());
        match lower.as_str() {
            "metadata" => self.pass_to_empty_line(),
            "points" if self.points.is_none() => {
                let count = header.count(0)?;
                let number_type = header.number_type(1)?;
                self.coordinates = self.numbers("point", count, 3, number_type)?;
                self.points = Some(count);
            }
            "vertices" | "lines" | "polygons" | "triangle_strips" if self.kind == Kind::Poly => {
                let names = ["vertices", "lines", "polygons", "triangle_strips"];
                let at = names.iter().position(|name| *name == lower).unwrap_or_default();
                if self.lists[at].is_some() {
                    return Err(Fault::malformed(place, format!("{lower} are there twice"), CURE));
                }
                self.lists[at] = Some(self.cells(&header)?);
            }
            "cells" if self.kind == Kind::Unstructured && self.cells.offsets.is_empty() => {
                self.cells = self.cells(&header)?;
            }
            "cell_types" if self.kind == Kind::Unstructured && self.types.is_none() => {
                let types = self.numbers("cell type", header.count(0)?, 1, NumberType::I32)?;
                self.types = Some(wholes(&types, "cell type")?);
            }
            _ => self.attributes(&lower, &header)?,
        }
        Ok(())
    }

    fn cells(&mut self, header: &Header) -> Result<Cells, Fault> {
        let (count, size) = (header.count(0)?, header.count(1)?);
        if self.offsets && (count > 0 || self.words.next_is("offsets")) {
            let offsets_type = self.array_type("OFFSETS")?;
            let offsets = self.numbers("offset", count, 1, offsets_type)?;
            let connectivity_type = self.array_type("CONNECTIVITY")?;
            let connectivity = self.numbers("corner", size, 1, connectivity_type)?;
            return Cells::from_offsets(&offsets, &connectivity);
        }
        if size < count {
            let problem = format!("{count} cells in {size} numbers");
            return Err(Fault::malformed(header.place.clone(), problem, CURE));
        }
        Cells::from_counts(&self.numbers("corner", size, 1, NumberType::I32)?, count)
    }

    /// The type of an array of cells, behind its name.
    fn array_type(&mut self, name: &str) -> Result<NumberType, Fault> {
        let word = self.words.value(name)?;
        if !word.eq_ignore_ascii_case(name.as_bytes()) {
            return Err(self.words.not(name, word));
        }
        let place = self.words.place();
        Header::of(self.words.rest_of_line(), place).number_type(0)
    }

    /// The numbers of `count` tuples, which are first compared with the bytes that are there.
    fn numbers(
        &mut self,
        name: &str,
        count: usize,
        components: usize,
        number_type: NumberType,
    ) -> Result<Vec<f64>, Fault> {
        self.check(name, count, components, number_type)?;
        if self.binary {
            let bytes = self.words.binary(count * components * number_type.size()).unwrap_or_default();
            return Ok(number_type.read(bytes, ByteOrder::Big));
        }
        (0..count * components).map(|_| self.words.number("a number")).collect()
    }

    /// Passes over as many numbers.
    fn skip(&mut self, count: usize, components: usize, number_type: NumberType) -> Result<(), Fault> {
        self.check("tuple", count, components, number_type)?;
        if self.binary {
            self.words.binary(count * components * number_type.size());
            return Ok(());
        }
        (0..count * components).try_for_each(|_| self.words.value("a number").map(|_| ()))
    }

    fn check(
        &self,
        name: &str,
        count: usize,
        components: usize,
        number_type: NumberType,
    ) -> Result<(), Fault> {
        // A digit and what parts it from the next, which the last number of a text may lack.
        let (least, slack) = if self.binary { (number_type.size(), 0) } else { (2, 1) };
        let tuple = components.saturating_mul(least);
        check_count(name, count, tuple, self.words.remaining() + slack, usize::MAX)
    }
}

/// The words behind the keyword of a section, on the same line.
struct Header<'a> {
    words: Vec<&'a str>,
    line: &'a [u8],
    place: Place,
}

impl<'a> Header<'a> {
    fn of(line: &'a [u8], place: Place) -> Self {
        let words =
            str::from_utf8(line).map(|line| line.split_ascii_whitespace().collect()).unwrap_or_default();
        Self { words, line, place }
    }

    fn word(&self, index: usize, expected: &str) -> Result<&'a str, Fault> {
        self.words.get(index).copied().ok_or_else(|| self.not(expected))
    }

    fn count(&self, index: usize) -> Result<usize, Fault> {
        self.word(index, "a count")?.parse().map_err(|_| self.not("a count"))
    }

    fn number_type(&self, index: usize) -> Result<NumberType, Fault> {
        let name = self.word(index, "a type of number")?;
        NumberType::of_legacy(name).ok_or_else(|| {
            let problem = format!("numbers of type '{}'", excerpt(name.as_bytes()));
            let cure = "only arrays of whole numbers and of float and double are read; write the file without others";
            Fault::unsupported(self.place.clone(), problem, cure)
        })
    }

    fn not(&self, expected: &str) -> Fault {
        let problem = format!("{expected} is missing in '{}'", excerpt(self.line));
        Fault::malformed(self.place.clone(), problem, CURE)
    }
}
