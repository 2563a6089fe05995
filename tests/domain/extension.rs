//! Surfaces that go on beyond the box.

use std::collections::{BTreeMap, BTreeSet};

use floe::mesh::normals::{group_keys, smooth};
use floe::mesh::{CornerNormals, Interface, RawMesh, Region};
use floe::scene::description::{Axis, Wall};
use floe::scene::domain::{DomainOutcome, DomainWarning, Side, WallTag, apply};
use glam::{DVec3, Vec3};

use crate::tanks::{
    Builder, MAX, MIN, N, dam_break, domain, interface, plan, tank, tank_with_pocket, two_layers, wave,
};

/// How often each directed edge occurs in the faces of one label pair, normal into the lesser label.
fn directed_edges(mesh: &RawMesh, pair: Interface) -> BTreeMap<(u32, u32), usize> {
    let mut edges = BTreeMap::new();
    for (t, labels) in mesh.triangles.iter().zip(mesh.interfaces.as_ref().unwrap()) {
        let t = match *labels {
            labels if labels == pair => *t,
            labels if labels == interface(pair.back.0, pair.front.0) => [t[0], t[2], t[1]],
            _ => continue,
        };
        for k in 0..3 {
            *edges.entry((t[k], t[(k + 1) % 3])).or_insert(0) += 1;
        }
    }
    edges
}

/// The edges of a surface that have one face only. Panics when an edge is used twice the same way.
fn border(mesh: &RawMesh, pair: Interface) -> Vec<(u32, u32)> {
    let edges = directed_edges(mesh, pair);
    assert!(edges.values().all(|&times| times == 1), "every edge is traversed once in each direction");
    edges.keys().filter(|&&(a, b)| !edges.contains_key(&(b, a))).copied().collect()
}

/// Asserts that the surface ends in the outermost ring only, flat at `height` from three box lengths on, and that
/// it is upright nowhere beyond the box.
fn assert_extended(mesh: &RawMesh, pair: Interface, height: f64) {
    let centre = 0.5 * (MIN + MAX);
    let reach = |index: u32| {
        let p = (mesh.positions[index as usize] - centre) / (0.5 * (MAX - MIN));
        p.x.abs().max(p.y.abs())
    };
    let border = border(mesh, pair);
    assert!(!border.is_empty());
    assert!(border.iter().all(|&(a, b)| reach(a) >= 1e5 && reach(b) >= 1e5));
    let mut beyond = 0;
    for (t, labels) in mesh.triangles.iter().zip(mesh.interfaces.as_ref().unwrap()) {
        let is_of_pair = [*labels, interface(labels.back.0, labels.front.0)].contains(&pair);
        if is_of_pair && t.iter().all(|&index| reach(index) > 3.0 - 1e-9) {
            let [a, b, c] = t.map(|index| mesh.positions[index as usize]);
            assert!([a, b, c].iter().all(|p| (p.z - height).abs() < 1e-12), "{a} {b} {c} at {height}");
            let normal = (b - a).cross(c - a).normalize();
            let upright = if *labels == pair { DVec3::Z } else { -DVec3::Z };
            assert!(normal.distance(upright) < 1e-12, "{normal}");
            beyond += 1;
        }
    }
    assert!(beyond > 0);
}

/// Mean height along the perimeter, with the points of the sheet's border, in an order of its own.
fn perimeter_mean(height: &dyn Fn(f64, f64) -> f64) -> f64 {
    let mut ends = Vec::new();
    for k in 0..N {
        ends.extend([(plan(k, 0), plan(k + 1, 0)), (plan(k, N), plan(k + 1, N))]);
        ends.extend([(plan(0, k), plan(0, k + 1)), (plan(N, k), plan(N, k + 1))]);
    }
    let (mut sum, mut weight) = (0.0, 0.0);
    for ((ax, ay), (bx, by)) in ends {
        let (az, bz) = (height(ax, ay), height(bx, by));
        let length = ((bx - ax).powi(2) + (by - ay).powi(2) + (bz - az).powi(2)).sqrt();
        sum += length * (az + bz) / 2.0;
        weight += length;
    }
    sum / weight
}

