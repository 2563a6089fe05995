//! Makes a mesh fit for rays: areas, shared vertices and labels.

use std::fmt;
use std::path::Path;

use glam::{DVec3, Vec3};

use super::coarse::Coarse;
use super::coincident::{Twins, merge_coincident};
use super::error::MeshError;
use super::topology::topology;
use super::{Interface, RawMesh, Region, weld};

/// What was changed about a mesh, or is doubtful about it.
#[derive(Clone, Debug, PartialEq)]
pub enum MeshWarning {
    /// There are no triangles (left).
    Empty,
    /// Triangles that repeat a vertex or have no area were dropped.
    Degenerate {
        /// How many.
        dropped: usize,
    },
    /// Triangles with the same region on both sides were dropped.
    SameRegion {
        /// How many.
        dropped: usize,
        /// The region of the first.
        region: Region,
    },
    /// Vertices of the same position were joined.
    Welded {
        /// How many vertices there were.
        before: usize,
        /// How many there are.
        after: usize,
    },
    /// Triangles of the same three points were taken as one boundary.
    Coincident {
        /// How many were dropped.
        dropped: usize,
    },
    /// Edges that have a triangle on one side only: the surface has holes or a rim.
    Open {
        /// How many.
        edges: usize,
        /// The ends of the first.
        first: [DVec3; 2],
        /// Whether the file gave the labels; if not, they are a guess.
        labelled: bool,
    },
    /// A closed mesh without labels whose normals pointed inwards.
    InsideOut,
    /// The outside lies within the other regions of a closed mesh with labels.
    OutsideWithin,
    /// Coordinates in single precision so far from zero that they have lost their detail.
    Coarse(Coarse),
    /// Edges around which the labels (or, without labels, the windings) contradict each other.
    Inconsistent {
        /// How many.
        edges: usize,
        /// The ends of the first.
        first: [DVec3; 2],
    },
    /// Velocities that are not finite were set to zero.
    Velocities {
        /// How many.
        not_finite: usize,
        /// Of how many.
        all: usize,
    },
}

impl fmt::Display for MeshWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Empty => write!(f, "the mesh has no triangles"),
            Self::Degenerate { dropped } => write!(f, "{dropped} triangles without area were dropped"),
            Self::SameRegion { dropped, region } => write!(
                f,
                "{dropped} triangles with the same label on both sides (the first: {}) were dropped",
                region.0
            ),
            Self::Coincident { dropped } => {
                write!(f, "{dropped} triangles that lie exactly on others were joined with them")
            }
            Self::Welded { before, after } => {
                write!(f, "vertices of the same position were joined: {after} are left of {before}")
            }
            Self::Open { edges, first: [a, b], labelled } => {
                write!(f, "the surface is open: {edges} edges have one triangle, the first from {a} to {b}")?;
                if !labelled {
                    write!(
                        f,
                        "; without labels in the file, its inside is taken to be where no normal points"
                    )?;
                }
                Ok(())
            }
            Self::InsideOut => {
                write!(f, "the normals of the closed surface point inwards; its sides were swapped")
            }
            Self::OutsideWithin => write!(
                f,
                "label 0, the outside, lies within the other regions: in front of a triangle, where its right-hand \
                 normal points, is label_front; swap the labels, or the order of the vertices"
            ),
            Self::Coarse(coarse) => coarse.fmt(f),
            Self::Velocities { not_finite, all } => {
                write!(
                    f,
                    "{not_finite} of {all} velocities are not finite; these vertices are taken to be still"
                )
            }
            Self::Inconsistent { edges, first: [a, b] } => {
                write!(
                    f,
                    "what lies on either side contradicts itself around {edges} edges, the first from {a} to {b}"
                )
            }
        }
    }
}

/// Makes a mesh fit for rays and gives it labels; `inside` is the region within meshes that have none.
///
/// Afterwards every triangle has an area and two different regions, in `interfaces`. `path` is named in errors.
///
/// # Errors
/// [`MeshError::Invalid`] when the parts of the mesh do not fit together; the readers return no such mesh.
pub fn prepare(mesh: RawMesh, inside: Region, path: &Path) -> Result<(RawMesh, Vec<MeshWarning>), MeshError> {
    prepare_as(mesh, inside, Twins::Joined, path)
}

/// The same for a mesh that need not be the boundary of anything, and has no labels: a sheet may be written from both sides.
///
/// # Errors
/// Those of [`prepare()`].
pub fn prepare_sheets(mesh: RawMesh, path: &Path) -> Result<(RawMesh, Vec<MeshWarning>), MeshError> {
    prepare_as(RawMesh { interfaces: None, ..mesh }, Region(1), Twins::Kept, path)
}

