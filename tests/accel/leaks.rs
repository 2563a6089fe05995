//! Rays from inside closed meshes: none gets out.

use floe::accel::Ignored;
use floe::geometry::Ray;
use floe::sampling::{SampleSeed, SampleStream, warp};
use glam::Vec3;
use rayon::prelude::*;

use crate::meshes::Mesh;

const SEED: SampleSeed = SampleSeed::new(1);

/// Casts rays that `ray` makes of random numbers and counts those that miss.
fn leaks(mesh: &Mesh, rays: u32, ray: impl Fn(u32, [f32; 4]) -> Ray + Sync) -> usize {
    let accel = mesh.built();
    let missed = |&i: &u32| {
        let ray = ray(i, SampleStream::new(SEED, i, 0, 0).next4());
        accel.closest(&ray, Ignored::NOTHING).is_none() || !accel.occluded(&ray, Ignored::NOTHING)
    };
    (0..rays).into_par_iter().filter(missed).count()
}

/// A point within half the radius of a blob.
fn inside(u: [f32; 3], scale: f32) -> Vec3 {
    warp::sphere([u[0], u[1]]) * (0.5 * scale * u[2])
}

/// Rays from inside at vertices, edge midpoints and random points of edges.
fn leaks_at_edges(mesh: &Mesh, centre: Vec3, scale: f32, rays: u32) -> usize {
    leaks(mesh, rays, |i, u| {
        let origin = centre + inside([u[0], u[1], u[2]], scale);
        let corners = mesh.vertices((i as usize * 7919) % mesh.triangles.len());
        let [a, b] = [corners[i as usize / 3 % 3], corners[(i as usize / 3 + 1) % 3]];
        let target = match i % 3 {
            0 => a,
            1 => a + (b - a) * 0.5,
            _ => a + (b - a) * u[3],
        };
        Ray::new(origin, (target - origin).normalize())
    })
}

#[test]
fn ten_million_rays_at_edges_and_vertices_never_leak() {
    for (name, mesh) in [("even", Mesh::blob(6)), ("uneven", Mesh::jittered_blob(6))] {
        for (scale, offset) in [(1.0, Vec3::ZERO), (1e-3, Vec3::ZERO), (1.0, Vec3::splat(1000.0))] {
            let leaks = leaks_at_edges(&mesh.placed(scale, offset), offset, scale, 1_700_000);
            assert_eq!(leaks, 0, "{name}, scale {scale}, offset {offset}");
        }
    }
}

#[test]
fn neither_huge_nor_tiny_meshes_leak() {
    let mesh = Mesh::jittered_blob(4);
    for exponent in [-15, -12, -9, -6, 6, 9, 12, 15, 17] {
        let scale = 10.0_f32.powi(exponent);
        let leaks = leaks_at_edges(&mesh.placed(scale, Vec3::ZERO), Vec3::ZERO, scale, 50_000);
        assert_eq!(leaks, 0, "scale {scale}");
    }
}

/// `cargo test --release --test accel -- --ignored --nocapture`
#[test]
#[ignore = "takes a minute"]
fn a_hundred_million_random_rays_never_leak() {
    let start = std::time::Instant::now();
    let found = leaks(&Mesh::jittered_blob(7), 100_000_000, |i, u| {
        // The directions have numbers of their own.
        let v = SampleStream::new(SEED, i, 1, 0).next4();
        Ray::new(inside([u[0], u[1], u[2]], 1.0), warp::sphere([v[0], v[1]]))
    });
    println!("100 million rays in {:.1} s", start.elapsed().as_secs_f64());
    assert_eq!(found, 0);
}
