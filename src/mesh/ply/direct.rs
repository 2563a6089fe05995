//! Reads the PLY layout that nearly every simulator writes straight from its bytes.
//!
//! Binary with the least byte first; vertices whose properties are all single numbers, coordinates, normals and
//! velocities among them `float` or `double`; faces whose only list has a one-byte count that is 3 everywhere and four-byte
//! indices. Then every element has the same size. Anything else is left to the general reader.

use glam::{DVec3, Vec3};
use ply_rs::ply::{ElementDef, Encoding, PropertyType, ScalarType};

use super::header::{Header, VELOCITY, check_length, index_list, size};
use crate::mesh::{CornerNormals, Interface, RawMesh, Region};

/// Reads everything behind the header; `None` when anything is unusual, errors included.
pub(super) fn read(header: &Header, payload: &[u8]) -> Option<RawMesh> {
    if header.declared.encoding != Encoding::BinaryLittleEndian {
        return None;
    }
    let mut mesh = RawMesh::default();
    let mut rest = payload;
    for element in header.declared.elements.values() {
        check_length(element, Encoding::BinaryLittleEndian, rest.len()).ok()?;
        let record = Record::of(element)?;
        let (records, after) = rest.split_at_checked(element.count.checked_mul(record.stride)?)?;
        match element.name.as_str() {
            // A stride of 0 has no records, and no coordinates either.
            "vertex" if record.stride > 0 => read_vertices(records, &record, header, &mut mesh)?,
            "face" if record.stride > 0 => read_faces(records, &record, header, &mut mesh)?,
            _ => {}
        }
        rest = after;
    }
    Some(mesh)
}

/// Where the properties of an element lie in its bytes.
struct Record<'a> {
    stride: usize,
    properties: Vec<(&'a str, usize, &'a ScalarType)>,
    /// The count of the only list, and behind it three indices.
    list: Option<usize>,
}

impl<'a> Record<'a> {
    fn of(element: &'a ElementDef) -> Option<Self> {
        let mut record = Self { stride: 0, properties: Vec::new(), list: None };
        for (name, property) in &element.properties {
            match &property.data_type {
                PropertyType::Scalar(scalar) => {
                    record.properties.push((name, record.stride, scalar));
                    record.stride += size(scalar);
                }
                PropertyType::List(ScalarType::UChar, ScalarType::Int | ScalarType::UInt)
                    if element.name == "face"
                        && record.list.is_none()
                        && index_list(element).is_ok_and(|name| name == property.name) =>
                {
                    record.list = Some(record.stride);
                    record.stride += 1 + 3 * 4;
                }
                PropertyType::List(..) => return None,
            }
        }
        Some(record)
    }

    fn find(&self, name: &str) -> Option<(usize, &ScalarType)> {
        self.properties.iter().find(|property| property.0 == name).map(|&(_, at, scalar)| (at, scalar))
    }

    /// Three properties that are all `float` or all `double`: where, and whether they are double.
    fn triple(&self, names: [&str; 3]) -> Option<([usize; 3], bool)> {
        let [x, y, z] = names.map(|name| self.find(name));
        let (x, y, z) = (x?, y?, z?);
        match [x.1, y.1, z.1] {
            [ScalarType::Float, ScalarType::Float, ScalarType::Float] => Some(([x.0, y.0, z.0], false)),
            [ScalarType::Double, ScalarType::Double, ScalarType::Double] => Some(([x.0, y.0, z.0], true)),
            _ => None,
        }
    }
}

fn read_vertices(bytes: &[u8], record: &Record, header: &Header, mesh: &mut RawMesh) -> Option<()> {
    let records = || bytes.chunks_exact(record.stride);
    let (at, double) = record.triple(["x", "y", "z"])?;
    mesh.positions = if double {
        records().map(|bytes| DVec3::from_array(at.map(|at| f64_at(bytes, at)))).collect()
    } else {
        records().map(|bytes| DVec3::from_array(at.map(|at| f64::from(f32_at(bytes, at))))).collect()
    };
    if !mesh.positions.iter().all(|position| position.is_finite()) {
        return None;
    }
    let vectors = |names| {
        let (at, double) = record.triple(names)?;
        Some(if double {
            records().map(|bytes| Vec3::from_array(at.map(|at| f64_at(bytes, at) as f32))).collect()
        } else {
            records().map(|bytes| Vec3::from_array(at.map(|at| f32_at(bytes, at)))).collect()
        })
    };
    if header.normals {
        mesh.normals = Some(CornerNormals { values: vectors(["nx", "ny", "nz"])?, corners: None });
    }
    if header.velocities {
        mesh.velocities = Some(vectors(VELOCITY)?);
    }
    Some(())
}

fn read_faces(bytes: &[u8], record: &Record, header: &Header, mesh: &mut RawMesh) -> Option<()> {
    let records = || bytes.chunks_exact(record.stride);
    let list = record.list?;
    // A negative index read without its sign is at least 2^31, and so out of range.
    let vertices = u32::try_from(header.vertices()).ok().filter(|&n| n <= 1 << 31)?;
    mesh.triangles.reserve_exact(bytes.len() / record.stride);
    for bytes in records() {
        let triangle = [1, 5, 9].map(|k| u32_at(bytes, list + k));
        if bytes[list] != 3 || triangle.iter().any(|&index| index >= vertices) {
            return None;
        }
        mesh.triangles.push(triangle);
    }
    if header.labelled {
        let (front, back) = (record.find("label_front")?, record.find("label_back")?);
        let interface =
            |bytes: &[u8]| Some(Interface { front: region_at(bytes, front)?, back: region_at(bytes, back)? });
        let mut interfaces = Vec::with_capacity(mesh.triangles.len());
        for bytes in records() {
            interfaces.push(interface(bytes)?);
        }
        mesh.interfaces = Some(interfaces);
    }
    Some(())
}

fn region_at(bytes: &[u8], (at, scalar): (usize, &ScalarType)) -> Option<Region> {
    let label = match scalar {
        ScalarType::Char => i32::from(i8::from_le_bytes([bytes[at]])),
        ScalarType::UChar => i32::from(bytes[at]),
        ScalarType::Short => i32::from(i16::from_le_bytes([bytes[at], bytes[at + 1]])),
        ScalarType::UShort => i32::from(u16::from_le_bytes([bytes[at], bytes[at + 1]])),
        ScalarType::Int => u32_at(bytes, at).cast_signed(),
        ScalarType::UInt => i32::try_from(u32_at(bytes, at)).ok()?,
        ScalarType::Float | ScalarType::Double => return None,
    };
    Some(Region(label))
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(array_at(bytes, at))
}

fn f32_at(bytes: &[u8], at: usize) -> f32 {
    f32::from_le_bytes(array_at(bytes, at))
}

fn f64_at(bytes: &[u8], at: usize) -> f64 {
    f64::from_le_bytes(array_at(bytes, at))
}

fn array_at<const N: usize>(bytes: &[u8], at: usize) -> [u8; N] {
    let mut array = [0; N];
    array.copy_from_slice(&bytes[at..at + N]);
    array
}
