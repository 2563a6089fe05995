//! Meshes to build hierarchies over.

use std::collections::BTreeMap;

use floe::accel::Accel;
use floe::sampling::{SampleSeed, SampleStream};
use glam::Vec3;

/// Vertices and triangles.
#[derive(Clone, Debug)]
pub struct Mesh {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// A closed, bumpy sphere of 8 * 4^levels triangles around the origin, of radii between 0.85 and 1.15.
    pub fn blob(levels: u32) -> Self {
        let mut positions = vec![Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z];
        let mut triangles =
            vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
        for _ in 0..levels {
            let mut midpoints = BTreeMap::new();
            let mut middle = |a: u32, b: u32, positions: &mut Vec<Vec3>| {
                *midpoints.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    positions.push((positions[a as usize] + positions[b as usize]).normalize());
                    positions.len() as u32 - 1
                })
            };
            let mut finer = Vec::new();
            for [a, b, c] in triangles {
                let (ab, bc, ca) = (
                    middle(a, b, &mut positions),
                    middle(b, c, &mut positions),
                    middle(c, a, &mut positions),
                );
                finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
            }
            triangles = finer;
        }
        for p in &mut positions {
            let bump = 1.0 + 0.1 * (7.0 * p.x).sin() * (5.0 * p.y).cos() + 0.05 * (11.0 * p.z).sin();
            *p *= bump;
        }
        Self { positions, triangles }
    }

    /// The blob with every vertex moved by up to half an edge: triangles of all shapes, no two edges parallel.
    pub fn jittered_blob(levels: u32) -> Self {
        let mut mesh = Self::blob(levels);
        let half_edge = 0.5 * std::f32::consts::FRAC_PI_2 / 2.0_f32.powi(levels as i32);
        for (i, p) in mesh.positions.iter_mut().enumerate() {
            let u = SampleStream::new(SampleSeed::new(9), i as u32, 0, 0).next4();
            *p += (Vec3::new(u[0], u[1], u[2]) * 2.0 - 1.0) * half_edge;
        }
        mesh
    }

    /// Triangles with a first vertex in common, one beside the other all around.
    pub fn fan(triangles: u32) -> Self {
        let rim = (0..triangles).map(|i| {
            let (sin, cos) = (std::f32::consts::TAU * i as f32 / triangles as f32).sin_cos();
            Vec3::new(cos, sin, 0.2 * (5.0 * sin).sin())
        });
        let positions = std::iter::once(Vec3::new(0.1, -0.05, 0.3)).chain(rim).collect();
        let triangles = (0..triangles).map(|i| [0, 1 + i, 1 + (i + 1) % triangles]).collect();
        Self { positions, triangles }
    }

    /// The mesh scaled, then moved.
    pub fn placed(&self, scale: f32, offset: Vec3) -> Self {
        let positions = self.positions.iter().map(|&p| p * scale + offset).collect();
        Self { positions, triangles: self.triangles.clone() }
    }

    /// The same triangles, each with vertices of its own.
    pub fn unshared(&self) -> Self {
        let positions = self.triangles.iter().flatten().map(|&i| self.positions[i as usize]).collect();
        let triangles = (0..self.triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        Self { positions, triangles }
    }

    /// The vertices of a triangle.
    pub fn vertices(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|i| self.positions[i as usize])
    }

    /// Its hierarchy, which must be sound.
    pub fn built(&self) -> Accel {
        let accel = Accel::build(&self.positions, &self.triangles);
        accel.validate(&self.positions, &self.triangles).unwrap();
        accel
    }

    /// Its hierarchy made from that of other positions, which must be sound.
    pub fn refitted(&self, mut accel: Accel) -> Accel {
        accel.refit(&self.positions, &self.triangles);
        accel.validate(&self.positions, &self.triangles).unwrap();
        accel
    }
}
