//! The rim: edges on the sides of the box that lose their wall faces, put in order as loops and chains.
//!
//! Every surface is looked at with its normal into the lesser of its two labels, so that a rim runs the same way
//! whichever way round its faces are. An edge belongs to the rim of a label pair when the faces of that pair
//! which remain there do not cancel (one forward, one back).

use std::collections::BTreeMap;

use super::Side;
use super::walls::WallFaces;
use crate::mesh::{Interface, RawMesh};

/// The length of the perimeter of the box in the coordinate of [`perimeter`].
pub(super) const PERIMETER: f64 = 8.0;

/// How one triangle uses an edge; the order of the fields is the order of sorting.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct EdgeUse {
    /// Lesser vertex.
    pub low: u32,
    /// Greater vertex.
    pub high: u32,
    /// The triangle.
    pub triangle: u32,
    /// Whether it runs from `low` to `high`.
    pub rising: bool,
}

/// The uses of all edges that lie on a wall, sorted by edge and triangle.
pub(super) fn wall_edges(mesh: &RawMesh, faces: &WallFaces) -> Vec<EdgeUse> {
    let mut uses = Vec::new();
    for (i, t) in mesh.triangles.iter().enumerate() {
        for (from, to) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            if from != to && faces.shared(from, to) != 0 {
                let triangle = i as u32;
                uses.push(EdgeUse { low: from.min(to), high: from.max(to), triangle, rising: from < to });
            }
        }
    }
    uses.sort_unstable();
    uses
}

/// Runs of uses of the same edge.
pub(super) fn by_edge(uses: &[EdgeUse]) -> impl Iterator<Item = &[EdgeUse]> {
    uses.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high))
}

/// An open edge as the surface that remains traverses it, normal into the lesser label.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct RimEdge {
    /// Where it starts.
    pub from: u32,
    /// Where it ends.
    pub to: u32,
    /// The labels as the surface's face has them.
    pub interface: Interface,
    /// One of the wall faces that were removed there.
    pub wall_face: u32,
    /// The wall.
    pub side: Side,
}

impl RimEdge {
    /// The labels in rising order.
    pub fn pair(&self) -> Interface {
        in_order(self.interface)
    }
}

fn in_order(interface: Interface) -> Interface {
    let Interface { front, back } = interface;
    Interface { front: front.min(back), back: front.max(back) }
}

/// What the faces that remain leave open at one edge: for each label pair, how often, and whether from low to high.
pub(super) fn open_uses(
    uses: &[EdgeUse],
    interfaces: &[Interface],
    removed: &[bool],
) -> Vec<(Interface, usize, bool)> {
    let mut remaining: Vec<(Interface, Interface, bool)> = uses
        .iter()
        .filter(|edge| !removed[edge.triangle as usize])
        .map(|edge| (edge, interfaces[edge.triangle as usize]))
        .filter(|(_, interface)| interface.front != interface.back)
        .map(|(edge, interface)| {
            (in_order(interface), interface, edge.rising != (interface.front > interface.back))
        })
        .collect();
    remaining.sort_unstable();
    let mut open = Vec::new();
    for same in remaining.chunk_by(|a, b| a.0 == b.0) {
        let rising = same.iter().filter(|edge| edge.2).count();
        let falling = same.len() - rising;
        if let Some(edge) = same.iter().find(|edge| edge.2 == (rising > falling))
            && rising != falling
        {
            open.push((edge.1, rising.abs_diff(falling), edge.2));
        }
    }
    open
}

/// The rim that the removal of the faces in `removed` leaves on the sides, but for edges on the planes `except`.
pub(super) fn find_rims(
    mesh: &RawMesh,
    interfaces: &[Interface],
    faces: &WallFaces,
    uses: &[EdgeUse],
    removed: &[bool],
    except: u8,
) -> Vec<Rim> {
    let sides = faces.planes.sides();
    let mut edges = Vec::new();
    for group in by_edge(uses) {
        let is_removed_side = |i: u32| removed[i as usize] && faces.is_on(i as usize, sides);
        let wall = group.iter().map(|edge| edge.triangle).find(|&i| is_removed_side(i));
        let Some((wall_face, side)) = wall.and_then(|i| Some((i, faces.sides[i as usize]?))) else {
            continue;
        };
        let (low, high) = (group[0].low, group[0].high);
        if faces.shared(low, high) & except != 0 {
            continue;
        }
        for (interface, times, rising) in open_uses(group, interfaces, removed) {
            let (from, to) = if rising { (low, high) } else { (high, low) };
            edges.extend(std::iter::repeat_n(RimEdge { from, to, interface, wall_face, side }, times));
        }
    }
    edges.sort_by_key(|edge| (edge.pair(), edge.from, edge.to));
    edges
        .chunk_by(|a, b| a.pair() == b.pair())
        .flat_map(walk)
        .map(|edges| Rim::new(mesh, faces, edges))
        .collect()
}

