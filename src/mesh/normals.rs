//! Shading normals at the corners of triangles: averaged over smooth stretches of one surface, or the file's.
//!
//! ```text
//! n = normalised sum over the corners c of a class of  angle(c) * n_face(c)
//! ```
//! Weighting by the angle at the corner makes the normal independent of how the faces around a vertex are cut
//! into triangles. A class holds corners that are connected across ordinary edges: exactly two triangles of the
//! same group, traversing the edge in opposite directions. So nothing is averaged across a triple line (one
//! triangle a group), where a surface touches itself (four of one group), or where the caller changes the group.
//!
//! Two neighbours of the same regions may differ in winding *and* have front and back exchanged; they are the
//! same surface. Everything is therefore summed as if the normal pointed into the lesser label, and the sign is
//! put back for the corners of triangles that are the other way round.
//!
//! Normals are on the front side of their triangle. Degenerate triangles add nothing; their corners take the
//! normal of their class. On a smooth surface the error is of second order in the edge length where the mesh is
//! even, and of first order along lines where the shape of its triangles changes (both tested on a sphere). Time
//! is linear but for sorting the edges at each vertex.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::corner_classes::corner_classes;
use super::{CornerNormals, Interface, RawMesh};

/// Below this part of the sum of its weights a sum of unit normals is rounding noise.
const CANCELLED: f64 = 1e-9;

/// Triangles whose normals and angles are computed at a time, on all threads; they are summed in order.
const BLOCK: usize = 1 << 16;

/// One number a triangle, equal for triangles that may share normals: same two regions, same wall.
///
/// `walls` tells faces on different walls of the domain apart (any numbers); triangles past its end are on
/// wall 0. Without interfaces every triangle of a wall is in one group: pass an empty slice.
pub fn group_keys(triangle_count: usize, interfaces: &[Interface], walls: &[u32]) -> Vec<u32> {
    let mut numbers = BTreeMap::new();
    let mut last = None;
    (0..triangle_count)
        .map(|i| {
            let pair = interfaces.get(i).map(|f| (f.front.min(f.back), f.front.max(f.back)));
            let key = (pair, walls.get(i).copied().unwrap_or(0));
            match last {
                Some((previous, number)) if previous == key => number,
                _ => {
                    let next = numbers.len() as u32;
                    let number = *numbers.entry(key).or_insert(next);
                    last = Some((key, number));
                    number
                }
            }
        })
        .collect()
}

/// Angle-weighted normals, smooth within each group (one key a triangle, see [`group_keys`]).
///
/// All values have unit length. Where the faces around a corner cancel, it takes its face's normal; a corner
/// whose face has none either gets +z.
pub fn smooth(mesh: &RawMesh, group: &[u32]) -> CornerNormals {
    let (classes, class_count) = corner_classes(mesh, group);
    let mut sums = vec![(DVec3::ZERO, 0.0); class_count];
    let mut block = Vec::new();
    for first in (0..mesh.triangles.len()).step_by(BLOCK) {
        let triangles = first..mesh.triangles.len().min(first + BLOCK);
        triangles.into_par_iter().map(|i| weighted_normal(mesh, i)).collect_into_vec(&mut block);
        for (i, (normal, angles)) in (first..).zip(&block) {
            for (k, angle) in angles.iter().enumerate() {
                let sum = &mut sums[classes[3 * i + k] as usize];
                sum.0 += *angle * *normal;
                sum.1 += angle;
            }
        }
    }
    indexed(mesh, &classes, &sums)
}

