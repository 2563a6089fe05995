//! The interface of a labelled tetrahedral mesh.

use glam::DVec3;

use super::faces::{FaceId, FacesByVertex, outward, owner};
use super::orientation::{signed_volume, signs};
use super::{Complex, parse};
use crate::mesh::error::{Fault, Place};
use crate::mesh::{Interface, RawMesh, Region};

/// What is wrong with the connectivity, by the numbers of tetrahedra.
#[derive(Debug, PartialEq)]
pub(super) enum ComplexError {
    /// A face of three tetrahedra or more.
    Crowded([u32; 3], Vec<usize>),
    /// Two tetrahedra of the same four vertices.
    Repeated(usize, usize),
    /// An interface face whose tetrahedra and all those joined to them are flat.
    Flat(usize),
}

impl ComplexError {
    /// The error with the lines of the file that it is about.
    pub fn fault(self, bytes: &[u8]) -> Fault {
        let line = |tetrahedron| parse::line_of_tetrahedron(bytes, tetrahedron);
        match self {
            Self::Crowded([a, b, c], tetrahedra) => {
                let lines: Vec<_> = tetrahedra.iter().take(8).map(|&t| line(t).to_string()).collect();
                let count = tetrahedra.len();
                let lines = lines.join(", ");
                let problem =
                    format!("{count} tetrahedra (lines {lines}) share the face of vertices {a}, {b}, {c}");
                let place = tetrahedra.first().map_or(Place::File, |&t| Place::Line(line(t)));
                Fault::invalid(place, problem, "a face has two sides; remove the tetrahedra that overlap")
            }
            Self::Repeated(first, second) => {
                let problem = format!("the tetrahedron of line {} again", line(first));
                Fault::invalid(Place::Line(line(second)), problem, "remove one of the two")
            }
            Self::Flat(tetrahedron) => {
                let problem =
                    "this tetrahedron and all that are joined to it are flat, its faces have no sides";
                Fault::invalid(Place::Line(line(tetrahedron)), problem, "check the positions of its vertices")
            }
        }
    }
}

/// The faces between different labels, and the faces of the boundary whose label is not 0.
pub(super) fn extract(complex: &Complex) -> Result<RawMesh, ComplexError> {
    let faces = FacesByVertex::of(complex);
    let mut triangles = Vec::new();
    let mut interfaces = Vec::new();
    let mut flat = Vec::new();
    faces.try_for_each(complex, |sharing| {
        let label = |face: FaceId| complex.labels[owner(face)];
        let (face, across) = match *sharing {
            [face] => (face, Region::OUTSIDE.0),
            [a, b] => {
                check_distinct(complex, a, b)?;
                let thicker =
                    signed_volume(complex, owner(a)).abs() >= signed_volume(complex, owner(b)).abs();
                if thicker { (a, label(b)) } else { (b, label(a)) }
            }
            _ => return Err(crowded(complex, sharing)),
        };
        let own = label(face);
        if own == across {
            return Ok(());
        }
        let volume = signed_volume(complex, owner(face));
        if volume == 0.0 {
            flat.push((triangles.len(), face));
        }
        // The normal is to point into the lower label, which is across if the own one is higher.
        triangles.push(turned(outward(complex, face), (volume < 0.0) != (own < across)));
        let (front, back) = (Region(own.min(across)), Region(own.max(across)));
        interfaces.push(Interface { front, back });
        Ok(())
    })?;
    side_flat(complex, &faces, &flat, &mut triangles)?;
    drop(faces);
    let positions = compact(&complex.positions, &mut triangles);
    Ok(RawMesh { positions, triangles, interfaces: Some(interfaces), normals: None, velocities: None })
}

/// Turns the faces of flat tetrahedra, which were taken for positive ones.
fn side_flat(
    complex: &Complex,
    faces: &FacesByVertex,
    flat: &[(usize, FaceId)],
    triangles: &mut [[u32; 3]],
) -> Result<(), ComplexError> {
    if flat.is_empty() {
        return Ok(());
    }
    let signs = signs(complex, faces);
    for &(triangle, face) in flat {
        let [a, b, c] = triangles[triangle].map(|index| complex.positions[index as usize]);
        match signs[owner(face)] {
            0 if (b - a).cross(c - a) != DVec3::ZERO => return Err(ComplexError::Flat(owner(face))),
            sign => triangles[triangle] = turned(triangles[triangle], sign < 0),
        }
    }
    Ok(())
}

fn turned([a, b, c]: [u32; 3], turn: bool) -> [u32; 3] {
    if turn { [a, c, b] } else { [a, b, c] }
}

/// Refuses two tetrahedra of the same vertices: they share not only this face but also the corner opposite.
fn check_distinct(complex: &Complex, a: FaceId, b: FaceId) -> Result<(), ComplexError> {
    let opposite = |face: FaceId| complex.tetrahedra[owner(face)][(face % 4) as usize];
    if opposite(a) == opposite(b) {
        return Err(ComplexError::Repeated(owner(a), owner(b)));
    }
    Ok(())
}

fn crowded(complex: &Complex, sharing: &[FaceId]) -> ComplexError {
    for (k, &a) in sharing.iter().enumerate() {
        for &b in &sharing[..k] {
            if let Err(repeated) = check_distinct(complex, b, a) {
                return repeated;
            }
        }
    }
    let mut vertices = sharing.first().map_or([0; 3], |&face| outward(complex, face));
    vertices.sort_unstable();
    ComplexError::Crowded(vertices, sharing.iter().map(|&face| owner(face)).collect())
}

/// The positions in use, in their order; the triangles' indices follow.
fn compact(positions: &[DVec3], triangles: &mut [[u32; 3]]) -> Vec<DVec3> {
    let mut new_index = vec![u32::MAX; positions.len()];
    for &index in triangles.iter().flatten() {
        new_index[index as usize] = 0;
    }
    let mut kept = Vec::new();
    for (index, &position) in new_index.iter_mut().zip(positions) {
        if *index == 0 {
            *index = kept.len() as u32;
            kept.push(position);
        }
    }
    for index in triangles.iter_mut().flatten() {
        *index = new_index[*index as usize];
    }
    kept
}
