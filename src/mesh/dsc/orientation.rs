//! Which of a tetrahedron's faces look outwards.

use std::collections::VecDeque;

use super::Complex;
use super::faces::{FaceId, FacesByVertex, outward, owner};

/// Six times the signed volume of a tetrahedron.
pub(super) fn signed_volume(complex: &Complex, tetrahedron: usize) -> f64 {
    let [a, b, c, d] = complex.tetrahedra[tetrahedron].map(|index| complex.positions[index as usize]);
    (b - a).cross(c - a).dot(d - a)
}

/// The sign of every tetrahedron's volume, where flat ones take it from their neighbours.
///
/// Two tetrahedra that share a face look at it from opposite sides; that alone fixes one sign from the other.
/// 0 is left where a whole component is flat.
pub(super) fn signs(complex: &Complex, faces: &FacesByVertex) -> Vec<i8> {
    let mut signs: Vec<i8> = (0..complex.tetrahedra.len())
        .map(|tetrahedron| match signed_volume(complex, tetrahedron) {
            volume if volume > 0.0 => 1,
            volume if volume < 0.0 => -1,
            _ => 0,
        })
        .collect();
    let links = links_of_flat(complex, faces, &signs);
    let mut queue: VecDeque<usize> =
        links.iter().map(|&(from, _)| owner(from)).filter(|&from| signs[from] != 0).collect();
    while let Some(from) = queue.pop_front() {
        let begin = links.partition_point(|&(face, _)| owner(face) < from);
        for &(face, across) in links[begin..].iter().take_while(|&&(face, _)| owner(face) == from) {
            let to = owner(across);
            if signs[to] == 0 {
                let same = same_winding(outward(complex, face), outward(complex, across));
                signs[to] = if same { -signs[from] } else { signs[from] };
                queue.push_back(to);
            }
        }
    }
    signs
}

/// Shared faces of which a tetrahedron is flat, from both sides, sorted by tetrahedron.
fn links_of_flat(complex: &Complex, faces: &FacesByVertex, signs: &[i8]) -> Vec<(FaceId, FaceId)> {
    let mut links = Vec::new();
    let visited: Result<(), std::convert::Infallible> = faces.try_for_each(complex, |sharing| {
        if let &[a, b] = sharing
            && (signs[owner(a)] == 0 || signs[owner(b)] == 0)
        {
            links.extend([(a, b), (b, a)]);
        }
        Ok(())
    });
    let Ok(()) = visited;
    links.sort_unstable();
    links
}

/// Whether two triangles of the same vertices go round in the same direction.
fn same_winding(a: [u32; 3], b: [u32; 3]) -> bool {
    (0..3).any(|turn| [b[turn], b[(turn + 1) % 3], b[(turn + 2) % 3]] == a)
}
