//! Triangles that lie exactly on each other: one boundary instead of two.
//!
//! Programs that write each phase as a closed surface of its own, or a face once for each of its owners, leave faces
//! of the same three points behind. A ray cannot tell which of them it meets first. With the labels seen from one side
//! ```text
//! (a|b) and (a|b)   are (a|b)      a face written twice
//! (a|b) and (b|c)   are (a|c)      a layer b of no thickness
//! (a|b) and (b|a)   are nothing    a body a or b of no thickness
//! ```
//! Anything else contradicts itself and is left to the count of mismatches. Positions are compared bit by bit.

use glam::DVec3;

use super::{Interface, RawMesh};

/// What becomes of two triangles on the same points that are wound against each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Twins {
    /// They are one boundary, or none, as their labels say.
    Joined,
    /// They stay: opaque sheets may well be written from both sides.
    Kept,
}

/// Joins triangles of the same three points; tells how many are gone.
pub(super) fn merge_coincident(mesh: &mut RawMesh, twins: Twins) -> usize {
    let Some(mut interfaces) = mesh.interfaces.take() else { return 0 };
    let mut kept = vec![true; mesh.triangles.len()];
    for group in groups(mesh) {
        for (place, &first) in group.iter().enumerate() {
            for &other in &group[place + 1..] {
                let turned = winding(mesh, first) != winding(mesh, other);
                if !kept[first] || !kept[other] || (turned && twins == Twins::Kept) {
                    continue;
                }
                let Interface { front, back } = interfaces[other];
                let seen = if turned { Interface { front: back, back: front } } else { interfaces[other] };
                if let Some(joined) = join(interfaces[first], seen) {
                    kept[other] = false;
                    kept[first] = joined.front != joined.back;
                    interfaces[first] = joined;
                }
            }
        }
    }
    mesh.interfaces = Some(interfaces);
    let dropped = kept.iter().filter(|&&keep| !keep).count();
    if dropped > 0 {
        mesh.retain_triangles(&kept);
    }
    dropped
}

/// What two faces in one place are together, both seen from the same side.
fn join(a: Interface, b: Interface) -> Option<Interface> {
    if a == b {
        Some(a)
    } else if a.back == b.front {
        Some(Interface { front: a.front, back: b.back })
    } else if b.back == a.front {
        Some(Interface { front: b.front, back: a.back })
    } else {
        None
    }
}

/// Triangles of the same three points, in rising order.
fn groups(mesh: &RawMesh) -> Vec<Vec<usize>> {
    // Nearly always there are none, which the sums of the hashes of their corners tell quickly.
    let mut keys: Vec<(u64, usize)> = (0..mesh.triangles.len()).map(|t| (key(mesh, t), t)).collect();
    keys.sort_unstable();
    let candidates = keys.chunk_by(|a, b| a.0 == b.0).filter(|group| group.len() > 1);
    let mut groups = Vec::new();
    for candidate in candidates {
        let mut sorted: Vec<_> = candidate.iter().map(|&(_, t)| (corners(mesh, t).0, t)).collect();
        sorted.sort_unstable();
        let same = sorted.chunk_by(|a, b| a.0 == b.0).filter(|group| group.len() > 1);
        groups.extend(same.map(|group| group.iter().map(|&(_, t)| t).collect()));
    }
    groups
}

/// The bits of a position; adding 0 turns -0 into 0.
fn bits(position: DVec3) -> [u64; 3] {
    (position + DVec3::ZERO).to_array().map(f64::to_bits)
}

/// A number that the corners of a triangle have in any order.
fn key(mesh: &RawMesh, triangle: usize) -> u64 {
    const PRIME: u64 = 0x0100_0000_01b3;
    let hash = |index: u32| {
        bits(mesh.positions[index as usize]).iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, &word| {
            ((hash ^ word).wrapping_mul(PRIME)).rotate_left(29)
        })
    };
    mesh.triangles[triangle].iter().fold(0, |sum: u64, &index| sum.wrapping_add(hash(index)))
}

/// The corners in rising order, and whether it took an odd number of swaps.
fn corners(mesh: &RawMesh, triangle: usize) -> ([[u64; 3]; 3], bool) {
    let mut corners = mesh.triangles[triangle].map(|index| bits(mesh.positions[index as usize]));
    let mut odd = false;
    for (a, b) in [(0, 1), (1, 2), (0, 1)] {
        if corners[a] > corners[b] {
            corners.swap(a, b);
            odd = !odd;
        }
    }
    (corners, odd)
}

fn winding(mesh: &RawMesh, triangle: usize) -> bool {
    corners(mesh, triangle).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Region;

    /// Two faces on the same points, of the second's own vertices, and a third beside them.
    fn sheets(second: [u32; 3], labels: [(i32, i32); 2]) -> RawMesh {
        let points =
            [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(-0.0, 0.0, -0.0), DVec3::X, DVec3::Y, DVec3::Z];
        let interface = |(front, back)| Interface { front: Region(front), back: Region(back) };
        RawMesh {
            positions: points.to_vec(),
            triangles: vec![[0, 1, 2], second, [0, 1, 6]],
            interfaces: Some(vec![interface(labels[0]), interface(labels[1]), interface((8, 9))]),
            normals: None,
            velocities: None,
        }
    }

    fn labels(mesh: &RawMesh) -> Vec<(i32, i32)> {
        mesh.interfaces.iter().flatten().map(|i| (i.front.0, i.back.0)).collect()
    }

    #[test]
    fn the_table_of_the_page_holds_from_either_side() {
        let (same, turned) = ([4, 5, 3], [4, 3, 5]);
        for (second, given, expected) in [
            (same, [(0, 1), (0, 1)], vec![(0, 1)]),
            (turned, [(0, 1), (1, 0)], vec![(0, 1)]),
            (same, [(0, 1), (1, 2)], vec![(0, 2)]),
            (same, [(1, 2), (0, 1)], vec![(0, 2)]),
            (turned, [(0, 1), (0, 2)], vec![(2, 1)]),
            (same, [(0, 1), (1, 0)], vec![]),
            (turned, [(0, 1), (0, 1)], vec![]),
            (same, [(0, 1), (2, 3)], vec![(0, 1), (2, 3)]),
        ] {
            let mut mesh = sheets(second, given);
            let dropped = merge_coincident(&mut mesh, Twins::Joined);
            assert_eq!(labels(&mesh), [expected.clone(), vec![(8, 9)]].concat(), "{given:?} {second:?}");
            assert_eq!(dropped, 2 - expected.len());
            assert_eq!(mesh.triangles.len(), expected.len() + 1);
        }
    }

    #[test]
    fn sheets_without_labels_keep_both_sides() {
        let mut mesh = sheets([4, 3, 5], [(0, 1), (0, 1)]);
        assert_eq!(merge_coincident(&mut mesh, Twins::Kept), 0);
        let mut mesh = sheets([4, 5, 3], [(0, 1), (0, 1)]);
        assert_eq!(merge_coincident(&mut mesh, Twins::Kept), 1);
    }
}
