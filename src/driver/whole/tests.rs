//! Every length of every format, cut and preallocated.

use std::io::Write;

use super::*;

/// A tetrahedron.
const CORNERS: [[f32; 3]; 4] = [[-1.0, -1.0, -1.0], [1.0, -1.0, -1.0], [0.0, 1.0, -1.0], [0.0, 0.0, 1.0]];
const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

/// Binary PLY; the faces' labels after their indices, if any.
fn ply(labels: &[u8], vertices_last: bool) -> Vec<u8> {
    let vertex = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
    let declared = ["property uchar label_front\n", "property uchar label_back\n"];
    let face = format!(
        "element face 4\nproperty list uchar int vertex_indices\n{}",
        declared[..labels.len()].concat()
    );
    let elements = if vertices_last { [&face, vertex] } else { [vertex, &face] };
    let mut bytes =
        format!("ply\nformat binary_little_endian 1.0\n{}end_header\n", elements.concat()).into_bytes();
    let vertices = CORNERS.as_flattened().iter().flat_map(|c| c.to_le_bytes());
    let faces = FACES.iter().flat_map(|face| {
        let indices = face.iter().flat_map(|index| index.to_le_bytes());
        [3].into_iter().chain(indices).chain(labels.iter().copied()).collect::<Vec<u8>>()
    });
    if vertices_last {
        bytes.extend(faces);
        bytes.extend(vertices);
    } else {
        bytes.extend(vertices);
        bytes.extend(faces);
    }
    bytes
}

fn ascii() -> Vec<u8> {
    let mut text =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                    element face 4\nproperty list uchar int vertex_indices\nend_header\n"
            .to_owned();
    for [x, y, z] in CORNERS {
        text += &format!("{x} {y} {z}\n");
    }
    for [a, b, c] in FACES {
        text += &format!("3 {a} {b} {c}\n");
    }
    text.into_bytes()
}

fn obj() -> Vec<u8> {
    let mut text = String::new();
    for [x, y, z] in CORNERS {
        text += &format!("v {x} {y} {z}\n");
    }
    for face in FACES {
        let [a, b, c] = face.map(|index| index + 1);
        text += &format!("f {a} {b} {c}\n");
    }
    text.into_bytes()
}

/// Two tetrahedra.
const DSC: &[u8] = b"v -1 -1 -1\nv 1 -1 -1\nv 0 1 -1\nv 0 0 1\nv 0 0 -3\nt 0 1 2 3 1\nt 0 1 2 4 2\n";

/// Legacy VTK with labels, as text or binary.
fn vtk(binary: bool) -> Vec<u8> {
    let mut bytes = format!("# vtk DataFile Version 3.0\nice\n{}\n", if binary { "BINARY" } else { "ASCII" });
    bytes += "DATASET POLYDATA\nPOINTS 4 float\n";
    let mut bytes = bytes.into_bytes();
    let mut add = |head: &str, words: Vec<String>, numbers: Vec<u8>| {
        bytes.extend(head.as_bytes());
        bytes.extend(if binary { numbers } else { words.join(" ").into_bytes() });
        bytes.push(b'\n');
    };
    let corners = CORNERS.as_flattened();
    add(
        "",
        corners.iter().map(f32::to_string).collect(),
        corners.iter().flat_map(|c| c.to_be_bytes()).collect(),
    );
    let polygons: Vec<u32> = FACES.iter().flat_map(|&[a, b, c]| [3, a, b, c]).collect();
    let whole = |list: &[u32]| {
        (list.iter().map(u32::to_string).collect(), list.iter().flat_map(|n| n.to_be_bytes()).collect())
    };
    let (words, numbers) = whole(&polygons);
    add("POLYGONS 4 16\n", words, numbers);
    for (section, name, label) in [("CELL_DATA 4\n", "label_front", 2), ("", "label_back", 1)] {
        let (words, numbers) = whole(&[label; 4]);
        add(&format!("{section}SCALARS {name} int 1\nLOOKUP_TABLE default\n"), words, numbers);
    }
    bytes
}

