//! Which faces lie on which walls, and what the scene says about them.

use glam::DVec3;

use super::extend::extend;
use super::{DomainError, DomainOutcome, DomainWarning, Side, WallTag};
use crate::mesh::RawMesh;
use crate::scene::description::{Axis, DomainDescription, Wall};

/// A vertex is on a plane within this part of the box's longest edge.
const TOLERANCE: f64 = 1e-5;

/// Tags the faces of `mesh` that lie on the walls of `domain`, and extends its surface where the sides say so.
///
/// With `sides = "extend"` the faces on the four upright walls are removed, and those on the bottom unless it is
/// opaque; the rim that this leaves goes on to the horizon. Added vertices have no normals of their own (zero,
/// where the mesh has normals), and vertices that no face uses any more stay where they are.
pub fn apply(mesh: &mut RawMesh, domain: &DomainDescription, up: Axis) -> Result<DomainOutcome, DomainError> {
    check(mesh, domain)?;
    let planes = Planes::new(domain.min, domain.max, up);
    let mut faces = WallFaces::find(mesh, planes);
    let mut outcome = DomainOutcome { warnings: missing_walls(mesh, &faces, domain), ..Default::default() };
    if domain.sides == Wall::Extend && faces.any(planes.sides()) {
        let extension = extend(mesh, &mut faces, domain)?;
        outcome.extended = extension.regions;
        outcome.warnings.extend(extension.warnings);
    }
    outcome.walls = faces
        .sides
        .iter()
        .map(|side| side.map_or(WallTag::None, |side| tag(planes.setting(domain, side), side)))
        .collect();
    Ok(outcome)
}

/// Faces that an extension leaves on a wall close off what it does not extend: an interface like any other.
fn tag(wall: Wall, side: Side) -> WallTag {
    match wall {
        Wall::Keep | Wall::Extend => WallTag::Keep(side),
        Wall::Open => WallTag::Open(side),
        Wall::Opaque => WallTag::Opaque(side),
    }
}

fn check(mesh: &RawMesh, domain: &DomainDescription) -> Result<(), DomainError> {
    let (min, max) = (domain.min, domain.max);
    if !(min.is_finite() && max.is_finite() && min.cmplt(max).all() && (max - min).is_finite()) {
        return Err(DomainError::Box { min, max });
    }
    match (domain.sides, domain.bottom, domain.top) {
        (_, _, Wall::Extend) => return Err(DomainError::TopExtended),
        (Wall::Extend, Wall::Keep, _) => return Err(DomainError::BottomKept),
        (Wall::Keep | Wall::Open | Wall::Opaque, Wall::Extend, _) => return Err(DomainError::BottomAlone),
        _ => {}
    }
    let (labelled, triangles) = (mesh.interfaces.as_ref().map_or(0, Vec::len), mesh.triangles.len());
    if labelled == triangles { Ok(()) } else { Err(DomainError::Unlabelled { labelled, triangles }) }
}

/// One warning for each setting that no face takes. A bottom below an extended sea need not be there.
fn missing_walls(mesh: &RawMesh, faces: &WallFaces, domain: &DomainDescription) -> Vec<DomainWarning> {
    let planes = faces.planes;
    let groups = [
        ("sides", domain.sides != Wall::Keep, planes.sides()),
        (
            "bottom",
            domain.bottom == Wall::Opaque || domain.sides != Wall::Extend && domain.bottom == Wall::Open,
            planes.bottom(),
        ),
        ("top", domain.top != Wall::Keep, planes.top()),
    ];
    let (mesh_min, mesh_max) = used_bounds(mesh);
    groups
        .into_iter()
        .filter(|&(_, set, planes)| set && !mesh.triangles.is_empty() && !faces.any(planes))
        .map(|(walls, ..)| DomainWarning::NoFaces {
            walls,
            mesh_min,
            mesh_max,
            box_min: domain.min,
            box_max: domain.max,
        })
        .collect()
}

/// Least and greatest corner of the triangles; inside out for a mesh without triangles.
pub(super) fn used_bounds(mesh: &RawMesh) -> (DVec3, DVec3) {
    mesh.triangles
        .iter()
        .flatten()
        .map(|&index| mesh.positions[index as usize])
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), p| (min.min(p), max.max(p)))
}

/// The six planes of a box; sets of them are bit masks with bit `Side.0`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Planes {
    pub min: DVec3,
    pub max: DVec3,
    pub up: Axis,
    tolerance: f64,
}

impl Planes {
    pub fn new(min: DVec3, max: DVec3, up: Axis) -> Self {
        Self { min, max, up, tolerance: TOLERANCE * (max - min).max_element() }
    }

    /// The planes that `p` is on.
    pub fn touched(&self, p: DVec3) -> u8 {
        (0..3).fold(0, |mask, axis| {
            let lower = u8::from((p[axis] - self.min[axis]).abs() <= self.tolerance);
            let upper = u8::from((p[axis] - self.max[axis]).abs() <= self.tolerance);
            mask | lower << (2 * axis) | upper << (2 * axis + 1)
        })
    }

    /// The plane below.
    pub fn bottom(&self) -> u8 {
        1 << (2 * self.up.index + usize::from(self.up.negative))
    }

    /// The plane above.
    pub fn top(&self) -> u8 {
        1 << (2 * self.up.index + usize::from(!self.up.negative))
    }

    /// The four upright planes.
    pub fn sides(&self) -> u8 {
        0b11_1111 & !self.bottom() & !self.top()
    }

    fn setting(&self, domain: &DomainDescription, side: Side) -> Wall {
        match 1_u8 << side.0 {
            bit if bit == self.bottom() => domain.bottom,
            bit if bit == self.top() => domain.top,
            _ => domain.sides,
        }
    }
}

/// Where the vertices and the faces of a mesh are with respect to the planes of the box.
pub(super) struct WallFaces {
    pub planes: Planes,
    /// The planes that each vertex is on.
    pub touched: Vec<u8>,
    /// The wall that each triangle lies on.
    pub sides: Vec<Option<Side>>,
}

impl WallFaces {
    pub fn find(mesh: &RawMesh, planes: Planes) -> Self {
        let touched: Vec<u8> = mesh.positions.iter().map(|&p| planes.touched(p)).collect();
        let sides = mesh
            .triangles
            .iter()
            .map(|triangle| {
                let shared = triangle.iter().fold(u8::MAX, |mask, &index| mask & touched[index as usize]);
                Side::ALL.into_iter().find(|side| shared & (1 << side.0) != 0)
            })
            .collect();
        Self { planes, touched, sides }
    }

    /// True when triangle `i` lies on one of `planes`.
    pub fn is_on(&self, i: usize, planes: u8) -> bool {
        self.sides[i].is_some_and(|side| planes & (1 << side.0) != 0)
    }

    /// True when any triangle lies on one of `planes`.
    pub fn any(&self, planes: u8) -> bool {
        (0..self.sides.len()).any(|i| self.is_on(i, planes))
    }

    /// The planes that both vertices are on.
    pub fn shared(&self, a: u32, b: u32) -> u8 {
        self.touched[a as usize] & self.touched[b as usize]
    }
}