pub fn extended(mesh: &mut RawMesh, bottom: Wall) -> DomainOutcome {
    let outcome = apply(mesh, &domain(Wall::Extend, bottom, Wall::Keep), Axis::Z).unwrap();
    assert_eq!(outcome.walls.len(), mesh.triangles.len());
    assert_eq!(mesh.interfaces.as_ref().unwrap().len(), mesh.triangles.len());
    outcome
}

fn count_on_plane(mesh: &RawMesh, axis: usize, at: f64) -> usize {
    let lies = |t: &&[u32; 3]| t.iter().all(|&i| (mesh.positions[i as usize][axis] - at).abs() < 3e-5);
    mesh.triangles.iter().filter(lies).count()
}

/// The heights of the vertices far beyond the box.
fn flat_heights(mesh: &RawMesh) -> Vec<f64> {
    let mut heights: Vec<f64> =
        mesh.positions.iter().filter(|p| p.x.abs().max(p.y.abs()) > 100.0).map(|p| p.z).collect();
    heights.sort_by(f64::total_cmp);
    heights.dedup();
    heights
}

#[test]
fn the_tank_of_these_tests_is_closed() {
    assert_eq!(border(&tank(), interface(0, 1)), []);
}

#[test]
fn the_sea_goes_on_to_the_horizon() {
    let mut mesh = tank();
    let outcome = extended(&mut mesh, Wall::Open);
    assert_eq!(outcome.extended, [Region(1)]);
    assert_eq!(outcome.warnings, []);
    assert!(outcome.walls.iter().all(|tag| *tag == WallTag::None));
    for (axis, at) in [(0, MIN.x), (0, MAX.x), (1, MIN.y), (1, MAX.y), (2, MIN.z)] {
        assert_eq!(count_on_plane(&mesh, axis, at), 0);
    }
    assert_extended(&mesh, interface(0, 1), perimeter_mean(&wave));
    // 2 (nx + ny) rim edges, 8 rings to three box lengths and 8 more to 3 * 4^8, two triangles each.
    assert_eq!(mesh.triangles.len() as u32, 2 * N * N + 4 * N * 16 * 2);
    // Shading normals go on across the rim and are upright on the flat sea.
    let normals = smooth(&mesh, &group_keys(mesh.triangles.len(), mesh.interfaces.as_ref().unwrap(), &[]));
    let last = normals.corners.as_ref().unwrap().last().unwrap();
    assert!(last.iter().all(|&i| normals.values[i as usize] == Vec3::Z));
    let used: BTreeSet<u32> = mesh.triangles.iter().flatten().copied().collect();
    assert_eq!(normals.values.len(), used.len(), "one normal a vertex");
}

#[test]
fn an_opaque_bottom_stays() {
    let mut mesh = tank();
    let outcome = extended(&mut mesh, Wall::Opaque);
    assert_eq!(outcome.warnings, []);
    assert_eq!(count_on_plane(&mesh, 2, MIN.z) as u32, 2 * N * N);
    let opaque = outcome.walls.iter().filter(|tag| matches!(tag, WallTag::Opaque(_))).count();
    assert_eq!(opaque as u32, 2 * N * N);
}

#[test]
fn layers_go_on_at_their_own_heights() {
    let mut mesh = two_layers();
    let outcome = extended(&mut mesh, Wall::Extend);
    assert_eq!(outcome.extended, [Region(1), Region(2)]);
    assert_eq!(outcome.warnings, []);
    assert_extended(&mesh, interface(0, 1), perimeter_mean(&wave));
    assert_extended(&mesh, interface(1, 2), perimeter_mean(&|x, y| -0.4 + 0.06 * (3.0 * x + y).sin()));
}

#[test]
fn winding_and_labels_may_be_exchanged() {
    let mut mesh = tank();
    for i in (0..mesh.triangles.len()).filter(|i| i % 3 == 0) {
        mesh.triangles[i].swap(1, 2);
        mesh.interfaces.as_mut().unwrap()[i] = interface(1, 0);
    }
    let outcome = extended(&mut mesh, Wall::Open);
    assert_eq!(outcome.extended, [Region(1)]);
    assert_extended(&mesh, interface(0, 1), perimeter_mean(&wave));
}

