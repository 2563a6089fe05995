//! The rim of a surface, carried from the sides of the box to the horizon in rings.
//!
//! ```text
//! (x, y)(s) = c + s ((x, y)_rim - c)
//! z(s)      = z_rim + w(t) (z_mean - z_rim),   t = (s - 1) / 2 clamped to [0, 1],   w(t) = t^2 (3 - 2 t)
//! ```
//! with c the centre of the box, z along up and z_mean the mean of the rim's height weighted by the length of its
//! edges. Scaling maps the perimeter of the box onto larger rectangles: s = 3 is one box length out, and from
//! there flat rings grow by a factor of 4 until s >= 1e5. Ring 0 is the rim itself, vertices and all, so that
//! the stitching is watertight.
//!
//! A rim that moves takes the rings with it by 1 - w: the flat sea is still.
//!
//! Every rim that runs round the box has its own mean (layers stay apart); chains, which stop at the bottom or
//! where three regions meet, have that of all chains of their labels. Where rims meet in a vertex they share its
//! column of ring vertices, at the average of their means. A rim that doubles back (a wave that
//! breaks along the wall) is unfolded on the way out: a vertex that lies behind its loop's foremost one moves to
//! that one and shares its column from s = 3, for otherwise the flat sheets would lie on each other.

use std::collections::BTreeMap;

use glam::DVec3;

use super::extend::Patch;
use super::rim::{PERIMETER, Rim};
use super::walls::WallFaces;
use super::{DomainError, DomainWarning};
use crate::mesh::{Interface, RawMesh, Region};

/// Rings from the rim to the flat sea.
const BLEND_RINGS: usize = 8;
/// Scale of the last of them: one box length beyond every side.
const BLEND_END: f64 = 3.0;
/// From one flat ring to the next.
const GROWTH: f64 = 4.0;
/// The last ring is the first at this scale or beyond.
const HORIZON: f64 = 1e5;
/// A vertex less than this ahead of another along the perimeter (of length 8) is not ahead.
const AHEAD: f64 = 1e-9;

/// What happens to one vertex of the rims.
struct Column {
    vertex: u32,
    /// Sum of the means of the rims that pass, and how often they do.
    height_sum: f64,
    visits: u32,
    /// The column that it shares from the end of the blend on.
    leader: usize,
    /// Index of its first ring vertex.
    first: u32,
}

/// Adds the rings of all `rims` to `patch`; the regions below the outermost one, in rising order, without the
/// outside.
pub(super) fn stitch(
    mesh: &RawMesh,
    faces: &WallFaces,
    rims: &[Rim],
    patch: &mut Patch,
    warnings: &mut Vec<DomainWarning>,
) -> Result<Vec<Region>, DomainError> {
    let mut columns = columns(mesh, faces, rims);
    for rim in rims {
        warnings.extend(open_ends(mesh, rim, &columns));
        unfold(rim, &mut columns);
    }
    let scales = ring_scales();
    place(mesh, faces, &mut columns, &scales, patch)?;
    let mut regions = Vec::new();
    for edge in rims.iter().flat_map(|rim| &rim.edges) {
        let ends = [edge.from, edge.to].map(|vertex| column_of(&columns, vertex));
        for ring in 0..scales.len() {
            let [a0, b0] = ends.map(|column| ring_vertex(&columns, column, ring));
            let [a1, b1] = ends.map(|column| ring_vertex(&columns, column, ring + 1));
            patch.push(edge, [b0, a0, a1], None);
            patch.push(edge, [b0, a1, b1], None);
        }
        let last = |column, back| ring_vertex(&columns, column, scales.len() - back);
        let outermost = [last(ends[1], 1), last(ends[0], 1), last(ends[0], 0)];
        regions.extend(region_below(mesh, faces, patch, edge.pair(), outermost));
    }
    regions.sort_unstable();
    regions.dedup();
    Ok(regions)
}

