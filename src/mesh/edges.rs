//! The edges of a triangle mesh, each with the triangles that use it.
//!
//! A use is the number of the corner at which the edge begins, 3 t + k for corner k of triangle t. Uses are
//! gathered by the lesser vertex of their edge: 4 bytes a use and 4 a vertex, and only short lists are sorted.

/// An edge and all its uses.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge<'a> {
    /// Its vertices, the lesser first.
    pub vertices: [u32; 2],
    /// Its uses, in rising order.
    pub uses: &'a [EdgeUse],
}

/// A triangle's use of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct EdgeUse {
    corner: u32,
    /// The vertex of the triangle that is not on the edge.
    pub opposite: u32,
    /// Whether the triangle goes from the lesser vertex to the greater.
    pub forward: bool,
}

impl EdgeUse {
    /// The triangle.
    pub fn triangle(&self) -> usize {
        (self.corner / 3) as usize
    }
}

/// Visits each edge once, in the order of its vertices. Triangles must not repeat a vertex.
pub(super) fn for_each_edge(vertices: usize, triangles: &[[u32; 3]], mut visit: impl FnMut(Edge)) {
    let (starts, corners) = corners_by_lesser_vertex(vertices, triangles);
    let mut keyed = Vec::new();
    let mut uses = Vec::new();
    for (lesser, range) in starts.windows(2).enumerate() {
        keyed.clear();
        let corners = &corners[range[0] as usize..range[1] as usize];
        keyed.extend(corners.iter().map(|&corner| {
            let [from, to, opposite] = from_corner(triangles, corner);
            (from.max(to), EdgeUse { corner, opposite, forward: from < to })
        }));
        keyed.sort_unstable();
        for group in keyed.chunk_by(|a, b| a.0 == b.0) {
            uses.clear();
            uses.extend(group.iter().map(|&(_, edge_use)| edge_use));
            visit(Edge { vertices: [lesser as u32, group[0].0], uses: &uses });
        }
    }
}

/// Where the corners of each vertex begin, and the corners.
fn corners_by_lesser_vertex(vertices: usize, triangles: &[[u32; 3]]) -> (Vec<u32>, Vec<u32>) {
    let all = || 0..3 * triangles.len() as u32;
    let lesser = |corner| {
        let [from, to, _] = from_corner(triangles, corner);
        from.min(to) as usize
    };
    let mut starts = vec![0; vertices + 1];
    for corner in all() {
        starts[lesser(corner) + 1] += 1;
    }
    for vertex in 1..starts.len() {
        starts[vertex] += starts[vertex - 1];
    }
    let mut next = starts.clone();
    let mut corners = vec![0; 3 * triangles.len()];
    for corner in all() {
        let slot = &mut next[lesser(corner)];
        corners[*slot as usize] = corner;
        *slot += 1;
    }
    (starts, corners)
}

/// The vertices of a triangle, beginning with one of its corners.
fn from_corner(triangles: &[[u32; 3]], corner: u32) -> [u32; 3] {
    let triangle = triangles[(corner / 3) as usize];
    let k = (corner % 3) as usize;
    [triangle[k], triangle[(k + 1) % 3], triangle[(k + 2) % 3]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_edges_of_two_triangles_are_five() {
        let mut seen = Vec::new();
        for_each_edge(4, &[[0, 1, 2], [2, 1, 3]], |edge| {
            let uses: Vec<_> = edge.uses.iter().map(|u| (u.triangle(), u.opposite, u.forward)).collect();
            seen.push((edge.vertices, uses));
        });
        let expected = [
            ([0, 1], vec![(0, 2, true)]),
            ([0, 2], vec![(0, 1, false)]),
            ([1, 2], vec![(0, 0, true), (1, 3, false)]),
            ([1, 3], vec![(1, 2, true)]),
            ([2, 3], vec![(1, 1, false)]),
        ];
        assert_eq!(seen, expected);
    }
}
