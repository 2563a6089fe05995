//! The walls of the simulated box, on small tanks that are made here: tags, extension to the horizon, warnings.
#![allow(clippy::unwrap_used)]

mod extension;
mod tanks;

use std::collections::{BTreeMap, BTreeSet};

use extension::extended;
use floe::mesh::{CornerNormals, RawMesh, Region};
use floe::scene::description::{Axis, DomainDescription, Wall};
use floe::scene::domain::{DomainError, DomainOutcome, Side, WallTag, apply, detect_box};
use glam::{DVec3, Vec3};
use proptest::prelude::*;
use tanks::{MAX, MIN, N, dam_break, domain, interface, tank};

#[test]
fn walls_are_tagged_and_nothing_changes() {
    let before = tank();
    let mut mesh = before.clone();
    let outcome = apply(&mut mesh, &domain(Wall::Open, Wall::Opaque, Wall::Keep), Axis::Z).unwrap();
    assert_eq!(mesh, before);
    assert_eq!((outcome.extended, outcome.warnings), (vec![], vec![]));
    let mut counts = BTreeMap::new();
    for tag in outcome.walls {
        *counts.entry(tag).or_insert(0) += 1;
    }
    let (wall, sheet) = (2 * 3 * N, 2 * N * N);
    let expected = [
        (WallTag::None, sheet),
        (WallTag::Open(Side(0)), wall),
        (WallTag::Open(Side(1)), wall),
        (WallTag::Open(Side(2)), wall),
        (WallTag::Open(Side(3)), wall),
        (WallTag::Opaque(Side(4)), sheet),
    ];
    assert_eq!(counts, BTreeMap::from(expected));
}

#[test]
fn the_up_axis_says_which_wall_is_the_bottom() {
    for (index, negative, side) in [(2, true, 5), (0, false, 0), (0, true, 1), (1, false, 2), (1, true, 3)] {
        // The tank turned so that its z axis points along the new up axis.
        let turn = |p: DVec3| {
            let p = if negative { DVec3::new(p.x, -p.y, -p.z) } else { p };
            match index {
                0 => DVec3::new(p.z, p.x, p.y),
                1 => DVec3::new(p.y, p.z, p.x),
                _ => p,
            }
        };
        let mut mesh = tank();
        mesh.positions.iter_mut().for_each(|p| *p = turn(*p));
        let (a, b) = (turn(MIN), turn(MAX));
        let up = Axis { index, negative };
        let mut walls = domain(Wall::Extend, Wall::Opaque, Wall::Keep);
        (walls.min, walls.max) = (a.min(b), a.max(b));
        let outcome = apply(&mut mesh, &walls, up).unwrap();
        assert_eq!(outcome.extended, [Region(1)]);
        assert_eq!(outcome.warnings, []);
        let bottom = outcome.walls.iter().filter(|tag| **tag != WallTag::None).collect::<BTreeSet<_>>();
        assert_eq!(bottom.into_iter().collect::<Vec<_>>(), [&WallTag::Opaque(Side(side))]);

        let mut straight = tank();
        extended(&mut straight, Wall::Opaque);
        assert_eq!(mesh.triangles, straight.triangles);
        for (found, expected) in mesh.positions.iter().zip(&straight.positions) {
            assert!(found.distance(turn(*expected)) <= 1e-12 * (1.0 + expected.length()));
        }
    }
}

#[test]
fn settings_that_contradict_each_other_are_errors() {
    let cases = [
        (domain(Wall::Extend, Wall::Keep, Wall::Keep), DomainError::BottomKept),
        (domain(Wall::Open, Wall::Extend, Wall::Keep), DomainError::BottomAlone),
        (domain(Wall::Extend, Wall::Open, Wall::Extend), DomainError::TopExtended),
        (
            DomainDescription { max: MIN, ..domain(Wall::Open, Wall::Open, Wall::Open) },
            DomainError::Box { min: MIN, max: MIN },
        ),
    ];
    for (description, error) in cases {
        assert_eq!(apply(&mut tank(), &description, Axis::Z), Err(error));
    }
    let mut unlabelled = RawMesh { interfaces: None, ..tank() };
    let triangles = unlabelled.triangles.len();
    assert_eq!(
        apply(&mut unlabelled, &domain(Wall::Open, Wall::Open, Wall::Keep), Axis::Z),
        Err(DomainError::Unlabelled { labelled: 0, triangles })
    );
}

