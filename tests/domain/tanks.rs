//! Small tanks of water in a box, made by hand.

use std::collections::BTreeMap;

use floe::mesh::{Interface, RawMesh, Region};
use floe::scene::description::{DomainDescription, Wall};
use floe::spectrum::Spectrum;
use glam::DVec3;

pub const N: u32 = 12;

pub const MIN: DVec3 = DVec3::new(-1.0, -2.0, -0.75);

pub const MAX: DVec3 = DVec3::new(1.5, 1.0, 1.0);

pub fn domain(sides: Wall, bottom: Wall, top: Wall) -> DomainDescription {
    DomainDescription { min: MIN, max: MAX, sides, bottom, top, reflectance: Spectrum::Constant(0.5) }
}

pub fn interface(front: i32, back: i32) -> Interface {
    Interface { front: Region(front), back: Region(back) }
}

/// A mesh under construction: vertices are shared by exact position.
#[derive(Default)]
pub struct Builder {
    pub vertices: BTreeMap<[u64; 3], u32>,
    pub mesh: RawMesh,
}

impl Builder {
    pub fn vertex(&mut self, p: DVec3) -> u32 {
        let key = p.to_array().map(f64::to_bits);
        *self.vertices.entry(key).or_insert_with(|| {
            self.mesh.positions.push(p);
            self.mesh.positions.len() as u32 - 1
        })
    }

    /// A quadrangle, counter-clockwise seen from `front`; corners that coincide make it a triangle or nothing.
    pub fn quad(&mut self, corners: [DVec3; 4], labels: Interface) {
        let [a, b, c, d] = corners.map(|p| self.vertex(p));
        for t in [[a, b, c], [a, c, d]] {
            if t[0] != t[1] && t[1] != t[2] && t[2] != t[0] {
                self.mesh.triangles.push(t);
                self.mesh.interfaces.get_or_insert_default().push(labels);
            }
        }
    }

    /// A height field over the box's floor plan, normal up.
    pub fn sheet(&mut self, height: &dyn Fn(f64, f64) -> f64, labels: Interface) {
        let at = |i: u32, j: u32| {
            let (x, y) = plan(i, j);
            DVec3::new(x, y, height(x, y))
        };
        for (i, j) in (0..N).flat_map(|i| (0..N).map(move |j| (i, j))) {
            self.quad([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)], labels);
        }
    }

    /// The four walls between two height fields, normals outwards, in `layers` rows.
    pub fn walls(
        &mut self,
        low: &dyn Fn(f64, f64) -> f64,
        high: &dyn Fn(f64, f64) -> f64,
        labels: Interface,
    ) {
        const LAYERS: u32 = 3;
        let at = |(i, j): (u32, u32), layer: u32| {
            let (x, y) = plan(i, j);
            // The ends exactly, so that the vertices are those of the sheets.
            let z = match layer {
                0 => low(x, y),
                LAYERS => high(x, y),
                _ => low(x, y) + (high(x, y) - low(x, y)) * f64::from(layer) / f64::from(LAYERS),
            };
            DVec3::new(x, y, z)
        };
        let perimeter: Vec<(u32, u32)> = (0..N)
            .map(|i| (i, 0))
            .chain((0..N).map(|j| (N, j)))
            .chain((0..N).map(|i| (N - i, N)))
            .chain((0..N).map(|j| (0, N - j)))
            .collect();
        for (k, &here) in perimeter.iter().enumerate() {
            let next = perimeter[(k + 1) % perimeter.len()];
            for l in 0..LAYERS {
                self.quad([at(here, l), at(next, l), at(next, l + 1), at(here, l + 1)], labels);
            }
        }
    }

    pub fn bottom(&mut self, labels: Interface) {
        let first = self.mesh.triangles.len();
        self.sheet(&|_, _| MIN.z, labels);
        self.mesh.triangles[first..].iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }
}

