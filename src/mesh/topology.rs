//! What the edges of a mesh say about it: holes, triple lines, contradicting labels.
//!
//! Going once round an edge, every triangle there leads from one region into the next. The labels on the
//! clockwise sides are then those on the counter-clockwise sides in another order, which is what is checked:
//! necessary for labels to agree, whatever the number of triangles. A mesh without labels is checked as if its
//! triangles had the outside in front and one region behind, that is, for a consistent winding.

use glam::DVec3;

use super::edges::{Edge, for_each_edge};
use super::{Interface, RawMesh, Region};

/// Counts of what is unusual about a mesh, with the first place of each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TopologyReport {
    /// Edges of one triangle only.
    pub open_edges: usize,
    /// The ends of the first of them.
    pub first_open_edge: Option<[DVec3; 2]>,
    /// Edges of three triangles or more; normal where three regions meet.
    pub non_manifold_edges: usize,
    /// Edges of two triangles or more around which the labels contradict each other.
    pub inconsistent_edges: usize,
    /// The ends of the first of them.
    pub first_inconsistent_edge: Option<[DVec3; 2]>,
    /// Triangles that repeat a vertex or have no area at all.
    pub degenerate_triangles: usize,
    /// Triangles whose vertices another triangle has already, in whatever order.
    pub duplicate_triangles: usize,
    /// Parts that share no vertex.
    pub components: usize,
}

impl TopologyReport {
    /// Whether the mesh has triangles all around every edge.
    pub fn is_closed(&self) -> bool {
        self.open_edges == 0
    }
}

/// Looks at every edge and triangle of a mesh. Triangles that repeat a vertex are counted and passed over.
pub fn topology(mesh: &RawMesh) -> TopologyReport {
    let has_repeat = |&[a, b, c]: &[u32; 3]| a == b || b == c || c == a;
    if mesh.triangles.iter().any(has_repeat) {
        let mut distinct = mesh.clone();
        let kept: Vec<bool> = mesh.triangles.iter().map(|triangle| !has_repeat(triangle)).collect();
        distinct.retain_triangles(&kept);
        let repeats = mesh.triangles.len() - distinct.triangles.len();
        let report = topology_of_distinct(&distinct);
        return TopologyReport { degenerate_triangles: report.degenerate_triangles + repeats, ..report };
    }
    topology_of_distinct(mesh)
}

fn topology_of_distinct(mesh: &RawMesh) -> TopologyReport {
    let mut report = TopologyReport {
        degenerate_triangles: mesh.triangles.iter().filter(|&&t| mesh.has_no_area(t)).count(),
        components: components(mesh),
        ..Default::default()
    };
    let mut sides = Sides::default();
    let mut opposites = Vec::new();
    for_each_edge(mesh.positions.len(), &mesh.triangles, |edge| {
        let ends = || Some(edge.vertices.map(|vertex| mesh.positions[vertex as usize]));
        if edge.uses.len() == 1 {
            report.open_edges += 1;
            report.first_open_edge = report.first_open_edge.or_else(ends);
        } else if !sides.agree(mesh, edge) {
            report.inconsistent_edges += 1;
            report.first_inconsistent_edge = report.first_inconsistent_edge.or_else(ends);
        }
        report.non_manifold_edges += usize::from(edge.uses.len() > 2);
        report.duplicate_triangles += duplicates(edge, &mut opposites);
    });
    report
}

/// The labels around an edge, kept to be used again for the next.
#[derive(Default)]
struct Sides {
    clockwise: Vec<Region>,
    counter_clockwise: Vec<Region>,
}

impl Sides {
    /// Whether both sides of the triangles at an edge have the same labels, each as often.
    fn agree(&mut self, mesh: &RawMesh, edge: Edge) -> bool {
        self.clockwise.clear();
        self.counter_clockwise.clear();
        for edge_use in edge.uses {
            let unlabelled = Interface { front: Region::OUTSIDE, back: Region(1) };
            let interface = mesh.interfaces.as_ref().map_or(unlabelled, |all| all[edge_use.triangle()]);
            // Seen against the edge's direction the normal of a forward triangle points counter-clockwise.
            let (ccw, cw) = match edge_use.forward {
                true => (interface.front, interface.back),
                false => (interface.back, interface.front),
            };
            self.counter_clockwise.push(ccw);
            self.clockwise.push(cw);
        }
        self.clockwise.sort_unstable();
        self.counter_clockwise.sort_unstable();
        self.clockwise == self.counter_clockwise
    }
}

