//! What the tags of an XML file say.

use std::borrow::Cow;
use std::str;

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use super::blocks::{Encoded, Storage};
use crate::mesh::error::{Fault, Place, excerpt};
use crate::mesh::vtk::arrays::Association;
use crate::mesh::vtk::number::{ByteOrder, NumberType};

const CURE: &str = "the file does not follow VTK's XML format; write it again";

const APPENDED: &[u8] = b"<AppendedData";

/// The element that an array stands in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Section {
    PointData,
    CellData,
    Points,
    /// Vertices, lines, polygons and strips.
    List(usize),
    /// Anything else.
    Other,
}

impl Section {
    fn of(name: &str) -> Self {
        match name {
            "PointData" => Self::PointData,
            "CellData" => Self::CellData,
            "Points" => Self::Points,
            "Verts" => Self::List(0),
            "Lines" => Self::List(1),
            "Polys" => Self::List(2),
            "Strips" => Self::List(3),
            _ => Self::Other,
        }
    }

    /// What the arrays of the section belong to.
    pub fn association(self) -> Option<Association> {
        match self {
            Self::PointData => Some(Association::Point),
            Self::CellData => Some(Association::Cell),
            Self::Points | Self::List(_) | Self::Other => None,
        }
    }
}

/// Where the numbers of an array are.
#[derive(Clone, Copy, Debug)]
pub(super) enum Source<'a> {
    /// Here, as text.
    Text(&'a str),
    /// Here, in base64.
    Inline(&'a str),
    /// At an offset of the appended data.
    Appended(usize),
}

/// An element `DataArray`.
#[derive(Debug)]
pub(super) struct DataArray<'a> {
    pub section: Section,
    pub name: String,
    pub type_name: String,
    pub components: usize,
    pub source: Source<'a>,
    line: usize,
}

impl DataArray<'_> {
    pub fn number_type(&self) -> Option<NumberType> {
        NumberType::of_xml(&self.type_name)
    }

    pub fn malformed(&self, problem: impl Into<String>, cure: &'static str) -> Fault {
        self.at(Fault::malformed(Place::File, problem, cure))
    }

    pub fn unsupported(&self, problem: impl Into<String>, cure: &'static str) -> Fault {
        self.at(Fault::unsupported(Place::File, problem, cure))
    }

    /// A fault of this array.
    pub fn at(&self, fault: Fault) -> Fault {
        let problem = format!("array '{}': {}", excerpt(self.name.as_bytes()), fault.problem);
        Fault { place: Place::Line(self.line), problem, ..fault }
    }
}

/// How many points and cells there are.
#[derive(Debug, Default)]
pub(super) struct Piece {
    pub points: usize,
    /// Vertices, lines, polygons and strips.
    pub lists: [usize; 4],
}

/// The tags of a file.
#[derive(Debug)]
pub(super) struct Document<'a> {
    pub storage: Storage,
    pub piece: Piece,
    pub arrays: Vec<DataArray<'a>>,
    /// The appended data behind its `_`, and whether it is raw.
    appended: Option<(&'a [u8], bool)>,
}

impl<'a> Document<'a> {
    pub fn of(bytes: &'a [u8]) -> Result<Self, Fault> {
        let mut tags = (0..bytes.len()).filter(|&at| bytes[at] == b'<');
        let start = tags.find(|&at| bytes[at..].starts_with(APPENDED));
        let end = start.and_then(|start| Some(start + bytes[start..].iter().position(|&b| b == b'>')? + 1));
        if let (Some(_), None) = (start, end) {
            let problem = "the file ends within the tag AppendedData";
            return Err(Fault::malformed(Place::File, problem, "the file is truncated; write it again"));
        }
        let (head, rest) = bytes.split_at(end.unwrap_or(bytes.len()));
        let head = str::from_utf8(head).map_err(|error| {
            let line = 1 + head[..error.valid_up_to()].iter().filter(|&&b| b == b'\n').count();
            Fault::malformed(Place::Line(line), "bytes that are no text", CURE)
        })?;
        let mut scan = Scan { appended: rest, ..Scan::default() };
        scan.all(head)?;
        let (Some(storage), Some(piece)) = (scan.storage, scan.piece) else {
            let problem = "the file has no element Piece within VTKFile and PolyData";
            return Err(Fault::malformed(Place::File, problem, CURE));
        };
        Ok(Self { storage, piece, arrays: scan.arrays, appended: scan.found })
    }

