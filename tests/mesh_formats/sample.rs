//! Small surfaces that every writer can write.

use floe::mesh::{Interface, RawMesh, Region};
use glam::{DVec3, Vec3};

/// Polygons, with what simulators say of their vertices.
#[derive(Clone, Debug)]
pub struct Sample {
    pub positions: Vec<[f32; 3]>,
    pub faces: Vec<Vec<u32>>,
    /// One a vertex.
    pub velocities: Option<Vec<[f32; 3]>>,
    /// Front and back of each face.
    pub labels: Option<Vec<[i32; 2]>>,
}

impl Sample {
    /// The unit cube of six quads, as the other examples of the repository hold it.
    pub fn cube() -> Self {
        let corner = |i: u32| [0, 1, 2].map(|axis| (i >> axis & 1) as f32);
        let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        Self {
            positions: (0..8).map(corner).collect(),
            faces: faces.map(Vec::from).to_vec(),
            velocities: None,
            labels: None,
        }
    }

    /// A closed surface without symmetry, of 32 triangles with velocities.
    pub fn blob() -> Self {
        let mut positions = vec![Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z];
        let mut faces = Vec::new();
        let mut middles: Vec<[u32; 2]> = Vec::new();
        for [a, b, c] in
            [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5_u32]]
        {
            let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[p, q]| {
                let edge = [p.min(q), p.max(q)];
                let at = middles.iter().position(|known| *known == edge).unwrap_or_else(|| {
                    middles.push(edge);
                    positions.push((positions[p as usize] + positions[q as usize]).normalize());
                    middles.len() - 1
                });
                6 + at as u32
            });
            faces.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]].map(Vec::from));
        }
        let bent = |p: Vec3| p * (1.0 + 0.2 * (3.0 * p.x + p.y).sin()) + Vec3::new(0.3, -7.1, 0.01);
        let velocities = positions.iter().map(|p| [p.y, 0.1 - p.z, 3.0 * p.x]).collect();
        Self {
            positions: positions.iter().map(|&p| bent(p).to_array()).collect(),
            faces,
            velocities: Some(velocities),
            labels: None,
        }
    }

    /// The same with labels that differ from face to face.
    pub fn labelled(self) -> Self {
        let labels = (0..self.faces.len() as i32).map(|face| [face % 3 - 1, 3 + face % 2]).collect();
        Self { labels: Some(labels), ..self }
    }

    /// What a reader ought to make of it.
    pub fn mesh(&self) -> RawMesh {
        let mut mesh = RawMesh {
            positions: self.positions.iter().map(|&p| Vec3::from_array(p).as_dvec3()).collect(),
            velocities: self.velocities.as_ref().map(|v| v.iter().copied().map(Vec3::from_array).collect()),
            interfaces: self.labels.as_ref().map(|_| Vec::new()),
            ..RawMesh::default()
        };
        for (index, face) in self.faces.iter().enumerate() {
            for k in 2..face.len() {
                mesh.triangles.push([face[0], face[k - 1], face[k]]);
                if let (Some(interfaces), Some(labels)) = (&mut mesh.interfaces, &self.labels) {
                    let [front, back] = labels[index].map(Region);
                    interfaces.push(Interface { front, back });
                }
            }
        }
        mesh
    }
}

/// The area, the volume and the bounds of a mesh.
pub fn measures(mesh: &RawMesh) -> [f64; 8] {
    let corners = |t: &[u32; 3]| t.map(|index| mesh.positions[index as usize]);
    let (mut area, mut volume) = (0.0, 0.0);
    let mut bounds = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for [a, b, c] in mesh.triangles.iter().map(corners) {
        area += 0.5 * (b - a).cross(c - a).length();
        volume += a.dot(b.cross(c)) / 6.0;
        bounds = (bounds.0.min(a).min(b).min(c), bounds.1.max(a).max(b).max(c));
    }
    let (min, max) = bounds;
    [area, volume, min.x, min.y, min.z, max.x, max.y, max.z]
}