#[test]
fn a_slab_that_floats_goes_on_above_and_below() {
    let floor = |x: f64, y: f64| -0.5 + 0.1 * (x * y).cos();
    let mut builder = Builder::default();
    builder.sheet(&wave, interface(0, 1));
    builder.walls(&floor, &wave, interface(0, 1));
    builder.sheet(&floor, interface(1, 0));
    let mut mesh = builder.mesh;
    let outcome = extended(&mut mesh, Wall::Open);
    assert_eq!((outcome.extended, outcome.warnings), (vec![Region(1)], vec![]));
    let heights = flat_heights(&mesh);
    for expected in [perimeter_mean(&wave), perimeter_mean(&floor)] {
        assert!(heights.iter().any(|z| (z - expected).abs() < 1e-12), "{heights:?} lacks {expected}");
    }
    border(&mesh, interface(0, 1));
}

#[test]
fn a_drop_on_a_wall_stays_closed_and_does_not_lift_the_sea() {
    let mut dry = tank();
    extended(&mut dry, Wall::Open);
    // A pyramid on the wall at the greater x, above the water.
    let base = [(-0.1, 0.6), (0.1, 0.6), (0.1, 0.8), (-0.1, 0.8)].map(|(y, z)| DVec3::new(MAX.x, y, z));
    let tip = DVec3::new(MAX.x - 0.3, 0.0, 0.7);
    let mut builder = Builder { mesh: tank(), ..Builder::default() };
    builder.quad(base, interface(0, 1));
    for k in 0..4 {
        builder.quad([base[(k + 1) % 4], base[k], tip, tip], interface(0, 1));
    }
    let mut mesh = builder.mesh;
    assert_eq!(border(&mesh, interface(0, 1)), []);
    let outcome = extended(&mut mesh, Wall::Open);
    assert_eq!((outcome.extended, outcome.warnings), (vec![Region(1)], vec![]));
    assert_eq!(mesh.triangles.len(), dry.triangles.len() + 6);
    assert_eq!(count_on_plane(&mesh, 0, MAX.x), 2);
    assert_eq!(outcome.walls.iter().filter(|tag| **tag == WallTag::Keep(Side(1))).count(), 2);
    assert_extended(&mesh, interface(0, 1), perimeter_mean(&wave));
}

#[test]
fn bubbles_and_drops_in_the_extended_region_are_capped() {
    for inside in [0, 2] {
        let mut mesh = tank_with_pocket(inside);
        let outcome = extended(&mut mesh, Wall::Open);
        assert_eq!((outcome.extended, outcome.warnings), (vec![Region(1)], vec![]));
        assert_eq!(count_on_plane(&mesh, 0, MAX.x), 4, "a fan of four triangles");
        assert_eq!(outcome.walls.iter().filter(|tag| **tag == WallTag::Keep(Side(1))).count(), 4);
        if inside != 0 {
            assert_eq!(border(&mesh, interface(1, inside)), []);
        }
        assert_extended(&mesh, interface(0, 1), perimeter_mean(&wave));
    }
}

#[test]
fn a_wave_that_breaks_along_a_wall_is_unfolded() {
    // The sheet's columns near the middle are pushed along y past each other, less and less towards the far wall.
    let mut mesh = tank();
    let fold = |p: &mut DVec3| {
        let near = if (p.x - MAX.x).abs() < 1e-9 { 1.0 } else { 0.0 };
        if p.y.abs() < 0.6 && p.z > MIN.z + 1e-9 {
            p.y += near * 0.8 * (1.0 - (p.y / 0.6).abs());
            p.z += near * 0.3 * (1.0 - (p.y / 0.6).abs());
        }
    };
    mesh.positions.iter_mut().for_each(fold);
    let folds = (0..N).filter(|&j| {
        let y = |j| {
            let mut p = DVec3::new(MAX.x, plan(0, j).1, 0.0);
            fold(&mut p);
            p.y
        };
        y(j + 1) < y(j)
    });
    assert!(folds.count() > 0, "the rim doubles back");
    let outcome = extended(&mut mesh, Wall::Open);
    assert_eq!(outcome.extended, [Region(1)]);
    let flat = flat_heights(&mesh);
    assert_eq!(flat.len(), 1);
    // Every flat triangle is the right way up: the extension does not lie on itself.
    assert_extended(&mesh, interface(0, 1), flat[0]);
}

