//! Small meshes, and their text as PLY, which keeps every digit.

use std::collections::BTreeMap;
use std::fmt::Write;

use glam::DVec3;

/// Triangles whose right-hand normals point to the front.
#[derive(Clone, Debug, Default)]
pub struct Shape {
    /// Vertices.
    pub positions: Vec<DVec3>,
    /// Three vertices each, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
}

/// Two triangles. The normal points along `edge1` x `edge2`.
pub fn parallelogram(corner: DVec3, edge1: DVec3, edge2: DVec3) -> Shape {
    Shape {
        positions: vec![corner, corner + edge1, corner + edge1 + edge2, corner + edge2],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

/// A closed box, normals outwards, with shared vertices.
pub fn cuboid(min: DVec3, max: DVec3) -> Shape {
    let pick = |i: u32, axis: usize| if i >> axis & 1 == 0 { min[axis] } else { max[axis] };
    let positions = (0..8).map(|i| DVec3::new(pick(i, 0), pick(i, 1), pick(i, 2))).collect();
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Shape { positions, triangles }
}

/// An octahedron subdivided `levels` times, vertices on the sphere, normals outwards.
pub fn sphere(centre: DVec3, radius: f64, levels: u32) -> Shape {
    let mut positions = vec![DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z];
    let mut triangles: Vec<[u32; 3]> =
        vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    for _ in 0..levels {
        let mut midpoints = BTreeMap::new();
        let mut middle = |a: u32, b: u32| {
            *midpoints.entry((a.min(b), a.max(b))).or_insert_with(|| {
                positions.push((positions[a as usize] + positions[b as usize]).normalize());
                positions.len() as u32 - 1
            })
        };
        let mut finer = Vec::new();
        for [a, b, c] in triangles {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    for p in &mut positions {
        *p = centre + *p * radius;
    }
    Shape { positions, triangles }
}

impl Shape {
    /// The same surface seen from the other side.
    #[must_use]
    pub fn turned(mut self) -> Self {
        for t in &mut self.triangles {
            t.swap(1, 2);
        }
        self
    }

    /// The text of an ASCII PLY file.
    pub fn ply(&self) -> String {
        let mut text = format!(
            "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n\
             element face {}\nproperty list uchar int vertex_indices\nend_header\n",
            self.positions.len(),
            self.triangles.len()
        );
        for p in &self.positions {
            let _ = writeln!(text, "{} {} {}", p.x, p.y, p.z);
        }
        for [a, b, c] in &self.triangles {
            let _ = writeln!(text, "3 {a} {b} {c}");
        }
        text
    }
}