/// The file's normals where they are finite, not zero and on the front side of their triangle; the
/// [`smooth`] normal of the corner elsewhere. Also the number of corners that do not have the file's normal.
///
/// All values have unit length. A degenerate triangle has no front side and takes any finite normal.
pub fn checked_file_normals(mesh: &RawMesh, group: &[u32]) -> (CornerNormals, usize) {
    let smooth = smooth(mesh, group);
    let Some(file) = &mesh.normals else {
        return (smooth, 3 * mesh.triangles.len());
    };
    let smooth_corners = smooth.corners.unwrap_or_default();

    let mut values = Vec::new();
    let mut from_file = vec![None; file.values.len()];
    let mut from_smooth = vec![None; smooth.values.len()];
    let mut replaced = 0;
    let mut place = |slot: &mut Option<u32>, value: Vec3| {
        *slot.get_or_insert_with(|| {
            values.push(value);
            values.len() as u32 - 1
        })
    };
    let mut corners = Vec::with_capacity(mesh.triangles.len());
    for (i, triangle) in mesh.triangles.iter().enumerate() {
        let face = face_normal(mesh, triangle);
        let indices = match &file.corners {
            Some(corners) => corners.get(i).copied().unwrap_or([u32::MAX; 3]),
            None => *triangle,
        };
        corners.push(std::array::from_fn(|k| {
            let index = indices[k] as usize;
            let given = file.values.get(index).and_then(|&value| unit(value.as_dvec3()));
            match given.filter(|normal| face.is_none_or(|face| normal.dot(face) > 0.0)) {
                Some(normal) => place(&mut from_file[index], normal.as_vec3()),
                None => {
                    replaced += 1;
                    let index = smooth_corners[i][k] as usize;
                    place(&mut from_smooth[index], smooth.values[index])
                }
            }
        }));
    }
    (CornerNormals { values, corners: Some(corners) }, replaced)
}

/// One value a class and sign, and the index of each corner's value.
fn indexed(mesh: &RawMesh, classes: &[u32], sums: &[(DVec3, f64)]) -> CornerNormals {
    let normals: Vec<Option<DVec3>> = sums
        .iter()
        .map(|&(sum, weight)| unit(sum).filter(|_| sum.length_squared() > (CANCELLED * weight).powi(2)))
        .collect();
    let mut values = Vec::with_capacity(sums.len());
    let mut push = |normal: DVec3| {
        values.push(normal.as_vec3());
        values.len() as u32 - 1
    };
    let mut slots = vec![[None; 2]; sums.len()];
    let mut corners = Vec::with_capacity(mesh.triangles.len());
    for (i, triangle) in mesh.triangles.iter().enumerate() {
        let reversed = is_reversed(mesh, i);
        let mut own = None;
        corners.push(std::array::from_fn(|k| {
            let class = classes[3 * i + k] as usize;
            match normals[class] {
                Some(normal) => *slots[class][usize::from(reversed)]
                    .get_or_insert_with(|| push(if reversed { -normal } else { normal })),
                None => *own.get_or_insert_with(|| push(face_normal(mesh, triangle).unwrap_or(DVec3::Z))),
            }
        }));
    }
    CornerNormals { values, corners: Some(corners) }
}

/// True when the triangle's normal points into the greater label.
pub(super) fn is_reversed(mesh: &RawMesh, triangle: usize) -> bool {
    mesh.interfaces.as_ref().and_then(|all| all.get(triangle)).is_some_and(|face| face.front > face.back)
}

/// The unit right-hand normal; `None` for a degenerate triangle.
fn face_normal(mesh: &RawMesh, triangle: &[u32; 3]) -> Option<DVec3> {
    let [a, b, c] = triangle.map(|index| mesh.positions[index as usize]);
    // Scaled to the longer edge, the product neither overflows nor underflows.
    let (u, v) = (b - a, c - a);
    let scale = u.abs().max_element().max(v.abs().max_element());
    if scale > 0.0 && scale.is_finite() { unit((u / scale).cross(v / scale)) } else { None }
}

/// The unit normal of a triangle into the lesser label and its angles in radians; zeros for a degenerate triangle.
fn weighted_normal(mesh: &RawMesh, triangle: usize) -> (DVec3, [f64; 3]) {
    let Some(normal) = face_normal(mesh, &mesh.triangles[triangle]) else { return (DVec3::ZERO, [0.0; 3]) };
    let [a, b, c] = mesh.triangles[triangle].map(|index| mesh.positions[index as usize]);
    let edges = [unit(b - a), unit(c - b), unit(a - c)];
    let angle = |k: usize| match (edges[k], edges[(k + 2) % 3]) {
        (Some(leaving), Some(arriving)) => {
            libm::atan2(leaving.cross(arriving).length(), -leaving.dot(arriving))
        }
        _ => 0.0,
    };
    (if is_reversed(mesh, triangle) { -normal } else { normal }, [angle(0), angle(1), angle(2)])
}