/// Cuts the edges of one pair, sorted by start, into chains (first) and closed loops that use each edge once.
fn walk(edges: &[RimEdge]) -> Vec<Vec<RimEdge>> {
    let mut surplus = BTreeMap::new();
    for edge in edges {
        *surplus.entry(edge.from).or_insert(0_i64) += 1;
        *surplus.entry(edge.to).or_insert(0) -= 1;
    }
    let chains = surplus.iter().flat_map(|(&v, &n)| std::iter::repeat_n(v, n.max(0) as usize));
    let loops = edges.iter().map(|edge| edge.from);

    // The next unused edge of each vertex, kept at the first of its edges.
    let mut next: Vec<usize> = (0..edges.len()).collect();
    let mut take = |vertex: u32| {
        let first = edges.partition_point(|edge| edge.from < vertex);
        let slot = next.get_mut(first)?;
        let edge = edges.get(*slot).filter(|edge| edge.from == vertex)?;
        *slot += 1;
        Some(*edge)
    };
    let mut rims = Vec::new();
    for start in chains.chain(loops) {
        let mut rim = Vec::new();
        let mut at = start;
        while let Some(edge) = take(at) {
            at = edge.to;
            rim.push(edge);
        }
        if !rim.is_empty() {
            rims.push(rim);
        }
    }
    rims
}

/// A connected stretch of open edges of one label pair.
pub(super) struct Rim {
    /// Each edge starts where the one before ends.
    pub edges: Vec<RimEdge>,
    /// How far each edge goes along the perimeter of the box, signed.
    pub steps: Vec<f64>,
    /// Whether the last edge ends where the first starts.
    pub is_closed: bool,
    /// How often it runs round the box, signed; 0 for chains.
    pub winding: i64,
}

impl Rim {
    fn new(mesh: &RawMesh, faces: &WallFaces, edges: Vec<RimEdge>) -> Self {
        let along = |vertex: u32| perimeter(faces, mesh.positions[vertex as usize]);
        let half = PERIMETER / 2.0;
        let step = |edge: &RimEdge| (along(edge.to) - along(edge.from) + half).rem_euclid(PERIMETER) - half;
        let steps: Vec<f64> = edges.iter().map(step).collect();
        let is_closed = edges.first().map(|edge| edge.from) == edges.last().map(|edge| edge.to);
        let turns = steps.iter().sum::<f64>() / PERIMETER;
        let winding = if is_closed { turns.round() as i64 } else { 0 };
        Self { edges, steps, is_closed, winding }
    }

    /// True for a closed loop that does not run round the box: where a drop or a bubble touches a wall.
    pub fn is_island(&self) -> bool {
        self.is_closed && self.winding == 0
    }
}

/// The place along the perimeter of the box, in [0, 8), two a side; the height plays no part.
fn perimeter(faces: &WallFaces, p: glam::DVec3) -> f64 {
    let planes = &faces.planes;
    let from_centre = (p - planes.min / 2.0 - planes.max / 2.0) / (planes.max - planes.min);
    let a = from_centre[(planes.up.index + 1) % 3];
    let b = from_centre[(planes.up.index + 2) % 3];
    let reach = a.abs().max(b.abs());
    let place = match (a.abs() >= b.abs(), a >= 0.0, b >= 0.0) {
        _ if reach == 0.0 => 0.0,
        (true, true, _) => b / reach,
        (true, false, _) => 4.0 - b / reach,
        (false, _, true) => 2.0 - a / reach,
        (false, _, false) => 6.0 + a / reach,
    };
    place.rem_euclid(PERIMETER)
}
