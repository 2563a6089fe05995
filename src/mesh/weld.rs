//! Joins vertices of the same position.

use glam::DVec3;

use super::prepare::retain_marked;
use super::{CornerNormals, RawMesh};

/// Joins all vertices whose positions have the same bits (0 and -0 count as the same), keeping the order of
/// their first occurrence. Normals that vertices carried stay with the corners; the first one's velocity is that of all.
pub fn weld(mesh: &mut RawMesh) {
    let new_index = merged_indices(&mesh.positions);
    if new_index.iter().enumerate().all(|(old, &new)| old == new as usize) {
        return;
    }
    if let Some(CornerNormals { corners: corners @ None, .. }) = &mut mesh.normals {
        *corners = Some(mesh.triangles.clone());
    }
    // The first occurrence of each new index comes in the order of these.
    let mut next = 0;
    let is_first: Vec<bool> = new_index
        .iter()
        .map(|&new| {
            let first = new == next;
            next += u32::from(first);
            first
        })
        .collect();
    retain_marked(&mut mesh.positions, &is_first);
    if let Some(velocities) = &mut mesh.velocities {
        retain_marked(velocities, &is_first);
    }
    for index in mesh.triangles.iter_mut().flatten() {
        *index = new_index[*index as usize];
    }
}

/// The new index of each vertex.
fn merged_indices(positions: &[DVec3]) -> Vec<u32> {
    // Adding 0 turns -0 into 0.
    let bits = |index: u32| (positions[index as usize] + DVec3::ZERO).to_array().map(f64::to_bits);
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    order.sort_unstable_by_key(|&index| (bits(index), index));
    let mut first = vec![0; positions.len()];
    for group in order.chunk_by(|&a, &b| bits(a) == bits(b)) {
        for &index in group {
            first[index as usize] = group[0];
        }
    }
    let mut count = 0;
    let mut new_index = first;
    for old in 0..new_index.len() {
        new_index[old] = if new_index[old] as usize == old {
            count += 1;
            count - 1
        } else {
            // The first occurrence lies before this one and has its new index already.
            new_index[new_index[old] as usize]
        };
    }
    new_index
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use proptest::prelude::*;

    use super::*;

    fn soup(corners: &[DVec3]) -> RawMesh {
        let count = corners.len() as u32 / 3;
        RawMesh {
            positions: corners.to_vec(),
            triangles: (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
            ..Default::default()
        }
    }

    #[test]
    fn a_soup_shares_its_vertices_and_keeps_its_normals() {
        let (o, x, y) = (DVec3::ZERO, DVec3::X, DVec3::Y);
        let mut mesh = soup(&[o, x, y, x, x + y, DVec3::new(-0.0, 1.0, 0.0)]);
        let values: Vec<Vec3> = (0..6).map(|k| Vec3::splat(k as f32)).collect();
        mesh.normals = Some(CornerNormals { values: values.clone(), corners: None });
        mesh.velocities = Some(values.clone());
        weld(&mut mesh);
        assert_eq!(mesh.positions, [o, x, y, x + y]);
        assert_eq!(mesh.triangles, [[0, 1, 2], [1, 3, 2]]);
        assert_eq!(mesh.velocities, Some(vec![values[0], values[1], values[2], values[4]]));
        let corners = Some(vec![[0, 1, 2], [3, 4, 5]]);
        assert_eq!(mesh.normals, Some(CornerNormals { values, corners }));
    }

    proptest! {
        #[test]
        fn corners_stay_where_they_are(codes in prop::collection::vec(0..27_u32, 0..60)) {
            let corners: Vec<DVec3> = codes[..codes.len() / 3 * 3].iter()
                .map(|&c| DVec3::new(f64::from(c % 3), f64::from(c / 3 % 3), f64::from(c / 9)))
                .collect();
            let mut mesh = soup(&corners);
            weld(&mut mesh);
            let after: Vec<DVec3> =
                mesh.triangles.iter().flatten().map(|&index| mesh.positions[index as usize]).collect();
            prop_assert_eq!(after, corners);
            let again = mesh.clone();
            weld(&mut mesh);
            prop_assert_eq!(mesh, again);
        }
    }
}