    /// The first array of a section, or the one of a name.
    pub fn find(&self, section: Section, name: Option<&str>) -> Option<&DataArray<'a>> {
        let fits = |array: &&DataArray| name.is_none_or(|name| name.eq_ignore_ascii_case(&array.name));
        self.arrays.iter().filter(|array| array.section == section).find(fits)
    }

    pub fn required<'d>(
        &self,
        array: Option<&'d DataArray<'a>>,
        name: &str,
    ) -> Result<&'d DataArray<'a>, Fault> {
        array.ok_or_else(|| {
            let problem = format!("the piece has no array '{name}' where one is needed");
            Fault::malformed(Place::File, problem, CURE)
        })
    }

    /// The appended data of an array.
    pub fn appended(&self, array: &DataArray, offset: usize) -> Result<Encoded<'a>, Fault> {
        let Some((data, raw)) = self.appended else {
            return Err(
                array.malformed("the file has no appended data", "the file is truncated; write it again")
            );
        };
        let Some(rest) = data.get(offset..) else {
            let problem = format!("offset {offset}, but {} bytes are appended", data.len());
            return Err(array.malformed(problem, "the file is truncated; write it again"));
        };
        if raw {
            return Ok(Encoded::Raw(rest));
        }
        let end = rest.iter().position(|&b| b == b'<').unwrap_or(rest.len());
        Ok(Encoded::Base64(Cow::Borrowed(rest[..end].trim_ascii_end())))
    }
}

/// What is open where the parser is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Open {
    Section(Section),
    /// An array by its index; further elements may stand in it.
    Array(usize),
    Other,
}

/// What the parser has found so far.
#[derive(Debug, Default)]
struct Scan<'a> {
    open: Vec<Open>,
    line: usize,
    storage: Option<Storage>,
    piece: Option<Piece>,
    arrays: Vec<DataArray<'a>>,
    /// What follows the tag of the appended data.
    appended: &'a [u8],
    found: Option<(&'a [u8], bool)>,
}

impl<'a> Scan<'a> {
    fn all(&mut self, head: &'a str) -> Result<(), Fault> {
        let mut reader = Reader::from_str(head);
        let mut counted = 0;
        self.line = 1;
        loop {
            let event = reader.read_event();
            let at = (reader.buffer_position() as usize).min(head.len());
            self.line += head.as_bytes()[counted..at].iter().filter(|&&b| b == b'\n').count();
            counted = at;
            match event {
                Ok(Event::Start(tag)) => self.start(&tag)?,
                Ok(Event::Empty(tag)) => {
                    self.start(&tag)?;
                    self.open.pop();
                }
                Ok(Event::End(_)) => {
                    self.open.pop();
                }
                Ok(Event::Text(text)) => self.text(text.into_inner())?,
                Ok(Event::Eof) => break,
                Ok(_) => {}
                Err(error) => {
                    let problem = format!("no XML: {}", excerpt(error.to_string().as_bytes()));
                    return Err(self.malformed(problem));
                }
            }
        }
        if self.open.is_empty() || self.found.is_some() {
            return Ok(());
        }
        let problem = format!("the file ends with {} elements open", self.open.len());
        Err(Fault::malformed(Place::Line(self.line), problem, "the file is truncated; write it again"))
    }

    fn malformed(&self, problem: impl Into<String>) -> Fault {
        Fault::malformed(Place::Line(self.line), problem, CURE)
    }

    fn start(&mut self, tag: &BytesStart) -> Result<(), Fault> {
        let name = tag.name();
        let open = match name.as_ref() {
            "VTKFile" => {
                self.file(tag)?;
                Open::Other
            }
            "Piece" => {
                self.piece(tag)?;
                Open::Other
            }
            "DataArray" => match self.open.last() {
                Some(&Open::Section(section)) if section != Section::Other => self.array(tag, section)?,
                _ => Open::Other,
            },
            "AppendedData" => {
                self.found = Some(self.data(tag)?);
                Open::Other
            }
            name if self.piece.is_some() => Open::Section(Section::of(name)),
            _ => Open::Other,
        };
        self.open.push(open);
        Ok(())
    }

