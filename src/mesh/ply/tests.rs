use glam::{DVec3, Vec3};
use proptest::prelude::*;

use super::*;
use crate::mesh::{Interface, Region};

fn read(bytes: &[u8]) -> Result<RawMesh, Fault> {
    super::read(bytes, &VelocityName::Known)
}

/// The number types in both spellings, each with a number that the narrower ones cannot hold.
const TYPES: [(&str, &str, f64); 8] = [
    ("char", "int8", 127.0),
    ("uchar", "uint8", 255.0),
    ("short", "int16", 32767.0),
    ("ushort", "uint16", 65535.0),
    ("int", "int32", 2147483647.0),
    ("uint", "uint32", 4294967295.0),
    ("float", "float32", 0.1),
    ("double", "float64", 0.1),
];

/// A number as bytes of a type, the least byte first.
fn bytes_of(type_name: &str, value: f64) -> Vec<u8> {
    match type_name {
        "char" => (value as i8).to_le_bytes().to_vec(),
        "uchar" => (value as u8).to_le_bytes().to_vec(),
        "short" => (value as i16).to_le_bytes().to_vec(),
        "ushort" => (value as u16).to_le_bytes().to_vec(),
        "int" => (value as i32).to_le_bytes().to_vec(),
        "uint" => (value as u32).to_le_bytes().to_vec(),
        "float" => (value as f32).to_le_bytes().to_vec(),
        _ => value.to_le_bytes().to_vec(),
    }
}

#[test]
fn every_number_type_is_read_in_both_spellings_and_all_encodings() {
    for (short, long, greatest) in TYPES {
        let expected = if short == "float" { f64::from(0.1_f32) } else { greatest };
        for spelling in [short, long] {
            let vertex = format!(
                "element vertex 1\nproperty {spelling} x\nproperty {spelling} y\nproperty {spelling} z\nend_header\n"
            );
            let text = format!("ply\nformat ascii 1.0\n{vertex}{greatest} 0 1\n");
            let mut little = format!("ply\nformat binary_little_endian 1.0\n{vertex}").into_bytes();
            let mut big = format!("ply\nformat binary_big_endian 1.0\n{vertex}").into_bytes();
            for value in [greatest, 0.0, 1.0] {
                let bytes = bytes_of(short, value);
                little.extend(&bytes);
                big.extend(bytes.iter().rev());
            }
            for file in [text.as_bytes(), &little, &big] {
                let mesh = read(file).unwrap();
                assert_eq!(mesh.positions, [DVec3::new(expected, 0.0, 1.0)], "{spelling}");
            }
        }
    }
}

#[test]
fn lists_and_labels_of_every_integer_type_are_read() {
    for (count, _, _) in &TYPES[..6] {
        for (index, _, _) in &TYPES[..6] {
            let header = format!(
                "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
                 property float z\nelement face 1\nproperty {index} label_front\nproperty list {count} {index} vertex_indices\n\
                 property {count} label_back\nend_header\n"
            );
            let mut file = header.into_bytes();
            file.extend([0; 36]);
            file.extend(bytes_of(index, 100.0));
            file.extend(bytes_of(count, 3.0));
            file.extend([2.0, 1.0, 0.0].map(|value| bytes_of(index, value)).concat());
            file.extend(bytes_of(count, 127.0));
            let mesh = read(&file).unwrap();
            assert_eq!(mesh.triangles, [[2, 1, 0]], "{count} {index}");
            let interface = Interface { front: Region(100), back: Region(127) };
            assert_eq!(mesh.interfaces, Some(vec![interface]), "{count} {index}");
        }
    }
}

#[test]
fn signed_labels_keep_their_sign() {
    let file = "ply\nformat ascii 1.0\nelement vertex 3\nproperty int x\nproperty int y\nproperty int z\n\
                element face 1\nproperty list uchar int vertex_index\nproperty char label_front\n\
                property int label_back\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 -1 -2147483648\n";
    let interface = Interface { front: Region(-1), back: Region(i32::MIN) };
    assert_eq!(read(file.as_bytes()).unwrap().interfaces, Some(vec![interface]));
}

#[test]
fn polygons_become_fans() {
    let file = "ply\nformat ascii 1.0\nelement vertex 5\nproperty int x\nproperty int y\nproperty int z\n\
                element face 2\nproperty list uchar int vertex_index\nproperty uchar label_front\n\
                property uchar label_back\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 2 0\n5 0 1 2 4 3 1 2\n3 0 2 1 3 4\n";
    let mesh = read(file.as_bytes()).unwrap();
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 4], [0, 4, 3], [0, 2, 1]]);
    let fronts: Vec<_> = mesh.interfaces.unwrap().iter().map(|interface| interface.front.0).collect();
    assert_eq!(fronts, [1, 1, 1, 3]);
}

#[test]
fn normals_may_be_anything_even_in_text() {
    let file = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n\
                property float nx\nproperty float ny\nproperty float nz\nend_header\n.5 -1. 1 nan -inf 1.\n0 0 0 0 0 1\n";
    let mesh = read(file.as_bytes()).unwrap();
    assert_eq!(mesh.positions[0], DVec3::new(0.5, -1.0, 1.0));
    let values = mesh.normals.unwrap().values;
    assert!(!values[0].x.is_finite() && !values[0].y.is_finite());
    assert_eq!(values[1], Vec3::Z);
}