/// `v` at unit length; `None` when it is zero or not finite.
fn unit(v: DVec3) -> Option<DVec3> {
    let scale = v.abs().max_element();
    if !(v.is_finite() && scale > 0.0) {
        return None;
    }
    let scaled = v / scale;
    Some(scaled / scaled.length())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::mesh::Region;

    fn interface(front: i32, back: i32) -> Interface {
        Interface { front: Region(front), back: Region(back) }
    }

    fn mesh(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>, interfaces: Vec<Interface>) -> RawMesh {
        RawMesh { positions, triangles, interfaces: Some(interfaces), normals: None, velocities: None }
    }

    fn keys(mesh: &RawMesh) -> Vec<u32> {
        group_keys(mesh.triangles.len(), mesh.interfaces.as_deref().unwrap_or_default(), &[])
    }

    fn smooth_by_labels(mesh: &RawMesh) -> CornerNormals {
        smooth(mesh, &keys(mesh))
    }

    fn at(normals: &CornerNormals, triangle: usize, corner: usize) -> DVec3 {
        normals.values[normals.corners.as_ref().unwrap()[triangle][corner] as usize].as_dvec3()
    }

    /// A unit sphere: an octahedron whose triangles are cut into four `levels` times.
    fn sphere(levels: u32) -> RawMesh {
        let mut positions = vec![DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z];
        let mut triangles: Vec<[u32; 3]> =
            vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
        for _ in 0..levels {
            let mut middles = BTreeMap::new();
            let mut middle = |a: u32, b: u32| {
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    positions.push((positions[a as usize] + positions[b as usize]).normalize());
                    positions.len() as u32 - 1
                })
            };
            let cut = |t: [u32; 3]| {
                let [ab, bc, ca] = [middle(t[0], t[1]), middle(t[1], t[2]), middle(t[2], t[0])];
                [[t[0], ab, ca], [ab, t[1], bc], [ca, bc, t[2]], [ab, bc, ca]]
            };
            triangles = triangles.into_iter().flat_map(cut).collect();
        }
        let interfaces = vec![interface(0, 1); triangles.len()];
        mesh(positions, triangles, interfaces)
    }

    /// Largest distance between a corner's normal and that of the sphere at its vertex.
    fn sphere_error(mesh: &RawMesh, normals: &CornerNormals) -> f64 {
        let error = |i: usize, k: usize| {
            let exact = mesh.positions[mesh.triangles[i][k] as usize];
            at(normals, i, k).distance(exact)
        };
        (0..mesh.triangles.len())
            .flat_map(|i| (0..3).map(move |k| (i, k)))
            .fold(0.0, |m, (i, k)| m.max(error(i, k)))
    }

    #[test]
    fn the_error_on_a_sphere_is_of_first_order_along_the_lines_of_the_octahedron() {
        let errors = [3, 4, 5].map(|levels| {
            let mesh = sphere(levels);
            let normals = smooth_by_labels(&mesh);
            assert_eq!(normals.values.len(), mesh.positions.len(), "one class a vertex");
            sphere_error(&mesh, &normals)
        });
        assert!(errors[0] < 0.021, "1.2 degrees, as an independent computation has it: {errors:?}");
        for pair in errors.windows(2) {
            assert!((1.9..2.1).contains(&(pair[0] / pair[1])), "{errors:?}");
        }
    }

    /// The part of the unit sphere over the upper face of a cube, as a regular grid of n x n squares.
    fn sphere_over_square(n: u32) -> RawMesh {
        let at = |i: u32| 2.0 * f64::from(i) / f64::from(n) - 1.0;
        let row = n + 1;
        let positions =
            (0..row * row).map(|i| DVec3::new(at(i % row), at(i / row), 1.0).normalize()).collect();
        let corners = (0..n * n).map(|i| i / n * row + i % n);
        let triangles: Vec<[u32; 3]> =
            corners.flat_map(|i| [[i, i + 1, i + row + 1], [i, i + row + 1, i + row]]).collect();
        let interfaces = vec![interface(0, 1); triangles.len()];
        mesh(positions, triangles, interfaces)
    }

    #[test]
    fn the_error_on_an_even_mesh_is_of_second_order() {
        let errors = [16_u32, 32, 64].map(|n| {
            let mesh = sphere_over_square(n);
            let normals = smooth_by_labels(&mesh);
            // Vertices at the border have half of their triangles only.
            let is_inside = |v: u32| (1..n).contains(&(v % (n + 1))) && (1..n).contains(&(v / (n + 1)));
            let mut worst = 0.0_f64;
            for (i, triangle) in mesh.triangles.iter().enumerate() {
                for k in (0..3).filter(|&k| is_inside(triangle[k])) {
                    worst = worst.max(at(&normals, i, k).distance(mesh.positions[triangle[k] as usize]));
                }
            }
            worst
        });
        // Halving the edges quarters the error up to higher orders.
        for pair in errors.windows(2) {
            assert!((3.8..4.2).contains(&(pair[0] / pair[1])), "{errors:?}");
        }
    }

    #[test]
    fn exchanged_labels_with_exchanged_winding_are_the_same_surface() {
        let plain = sphere(3);
        let expected = smooth_by_labels(&plain);
        let mut mixed = plain.clone();
        for i in (0..mixed.triangles.len()).filter(|i| i % 3 == 0) {
            mixed.triangles[i].swap(1, 2);
            mixed.interfaces.as_mut().unwrap()[i] = interface(1, 0);
        }
        let found = smooth_by_labels(&mixed);
        for i in 0..plain.triangles.len() {
            for k in 0..3 {
                let (sign, l) = if i % 3 == 0 { (-1.0, [0, 2, 1][k]) } else { (1.0, k) };
                // Both sum the same terms; the order in which a corner's angle takes its edges differs.
                assert!(at(&found, i, l).distance(sign * at(&expected, i, k)) < 1e-6);
            }
        }
    }

    #[test]
    fn faces_of_a_cube_in_groups_of_their_own_are_flat() {
        let positions =
            (0..8).map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2))).collect();
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles: Vec<[u32; 3]> =
            quads.iter().flat_map(|q: &[u32; 4]| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
        let cube = mesh(positions, triangles, vec![interface(0, 1); 12]);
        let walls: Vec<u32> = (0..12).map(|i| i / 2).collect();
        let flat = smooth(&cube, &group_keys(12, cube.interfaces.as_ref().unwrap(), &walls));
        // In each face, corners are joined across the diagonal only: four classes.
        assert_eq!(flat.values.len(), 6 * 4);
        for i in 0..12 {
            let face = face_normal(&cube, &cube.triangles[i]).unwrap();
            for k in 0..3 {
                assert_eq!(at(&flat, i, k), face);
            }
        }
        // In one group every corner has the mean of three perpendicular faces of the same total angle.
        let round = smooth_by_labels(&cube);
        assert_eq!(round.values.len(), 8);
        for i in 0..12 {
            for k in 0..3 {
                let out = (cube.positions[cube.triangles[i][k] as usize] - 0.5).normalize();
                assert!(at(&round, i, k).distance(out) < 1e-6);
            }
        }
    }

    /// Three half planes that meet in the z axis, two triangles each, with the labels of the regions between.
    fn triple_line(labels: [Interface; 3]) -> RawMesh {
        let mut positions = vec![DVec3::ZERO, DVec3::Z];
        let mut triangles = Vec::new();
        for sheet in 0..3_u32 {
            let (sine, cosine) = (2.1 * f64::from(sheet)).sin_cos();
            let out = DVec3::new(cosine, sine, 0.0);
            positions.extend([out, out + DVec3::Z]);
            let near = 2 + 2 * sheet;
            triangles.extend([[0, near, near + 1], [0, near + 1, 1]]);
        }
        mesh(positions, triangles, labels.iter().flat_map(|&label| [label; 2]).collect())
    }

    #[test]
    fn nothing_crosses_a_triple_line_or_a_self_contact() {
        let triple = triple_line([interface(0, 1), interface(1, 2), interface(2, 0)]);
        // Two sheets of the same labels go on from each other; the third stays on its own.
        let passing = triple_line([interface(0, 1), interface(1, 0), interface(1, 2)]);
        // Four sheets of the same labels: two wedges of one region that touch in a line.
        let mut contact = triple_line([interface(0, 1), interface(1, 0), interface(0, 1)]);
        contact.positions.extend([DVec3::new(0.6, -0.8, 0.0), DVec3::new(0.6, -0.8, 1.0)]);
        contact.triangles.extend([[0, 8, 9], [0, 9, 1]]);
        contact.interfaces.as_mut().unwrap().extend([interface(1, 0); 2]);
        for (mesh, joined) in [(triple, 0), (passing, 2), (contact, 0)] {
            let normals = smooth_by_labels(&mesh);
            for i in 0..mesh.triangles.len() {
                let face = face_normal(&mesh, &mesh.triangles[i]).unwrap();
                let is_flat = (0..3).all(|k| at(&normals, i, k).distance(face) < 1e-6);
                assert_eq!(is_flat, i / 2 >= joined, "triangle {i}");
            }
        }
    }

    #[test]
    fn normals_of_the_file_that_cannot_be_right_are_replaced() {
        let mut mesh = sphere(2);
        let exact: Vec<Vec3> = mesh.positions.iter().map(|p| 2.0 * p.as_vec3()).collect();
        let bad = [Vec3::NAN, Vec3::ZERO, -exact[2], Vec3::new(f32::INFINITY, 0.0, 0.0)];
        let mut values = exact.clone();
        values[..4].copy_from_slice(&bad);
        mesh.normals = Some(CornerNormals { values, corners: None });
        let (normals, replaced) = checked_file_normals(&mesh, &keys(&mesh));
        // The first six vertices are those of the octahedron, where four triangles meet.
        assert_eq!(replaced, 4 * 4);
        assert_eq!(normals.values.len(), mesh.positions.len());
        assert!(sphere_error(&mesh, &normals) < 1e-6);

        mesh.normals = None;
        let (normals, replaced) = checked_file_normals(&mesh, &keys(&mesh));
        assert_eq!(replaced, 3 * mesh.triangles.len());
        assert_eq!(normals, smooth_by_labels(&mesh));
    }

    #[test]
    fn a_mesh_of_nothing_has_no_normals() {
        let (normals, replaced) = checked_file_normals(&RawMesh::default(), &[]);
        assert_eq!((normals.values.len(), normals.corners, replaced), (0, Some(Vec::new()), 0));
    }

    proptest! {
        #[test]
        fn any_soup_gets_unit_normals(
            points in prop::collection::vec(prop::array::uniform3(-2_i8..3), 1..12),
            faces in prop::collection::vec((prop::array::uniform3(0_u32..12), 0..3, 0..3), 0..60),
            exponent in -200_i32..200,
            given in prop::collection::vec(prop::array::uniform3(prop_oneof![
                -1.0_f32..1.0, Just(0.0), Just(f32::NAN), Just(f32::INFINITY), Just(f32::MIN_POSITIVE)
            ]), 0..14),
        ) {
            let scale = 10_f64.powi(exponent);
            let positions: Vec<DVec3> =
                points.iter().map(|p| scale * DVec3::from_array(p.map(f64::from))).collect();
            let triangles = faces.iter().map(|f| f.0.map(|i| i % positions.len() as u32)).collect();
            let interfaces = faces.iter().map(|f| interface(f.1, f.2)).collect();
            let mut mesh = mesh(positions, triangles, interfaces);
            mesh.normals = Some(CornerNormals {
                values: given.into_iter().map(Vec3::from_array).collect(),
                corners: None,
            });
            for normals in [smooth_by_labels(&mesh), checked_file_normals(&mesh, &keys(&mesh)).0] {
                prop_assert_eq!(normals.corners.as_ref().map(Vec::len), Some(mesh.triangles.len()));
                for value in &normals.values {
                    prop_assert!((value.length() - 1.0).abs() < 1e-6, "{}", value);
                }
            }
        }
    }
}
