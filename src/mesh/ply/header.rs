//! What a PLY file declares, checked before any of it is believed.

use ply_rs::parser::{Parser, Reader};
use ply_rs::ply::{self, ElementDef, Encoding, PropertyType, ScalarType};

use super::elements::VertexRecord;
use crate::mesh::error::{Fault, Place, excerpt};
use crate::mesh::limits::{MAX_TRIANGLES, MAX_VERTICES, check_count};
use crate::mesh::{VelocityName, VelocityProperty};

/// The longest header that is looked through for its end.
const LONGEST: usize = 1 << 20;

const CURE: &str = "the header does not follow the PLY format; correct it or write the file again";

/// The checked header of a file.
pub(super) struct Header {
    /// What it declares.
    pub declared: ply::Header,
    /// Its bytes, up to and including the line `end_header`.
    pub length: usize,
    /// Its lines.
    pub lines: usize,
    /// Whether faces carry labels.
    pub labelled: bool,
    /// Whether vertices carry normals.
    pub normals: bool,
    /// Whether vertices carry velocities that are wanted; they are renamed to [`VELOCITY`].
    pub velocities: bool,
}

/// What velocities are called in [`Header::declared`] whatever the file calls them: no name in a file has a space.
pub(super) const VELOCITY: [&str; 3] = ["velocity x", "velocity y", "velocity z"];

impl Header {
    /// The number of vertices.
    pub fn vertices(&self) -> usize {
        self.declared.elements.get("vertex").map_or(0, |vertex| vertex.count)
    }
}

/// Reads and checks the header of a file.
pub(super) fn read(bytes: &[u8], velocity: &VelocityName) -> Result<Header, Fault> {
    let length = length(bytes)?;
    let text = &bytes[..length];
    let mut declared =
        Parser::<VertexRecord>::new().read_header(&mut Reader::new(text)).map_err(|error| {
            let place = error.line().map_or(Place::File, Place::Line);
            let message = error.to_string();
            // The parser's messages about a line quote it.
            let problem = match message.split_once("String: '") {
                Some((_, quoted)) => {
                    let line = quoted.lines().next().unwrap_or(quoted).trim_end_matches('\'');
                    format!("not a header line: '{}'", excerpt(line.as_bytes()))
                }
                None => excerpt(message.trim_end_matches('.').as_bytes()),
            };
            Fault::malformed(place, problem, CURE)
        })?;
    check_repeats(text, &declared)?;
    let lines = text.iter().filter(|&&b| b == b'\n').count();
    let (labelled, normals) = check_roles(&declared)?;
    let velocities = rename_velocities(&mut declared, velocity);
    Ok(Header { declared, length, lines, labelled, normals, velocities })
}

/// Gives the wanted velocities their names, if there are any.
fn rename_velocities(declared: &mut ply::Header, velocity: &VelocityName) -> bool {
    let Some(vertex) = declared.elements.get_mut("vertex") else { return false };
    let is_number = |property: &&ply::PropertyDef| matches!(property.data_type, PropertyType::Scalar(_));
    let numbers: Vec<&str> = vertex.properties.values().filter(is_number).map(|p| p.name.as_str()).collect();
    let Some(VelocityProperty::Components(names)) = velocity.find(&[], &numbers) else { return false };
    let renamed = std::mem::take(&mut vertex.properties).into_iter().map(|(name, property)| {
        let axis = names.iter().position(|of_axis| *of_axis == name);
        (axis.map_or(name, |axis| VELOCITY[axis].to_owned()), property)
    });
    vertex.properties = renamed.collect();
    true
}

/// The bytes up to and including the line `end_header`.
fn length(bytes: &[u8]) -> Result<usize, Fault> {
    const END: &[u8] = b"end_header";
    let mut at = 0;
    for line in bytes[..bytes.len().min(LONGEST)].split_inclusive(|&b| b == b'\n') {
        let content = line.trim_ascii_end();
        if at == 0 && content != b"ply" {
            let problem = format!("the file begins with '{}' and not with the line 'ply'", excerpt(content));
            return Err(Fault::malformed(
                Place::Line(1),
                problem,
                "this is no PLY file; rename or remove it",
            ));
        }
        at += line.len();
        if content == END {
            return Ok(at);
        }
    }
    let problem = format!("no line 'end_header' in the first {} bytes", bytes.len().min(LONGEST));
    Err(Fault::malformed(Place::File, problem, "the file is truncated or no PLY file; write it again"))
}

/// The parser keeps the last of several declarations of one name, which would shift everything after it.
fn check_repeats(text: &[u8], declared: &ply::Header) -> Result<(), Fault> {
    let lines_with =
        |keyword: &[u8]| text.split(|&b| b == b'\n').filter(|line| line.starts_with(keyword)).count();
    let properties: usize = declared.elements.values().map(|element| element.properties.len()).sum();
    if lines_with(b"element") != declared.elements.len() || lines_with(b"property") != properties {
        let problem = "an element or a property of an element is declared twice";
        return Err(Fault::malformed(Place::File, problem, CURE));
    }
    Ok(())
}