#[test]
fn velocities_are_read_where_they_are_wanted() {
    let file = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float vy\nproperty float x\nproperty float y\n\
                property float z\nproperty short VX\nproperty double vz\nend_header\n2 .5 -1. 1 1 nan\n0 0 0 0 0 7\n";
    let velocities = read(file.as_bytes()).unwrap().velocities.unwrap();
    assert_eq!((velocities[0].x, velocities[0].y, velocities[1]), (1.0, 2.0, Vec3::Z * 7.0));
    assert!(!velocities[0].z.is_finite());
    let none = super::read(file.as_bytes(), &VelocityName::Nothing).unwrap();
    assert_eq!((none.positions[0], none.velocities), (DVec3::new(0.5, -1.0, 1.0), None));
}

/// A file of the layout that the direct reader takes.
#[derive(Clone, Debug)]
struct Sample {
    double: bool,
    normals: bool,
    label_type: Option<&'static str>,
    index_type: &'static str,
    vertices: Vec<[f32; 3]>,
    faces: Vec<([u32; 3], u8)>,
}

impl Sample {
    fn bytes(&self) -> Vec<u8> {
        let coordinate = if self.double { "double" } else { "float" };
        let mut header =
            format!("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", self.vertices.len());
        for axis in ["x", "y", "z"] {
            header += &format!("property {coordinate} {axis}\n");
        }
        if self.normals {
            header += "property short age\nproperty float nx\nproperty float ny\nproperty float nz\n";
            header += "property double vx\nproperty double vy\nproperty double vz\n";
        }
        header += &format!("element extra 2\nproperty double a\nelement face {}\n", self.faces.len());
        header += &format!("property uchar flags\nproperty list uchar {} vertex_index\n", self.index_type);
        if let Some(label) = self.label_type {
            header +=
                &format!("property {label} label_front\nproperty float area\nproperty {label} label_back\n");
        }
        let mut bytes = (header + "end_header\n").into_bytes();
        for vertex in &self.vertices {
            bytes.extend(vertex.map(|value| bytes_of(coordinate, f64::from(value))).concat());
            if self.normals {
                bytes.extend([7, 0]);
                bytes.extend(vertex.map(|value| bytes_of("float", f64::from(value))).concat());
                bytes.extend(vertex.map(|value| bytes_of("double", f64::from(-value))).concat());
            }
        }
        bytes.extend([1; 16]);
        for (triangle, label) in &self.faces {
            bytes.extend([9, 3]);
            bytes.extend(triangle.map(u32::to_le_bytes).concat());
            if let Some(name) = self.label_type {
                bytes.extend(bytes_of(name, f64::from(*label)));
                bytes.extend([0, 0, 128, 63]);
                bytes.extend(bytes_of(name, 0.0));
            }
        }
        bytes
    }
}

fn samples() -> impl Strategy<Value = Sample> {
    let labels =
        prop::option::of(prop::sample::select(vec!["char", "uchar", "short", "ushort", "int", "uint"]));
    let faces = prop::collection::vec((prop::array::uniform3(0..6_u32), 0..127_u8), 0..9);
    (
        any::<bool>(),
        any::<bool>(),
        labels,
        prop::sample::select(vec!["int", "uint"]),
        prop::collection::vec(prop::array::uniform3(-1e6..1e6_f32), 6..9),
        faces,
    )
        .prop_map(|(double, normals, label_type, index_type, vertices, faces)| Sample {
            double,
            normals,
            label_type,
            index_type,
            vertices,
            faces,
        })
}

proptest! {
    #[test]
    fn the_direct_reader_gives_what_the_general_one_gives(sample in samples()) {
        let bytes = sample.bytes();
        let header = header::read(&bytes, &VelocityName::Known).unwrap();
        let payload = &bytes[header.length..];
        let direct = direct::read(&header, payload);
        prop_assert!(direct.is_some());
        prop_assert_eq!(direct, Some(general::read(&header, payload).unwrap()));
    }

    #[test]
    fn the_direct_reader_takes_nothing_that_the_general_one_refuses(
        sample in samples(),
        at in 0.0..1.0,
        value in any::<u8>(),
        cut in 0..40_usize,
    ) {
        let mut bytes = sample.bytes();
        let flipped = (at * bytes.len() as f64) as usize;
        bytes[flipped] = value;
        bytes.truncate(bytes.len() - cut.saturating_sub(20));
        let Ok(header) = header::read(&bytes, &VelocityName::Known) else { return Ok(()) };
        let payload = &bytes[header.length..];
        if let Some(direct) = direct::read(&header, payload) {
            let general = general::read(&header, payload).unwrap();
            // Normals may be NaN, which equals nothing.
            prop_assert_eq!(direct.positions, general.positions);
            prop_assert_eq!(direct.triangles, general.triangles);
            prop_assert_eq!(direct.interfaces, general.interfaces);
        }
    }
}