#[test]
fn a_dam_break_touches_part_of_the_sides() {
    let mesh = dam_break();
    assert_eq!(border(&mesh, interface(0, 1)), []);
    let mut opaque = mesh.clone();
    let outcome = extended(&mut opaque, Wall::Opaque);
    assert_eq!(outcome.extended, [Region(1)]);
    // The rim comes down to the bottom on two walls.
    let ends = outcome.warnings.iter().filter(|w| matches!(w, DomainWarning::OpenRim { .. })).count();
    assert_eq!((ends, outcome.warnings.len()), (2, 2));
    assert_eq!(flat_heights(&opaque).len(), 1);

    let mut open = mesh;
    let outcome = extended(&mut open, Wall::Open);
    assert!(
        outcome.warnings.contains(&DomainWarning::DryBottom { edges: N as usize }),
        "{:?}",
        outcome.warnings
    );
}

#[test]
fn rims_that_meet_share_their_columns() {
    // A third region reaches the wall at y = MIN.y: sheets of three label pairs meet at two of its vertices.
    let mut mesh = tank();
    let is_block = |p: DVec3| p.x > 0.0 && p.x < 0.9 && p.y < -1.0;
    let lid = |p: DVec3| p + DVec3::Z * 0.2;
    let mut builder = Builder::default();
    let labels = mesh.interfaces.take().unwrap();
    for (t, labels) in mesh.triangles.iter().zip(labels) {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        let on_surface = [a, b, c].iter().all(|p| (p.z - wave(p.x, p.y)).abs() < 1e-12);
        builder.quad(
            [a, b, c, c],
            if on_surface && is_block((a + b + c) / 3.0) { interface(2, 1) } else { labels },
        );
    }
    let mut lids = Vec::new();
    for (t, labels) in builder.mesh.triangles.iter().zip(builder.mesh.interfaces.as_ref().unwrap()) {
        if *labels == interface(2, 1) {
            lids.push(t.map(|i| builder.mesh.positions[i as usize]));
        }
    }
    let edges: BTreeSet<[[u64; 3]; 2]> = lids
        .iter()
        .flat_map(|t| (0..3).map(|k| [t[k], t[(k + 1) % 3]].map(|p| p.to_array().map(f64::to_bits))))
        .collect();
    for [a, b, c] in &lids {
        builder.quad([lid(*a), lid(*b), lid(*c), lid(*c)], interface(0, 2));
        for (p, q) in [(*a, *b), (*b, *c), (*c, *a)] {
            let [from, to] = [p, q].map(|p| p.to_array().map(f64::to_bits));
            if !edges.contains(&[to, from]) {
                builder.quad([p, q, lid(q), lid(p)], interface(0, 2));
            }
        }
    }
    let mut mesh = builder.mesh;
    let outcome = extended(&mut mesh, Wall::Open);
    assert_eq!(outcome.warnings, []);
    assert_eq!(outcome.extended, [Region(1), Region(2)]);
    // The boundary of region 2 as a whole is closed but for the horizon.
    let mut edges = directed_edges(&mesh, interface(0, 2));
    for ((a, b), times) in directed_edges(&mesh, interface(1, 2)) {
        *edges.entry((a, b)).or_insert(0) += times;
    }
    let far = |i: &u32| mesh.positions[*i as usize].abs().max_element() > 1e4;
    for ((a, b), times) in &edges {
        assert!(edges.get(&(*b, *a)) == Some(times) || far(a) && far(b));
    }
}

#[test]
fn normals_of_the_file_stay_with_their_corners() {
    let mut by_vertex = tank();
    by_vertex.normals =
        Some(CornerNormals { values: vec![Vec3::X; by_vertex.positions.len()], corners: None });
    extended(&mut by_vertex, Wall::Open);
    assert_eq!(by_vertex.normals.unwrap().values.len(), by_vertex.positions.len());

    let mut by_corner = tank();
    let numbers: Vec<[u32; 3]> = (0..by_corner.triangles.len() as u32).map(|i| [i; 3]).collect();
    let values = vec![Vec3::X; numbers.len()];
    by_corner.normals = Some(CornerNormals { values, corners: Some(numbers) });
    extended(&mut by_corner, Wall::Open);
    let normals = by_corner.normals.unwrap();
    let corners = normals.corners.unwrap();
    assert_eq!(corners.len(), by_corner.triangles.len());
    // The sheet comes first in the tank; what was added has no normals.
    assert_eq!(corners[5], [5; 3]);
    assert_eq!(normals.values[corners.last().unwrap()[0] as usize], Vec3::ZERO);
}
