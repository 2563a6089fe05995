use glam::Vec3;

use super::*;
use crate::mesh::CornerNormals;

/// The unit tetrahedron, wound outwards.
fn tetrahedron() -> RawMesh {
    RawMesh {
        positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
        triangles: vec![[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]],
        ..Default::default()
    }
}

fn interface(front: i32, back: i32) -> Interface {
    Interface { front: Region(front), back: Region(back) }
}

fn prepared(mesh: RawMesh) -> (RawMesh, Vec<MeshWarning>) {
    prepare(mesh, Region(7), Path::new("mesh.ply")).unwrap()
}

#[test]
fn a_closed_mesh_gets_its_region_behind() {
    let (mesh, warnings) = prepared(tetrahedron());
    assert_eq!(mesh.interfaces, Some(vec![interface(0, 7); 4]));
    assert_eq!(warnings, []);
}

#[test]
fn a_mesh_that_is_inside_out_gets_it_in_front() {
    let mut mesh = tetrahedron();
    for triangle in &mut mesh.triangles {
        triangle.swap(0, 1);
    }
    // Far from the origin the sign of the volume must not drown.
    for position in &mut mesh.positions {
        *position += 1e9;
    }
    let (mesh, warnings) = prepared(mesh);
    assert_eq!(mesh.interfaces, Some(vec![interface(7, 0); 4]));
    assert_eq!(warnings, [MeshWarning::InsideOut]);
}

#[test]
fn labels_of_the_file_stay() {
    let mut mesh = tetrahedron();
    mesh.interfaces = Some(vec![interface(3, 2); 4]);
    assert_eq!(prepared(mesh.clone()), (mesh, vec![]));
}

#[test]
fn an_open_mesh_warns_with_its_first_edge() {
    let mut mesh = tetrahedron();
    mesh.triangles.remove(0);
    let (mesh, warnings) = prepared(mesh);
    assert_eq!(mesh.interfaces, Some(vec![interface(0, 7); 3]));
    let first = [DVec3::X, DVec3::Y];
    assert_eq!(warnings, [MeshWarning::Open { edges: 3, first, labelled: false }]);
    assert!(warnings[0].to_string().contains("3 edges"), "{}", warnings[0]);
}

#[test]
fn a_soup_is_welded() {
    let closed = tetrahedron();
    let corners = closed.triangles.iter().flatten().map(|&index| closed.positions[index as usize]);
    let soup = RawMesh {
        positions: corners.collect(),
        triangles: (0..4).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
        ..Default::default()
    };
    let (mesh, warnings) = prepared(soup);
    assert_eq!(mesh.positions.len(), 4);
    assert_eq!(warnings, [MeshWarning::Welded { before: 12, after: 4 }]);
}

#[test]
fn velocities_that_are_not_finite_are_told_and_set_to_zero() {
    let mut mesh = tetrahedron();
    let nan = Vec3::new(0.0, f32::NAN, 1.0);
    mesh.velocities = Some(vec![Vec3::X, nan, Vec3::Y, Vec3::INFINITY]);
    let (mesh, warnings) = prepared(mesh);
    assert_eq!(mesh.velocities, Some(vec![Vec3::X, Vec3::ZERO, Vec3::Y, Vec3::ZERO]));
    assert_eq!(warnings, [MeshWarning::Velocities { not_finite: 2, all: 4 }]);
}

#[test]
fn closed_surfaces_that_touch_stay_apart() {
    let mut mesh = tetrahedron();
    // They have the point at 1 on the x axis in common.
    mesh.positions.extend(tetrahedron().positions.iter().map(|p| *p + DVec3::X));
    mesh.triangles.extend(tetrahedron().triangles.iter().map(|triangle| triangle.map(|index| index + 4)));
    let (mesh, warnings) = prepared(mesh);
    assert_eq!((mesh.positions.len(), warnings.len()), (8, 0));
}

