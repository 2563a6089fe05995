//! Reads the elements of any PLY file, one record after the other.

use std::borrow::Cow;
use std::io::ErrorKind;
use std::str;

use glam::DVec3;
use ply_rs::parser::{ParseError, Parser};
use ply_rs::ply::{ElementDef, Encoding, PropertyAccess};

use super::elements::{FaceRecord, SkippedRecord, VertexRecord};
use super::header::{Header, check_length};
use crate::mesh::error::{Fault, Place, excerpt};
use crate::mesh::polygons::{add_fan, region};
use crate::mesh::{CornerNormals, Interface, RawMesh};

/// The longest line of text that is taken for an element.
const LONGEST_LINE: usize = 1 << 20;

const WRITE_AGAIN: &str = "the file is truncated or damaged; write it again";

/// Reads everything behind the header.
pub(super) fn read(header: &Header, payload: &[u8]) -> Result<RawMesh, Fault> {
    let mut records =
        Records { rest: payload, encoding: header.declared.encoding, line: header.lines, text: &[] };
    let mut mesh = RawMesh::default();
    for element in header.declared.elements.values() {
        check_length(element, records.encoding, records.rest.len())?;
        match element.name.as_str() {
            "vertex" => read_vertices(&mut records, element, header, &mut mesh)?,
            "face" => read_faces(&mut records, element, header, &mut mesh)?,
            // Without properties there is nothing to pass over, however many are declared.
            _ if element.properties.is_empty() => {}
            _ => {
                for index in 0..element.count {
                    records.next::<SkippedRecord>(element, index)?;
                }
            }
        }
    }
    Ok(mesh)
}

fn read_vertices(
    records: &mut Records,
    element: &ElementDef,
    header: &Header,
    mesh: &mut RawMesh,
) -> Result<(), Fault> {
    mesh.positions.reserve_exact(element.count);
    let mut normals = Vec::with_capacity(if header.normals { element.count } else { 0 });
    let mut velocities = Vec::with_capacity(if header.velocities { element.count } else { 0 });
    for index in 0..element.count {
        let vertex: VertexRecord = records.next(element, index)?;
        if !vertex.position.is_finite() {
            return Err(records.not_finite(element, index, vertex.position));
        }
        mesh.positions.push(vertex.position);
        if header.normals {
            normals.push(vertex.normal);
        }
        if header.velocities {
            velocities.push(vertex.velocity);
        }
    }
    mesh.normals = header.normals.then_some(CornerNormals { values: normals, corners: None });
    mesh.velocities = header.velocities.then_some(velocities);
    Ok(())
}

fn read_faces(
    records: &mut Records,
    element: &ElementDef,
    header: &Header,
    mesh: &mut RawMesh,
) -> Result<(), Fault> {
    let vertices = header.vertices();
    mesh.triangles.reserve_exact(element.count);
    let mut interfaces = Vec::with_capacity(if header.labelled { element.count } else { 0 });
    for index in 0..element.count {
        let face: FaceRecord = records.next(element, index)?;
        let place = || Place::element(&element.name, index);
        add_fan(&face.indices, vertices, &mut mesh.triangles, place)?;
        if header.labelled {
            let interface = Interface { front: region(face.front, place)?, back: region(face.back, place)? };
            interfaces.resize(mesh.triangles.len(), interface);
        }
    }
    mesh.interfaces = header.labelled.then_some(interfaces);
    Ok(())
}

/// The records that follow, in whatever encoding.
struct Records<'a> {
    rest: &'a [u8],
    encoding: Encoding,
    /// The line last read, when the encoding is text.
    line: usize,
    /// Its contents.
    text: &'a [u8],
}

impl Records<'_> {
    fn next<E: PropertyAccess>(&mut self, element: &ElementDef, index: usize) -> Result<E, Fault> {
        let parser = Parser::<E>::new();
        let record = match self.encoding {
            Encoding::Ascii => return self.next_line(&parser, element, index),
            Encoding::BinaryLittleEndian => parser.read_little_endian_element(&mut self.rest, element),
            Encoding::BinaryBigEndian => parser.read_big_endian_element(&mut self.rest, element),
        };
        record.map_err(|error| fault(&error, Place::element(&element.name, index), element.count))
    }

    fn next_line<E: PropertyAccess>(
        &mut self,
        parser: &Parser<E>,
        element: &ElementDef,
        index: usize,
    ) -> Result<E, Fault> {
        loop {
            if self.rest.is_empty() {
                let problem = format!("the file ends before this element; {} are declared", element.count);
                return Err(Fault::malformed(Place::element(&element.name, index), problem, WRITE_AGAIN));
            }
            let end = self.rest.iter().position(|&b| b == b'\n').map_or(self.rest.len(), |at| at + 1);
            let (line, rest) = self.rest.split_at(end);
            (self.text, self.rest) = (line.trim_ascii(), rest);
            self.line += 1;
            if !self.text.is_empty() {
                break;
            }
        }
        let place = Place::Line(self.line);
        let cure = "write numbers, as many as the header declares";
        let text = match str::from_utf8(self.text) {
            Ok(text) if text.len() <= LONGEST_LINE => text,
            Ok(_) => return Err(Fault::malformed(place, "a line of more than a megabyte", cure)),
            Err(_) => return Err(Fault::malformed(place, "bytes that are no text", cure)),
        };
        parser.read_ascii_element(&plain_numbers(text), element).map_err(|_| {
            let problem =
                format!("'{}' is no {} as the header declares it", excerpt(self.text), element.name);
            Fault::malformed(place, problem, cure)
        })
    }

    fn not_finite(&self, element: &ElementDef, index: usize, position: DVec3) -> Fault {
        let cure = "the simulation or its writer failed here; coordinates must be finite";
        match self.encoding {
            Encoding::Ascii => {
                let problem = format!("coordinates that are not finite: '{}'", excerpt(self.text));
                Fault::invalid(Place::Line(self.line), problem, cure)
            }
            _ => {
                let problem = format!("the coordinates {position} are not finite");
                Fault::invalid(Place::element(&element.name, index), problem, cure)
            }
        }
    }
}

fn fault(error: &ParseError, place: Place, count: usize) -> Fault {
    let problem = if error.kind() == ErrorKind::UnexpectedEof {
        format!("the file ends within this element; {count} are declared")
    } else {
        excerpt(error.to_string().trim_end_matches('.').as_bytes())
    };
    Fault::malformed(place, problem, WRITE_AGAIN)
}

/// A line with the numbers that C writes and the parser's grammar lacks (`1.`, `.5`, `nan`, `inf`) written so
/// that it has them; 1e999 is infinite, and so neither a position nor a normal.
fn plain_numbers(line: &str) -> Cow<'_, str> {
    let is_plain = |token: &str| {
        let digits = token.strip_prefix(['+', '-']).unwrap_or(token);
        let (whole, fraction) = digits.split_once('.').unwrap_or((digits, "0"));
        whole.starts_with(|c: char| c.is_ascii_digit()) && fraction.starts_with(|c: char| c.is_ascii_digit())
    };
    if line.split_ascii_whitespace().all(is_plain) {
        return Cow::Borrowed(line);
    }
    let plain = |token: &str| match token.parse::<f64>() {
        Ok(value) if value.is_finite() => format!("{value:e}"),
        Ok(_) => "1e999".to_owned(),
        Err(_) => token.to_owned(),
    };
    let tokens = line.split_ascii_whitespace();
    let tokens: Vec<_> =
        tokens.map(|token| if is_plain(token) { token.to_owned() } else { plain(token) }).collect();
    Cow::Owned(tokens.join(" "))
}