/// VTK's XML as text.
fn vtp() -> Vec<u8> {
    let array = |kind: &str, name: &str, words: &[String]| {
        let words = words.join(" ");
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"1\" format=\"ascii\">{words}</DataArray>\n"
        )
    };
    let corners: Vec<String> = CORNERS.as_flattened().iter().map(f32::to_string).collect();
    let faces: Vec<String> = FACES.as_flattened().iter().map(u32::to_string).collect();
    let offsets: Vec<String> = (1..=4).map(|k| (3 * k).to_string()).collect();
    let labels = |label: &str| vec![label.to_owned(); 4];
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\">\n<PolyData>\n\
         <Piece NumberOfPoints=\"4\" NumberOfPolys=\"4\">\n<CellData>\n{}{}</CellData>\n<Points>\n{}</Points>\n\
         <Polys>\n{}{}</Polys>\n</Piece>\n</PolyData>\n</VTKFile>",
        array("Int32", "label_front", &labels("2")),
        array("Int32", "label_back", &labels("1")),
        array("Float32", "Points", &corners).replace("Components=\"1\"", "Components=\"3\""),
        array("Int64", "connectivity", &faces),
        array("Int64", "offsets", &offsets),
    )
    .into_bytes()
}

/// The tetrahedron's faces as one solid after the other, two faces each.
fn stl_text() -> Vec<u8> {
    let mut text = String::new();
    for (solid, faces) in FACES.chunks(2).enumerate() {
        text += &format!("solid part{solid}\n");
        for face in faces {
            text += "facet normal 0 0 0\nouter loop\n";
            for [x, y, z] in face.map(|index| CORNERS[index as usize]) {
                text += &format!("vertex {x} {y} {z}\n");
            }
            text += "endloop\nendfacet\n";
        }
        text += &format!("endsolid part{solid}\n");
    }
    text.into_bytes()
}

fn stl() -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend(4u32.to_le_bytes());
    for face in FACES {
        bytes.extend([0; 12]);
        let corners = face.map(|index| CORNERS[index as usize]);
        bytes.extend(corners.as_flattened().iter().flat_map(|c| c.to_le_bytes()));
        bytes.extend([0, 0]);
    }
    bytes
}