#[test]
fn triangles_without_area_go_but_close_what_they_close() {
    let mut mesh = tetrahedron();
    // A sliver between an edge of the first triangle and its two halves.
    mesh.positions.push(0.5 * (DVec3::X + DVec3::Y));
    mesh.triangles.splice(0..1, [[1, 4, 3], [4, 2, 3], [1, 2, 4], [3, 3, 2]]);
    mesh.normals = Some(CornerNormals {
        values: vec![Vec3::Z; 5],
        corners: Some(mesh.triangles.iter().map(|&[a, ..]| [a, 0, 0]).collect()),
    });
    let (mesh, warnings) = prepared(mesh);
    assert_eq!(warnings, [MeshWarning::Degenerate { dropped: 2 }]);
    assert_eq!(mesh.triangles[..3], [[1, 4, 3], [4, 2, 3], [0, 3, 2]]);
    let corners = mesh.normals.unwrap().corners.unwrap();
    assert_eq!(corners.iter().map(|c| c[0]).collect::<Vec<_>>(), [1, 4, 0, 0, 0]);
    assert_eq!(mesh.interfaces.unwrap().len(), 5);
}

#[test]
fn triangles_between_equal_regions_go() {
    let mut mesh = tetrahedron();
    mesh.triangles.push([1, 2, 3]);
    mesh.interfaces = Some([vec![interface(0, 1); 4], vec![interface(5, 5)]].concat());
    let (mesh, warnings) = prepared(mesh);
    assert_eq!(mesh.triangles.len(), 4);
    assert_eq!(warnings, [MeshWarning::SameRegion { dropped: 1, region: Region(5) }]);
}

#[test]
fn contradicting_labels_warn() {
    let mut mesh = tetrahedron();
    mesh.interfaces = Some(vec![interface(0, 1), interface(0, 2), interface(0, 1), interface(0, 1)]);
    let (_, warnings) = prepared(mesh);
    let first = [DVec3::ZERO, DVec3::Y];
    assert_eq!(warnings, [MeshWarning::Inconsistent { edges: 3, first }]);
}

#[test]
fn an_empty_mesh_is_no_error() {
    let (mesh, warnings) = prepared(RawMesh::default());
    assert_eq!(mesh.interfaces, Some(vec![]));
    assert_eq!(warnings, [MeshWarning::Empty]);
}

#[test]
fn meshes_that_do_not_fit_together_are_refused() {
    let broken: [fn(&mut RawMesh); 4] = [
        |mesh| mesh.positions[0].x = f64::NAN,
        |mesh| mesh.triangles[0][2] = 4,
        |mesh| mesh.interfaces = Some(vec![]),
        |mesh| mesh.normals = Some(CornerNormals { values: vec![Vec3::Z], corners: None }),
    ];
    for breaking in broken {
        let mut mesh = tetrahedron();
        breaking(&mut mesh);
        let error = prepare(mesh, Region(1), Path::new("m.obj")).unwrap_err();
        assert!(error.to_string().starts_with("m.obj: "), "{error}");
    }
}

#[test]
fn an_outside_within_the_others_is_told() {
    let with = |front, back| RawMesh { interfaces: Some(vec![interface(front, back); 4]), ..tetrahedron() };
    assert_eq!(prepared(with(1, 0)).1, [MeshWarning::OutsideWithin]);
    // Of a surface between two others, or with a hole, nothing follows.
    assert_eq!(prepared(with(2, 1)).1, []);
    let mut open = with(1, 0);
    open.retain_triangles(&[true, true, true, false]);
    assert!(!prepared(open).1.contains(&MeshWarning::OutsideWithin));
}

/// Closed surfaces that touch have no boundary there, whether the file says so or not; opaque sheets have two sides.
#[test]
fn faces_on_each_other_that_look_apart_are_no_boundary_but_may_be_sheets() {
    let mut sheet = tetrahedron();
    sheet.triangles = vec![[0, 1, 2], [0, 2, 1]];
    let (mesh, warnings) = prepared(sheet.clone());
    assert_eq!((mesh.triangles.len(), &warnings[0]), (0, &MeshWarning::Coincident { dropped: 2 }));
    let (mesh, _) = prepare_sheets(sheet, Path::new("mesh.ply")).unwrap();
    assert_eq!(mesh.triangles.len(), 2);
}