    fn file(&mut self, tag: &BytesStart) -> Result<(), Fault> {
        let kind = self.attribute(tag, "type")?.unwrap_or_default();
        if kind != "PolyData" {
            let problem = format!("a dataset of type '{}'", excerpt(kind.as_bytes()));
            let cure = "write the surface as PolyData (ParaView: Contour, Extract Surface)";
            return Err(Fault::unsupported(Place::Line(self.line), problem, cure));
        }
        let order = match self.attribute(tag, "byte_order")?.as_deref() {
            Some("LittleEndian") | None => ByteOrder::Little,
            Some("BigEndian") => ByteOrder::Big,
            Some(order) => {
                return Err(self.malformed(format!("the byte order '{}'", excerpt(order.as_bytes()))));
            }
        };
        let header = match self.attribute(tag, "header_type")?.as_deref() {
            Some("UInt32") | None => 4,
            Some("UInt64") => 8,
            Some(other) => {
                return Err(self.malformed(format!("headers of type '{}'", excerpt(other.as_bytes()))));
            }
        };
        let zlib = match self.attribute(tag, "compressor")?.as_deref() {
            Some("vtkZLibDataCompressor") => true,
            Some("") | None => false,
            Some(other) => {
                let problem = format!("data compressed by '{}'", excerpt(other.as_bytes()));
                let cure = "write the file without compression or with zlib";
                return Err(Fault::unsupported(Place::Line(self.line), problem, cure));
            }
        };
        self.storage = Some(Storage { order, header, zlib });
        Ok(())
    }

    fn piece(&mut self, tag: &BytesStart) -> Result<(), Fault> {
        if self.piece.is_some() {
            let problem = "a second piece";
            let cure = "write the surface as one piece (ParaView: Merge Blocks)";
            return Err(Fault::unsupported(Place::Line(self.line), problem, cure));
        }
        let count = |name: &str| match self.attribute(tag, name)? {
            None => Ok(0),
            Some(text) => text.trim().parse().map_err(|_| {
                self.malformed(format!("'{}' as {name}, which is a count", excerpt(text.as_bytes())))
            }),
        };
        let lists = [
            count("NumberOfVerts")?,
            count("NumberOfLines")?,
            count("NumberOfPolys")?,
            count("NumberOfStrips")?,
        ];
        self.piece = Some(Piece { points: count("NumberOfPoints")?, lists });
        Ok(())
    }

    fn array(&mut self, tag: &BytesStart, section: Section) -> Result<Open, Fault> {
        let number = |name: &str, otherwise: usize| match self.attribute(tag, name)? {
            None => Ok(otherwise),
            Some(text) => text.trim().parse().map_err(|_| {
                self.malformed(format!("'{}' as {name}, which is a count", excerpt(text.as_bytes())))
            }),
        };
        let components = number("NumberOfComponents", 1)?;
        let source = match self.attribute(tag, "format")?.as_deref() {
            Some("ascii") | None => Source::Text(""),
            Some("binary") => Source::Inline(""),
            Some("appended") => Source::Appended(number("offset", 0)?),
            Some(other) => {
                return Err(self.malformed(format!("an array of format '{}'", excerpt(other.as_bytes()))));
            }
        };
        let name = self.attribute(tag, "Name")?.unwrap_or_default();
        let type_name = self.attribute(tag, "type")?.unwrap_or_default();
        self.arrays.push(DataArray { section, name, type_name, components, source, line: self.line });
        Ok(Open::Array(self.arrays.len() - 1))
    }

    /// Keeps the first text of an array that is not blank.
    fn text(&mut self, text: Cow<'a, str>) -> Result<(), Fault> {
        let Some(&Open::Array(index)) = self.open.last() else { return Ok(()) };
        let Cow::Borrowed(text) = text else {
            return Err(self.malformed("text that is not as it stands in the file"));
        };
        let text = text.trim();
        match &mut self.arrays[index].source {
            Source::Text(kept) | Source::Inline(kept) if kept.is_empty() => *kept = text,
            Source::Text(_) | Source::Inline(_) if !text.is_empty() => {
                return Err(self.malformed("an array in two parts"));
            }
            _ => {}
        }
        Ok(())
    }

    /// The appended data, and whether it is raw.
    fn data(&self, tag: &BytesStart) -> Result<(&'a [u8], bool), Fault> {
        let raw = match self.attribute(tag, "encoding")?.as_deref() {
            Some("raw") => true,
            Some("base64") | None => false,
            Some(other) => {
                return Err(self.malformed(format!("appended data in '{}'", excerpt(other.as_bytes()))));
            }
        };
        match self.appended.trim_ascii_start().strip_prefix(b"_") {
            Some(data) => Ok((data, raw)),
            None => {
                let cure = "the file is truncated; write it again";
                Err(Fault::malformed(Place::Line(self.line), "appended data without its '_'", cure))
            }
        }
    }

    fn attribute(&self, tag: &BytesStart, name: &str) -> Result<Option<String>, Fault> {
        let attribute = tag.try_get_attribute(name).map_err(|error| {
            self.malformed(format!(
                "attributes that cannot be read: {}",
                excerpt(error.to_string().as_bytes())
            ))
        })?;
        Ok(attribute.map(|attribute| attribute.value.into_owned()))
    }
}