fn bobj() -> Vec<u8> {
    let mut bytes = 4u32.to_le_bytes().to_vec();
    bytes.extend(CORNERS.as_flattened().iter().flat_map(|c| c.to_le_bytes()));
    bytes.extend(4u32.to_le_bytes());
    bytes.extend(FACES.as_flattened().iter().flat_map(|index| index.to_le_bytes()));
    bytes
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

fn proof(bytes: &[u8], name: &str) -> Option<Proof> {
    let before = Traits { loose: Some(false), labels: Some(true), velocities: Some(false) };
    inspect(bytes, Path::new(name), &VelocityName::Nothing, before).ok().map(|inspected| inspected.proof)
}

/// All files, and how well the whole one proves that it is.
fn files() -> Vec<(&'static str, Vec<u8>, Proof)> {
    vec![
        ("labelled.ply", ply(&[0, 1], false), Proof::Proven),
        ("last_label_0.ply", ply(&[1, 0], false), Proof::Plausible),
        ("unlabelled.ply", ply(&[], false), Proof::Plausible),
        ("vertices_last.ply", ply(&[0, 1], true), Proof::Proven),
        ("ascii.ply", ascii(), Proof::Proven),
        ("surface.obj", obj(), Proof::Plausible),
        ("complex.dsc", DSC.to_vec(), Proof::Plausible),
        ("labelled.ply.gz", gzip(&ply(&[0, 1], false)), Proof::Proven),
        ("surface.obj.gz", gzip(&obj()), Proof::Proven),
        ("text.vtk", vtk(false), Proof::Plausible),
        ("binary.vtk", vtk(true), Proof::Plausible),
        ("surface.vtk.gz", gzip(&vtk(true)), Proof::Proven),
        ("text.vtp", vtp(), Proof::Proven),
        ("text.stl", stl_text(), Proof::Plausible),
        ("binary.stl", stl(), Proof::Plausible),
        ("surface.bobj", bobj(), Proof::Plausible),
    ]
}

#[test]
fn whole_files_are_known_as_such() {
    for (name, bytes, wanted) in files() {
        assert_eq!(proof(&bytes, name), Some(wanted), "{name}");
    }
}

/// No cut file is taken at once. A file that says how long it is cannot be read at all, but for one byte of text: a last
/// number without its line break. What does not say is doubtful wherever it is cut, but for the very last faces.
#[test]
fn no_length_but_the_whole_is_proven() {
    for (name, bytes, _) in files() {
        for length in 0..bytes.len() {
            let found = proof(&bytes[..length], name);
            match name {
                "surface.obj" | "complex.dsc" => {
                    assert!(
                        found.is_none_or(|proof| proof == Proof::Doubtful),
                        "{name} cut at {length}: {found:?}"
                    );
                }
                // Without labels doubtful; else it is the last line break or digits before it.
                "text.vtk" | "binary.vtk" => assert!(found != Some(Proof::Proven), "{name} cut at {length}"),
                // The first of two solids is a whole file.
                "text.stl" => assert!(found != Some(Proof::Proven), "{name} cut at {length}"),
                "ascii.ply" if length + 1 == bytes.len() => assert_eq!(found, Some(Proof::Plausible)),
                _ => assert_eq!(found, None, "{name} cut at {length}"),
            }
        }
    }
}

/// The same with zeros instead of what is missing. Only within the last record can they be mistaken for data.
#[test]
fn no_zeros_are_taken_for_data() {
    for (name, bytes, _) in files() {
        for length in 0..bytes.len() {
            let mut allocated = bytes[..length].to_vec();
            allocated.resize(bytes.len(), 0);
            if allocated == bytes {
                continue;
            }
            let found = proof(&allocated, name);
            let record = if name == "binary.stl" { 50 } else { 15 };
            let within_last = bytes.len() - length < record;
            assert!(
                found.is_none_or(|p| p == Proof::Doubtful || (within_last && p == Proof::Plausible)),
                "{name} written up to {length}: {found:?}"
            );
        }
    }
}

#[test]
fn an_open_surface_is_doubted_when_the_one_before_was_closed() {
    let open = &obj()[..obj().len() - "f 3 1 4\n".len()];
    let inspect = |loose| {
        let before = Traits { loose, ..Traits::default() };
        inspect(open, Path::new("a.obj"), &VelocityName::Nothing, before).unwrap()
    };
    let after_closed = inspect(Some(false));
    assert_eq!((after_closed.proof, after_closed.traits.loose), (Proof::Doubtful, Some(true)));
    assert!(after_closed.doubt.unwrap().contains("unlike the frame before"));
    let after_open = inspect(Some(true));
    assert_eq!((after_open.proof, after_open.doubt), (Proof::Plausible, None));
    // Of the first frame nothing is known: it waits, but there is nothing to warn of.
    let first = inspect(None);
    assert_eq!((first.proof, first.doubt), (Proof::Doubtful, None));
}

/// Cut between its sections a VTK file is a whole one with less in it.
#[test]
fn what_the_frame_before_had_is_missed() {
    let labelled = vtk(false);
    let cut = labelled.windows(9).position(|words| words == b"CELL_DATA").unwrap();
    let inspect = |bytes: &[u8], velocity: &VelocityName, before| {
        inspect(bytes, Path::new("a.vtk"), velocity, before).unwrap()
    };
    let without = |before: Option<bool>| {
        let before = Traits { labels: before, ..Traits::default() };
        let found = inspect(&labelled[..cut], &VelocityName::Nothing, before);
        (found.proof, found.doubt)
    };
    assert_eq!(without(None), (Proof::Doubtful, None));
    assert_eq!(without(Some(false)), (Proof::Plausible, None));
    assert_eq!(
        without(Some(true)),
        (Proof::Doubtful, Some("it has no labels, unlike the frame before".into()))
    );
    let with = inspect(&labelled, &VelocityName::Nothing, Traits::default());
    assert_eq!(
        (with.proof, with.traits.labels, with.traits.velocities),
        (Proof::Plausible, Some(true), None)
    );
    // Velocities are missed by those who ask for them.
    let asked = |velocities| {
        inspect(&labelled, &VelocityName::Known, Traits { velocities, ..Traits::default() }).proof
    };
    assert_eq!(
        [None, Some(false), Some(true)].map(asked),
        [Proof::Doubtful, Proof::Plausible, Proof::Doubtful]
    );
}

/// Elements behind the faces that are all zeros may be data, and may be unwritten.
#[test]
fn many_zeros_behind_the_faces_are_doubtful() {
    let head = String::from_utf8_lossy(&ply(&[0, 1], false)).split("end_header").next().unwrap().to_owned();
    let body = ply(&[0, 1], false)[head.len()..].to_vec();
    let mut bytes = format!("{head}element cell 20\nproperty float pressure\n").into_bytes();
    bytes.extend(body);
    bytes.extend([0; 80]);
    let inspected = inspect(&bytes, Path::new("a.ply"), &VelocityName::Nothing, Traits::default()).unwrap();
    assert_eq!(inspected.proof, Proof::Doubtful);
    assert_eq!(inspected.doubt.unwrap(), "80 zeros at its end");
}