/// The columns of all rim vertices, in order of the vertices.
fn columns(mesh: &RawMesh, faces: &WallFaces, rims: &[Rim]) -> Vec<Column> {
    let mut visits: Vec<(u32, f64)> = Vec::new();
    for (rim, mean) in rims.iter().zip(mean_heights(mesh, faces, rims)) {
        visits.extend(rim.edges.iter().map(|edge| (edge.from, mean)));
        visits.extend(rim.edges.last().filter(|_| !rim.is_closed).map(|edge| (edge.to, mean)));
    }
    visits.sort_by_key(|visit| visit.0);
    visits
        .chunk_by(|a, b| a.0 == b.0)
        .enumerate()
        .map(|(leader, same)| Column {
            vertex: same[0].0,
            height_sum: same.iter().map(|visit| visit.1).sum(),
            visits: same.len() as u32,
            leader,
            first: 0,
        })
        .collect()
}

fn column_of(columns: &[Column], vertex: u32) -> usize {
    columns.partition_point(|column| column.vertex < vertex)
}

/// Mean coordinate along the up axis of each rim, weighted by edge length; chains of a label pair share theirs.
fn mean_heights(mesh: &RawMesh, faces: &WallFaces, rims: &[Rim]) -> Vec<f64> {
    let axis = faces.planes.up.index;
    let sums: Vec<(f64, f64)> = rims
        .iter()
        .map(|rim| {
            rim.edges.iter().fold((0.0, 0.0), |(sum, weight), edge| {
                let [a, b] = [edge.from, edge.to].map(|vertex| mesh.positions[vertex as usize]);
                let length = a.distance(b);
                (sum + length * (0.5 * a[axis] + 0.5 * b[axis]), weight + length)
            })
        })
        .collect();
    let mut chains: BTreeMap<Interface, (f64, f64)> = BTreeMap::new();
    for (rim, sum) in rims.iter().zip(&sums).filter(|(rim, _)| !rim.is_closed) {
        let of_pair = chains.entry(rim.edges[0].pair()).or_default();
        *of_pair = (of_pair.0 + sum.0, of_pair.1 + sum.1);
    }
    rims.iter()
        .zip(sums)
        .map(|(rim, own)| {
            let chain = chains.get(&rim.edges[0].pair()).filter(|_| !rim.is_closed);
            let (sum, weight) = chain.copied().unwrap_or(own);
            if weight > 0.0 { sum / weight } else { mesh.positions[rim.edges[0].from as usize][axis] }
        })
        .collect()
}

/// A warning for each end of a chain from where no other rim goes on.
fn open_ends(mesh: &RawMesh, rim: &Rim, columns: &[Column]) -> Vec<DomainWarning> {
    let (Some(first), Some(last), false) = (rim.edges.first(), rim.edges.last(), rim.is_closed) else {
        return Vec::new();
    };
    let Interface { front, back } = first.pair();
    [first.from, last.to]
        .into_iter()
        .filter(|&vertex| columns[column_of(columns, vertex)].visits == 1)
        .map(|vertex| DomainWarning::OpenRim { front, back, at: mesh.positions[vertex as usize] })
        .collect()
}

/// Gives every vertex of a loop round the box that lies behind the foremost so far that one as its leader. A
/// loop that meets itself or another rim stays as it is.
fn unfold(rim: &Rim, columns: &mut [Column]) {
    let of_edges: Vec<usize> = rim.edges.iter().map(|edge| column_of(columns, edge.from)).collect();
    if rim.winding == 0 || of_edges.iter().any(|&column| columns[column].visits != 1) {
        return;
    }
    let forward = rim.winding.signum() as f64;
    let ends = rim.steps.iter().scan(0.0, |at, step| {
        *at += forward * step;
        Some(*at)
    });
    let places: Vec<f64> = std::iter::once(0.0).chain(ends).take(of_edges.len()).collect();
    // From the foremost vertex of one turn, every vertex is behind the end of the turn that begins there.
    let start = (0..places.len()).fold(0, |best, i| if places[i] > places[best] { i } else { best });
    let turn = PERIMETER * rim.winding.abs() as f64;
    let (mut foremost, mut leader) = (places[start], of_edges[start]);
    for i in (start + 1..places.len()).chain(0..start) {
        let place = if i < start { places[i] + turn } else { places[i] };
        if place > foremost + AHEAD {
            (foremost, leader) = (place, of_edges[i]);
        }
        columns[of_edges[i]].leader = leader;
    }
}