#[test]
fn a_box_that_nothing_touches_warns_and_names_both() {
    let mut mesh = tank();
    let before = mesh.clone();
    let far = DomainDescription {
        min: 10.0 * MIN,
        max: 10.0 * MAX,
        ..domain(Wall::Extend, Wall::Open, Wall::Keep)
    };
    let outcome = apply(&mut mesh, &far, Axis::Z).unwrap();
    assert_eq!(mesh, before);
    assert_eq!(outcome.extended, []);
    let message = outcome.warnings[0].to_string();
    assert!(message.starts_with("no face lies on the sides of the box"), "{message}");
    assert!(message.contains("[-1, -2, -0.75]") && message.contains("[15, 10, 10]"), "{message}");
}

#[test]
fn an_empty_mesh_is_fine() {
    for wall in [Wall::Keep, Wall::Open, Wall::Opaque] {
        let mut mesh = RawMesh { interfaces: Some(Vec::new()), ..RawMesh::default() };
        assert_eq!(apply(&mut mesh, &domain(wall, wall, wall), Axis::Z), Ok(DomainOutcome::default()));
    }
    assert_eq!(detect_box(&RawMesh::default()), None);
}

#[test]
fn the_box_is_found_where_the_fluid_stands_in_it() {
    let mesh = tank();
    let (min, max) = detect_box(&mesh).unwrap();
    let highest = mesh.positions.iter().fold(f64::MIN, |z, p| z.max(p.z));
    assert_eq!((min, max), (MIN, MAX.with_z(highest)));
    assert_eq!(detect_box(&dam_break()), None);
    let mut bottomless = mesh;
    bottomless.triangles.truncate(bottomless.triangles.len() - (N * N) as usize);
    assert_eq!(detect_box(&bottomless), None, "half of the bottom is missing");
}

proptest! {
    #[test]
    fn any_soup_goes_through(
        points in prop::collection::vec(prop::array::uniform3(0_usize..6), 1..24),
        faces in prop::collection::vec((prop::array::uniform3(0_u32..24), 0..3, 0..3), 0..120),
        settings in prop::array::uniform3(0_usize..4),
        up in (0_usize..3, any::<bool>()),
    ) {
        // Most vertices are on planes of the box.
        let place = |axis: usize, i: usize| {
            [MIN[axis], MIN[axis], MAX[axis], MAX[axis], 0.1, 2.0 * MAX[axis]][i]
        };
        let positions: Vec<DVec3> =
            points.iter().map(|p| DVec3::new(place(0, p[0]), place(1, p[1]), place(2, p[2]))).collect();
        let count = positions.len() as u32;
        let mut mesh = RawMesh {
            triangles: faces.iter().map(|f| f.0.map(|i| i % count)).collect(),
            interfaces: Some(faces.iter().map(|f| interface(f.1, f.2)).collect()),
            normals: Some(CornerNormals { values: vec![Vec3::Z; positions.len()], corners: None }),
            velocities: Some(vec![Vec3::Z; positions.len()]),
            positions,
        };
        detect_box(&mesh);
        let walls = settings.map(|i| [Wall::Keep, Wall::Open, Wall::Opaque, Wall::Extend][i]);
        let up = Axis { index: up.0, negative: up.1 };
        if let Ok(outcome) = apply(&mut mesh, &domain(walls[0], walls[1], walls[2]), up) {
            prop_assert_eq!(outcome.walls.len(), mesh.triangles.len());
            prop_assert_eq!(mesh.interfaces.as_ref().map(Vec::len), Some(mesh.triangles.len()));
            prop_assert!(mesh.triangles.iter().flatten().all(|&i| (i as usize) < mesh.positions.len()));
            prop_assert!(mesh.positions.iter().all(|p| p.is_finite()));
            let velocities = mesh.velocities.unwrap();
            prop_assert_eq!(velocities.len(), mesh.positions.len());
            prop_assert!(velocities.iter().all(|v| v.abs_diff_eq(Vec3::Z * v.z, 0.0) && (0.0..=1.0).contains(&v.z)));
        }
    }
}