/// Finds what the mesh needs; tells whether there are labels and normals.
fn check_roles(declared: &ply::Header) -> Result<(bool, bool), Fault> {
    let Some(vertex) = declared.elements.get("vertex") else {
        return Err(Fault::malformed(Place::File, "the header declares no element 'vertex'", CURE));
    };
    for axis in ["x", "y", "z"] {
        if !is_scalar(vertex, axis) {
            let problem = format!("element 'vertex' has no number '{axis}'");
            return Err(Fault::malformed(Place::File, problem, "declare the properties x, y and z"));
        }
    }
    let normals = ["nx", "ny", "nz"].iter().all(|axis| is_scalar(vertex, axis));
    let Some(face) = declared.elements.get("face") else {
        if declared.elements.contains_key("tristrips") {
            let problem = "triangle strips (element 'tristrips') are not read";
            return Err(Fault::unsupported(Place::File, problem, "write the triangles as element 'face'"));
        }
        return Ok((false, normals));
    };
    index_list(face)?;
    Ok((check_labels(face)?, normals))
}

/// The name of the list of vertex indices of a face.
pub(super) fn index_list(face: &ElementDef) -> Result<&str, Fault> {
    const NAMES: [&str; 2] = ["vertex_indices", "vertex_index"];
    let mut found = face.properties.values().filter(|property| NAMES.contains(&property.name.as_str()));
    match (found.next(), found.next()) {
        (Some(list), None) => match &list.data_type {
            PropertyType::List(count, index) if is_integer(count) && is_integer(index) => Ok(&list.name),
            _ => Err(Fault::malformed(
                Place::File,
                format!("property '{}' of 'face' is not a list of whole numbers", list.name),
                "declare it as: property list uchar int vertex_indices",
            )),
        },
        (Some(_), Some(_)) => Err(Fault::malformed(
            Place::File,
            "'face' has both vertex_indices and vertex_index",
            "keep one of them",
        )),
        (None, _) => Err(Fault::malformed(
            Place::File,
            "element 'face' has no list 'vertex_indices'",
            "declare: property list uchar int vertex_indices",
        )),
    }
}

/// Whether faces have labels: both, and whole numbers.
fn check_labels(face: &ElementDef) -> Result<bool, Fault> {
    let mut present = 0;
    for name in ["label_front", "label_back"] {
        match face.properties.get(name).map(|property| &property.data_type) {
            None => {}
            Some(PropertyType::Scalar(scalar)) if is_integer(scalar) => present += 1,
            Some(_) => {
                let problem = format!("property '{name}' of 'face' is not a whole number");
                return Err(Fault::invalid(Place::File, problem, "declare labels as uchar or int"));
            }
        }
    }
    if present == 1 {
        let problem = "'face' has only one of label_front and label_back";
        return Err(Fault::invalid(Place::File, problem, "write both labels or none"));
    }
    Ok(present == 2)
}

fn is_scalar(element: &ElementDef, name: &str) -> bool {
    let property = element.properties.get(name);
    property.is_some_and(|property| matches!(property.data_type, PropertyType::Scalar(_)))
}

fn is_integer(scalar: &ScalarType) -> bool {
    !matches!(scalar, ScalarType::Float | ScalarType::Double)
}

/// Bytes of a number in a binary file.
pub(super) fn size(scalar: &ScalarType) -> usize {
    match scalar {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    }
}

/// Refuses an element that cannot be as long as declared in the bytes that are left.
pub(super) fn check_length(element: &ElementDef, encoding: Encoding, remaining: usize) -> Result<(), Fault> {
    let least: usize =
        element.properties.values().map(|property| least_size(element, property, encoding)).sum();
    // The last line of a text may lack its line break.
    let slack = usize::from(encoding == Encoding::Ascii);
    let most = match element.name.as_str() {
        "vertex" => MAX_VERTICES,
        "face" => MAX_TRIANGLES,
        _ => usize::MAX,
    };
    check_count(&element.name, element.count, least, remaining + slack, most)
}

/// The least bytes of a property; a face has three corners or more, other lists may be empty.
fn least_size(element: &ElementDef, property: &ply::PropertyDef, encoding: Encoding) -> usize {
    let is_index_list = element.name == "face" && property.name.starts_with("vertex_ind");
    let entries = if is_index_list { 3 } else { 0 };
    match (encoding, &property.data_type) {
        // A digit and what parts it from the next.
        (Encoding::Ascii, PropertyType::Scalar(_)) => 2,
        (Encoding::Ascii, PropertyType::List(..)) => 2 + 2 * entries,
        (_, PropertyType::Scalar(scalar)) => size(scalar),
        (_, PropertyType::List(count, entry)) => size(count) + entries * size(entry),
    }
}
