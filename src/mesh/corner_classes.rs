//! Which corners of triangles share a normal.
//!
//! A class holds corners at one vertex that are connected across ordinary edges: exactly two triangles of the
//! same group, traversing the edge in opposite directions once both are seen with their normals into the lesser
//! label.

use super::RawMesh;
use super::disjoint::DisjointSets;
use super::normals::is_reversed;

/// The class of every corner (three a triangle, in order), and the number of classes.
pub(super) fn corner_classes(mesh: &RawMesh, group: &[u32]) -> (Vec<u32>, usize) {
    let mut sets = DisjointSets::new(3 * mesh.triangles.len() as u32);
    let edges = HalfEdges::by_least_vertex(mesh);
    let mut bucket = Vec::new();
    for least in 0..mesh.positions.len() {
        bucket.clear();
        bucket.extend(edges.at(least).iter().map(|&edge| HalfEdgeKey::new(mesh, group, edge)));
        bucket.sort_unstable();
        for uses in bucket.chunk_by(|a, b| (a.greatest, a.group) == (b.greatest, b.group)) {
            if let [a, b] = uses
                && a.rising != b.rising
            {
                sets.join(a.corner_at_least, b.corner_at_least);
                sets.join(a.corner_at_greatest, b.corner_at_greatest);
            }
        }
    }
    sets.into_numbers()
}

/// The edges of all triangles, listed at the lesser of their two vertices. Half-edge 3 t + k leaves corner k of
/// triangle t.
struct HalfEdges {
    starts: Vec<u32>,
    edges: Vec<u32>,
}

impl HalfEdges {
    fn by_least_vertex(mesh: &RawMesh) -> Self {
        let ends = || {
            mesh.triangles.iter().enumerate().flat_map(|(i, t)| {
                (0..3).map(move |k| (3 * i as u32 + k as u32, t[k], t[(k + 1) % 3])).filter(|e| e.1 != e.2)
            })
        };
        let mut starts = vec![0_u32; mesh.positions.len() + 1];
        for (_, from, to) in ends() {
            starts[from.min(to) as usize + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut next = starts.clone();
        let mut edges = vec![0; starts.last().map_or(0, |&count| count as usize)];
        for (edge, from, to) in ends() {
            let slot = &mut next[from.min(to) as usize];
            edges[*slot as usize] = edge;
            *slot += 1;
        }
        Self { starts, edges }
    }

    fn at(&self, least: usize) -> &[u32] {
        &self.edges[self.starts[least] as usize..self.starts[least + 1] as usize]
    }
}

/// A half-edge as it is matched with others at its lesser vertex; the order of the fields is the order of sorting.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct HalfEdgeKey {
    greatest: u32,
    group: u32,
    corner_at_least: u32,
    corner_at_greatest: u32,
    /// Whether the triangle, seen with its normal into the lesser label, runs from the lesser vertex to the greater.
    rising: bool,
}

impl HalfEdgeKey {
    fn new(mesh: &RawMesh, group: &[u32], edge: u32) -> Self {
        let (triangle, k) = ((edge / 3) as usize, edge % 3);
        let (start, end) = (edge, 3 * (edge / 3) + (k + 1) % 3);
        let indices = mesh.triangles[triangle];
        let (from, to) = (indices[k as usize], indices[(k as usize + 1) % 3]);
        let rising = from < to;
        let (corner_at_least, corner_at_greatest) = if rising { (start, end) } else { (end, start) };
        Self {
            greatest: from.max(to),
            group: group.get(triangle).copied().unwrap_or(0),
            corner_at_least,
            corner_at_greatest,
            rising: rising != is_reversed(mesh, triangle),
        }
    }
}