pub fn plan(i: u32, j: u32) -> (f64, f64) {
    let between = |a: f64, b: f64, k: u32| {
        if k == N { b } else { a + (b - a) * f64::from(k) / f64::from(N) }
    };
    (between(MIN.x, MAX.x, i), between(MIN.y, MAX.y, j))
}

pub fn wave(x: f64, y: f64) -> f64 {
    0.2 + 0.11 * (2.3 * x + 0.4).sin() * (1.7 * y).cos() + 0.05 * x
}

pub fn bed(_: f64, _: f64) -> f64 {
    MIN.z
}

/// Water with waves in the box: label 1 under label 0.
pub fn tank() -> RawMesh {
    let mut builder = Builder::default();
    builder.sheet(&wave, interface(0, 1));
    builder.walls(&bed, &wave, interface(0, 1));
    builder.bottom(interface(0, 1));
    builder.mesh
}

/// Water (1) over oil (2).
pub fn two_layers() -> RawMesh {
    let middle = |x: f64, y: f64| -0.4 + 0.06 * (3.0 * x + y).sin();
    let mut builder = Builder::default();
    builder.sheet(&wave, interface(0, 1));
    builder.sheet(&middle, interface(1, 2));
    builder.walls(&middle, &wave, interface(0, 1));
    builder.walls(&bed, &middle, interface(0, 2));
    builder.bottom(interface(0, 2));
    builder.mesh
}

/// Water against the wall at the lesser x only, with a front that slopes to the bottom: a dam break.
pub fn dam_break() -> RawMesh {
    let mut builder = Builder::default();
    let at = |i: u32, j: u32| {
        let t = f64::from(i) / f64::from(N);
        DVec3::new(MIN.x + t, plan(0, j).1, if i == N { MIN.z } else { 0.5 + (MIN.z - 0.5) * t })
    };
    let down = |p: DVec3| p.with_z(MIN.z);
    for (i, j) in (0..N).flat_map(|i| (0..N).map(move |j| (i, j))) {
        let top = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        builder.quad(top, interface(0, 1));
        let [a, b, c, d] = top.map(down);
        builder.quad([d, c, b, a], interface(0, 1));
    }
    for k in 0..N {
        builder.quad([down(at(k, 0)), down(at(k + 1, 0)), at(k + 1, 0), at(k, 0)], interface(0, 1));
        builder.quad([at(k, N), at(k + 1, N), down(at(k + 1, N)), down(at(k, N))], interface(0, 1));
        builder.quad([at(0, k), at(0, k + 1), down(at(0, k + 1)), down(at(0, k))], interface(0, 1));
    }
    builder.mesh
}

/// The tank with a pyramid of region `inside` under water at the wall at the greater x.
pub fn tank_with_pocket(inside: i32) -> RawMesh {
    let mut mesh = tank();
    let middle = |mesh: &RawMesh, i: usize| {
        mesh.triangles[i].iter().map(|&k| mesh.positions[k as usize]).sum::<DVec3>() / 3.0
    };
    // A square of that wall: two triangles in a row.
    let first = (0..mesh.triangles.len())
        .find(|&i| {
            let p = middle(&mesh, i);
            p.x == MAX.x && p.y.abs() < 0.3 && (-0.4..-0.1).contains(&p.z)
        })
        .unwrap();
    let [[a, b, c], [a2, c2, d]] = [mesh.triangles[first], mesh.triangles[first + 1]];
    assert_eq!([a, c], [a2, c2]);
    let tip = mesh.positions.len() as u32;
    mesh.positions.push(middle(&mesh, first) - DVec3::X * 0.4);
    let labels = mesh.interfaces.as_mut().unwrap();
    if inside == 0 {
        mesh.triangles.drain(first..first + 2);
        labels.drain(first..first + 2);
    } else {
        labels[first..first + 2].fill(interface(0, inside));
    }
    for (from, to) in [(a, b), (b, c), (c, d), (d, a)] {
        // The normal points into the pocket.
        mesh.triangles.push([from, to, tip]);
        labels.push(interface(inside, 1));
    }
    mesh
}
