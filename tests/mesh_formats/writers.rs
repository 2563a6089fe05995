//! Writers of STL, binary OBJ and PLY, laid out as simulators and their tools write them.

use std::fmt::Write;

use crate::sample::Sample;

/// The corners of the triangles, and their normals.
fn triangles(sample: &Sample) -> Vec<[[f32; 3]; 3]> {
    let mesh = sample.mesh();
    mesh.triangles.iter().map(|t| t.map(|index| sample.positions[index as usize])).collect()
}

fn le(numbers: &[[f32; 3]]) -> Vec<u8> {
    numbers.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// Binary STL with a header that begins with some text.
pub fn stl_binary(sample: &Sample, header: &str) -> Vec<u8> {
    let triangles = triangles(sample);
    let mut file = header.as_bytes().to_vec();
    file.resize(80, 0);
    file.extend((triangles.len() as u32).to_le_bytes());
    for corners in triangles {
        file.extend([0; 12]);
        file.extend(le(&corners));
        file.extend([0; 2]);
    }
    file
}

/// STL as text.
pub fn stl_text(sample: &Sample) -> Vec<u8> {
    let mut text = "solid a name\n".to_owned();
    for corners in triangles(sample) {
        text += "facet normal 0 0 0\n  outer loop\n";
        for [x, y, z] in corners {
            let _ = writeln!(text, "    vertex {x:e} {y:e} {z:e}");
        }
        text += "  endloop\nendfacet\n";
    }
    (text + "endsolid a name\n").into_bytes()
}

/// Binary OBJ of Mantaflow, with normals, or of FLIP Fluids.
pub fn bobj(sample: &Sample, normals: Option<&[[f32; 3]]>) -> Vec<u8> {
    let count = |n: usize| (n as i32).to_le_bytes();
    let triangles = sample.mesh().triangles;
    let mut file = [&count(sample.positions.len())[..], &le(&sample.positions)].concat();
    if let Some(normals) = normals {
        file.extend([&count(normals.len())[..], &le(normals)].concat());
    }
    file.extend(count(triangles.len()));
    file.extend(triangles.as_flattened().iter().flat_map(|index| index.to_le_bytes()));
    file
}

/// Velocities as FLIP Fluids writes them.
pub fn bobj_velocities(sample: &Sample) -> Vec<u8> {
    let positions = sample.velocities.clone().unwrap_or_default();
    bobj(&Sample { positions, faces: Vec::new(), velocities: None, labels: None }, None)
}

/// The twin that every other file is compared with.
pub fn ply(sample: &Sample) -> Vec<u8> {
    let mut header = "ply\nformat binary_little_endian 1.0\n".to_owned();
    let _ = writeln!(header, "element vertex {}", sample.positions.len());
    header += "property float x\nproperty float y\nproperty float z\n";
    if sample.velocities.is_some() {
        header += "property float vx\nproperty float vy\nproperty float vz\n";
    }
    let _ = write!(header, "element face {}\nproperty list uchar int vertex_indices\n", sample.faces.len());
    if sample.labels.is_some() {
        header += "property int label_front\nproperty int label_back\n";
    }
    let mut file = (header + "end_header\n").into_bytes();
    for (index, position) in sample.positions.iter().enumerate() {
        file.extend(le(&[*position]));
        file.extend(sample.velocities.iter().flat_map(|velocities| le(&[velocities[index]])));
    }
    for (index, face) in sample.faces.iter().enumerate() {
        file.push(face.len() as u8);
        file.extend(face.iter().flat_map(|index| index.to_le_bytes()));
        file.extend(sample.labels.iter().flat_map(|labels| labels[index]).flat_map(i32::to_le_bytes));
    }
    file
}
