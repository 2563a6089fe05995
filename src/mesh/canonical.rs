//! Forms of a mesh that do not depend on the order in which its file lists things.

use super::{Interface, RawMesh};

/// The same surface with its vertices in the order of their positions and its triangles, each begun at its least
/// vertex, in the order of these. Unused vertices, normals and velocities are left out.
///
/// Two files of one surface have the same canonical mesh unless vertices coincide; weld such meshes first.
pub fn canonical(mesh: &RawMesh) -> RawMesh {
    let mut used = vec![false; mesh.positions.len()];
    for &index in mesh.triangles.iter().flatten() {
        used[index as usize] = true;
    }
    // Adding 0 turns -0 into 0.
    let position = |index: u32| mesh.positions[index as usize] + glam::DVec3::ZERO;
    let mut order: Vec<u32> = (0..mesh.positions.len() as u32).filter(|&v| used[v as usize]).collect();
    order.sort_by(|&a, &b| {
        let (a, b) = (position(a), position(b));
        a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z))
    });
    let mut new_index = vec![0; mesh.positions.len()];
    for (new, &old) in order.iter().enumerate() {
        new_index[old as usize] = new as u32;
    }
    let renumbered = |triangle: &[u32; 3]| least_first(triangle.map(|index| new_index[index as usize]));
    let interface = |triangle: usize| mesh.interfaces.as_ref().map(|interfaces| interfaces[triangle]);
    let mut faces: Vec<([u32; 3], Option<Interface>)> =
        mesh.triangles.iter().enumerate().map(|(t, triangle)| (renumbered(triangle), interface(t))).collect();
    faces.sort_unstable();
    RawMesh {
        positions: order.iter().map(|&index| position(index)).collect(),
        triangles: faces.iter().map(|face| face.0).collect(),
        interfaces: mesh.interfaces.as_ref().map(|_| faces.iter().filter_map(|face| face.1).collect()),
        normals: None,
        velocities: None,
    }
}

/// The same oriented triangle, begun at its least vertex.
pub(crate) fn least_first([a, b, c]: [u32; 3]) -> [u32; 3] {
    if a <= b && a <= c {
        [a, b, c]
    } else if b <= c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;
    use crate::mesh::Region;

    /// A closed fan of `n` triangles around the origin, the interface of triangle t being (t, t + 1).
    fn fan(n: u32) -> RawMesh {
        let ring = (0..n).map(|k| DVec3::new(f64::from(k), f64::from(k * k % 7), 1.0));
        RawMesh {
            positions: std::iter::once(DVec3::ZERO).chain(ring).collect(),
            triangles: (0..n).map(|k| [0, 1 + k, 1 + (k + 1) % n]).collect(),
            interfaces: Some(
                (0..n as i32).map(|t| Interface { front: Region(t), back: Region(t + 1) }).collect(),
            ),
            normals: None,
            velocities: None,
        }
    }

    /// The same fan with vertices, triangles and first corners moved on by an amount.
    fn shifted(mesh: &RawMesh, by: usize) -> RawMesh {
        let (vertices, faces) = (mesh.positions.len(), mesh.triangles.len());
        let mut moved = mesh.clone();
        moved.positions.rotate_right(by % vertices);
        for triangle in &mut moved.triangles {
            *triangle = triangle.map(|index| ((index as usize + by) % vertices) as u32);
            triangle.rotate_left(by % 3);
        }
        moved.triangles.rotate_left(by % faces);
        moved.interfaces.as_mut().unwrap().rotate_left(by % faces);
        moved
    }

    proptest! {
        #[test]
        fn the_order_of_a_file_does_not_matter(n in 3..12_u32, by in 0..100_usize) {
            let mesh = fan(n);
            let moved = shifted(&mesh, by);
            prop_assert_eq!(canonical(&moved), canonical(&mesh));
            prop_assert_eq!(canonical(&mesh), canonical(&canonical(&mesh)));
        }
    }

    #[test]
    fn winding_labels_and_positions_matter() {
        let mesh = fan(5);
        let mut turned = mesh.clone();
        turned.triangles[2].swap(1, 2);
        assert_ne!(canonical(&turned), canonical(&mesh));
        let mut relabelled = mesh.clone();
        relabelled.interfaces.as_mut().unwrap()[2].front = Region(9);
        assert_ne!(canonical(&relabelled), canonical(&mesh));
        let mut moved = mesh.clone();
        moved.positions[3].z += 1e-12;
        assert_ne!(canonical(&moved), canonical(&mesh));
    }
}