fn prepare_as(
    mut mesh: RawMesh,
    inside: Region,
    twins: Twins,
    path: &Path,
) -> Result<(RawMesh, Vec<MeshWarning>), MeshError> {
    mesh.check(path)?;
    let labelled = mesh.interfaces.is_some();
    let mut warnings = Vec::from_iter(still_the_not_finite(&mut mesh));
    warnings.extend(Coarse::of(&mesh).map(MeshWarning::Coarse));
    let repeats = mesh.retain(|_, [a, b, c]| a != b && b != c && c != a);
    let mut report = topology(&mesh);
    let mut dropped = repeats;
    if !report.is_closed() {
        let before = mesh.positions.len();
        weld(&mut mesh);
        let after = mesh.positions.len();
        if after < before {
            warnings.push(MeshWarning::Welded { before, after });
            dropped += mesh.retain(|_, [a, b, c]| a != b && b != c && c != a);
            report = topology(&mesh);
        }
    }
    if let Some(first) = report.first_open_edge {
        warnings.push(MeshWarning::Open { edges: report.open_edges, first, labelled });
    }
    if let Some(first) = report.first_inconsistent_edge {
        warnings.push(MeshWarning::Inconsistent { edges: report.inconsistent_edges, first });
    }
    if labelled {
        let is_within = report.is_closed() && volume_within_outside(&mesh) < 0.0;
        warnings.extend(is_within.then_some(MeshWarning::OutsideWithin));
    } else {
        let inside_out = report.is_closed() && volume(&mesh, |_| 1.0) < 0.0;
        warnings.extend(inside_out.then_some(MeshWarning::InsideOut));
        mesh.interfaces = Some(vec![interface_of(inside, inside_out); mesh.triangles.len()]);
    }
    let coincident = merge_coincident(&mut mesh, twins);
    warnings.extend((coincident > 0).then_some(MeshWarning::Coincident { dropped: coincident }));
    if coincident > 0 && mesh.velocities.is_some() {
        // The sheets that are left must go on meeting where they move.
        weld(&mut mesh);
    }
    // Only now: what has no area still joins its neighbours.
    dropped += mesh.retain(|mesh, triangle| !mesh.has_no_area(triangle));
    warnings.extend((dropped > 0).then_some(MeshWarning::Degenerate { dropped }));
    warnings.extend(drop_same_region(&mut mesh));
    warnings.extend(mesh.triangles.is_empty().then_some(MeshWarning::Empty));
    Ok((mesh, warnings))
}

fn interface_of(inside: Region, inside_out: bool) -> Interface {
    let (front, back) = if inside_out { (inside, Region::OUTSIDE) } else { (Region::OUTSIDE, inside) };
    Interface { front, back }
}

fn drop_same_region(mesh: &mut RawMesh) -> Option<MeshWarning> {
    let interfaces = mesh.interfaces.as_deref()?;
    let region = interfaces.iter().find(|interface| interface.front == interface.back)?.front;
    let kept: Vec<bool> = interfaces.iter().map(|interface| interface.front != interface.back).collect();
    let dropped = kept.iter().filter(|&&keep| !keep).count();
    mesh.retain_triangles(&kept);
    Some(MeshWarning::SameRegion { dropped, region })
}

/// Six times the volume that a closed mesh encloses, positive when its normals point outwards; each triangle counts as
/// often as `side` says of its number. 0 where it cannot be told from rounding.
fn volume(mesh: &RawMesh, side: impl Fn(usize) -> f64) -> f64 {
    // Relative to a point of the mesh, so that a far origin costs no digits.
    let origin = mesh.positions.first().copied().unwrap_or_default();
    let corner = |index: u32| mesh.positions[index as usize] - origin;
    let (mut sum, mut of_magnitudes) = (0.0, 0.0);
    for (triangle, &[a, b, c]) in mesh.triangles.iter().enumerate() {
        let part: f64 = corner(a).dot(corner(b).cross(corner(c))) * side(triangle);
        sum += part;
        of_magnitudes += part.abs();
    }
    // Each part and each sum is off by a few roundings of what it is made of.
    let rounding = 4.0 * f64::EPSILON * mesh.triangles.len() as f64 * of_magnitudes;
    if f64::abs(sum) > rounding { sum } else { 0.0 }
}

/// Six times the volume of all that is not the outside; negative where the outside lies within it.
fn volume_within_outside(mesh: &RawMesh) -> f64 {
    volume(mesh, |triangle| match mesh.interfaces.as_deref().map(|interfaces| interfaces[triangle]) {
        Some(Interface { front: Region::OUTSIDE, .. }) => 1.0,
        Some(Interface { back: Region::OUTSIDE, .. }) => -1.0,
        _ => 0.0,
    })
}

/// Sets velocities that are not finite to zero.
fn still_the_not_finite(mesh: &mut RawMesh) -> Option<MeshWarning> {
    let velocities = mesh.velocities.as_mut()?;
    let all = velocities.len();
    let mut not_finite = 0;
    for velocity in velocities.iter_mut().filter(|velocity| !velocity.is_finite()) {
        *velocity = Vec3::ZERO;
        not_finite += 1;
    }
    (not_finite > 0).then_some(MeshWarning::Velocities { not_finite, all })
}

/// Keeps the items that are marked.
pub(super) fn retain_marked<T>(items: &mut Vec<T>, kept: &[bool]) {
    let mut marks = kept.iter();
    items.retain(|_| marks.next().copied().unwrap_or(true));
}

impl RawMesh {
    /// Whether a triangle has exactly no area in double precision.
    pub(super) fn has_no_area(&self, triangle: [u32; 3]) -> bool {
        let [a, b, c] = triangle.map(|index| self.positions[index as usize]);
        (b - a).cross(c - a) == DVec3::ZERO
    }

    /// Keeps the triangles that are marked, with their labels and normals.
    pub(super) fn retain_triangles(&mut self, kept: &[bool]) {
        retain_marked(&mut self.triangles, kept);
        if let Some(interfaces) = &mut self.interfaces {
            retain_marked(interfaces, kept);
        }
        if let Some(corners) = self.normals.as_mut().and_then(|normals| normals.corners.as_mut()) {
            retain_marked(corners, kept);
        }
    }

    /// Keeps the triangles that pass; tells how many did not.
    fn retain(&mut self, passes: impl Fn(&Self, [u32; 3]) -> bool) -> usize {
        let failing = self.triangles.iter().filter(|&&triangle| !passes(self, triangle)).count();
        if failing > 0 {
            let kept: Vec<bool> = self.triangles.iter().map(|&triangle| passes(self, triangle)).collect();
            self.retain_triangles(&kept);
        }
        failing
    }
}

#[cfg(test)]
mod tests;