/// How many triangles at an edge have been there before; each is looked at only where its least edge is.
fn duplicates(edge: Edge, opposites: &mut Vec<u32>) -> usize {
    if edge.uses.len() < 2 {
        return 0;
    }
    opposites.clear();
    opposites.extend(edge.uses.iter().map(|edge_use| edge_use.opposite).filter(|&o| o > edge.vertices[1]));
    opposites.sort_unstable();
    opposites.windows(2).filter(|pair| pair[0] == pair[1]).count()
}

/// The number of parts that share no vertex, by union of the vertices of each triangle.
fn components(mesh: &RawMesh) -> usize {
    fn root(parents: &mut [u32], mut vertex: u32) -> u32 {
        while parents[vertex as usize] != vertex {
            let grandparent = parents[parents[vertex as usize] as usize];
            parents[vertex as usize] = grandparent;
            vertex = grandparent;
        }
        vertex
    }
    let mut parents: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    let mut used = vec![false; mesh.positions.len()];
    for &[a, b, c] in &mesh.triangles {
        for vertex in [a, b, c] {
            used[vertex as usize] = true;
        }
        for vertex in [b, c] {
            let (from, to) = (root(&mut parents, vertex), root(&mut parents, a));
            // The lesser root stays, which keeps the result independent of the order.
            parents[from.max(to) as usize] = from.min(to);
        }
    }
    (0..parents.len()).filter(|&vertex| used[vertex] && parents[vertex] as usize == vertex).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The unit tetrahedron, wound outwards, its edges at index 0 of the positions on.
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

    #[test]
    fn a_tetrahedron_is_clean() {
        let report = topology(&tetrahedron());
        assert_eq!(report, TopologyReport { components: 1, ..Default::default() });
        assert!(report.is_closed());
    }

    #[test]
    fn a_missing_triangle_opens_three_edges() {
        let mut mesh = tetrahedron();
        mesh.triangles.remove(0);
        let report = topology(&mesh);
        assert_eq!((report.open_edges, report.inconsistent_edges), (3, 0));
        assert_eq!(report.first_open_edge, Some([DVec3::X, DVec3::Y]));
    }

    #[test]
    fn a_turned_triangle_contradicts_its_three_neighbours() {
        let mut mesh = tetrahedron();
        mesh.triangles[0] = [1, 3, 2];
        let report = topology(&mesh);
        assert_eq!((report.open_edges, report.inconsistent_edges), (0, 3));
        assert_eq!(report.first_inconsistent_edge, Some([DVec3::X, DVec3::Y]));
        // Labels the other way round make up for it.
        mesh.interfaces = Some(vec![interface(1, 0), interface(0, 1), interface(0, 1), interface(0, 1)]);
        assert_eq!(topology(&mesh).inconsistent_edges, 0);
    }

    /// Two tetrahedra of labels 1 and 2 over the same face, which lies between them once.
    fn two_phases(shared: Interface) -> RawMesh {
        RawMesh {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, -DVec3::Z],
            triangles: vec![[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1], [1, 4, 2], [0, 2, 4], [0, 4, 1]],
            interfaces: Some(vec![
                interface(0, 1),
                interface(0, 1),
                interface(0, 1),
                shared,
                interface(0, 2),
                interface(0, 2),
                interface(0, 2),
            ]),
            normals: None,
            velocities: None,
        }
    }

    #[test]
    fn triple_lines_are_consistent_when_their_labels_go_round() {
        let report = topology(&two_phases(interface(2, 1)));
        assert_eq!((report.non_manifold_edges, report.inconsistent_edges, report.open_edges), (3, 0, 0));
        assert_eq!(topology(&two_phases(interface(1, 2))).inconsistent_edges, 3);
        assert_eq!(topology(&two_phases(interface(3, 1))).inconsistent_edges, 3);
    }

    #[test]
    fn duplicates_degenerates_and_components_are_counted() {
        let mut mesh = tetrahedron();
        mesh.triangles.extend([[2, 1, 3], [1, 1, 2]]);
        mesh.positions.extend([DVec3::ONE, 2.0 * DVec3::ONE, 3.0 * DVec3::ONE, DVec3::NAN]);
        mesh.triangles.push([4, 5, 6]);
        let report = topology(&mesh);
        assert_eq!((report.duplicate_triangles, report.degenerate_triangles, report.components), (1, 2, 2));
    }
}
