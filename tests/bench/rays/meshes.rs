//! The meshes that are traced: a sheet of waves in two resolutions and a rough closed blob.

use std::collections::HashMap;

use glam::Vec3;

use super::random::Random;

/// Triangles and where to look at them from.
pub struct Mesh {
    /// What `--meshes` calls it.
    pub name: &'static str,
    /// Vertices.
    pub positions: Vec<Vec3>,
    /// Index triples.
    pub triangles: Vec<[u32; 3]>,
    /// The camera, which looks at the origin.
    pub eye: Vec3,
    /// Half the size of the mesh, roughly.
    pub extent: f32,
}

/// The names of all meshes.
pub const NAMES: [&str; 3] = ["20k", "200k", "2m"];

/// The mesh of one of [`NAMES`].
pub fn by_name(name: &str) -> Option<Mesh> {
    match name {
        "20k" => Some(waves(NAMES[0], 100)),
        "200k" => Some(waves(NAMES[1], 316)),
        "2m" => Some(blob(NAMES[2], 9)),
        _ => None,
    }
}

impl Mesh {
    /// The vertices a moment later: what a refit is given.
    pub fn moved(&self) -> Vec<Vec3> {
        let shift = |p: Vec3| Vec3::new((5.0 * p.y).sin(), (4.0 * p.z).sin(), (6.0 * p.x).sin());
        self.positions.iter().map(|&p| p + 0.01 * self.extent * shift(p)).collect()
    }
}

/// Two triangles in each of `cells` by `cells` jittered squares, z up.
fn waves(name: &'static str, cells: u32) -> Mesh {
    let mut random = Random(1);
    let width = 2.0 / cells as f32;
    let mut positions = Vec::new();
    for row in 0..=cells {
        for column in 0..=cells {
            let x = (column as f32 + 0.3 * random.signed()) * width - 1.0;
            let y = (row as f32 + 0.3 * random.signed()) * width - 1.0;
            positions.push(Vec3::new(x, y, wave_height(x, y)));
        }
    }
    let mut triangles = Vec::new();
    for row in 0..cells {
        for a in (0..cells).map(|column| row * (cells + 1) + column) {
            let (b, c, d) = (a + 1, a + cells + 2, a + cells + 1);
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Mesh { name, positions, triangles, eye: Vec3::new(0.0, -1.1, 1.2), extent: 1.0 }
}

/// Long waves that cross, and ripples down to a wavelength of six centimetres on a sheet of two metres.
fn wave_height(x: f32, y: f32) -> f32 {
    const WAVES: [(f32, f32, f32); 6] = [
        (3.1, 1.7, 0.09),
        (-2.3, 5.9, 0.05),
        (9.0, -7.0, 0.027),
        (21.0, 17.0, 0.012),
        (-43.0, 31.0, 0.006),
        (67.0, 83.0, 0.003),
    ];
    WAVES.iter().map(|(kx, ky, amplitude)| amplitude * (kx * x + ky * y).sin()).sum()
}

/// An octahedron divided `levels` times (8 * 4^levels triangles), blown up to a sphere with bumps in seven octaves.
fn blob(name: &'static str, levels: u32) -> Mesh {
    let mut positions = vec![Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z];
    let mut triangles =
        vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    for _ in 0..levels {
        triangles = divided(&mut positions, &triangles);
    }
    let mut random = Random(2);
    let octaves: Vec<(Vec3, f32)> = (0..7)
        .flat_map(|octave| [octave; 3])
        .map(|octave| (random.direction() * (3 << octave) as f32, 0.06 / (1 << octave) as f32))
        .collect();
    for p in &mut positions {
        let bumps: f32 = octaves.iter().map(|(k, amplitude)| amplitude * k.dot(*p).sin()).sum();
        *p *= 1.0 + bumps;
    }
    Mesh { name, positions, triangles, eye: Vec3::new(0.0, -2.2, 0.9), extent: 1.0 }
}

/// Four triangles for each, with midpoints on the unit sphere.
fn divided(positions: &mut Vec<Vec3>, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut midpoints = HashMap::with_capacity(triangles.len() * 3 / 2);
    let mut middle = |a: u32, b: u32| {
        *midpoints.entry((a.min(b), a.max(b))).or_insert_with(|| {
            positions.push((positions[a as usize] + positions[b as usize]).normalize());
            positions.len() as u32 - 1
        })
    };
    let mut finer = Vec::with_capacity(4 * triangles.len());
    for &[a, b, c] in triangles {
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
    }
    finer
}
