//! Random meshes and rays against brute force.

use floe::geometry::{Bounds, Ray};
use glam::Vec3;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;

use crate::brute_force::assert_agrees;
use crate::meshes::Mesh;

/// Of a coarse lattice, on which ties, slivers, coplanar and degenerate triangles are common; zeros of both signs.
fn lattice() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-5_i32..=4).prop_map(|i| {
        // -5 stands for -0.
        Vec3::from_array(i.map(|i| if i == -5 { -0.0 } else { i as f32 * 0.25 }))
    })
}

/// Anywhere in the cube from -1 to 1.
fn anywhere() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-1.0_f32..1.0).prop_map(Vec3::from_array)
}

/// A strip: each three points in a row are a triangle.
fn strip(positions: Vec<Vec3>) -> Mesh {
    let triangles = (0..positions.len() as u32 - 2).map(|i| [i, i + 1, i + 2]).collect();
    Mesh { positions, triangles }
}

/// Triangles over few vertices, so that many share some, and some repeat or are the same.
fn tangle() -> impl Strategy<Value = Mesh> {
    (vec(lattice(), 4..12), vec(prop::array::uniform3(any::<Index>()), 1..80)).prop_map(
        |(positions, triples)| {
            let triangle = |triple: [Index; 3]| triple.map(|i| i.index(positions.len()) as u32);
            Mesh { triangles: triples.into_iter().map(triangle).collect(), positions }
        },
    )
}

/// Triangles whose third vertex is nearly or exactly on the line through the others.
fn slivers() -> impl Strategy<Value = Mesh> {
    let sliver =
        (anywhere(), anywhere(), -1.0_f32..2.0, lattice(), 0_i32..10).prop_map(|(a, b, s, off, exponent)| {
            let aside = off * 10.0_f32.powi(-exponent);
            [a, b, a + (b - a) * s + if exponent == 9 { Vec3::ZERO } else { aside }]
        });
    vec(sliver, 1..40).prop_map(|all| Mesh { positions: all.concat(), triangles: vec![] }.soup())
}

impl Mesh {
    /// Each three vertices are a triangle.
    fn soup(mut self) -> Self {
        self.triangles =
            (0..self.positions.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        self
    }

    /// The mesh with every triangle again at other indices, some begun at another corner, over vertices of its own.
    fn doubled(mut self) -> Self {
        let first = self.positions.len() as u32;
        self.positions.extend_from_within(..);
        let again = self.triangles.iter().rev().map(|&[a, b, c]| match a % 3 {
            0 => [a, b, c],
            1 => [b, c, a],
            _ => [a, c, b],
        });
        let again: Vec<[u32; 3]> = again.map(|t| t.map(|i| first + i)).collect();
        self.triangles.extend(again);
        self
    }
}

fn any_mesh() -> impl Strategy<Value = Mesh> {
    prop_oneof![
        3 => vec(lattice(), 3..120).prop_map(strip),
        1 => vec(anywhere(), 3..120).prop_map(strip),
        2 => vec(lattice(), 3..150).prop_map(|positions| Mesh { positions, triangles: vec![] }.soup()),
        2 => tangle(),
        2 => slivers(),
        1 => vec(lattice(), 3..60).prop_map(|positions| strip(positions).doubled()),
        1 => slivers().prop_map(Mesh::doubled),
        1 => (3_u32..200).prop_map(Mesh::fan),
    ]
}

/// How a ray is laid through a mesh.
#[derive(Clone, Copy, Debug)]
struct Aim {
    start: u8,
    towards: u8,
    pick: [Index; 2],
    points: [Vec3; 2],
    weight: f32,
}

fn aim() -> impl Strategy<Value = Aim> {
    (0..7_u8, 0..6_u8, any::<[Index; 2]>(), [lattice(), lattice()], 0.0_f32..1.0)
        .prop_map(|(start, towards, pick, points, weight)| Aim { start, towards, pick, points, weight })
}

impl Aim {
    /// A ray through a mesh that is `scale` large.
    fn ray(&self, mesh: &Mesh, scale: f32) -> Option<Ray> {
        let Self { start, towards, pick, points, weight } = *self;
        let [a, b, c] = mesh.vertices(pick[0].index(mesh.triangles.len()));
        let bounds = Bounds::of_points(mesh.positions.iter().copied());
        let free = points[0] * scale;
        let origin = match start {
            0 => a,
            1 => a + (b - a) * 0.5,
            2 => a + (b - a) * (0.5 * weight) + (c - a) * (0.5 * weight),
            3 => Vec3::new(bounds.min.x, free.y, free.z),
            4 => Vec3::new(free.x, bounds.max.y, a.z),
            5 => free * 3.0,
            _ => free,
        };
        let [p, q, _] = mesh.vertices(pick[1].index(mesh.triangles.len()));
        let direction = match towards {
            0 => p - origin,
            1 => p + (q - p) * 0.5 - origin,
            2 => p + (q - p) * weight - origin,
            3 => [Vec3::X, Vec3::new(-0.0, -1.0, 0.0), Vec3::new(0.0, -0.0, 1.0)][pick[1].index(3)],
            4 => points[1] * Vec3::new(1.0, -0.0, 1.0),
            _ => points[1],
        };
        // Lengths are taken of what is about one, whose squares do not underflow.
        let greatest = direction.abs().max_element();
        (greatest > 0.0).then(|| Ray::new(origin, (direction / greatest).normalize()))
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]
    #[test]
    fn the_tree_agrees_with_brute_force(
        mesh in any_mesh(), exponent in -15_i32..=17, of_one in any::<bool>(), aims in vec(aim(), 30)
    ) {
        let scale = if of_one { 1.0 } else { 10.0_f32.powi(exponent) };
        let mesh = mesh.placed(scale, Vec3::ZERO);
        let accel = mesh.built();
        aims.iter().filter_map(|aim| aim.ray(&mesh, scale)).for_each(|ray| assert_agrees(&accel, &mesh, &ray));
    }

    #[test]
    fn a_tree_refitted_to_anything_agrees_with_brute_force(
        mesh in any_mesh(), anything in vec(prop_oneof![lattice(), anywhere()], 1..8), same in any::<bool>(),
        exponent in -15_i32..=17, aims in vec(aim(), 15)
    ) {
        let scale = 10.0_f32.powi(exponent);
        // Few points, so that nearly everything becomes degenerate; or one.
        let moved = |i: usize| anything[if same { 0 } else { i * i % anything.len() }] * scale;
        let positions = (0..mesh.positions.len()).map(moved).collect();
        let moved = Mesh { positions, triangles: mesh.triangles.clone() };
        let accel = moved.refitted(mesh.built());
        aims.iter().filter_map(|aim| aim.ray(&moved, scale)).for_each(|ray| assert_agrees(&accel, &moved, &ray));
        let accel = mesh.refitted(accel);
        aims.iter().filter_map(|aim| aim.ray(&mesh, 1.0)).for_each(|ray| assert_agrees(&accel, &mesh, &ray));
    }
}
