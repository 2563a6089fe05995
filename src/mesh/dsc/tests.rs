use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::mesh::canonical::canonical;
use crate::mesh::topology::topology;
use crate::mesh::{Interface, Region};

fn read_text(text: &str) -> RawMesh {
    read(text.as_bytes()).unwrap()
}

/// Whether every triangle's normal points into its front, where `inside` tells the label at a point.
fn points_into_front(mesh: &RawMesh, step: f64, label: impl Fn(DVec3) -> i32) -> bool {
    mesh.triangles.iter().zip(mesh.interfaces.as_ref().unwrap()).all(|(triangle, interface)| {
        let [a, b, c] = triangle.map(|index| mesh.positions[index as usize]);
        let (centre, normal) = ((a + b + c) / 3.0, (b - a).cross(c - a).normalize());
        let sides = (label(centre + step * normal), label(centre - step * normal));
        sides == (interface.front.0, interface.back.0)
    })
}

/// A block of n^3 unit cubes of six tetrahedra each; labels by cube, vertex orders mixed.
fn block(n: usize, label: impl Fn(usize, usize, usize) -> i32, turn: impl Fn(usize) -> usize) -> String {
    let mut text = String::new();
    let vertex = |[x, y, z]: [usize; 3]| (x * (n + 1) + y) * (n + 1) + z;
    let mut count = 0;
    for cube in 0..n * n * n {
        let (x, y, z) = (cube / (n * n), cube / n % n, cube % n);
        for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let mut corner = [x, y, z];
            let mut tetrahedron = vec![vertex(corner)];
            for axis in order {
                corner[axis] += 1;
                tetrahedron.push(vertex(corner));
            }
            let turned = turn(count);
            tetrahedron.rotate_left(turned % 4);
            tetrahedron.swap(turned / 4 % 4, 3);
            count += 1;
            let [a, b, c, d] = tetrahedron[..] else { unreachable!() };
            text += &format!("t {a} {b} {c} {d} {}\n", label(x, y, z));
        }
    }
    for x in 0..=n {
        for y in 0..=n {
            for z in 0..=n {
                text += &format!("v {x} {y} {z}\n");
            }
        }
    }
    text
}

#[test]
fn a_block_of_three_phases_is_closed_and_looks_the_right_way() {
    let label_of = |x: usize, y: usize, z: usize| [0, 1, 2, 1][(x + 2 * y + 3 * z) % 4];
    let mesh = read_text(&block(3, label_of, |t| t * 7));
    let label = |p: DVec3| match p.floor().to_array() {
        [x, y, z] if [x, y, z].iter().all(|&c| (0.0..3.0).contains(&c)) => {
            label_of(x as usize, y as usize, z as usize)
        }
        _ => 0,
    };
    // Interface triangles are on the faces of unit cubes; a step of 0.1 stays within the next cube.
    assert!(points_into_front(&mesh, 0.1, label));
    let report = topology(&mesh);
    assert_eq!((report.open_edges, report.inconsistent_edges, report.duplicate_triangles), (0, 0, 0));
    assert!(report.non_manifold_edges > 0);
}

proptest! {
    #[test]
    fn vertex_order_does_not_matter(turns in prop::collection::vec(0..16_usize, 48)) {
        let label = |x, y, z| i32::from(x + y + z == 1);
        let expected = canonical(&read_text(&block(2, label, |_| 0)));
        let mesh = read_text(&block(2, label, |t| turns[t]));
        prop_assert_eq!(canonical(&mesh), expected);
    }
}

const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\n";

#[test]
fn negative_labels_are_regions_below_the_outside() {
    let mesh = read_text(&format!("{CORNERS}t 0 1 2 3 -4\n"));
    let interfaces = mesh.interfaces.as_ref().unwrap();
    assert_eq!(interfaces[..], [Interface { front: Region(-4), back: Region::OUTSIDE }; 4]);
    assert!(points_into_front(&mesh, 0.05, |p| {
        if p.min_element() > 0.0 && p.element_sum() < 1.0 { -4 } else { 0 }
    }));
}

#[test]
fn the_shell_is_outside() {
    assert_eq!(
        read_text(&format!("{CORNERS}t 0 1 2 3 999\n")),
        read_text(&format!("{CORNERS}t 0 1 2 3 0\n"))
    );
    let shelled = read_text(&format!("{CORNERS}t 0 1 2 3 2\nt 1 2 3 4 999\n"));
    let aired = read_text(&format!("{CORNERS}t 0 1 2 3 2\nt 1 2 3 4 0\n"));
    let alone = read_text(&format!("{CORNERS}t 0 1 2 3 2\n"));
    assert_eq!(shelled, aired);
    assert_eq!(canonical(&shelled), canonical(&alone));
}

#[test]
fn unused_vertices_are_left_out() {
    let mesh = read_text(&format!("{CORNERS}t 1 2 3 4 1\n"));
    assert_eq!(mesh.positions, [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE]);
}

#[test]
fn a_repeated_last_tetrahedron_is_dropped() {
    let once = format!("{CORNERS}t 0 1 2 3 1\nt 1 2 3 4 2\n");
    assert_eq!(read_text(&format!("{once}t 1 2 3 4 2\n")), read_text(&once));
}

/// Four vertices in the plane z = 0 make a flat tetrahedron on the floor of two proper ones above it.
#[test]
fn flat_tetrahedra_take_their_sides_from_their_neighbours() {
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\n\
                t 0 1 2 4 1\nt 0 2 3 4 1\nt 0 1 2 3 1\n";
    let mesh = read_text(text);
    let in_pyramid = |p: DVec3| p.z > 0.0 && (p.truncate() - 0.5).abs().max_element() < 0.5 * (1.0 - p.z);
    assert!(points_into_front(&mesh, 0.01, |p| i32::from(in_pyramid(p))));
    let report = topology(&mesh);
    assert_eq!((report.open_edges, report.inconsistent_edges), (0, 0));
    assert_eq!(mesh.triangles.len(), 6);
    // In the other order of the flat one's vertices, and with a label of its own.
    assert_eq!(canonical(&read_text(&text.replace("t 0 1 2 3", "t 1 0 2 3"))), canonical(&mesh));
    let other = read_text(&text.replace("t 0 1 2 3 1", "t 0 1 2 3 2"));
    assert_eq!(topology(&other).inconsistent_edges, 0);
}
