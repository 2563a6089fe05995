//! Wavefront OBJ.
//!
//! Vertices `v`, normals `vn` and faces `f` in all their forms: `a`, `a/b`, `a//c`, `a/b/c`, indices that count
//! from 1 or, when negative, back from the last; polygons become fans. Groups and objects are one mesh, and
//! their shared vertices stay shared. Lines, points, curves, texture coordinates, colours and materials are
//! passed over; no other file is opened. A fourth coordinate divides the others.
//!
//! Vertices are numbered as the faces first use them; unused ones are left out. Normals count only if every
//! corner has one.

mod screen;

use std::str;

use glam::{DVec3, Vec3};
use tobj::{LoadError, LoadOptions, Mesh};

use self::screen::Screen;
use super::error::{Fault, Place};
use super::{CornerNormals, RawMesh};

const OPTIONS: LoadOptions =
    LoadOptions { single_index: false, triangulate: true, ignore_points: true, ignore_lines: true };

/// Reads an OBJ file.
pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, Fault> {
    let mut screen = Screen::new(bytes);
    let loaded = tobj::load_obj_buf(&mut screen, &OPTIONS, |_| Err(LoadError::GenericFailure))
        .map(|(models, _)| models);
    screen.finish()?;
    let models = loaded.map_err(|error| {
        let place = Place::Line(screen.line());
        Fault::malformed(
            place,
            format!("{error} in '{}'", screen.text()),
            "correct the line or write the file again",
        )
    })?;
    let all_normals = screen.every_corner_has_normal();
    drop(screen);
    // Groups are screened out, so that there is one model.
    let mesh = models.into_iter().next().map(|model| model.mesh).unwrap_or_default();
    if mesh.positions.is_empty() && str::from_utf8(bytes).is_err() {
        let problem = "no faces, and bytes that are no text";
        return Err(Fault::malformed(Place::File, problem, "this is no OBJ file; rename or remove it"));
    }
    convert(mesh, all_normals).map_err(|vertex| screen::not_finite(bytes, vertex))
}

/// The mesh, or the first position that is not finite.
fn convert(mesh: Mesh, all_normals: bool) -> Result<RawMesh, DVec3> {
    let positions: Vec<DVec3> = mesh.positions.chunks_exact(3).map(DVec3::from_slice).collect();
    if let Some(&position) = positions.iter().find(|position| !position.is_finite()) {
        return Err(position);
    }
    let normals = (all_normals && !mesh.normal_indices.is_empty()).then(|| CornerNormals {
        values: mesh.normals.chunks_exact(3).map(|n| DVec3::from_slice(n).as_vec3()).collect::<Vec<Vec3>>(),
        corners: Some(triples(&mesh.normal_indices)),
    });
    Ok(RawMesh { positions, triangles: triples(&mesh.indices), interfaces: None, normals, velocities: None })
}

fn triples(indices: &[u32]) -> Vec<[u32; 3]> {
    indices.as_chunks::<3>().0.to_vec()
}

#[cfg(test)]
mod tests;
