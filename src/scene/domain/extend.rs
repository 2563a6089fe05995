//! The sea goes on: wall faces are taken away and what ends on the sides of the box is carried to the horizon.
//!
//! Three things can end there. A surface that runs round the box, or along its sides down to the bottom, is
//! extended (see [`super::stitch`]). A drop that touches a wall keeps the faces it has there. What
//! lies in a hole of an extended region (a bubble, or a drop of oil in water) gets a flat cap on the wall.

use glam::{DVec3, Vec3};

use super::rim::{EdgeUse, Rim, RimEdge, by_edge, find_rims, open_uses, wall_edges};
use super::stitch::stitch;
use super::walls::WallFaces;
use super::{DomainError, DomainWarning, Side};
use crate::mesh::disjoint::DisjointSets;
use crate::mesh::{Interface, RawMesh, Region};
use crate::scene::description::{DomainDescription, Wall};

/// The regions that reach infinity, and what to tell the user.
pub(super) struct Extension {
    pub regions: Vec<Region>,
    pub warnings: Vec<DomainWarning>,
}

/// Vertices and faces that are added to a mesh.
#[derive(Default)]
pub(super) struct Patch {
    pub positions: Vec<DVec3>,
    /// One a vertex where the mesh has velocities, else none.
    pub velocities: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    pub interfaces: Vec<Interface>,
    pub sides: Vec<Option<Side>>,
}

impl Patch {
    /// Adds a triangle on the outer side of a rim edge, given as the surface's normal into the lesser label has
    /// it; labels and winding are those of the face at the edge.
    pub fn push(&mut self, edge: &RimEdge, mut triangle: [u32; 3], side: Option<Side>) {
        if triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0] {
            return;
        }
        if edge.interface.front > edge.interface.back {
            triangle.swap(1, 2);
        }
        self.triangles.push(triangle);
        self.interfaces.push(edge.interface);
        self.sides.push(side);
    }
}

/// Takes away the faces on the sides (and on a bottom that is not opaque) and extends the surface.
pub(super) fn extend(
    mesh: &mut RawMesh,
    faces: &mut WallFaces,
    domain: &DomainDescription,
) -> Result<Extension, DomainError> {
    let planes = faces.planes;
    let with_bottom = if domain.bottom == Wall::Opaque { 0 } else { planes.bottom() };
    let mut removed: Vec<bool> =
        (0..faces.sides.len()).map(|i| faces.is_on(i, planes.sides() | with_bottom)).collect();
    // A top that is kept is an interface like any other, and so is its rim.
    let except = planes.bottom() | if domain.top == Wall::Keep { 0 } else { planes.top() };

    let interfaces = mesh.interfaces.as_deref().unwrap_or_default();
    let uses = wall_edges(mesh, faces);
    let mut rims = find_rims(mesh, interfaces, faces, &uses, &removed, except);
    if restore_islands(&uses, &rims, faces, &mut removed, except) {
        rims = find_rims(mesh, interfaces, faces, &uses, &removed, except);
    }
    let (islands, rims): (Vec<Rim>, Vec<Rim>) = rims.into_iter().partition(Rim::is_island);

    let mut warnings = Vec::new();
    if rims.is_empty() {
        warnings.push(DomainWarning::NothingExtended);
    }
    let edges = dry_edges(&uses, interfaces, faces, &removed);
    if edges > 0 {
        warnings.push(DomainWarning::DryBottom { edges });
    }
    let mut patch = Patch::default();
    let regions = stitch(mesh, faces, &rims, &mut patch, &mut warnings)?;
    for island in &islands {
        cap(mesh, island, &mut patch)?;
    }
    replace(mesh, faces, &removed, patch);
    Ok(Extension { regions, warnings })
}

