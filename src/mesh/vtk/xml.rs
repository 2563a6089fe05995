//! XML files of polygons (`.vtp`).
//!
//! ```text
//! VTKFile type="PolyData" byte_order=.. header_type=.. compressor=..
//!   PolyData
//!     Piece NumberOfPoints=.. NumberOfVerts=.. NumberOfLines=.. NumberOfPolys=.. NumberOfStrips=..
//!       PointData, CellData                   DataArray type=.. Name=.. NumberOfComponents=.. format=..
//!       Points                                one array
//!       Verts, Lines, Polys, Strips           arrays 'connectivity' and 'offsets', where each cell ends
//!   AppendedData encoding="raw" | "base64"    behind '_'
//! ```
//! An array is text, base64 where it stands, or at an offset of the appended data; [`blocks`] decodes the latter
//! two. No count of the file is believed before the bytes of an array have been compared with it. Appended raw
//! data is no XML, so that the parser sees the file up to there only.

mod blocks;
mod document;

use self::blocks::Encoded;
use self::document::{DataArray, Document, Section, Source};
use super::arrays::{Chosen, Declared};
use super::number::{NumberType, whole};
use super::{CellLists, Cells, Dataset};
use crate::mesh::VelocityName;
use crate::mesh::error::{Fault, excerpt};
use crate::mesh::limits::decompressed_limit;

/// Reads what a mesh needs of an XML file.
pub(super) fn read(bytes: &[u8], velocity: &VelocityName) -> Result<Dataset, Fault> {
    let document = Document::of(bytes)?;
    let reader = Reader { document: &document, limit: decompressed_limit(bytes.len()) };
    let piece = &document.piece;
    let coordinates = match document.find(Section::Points, None) {
        None if piece.points == 0 => Vec::new(),
        array => reader.values(document.required(array, "Points")?, piece.points, 3)?,
    };
    let mut lists: [Cells; 4] = Default::default();
    for (list, cells) in lists.iter_mut().enumerate() {
        *cells = reader.cells(list, piece.lists[list])?;
    }
    let cells = lists.iter().map(Cells::len).sum();
    let mut declared = Vec::new();
    let mut arrays = Vec::new();
    for array in &document.arrays {
        if let (Some(association), Some(_)) = (array.section.association(), array.number_type()) {
            declared.push(Declared { association, name: array.name.clone(), components: array.components });
            arrays.push((array, if array.section == Section::PointData { piece.points } else { cells }));
        }
    }
    let arrays = Chosen::of(&declared, velocity, |index| {
        let (array, count) = arrays[index];
        reader.values(array, count, array.components)
    })?;
    Ok(Dataset { coordinates, cells: CellLists::Poly(lists), arrays })
}

struct Reader<'d> {
    document: &'d Document<'d>,
    /// The most bytes that an array may expand to.
    limit: u64,
}

impl Reader<'_> {
    /// Vertices, lines, polygons or strips.
    fn cells(&self, list: usize, count: usize) -> Result<Cells, Fault> {
        if count == 0 {
            return Ok(Cells::default());
        }
        let find = |name| {
            let array = self.document.find(Section::List(list), Some(name));
            self.document.required(array, name)
        };
        let ends = find("offsets")?;
        let mut offsets = self.values(ends, count, 1)?;
        offsets.insert(0, 0.0);
        let corners = offsets.last().and_then(|&end| usize::try_from(whole(end)?).ok());
        let Some(corners) = corners else {
            let problem = format!("the cells end at {}", offsets[count]);
            return Err(ends.malformed(problem, "offsets count corners; write the file again"));
        };
        Cells::from_offsets(&offsets, &self.values(find("connectivity")?, corners, 1)?)
    }

    /// The numbers of an array of `count` tuples.
    fn values(&self, array: &DataArray, count: usize, components: usize) -> Result<Vec<f64>, Fault> {
        let Some(number_type) = array.number_type() else {
            let problem = format!("numbers of type '{}'", excerpt(array.type_name.as_bytes()));
            return Err(array.unsupported(problem, "write numbers, such as Float32 or Int64"));
        };
        if array.components != components {
            let problem = format!("{} numbers a tuple where {components} are needed", array.components);
            return Err(array.malformed(problem, "coordinates have three components, indices have one"));
        }
        let Some(count) = count.checked_mul(components) else {
            return Err(array.malformed(format!("{count} tuples"), "the counts of the piece are wrong"));
        };
        let encoded = match array.source {
            Source::Text(text) => return text_values(array, text, count),
            Source::Inline(text) => Encoded::base64(text),
            Source::Appended(offset) => self.document.appended(array, offset)?,
        };
        let Some(bytes) = count.checked_mul(number_type.size()) else {
            return Err(array.malformed(format!("{count} numbers"), "the counts of the piece are wrong"));
        };
        let storage = &self.document.storage;
        let bytes = blocks::read(encoded, storage, bytes, self.limit).map_err(|fault| array.at(fault))?;
        Ok(NumberType::read(number_type, &bytes, storage.order))
    }
}

fn text_values(array: &DataArray, text: &str, count: usize) -> Result<Vec<f64>, Fault> {
    let mut values = Vec::new();
    for word in text.split_ascii_whitespace() {
        let Ok(value) = word.parse::<f64>() else {
            let problem = format!("'{}' is no number", excerpt(word.as_bytes()));
            return Err(array.malformed(problem, "write numbers"));
        };
        values.push(value);
    }
    if values.len() == count {
        return Ok(values);
    }
    let problem = format!("{} numbers, but {count} are declared", values.len());
    Err(array.malformed(problem, "the file is truncated or its counts are wrong; write it again"))
}