/// Scale of each ring and how far its height has gone from the rim's to the mean, from ring 1 on.
fn ring_scales() -> Vec<(f64, f64)> {
    let blend = (1..=BLEND_RINGS).map(|ring| {
        let t = ring as f64 / BLEND_RINGS as f64;
        (1.0 + t * (BLEND_END - 1.0), t * t * (3.0 - 2.0 * t))
    });
    let mut scales: Vec<(f64, f64)> = blend.collect();
    let mut scale = BLEND_END;
    while scale < HORIZON {
        scale *= GROWTH;
        scales.push((scale, 1.0));
    }
    scales
}

/// Computes the ring vertices. A column that follows another has its own only before the end of the blend.
fn place(
    mesh: &RawMesh,
    faces: &WallFaces,
    columns: &mut [Column],
    scales: &[(f64, f64)],
    patch: &mut Patch,
) -> Result<(), DomainError> {
    let too_large = DomainError::TooLarge { rim: columns.len(), limit: u32::MAX };
    let planes = &faces.planes;
    let axis = planes.up.index;
    let centre = planes.min / 2.0 + planes.max / 2.0;
    for i in 0..columns.len() {
        columns[i].first =
            u32::try_from(mesh.positions.len() + patch.positions.len()).map_err(|_| too_large.clone())?;
        let column = &columns[i];
        let own = mesh.positions[column.vertex as usize];
        let foremost = mesh.positions[columns[column.leader].vertex as usize];
        let mean = column.height_sum / f64::from(column.visits);
        let count = if column.leader == i { scales.len() } else { BLEND_RINGS - 1 };
        patch.positions.extend(scales[..count].iter().map(|&(scale, weight)| {
            let mut p = centre + scale * (own + weight * (foremost - own) - centre);
            p[axis] = own[axis] + weight * (mean - own[axis]);
            p
        }));
        if let Some(velocities) = &mesh.velocities {
            let own = velocities[column.vertex as usize];
            patch.velocities.extend(scales[..count].iter().map(|&(_, weight)| own * (1.0 - weight as f32)));
        }
    }
    let total = mesh.positions.len() + patch.positions.len();
    if u32::try_from(total).is_ok() { Ok(()) } else { Err(too_large) }
}

/// The vertex of a column in a ring; ring 0 is the rim.
fn ring_vertex(columns: &[Column], column: usize, ring: usize) -> u32 {
    match ring {
        0 => columns[column].vertex,
        _ if ring < BLEND_RINGS => columns[column].first + ring as u32 - 1,
        _ => columns[columns[column].leader].first + ring as u32 - 1,
    }
}

/// The region below a triangle whose normal points into the lesser label; `None` for the outside, and for an
/// upright or degenerate triangle.
fn region_below(
    mesh: &RawMesh,
    faces: &WallFaces,
    patch: &Patch,
    pair: Interface,
    triangle: [u32; 3],
) -> Option<Region> {
    let up = faces.planes.up;
    let [a, b, c] = triangle.map(|index| {
        let index = index as usize;
        let added = || patch.positions[index - mesh.positions.len()];
        mesh.positions.get(index).copied().unwrap_or_else(added)
    });
    let normal: DVec3 = (b - a).cross(c - a);
    let rise = if up.negative { -normal[up.index] } else { normal[up.index] };
    let below = match rise.partial_cmp(&0.0)? {
        std::cmp::Ordering::Greater => pair.back,
        std::cmp::Ordering::Less => pair.front,
        std::cmp::Ordering::Equal => return None,
    };
    Some(below).filter(|&region| region != Region::OUTSIDE)
}