/// Puts back the wall faces of drops: connected wall faces that end in islands only, neither on the planes
/// `except` nor in a rim that goes on. True when there are any.
fn restore_islands(
    uses: &[EdgeUse],
    rims: &[Rim],
    faces: &WallFaces,
    removed: &mut [bool],
    except: u8,
) -> bool {
    let sides = faces.planes.sides();
    let mut patches = DisjointSets::new(removed.len() as u32);
    let mut going_on: Vec<u32> = rims
        .iter()
        .filter(|rim| !rim.is_island())
        .flat_map(|rim| &rim.edges)
        .map(|edge| edge.wall_face)
        .collect();
    for group in by_edge(uses) {
        let mut walls = group.iter().map(|edge| edge.triangle).filter(|&i| faces.is_on(i as usize, sides));
        if let Some(first) = walls.next() {
            walls.for_each(|i| patches.join(first, i));
            if faces.shared(group[0].low, group[0].high) & except != 0 {
                going_on.push(first);
            }
        }
    }
    let mut goes_on = vec![false; removed.len()];
    for face in going_on {
        goes_on[patches.find(face) as usize] = true;
    }
    let mut any = false;
    for i in 0..removed.len() {
        if removed[i] && faces.is_on(i, sides) && !goes_on[patches.find(i as u32) as usize] {
            removed[i] = false;
            any = true;
        }
    }
    any
}

/// How many edges of the surface lie on the bottom and have lost their faces there.
fn dry_edges(uses: &[EdgeUse], interfaces: &[Interface], faces: &WallFaces, removed: &[bool]) -> usize {
    let bottom = faces.planes.bottom();
    by_edge(uses)
        .filter(|group| {
            group
                .iter()
                .any(|edge| removed[edge.triangle as usize] && faces.is_on(edge.triangle as usize, bottom))
                && !open_uses(group, interfaces, removed).is_empty()
        })
        .count()
}

/// Closes an island with a fan around its centroid, which lies on the wall when all its edges do.
fn cap(mesh: &RawMesh, island: &Rim, patch: &mut Patch) -> Result<(), DomainError> {
    let rim = island.edges.len();
    let centre = u32::try_from(mesh.positions.len() + patch.positions.len())
        .map_err(|_| DomainError::TooLarge { rim, limit: u32::MAX })?;
    let sum: DVec3 = island.edges.iter().map(|edge| mesh.positions[edge.from as usize]).sum();
    patch.positions.push(sum / rim as f64);
    if let Some(velocities) = &mesh.velocities {
        let sum: Vec3 = island.edges.iter().map(|edge| velocities[edge.from as usize]).sum();
        patch.velocities.push(sum / rim as f32);
    }
    for edge in &island.edges {
        patch.push(edge, [edge.to, edge.from, centre], Some(edge.side));
    }
    Ok(())
}

/// Drops the removed faces and appends those of the patch, in the mesh and in what is kept beside it.
fn replace(mesh: &mut RawMesh, faces: &mut WallFaces, removed: &[bool], patch: Patch) {
    fn rest<T: Copy>(all: &mut Vec<T>, removed: &[bool]) {
        let mut is_removed = removed.iter();
        all.retain(|_| !is_removed.next().copied().unwrap_or(false));
    }
    rest(&mut mesh.triangles, removed);
    rest(&mut faces.sides, removed);
    if let Some(interfaces) = &mut mesh.interfaces {
        rest(interfaces, removed);
        interfaces.extend(patch.interfaces);
    }
    mesh.positions.extend(patch.positions);
    if let Some(velocities) = &mut mesh.velocities {
        velocities.extend(patch.velocities);
    }
    if let Some(normals) = &mut mesh.normals {
        match &mut normals.corners {
            Some(corners) => {
                rest(corners, removed);
                let none = normals.values.len() as u32;
                normals.values.push(glam::Vec3::ZERO);
                corners.extend(patch.triangles.iter().map(|_| [none; 3]));
            }
            None => normals.values.resize(mesh.positions.len(), glam::Vec3::ZERO),
        }
    }
    mesh.triangles.extend(patch.triangles);
    faces.sides.extend(patch.sides);
}
