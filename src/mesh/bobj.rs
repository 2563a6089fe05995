//! Binary OBJ, the caches of two fluid solvers: Mantaflow (with normals) and FLIP Fluids (without).
//!
//! ```text
//! int32 vertices,  float32 position[3] each
//! int32 normals,   float32 normal[3] each       Mantaflow only: as many as vertices, or none
//! int32 triangles, int32 index[3] each          from 0; the least byte first everywhere
//! ```
//! Nothing in a file says which of the two it is but its length: every element has 12 bytes, so that the counts
//! leave 12 bytes or 8 over.
//!
//! FLIP Fluids writes velocities into files of their own, as the vertices of a mesh without triangles:
//! `velocity000012.bobj` beside `000012.bobj`. Those of Mantaflow in Blender (`fluid_mesh_0012.uni` or `.vdb`) count
//! cells a frame, whose size is in neither file; they are not read.

use std::path::{Path, PathBuf};

use glam::{DVec3, Vec3};

use super::error::{Fault, Place};
use super::limits::{MAX_TRIANGLES, MAX_VERTICES, check_count};
use super::{CornerNormals, RawMesh};

/// Bytes of three numbers.
const ELEMENT: usize = 12;

const WRITE_AGAIN: &str = "the file is truncated or no binary OBJ file; write it again";

/// Reads a binary OBJ file.
pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, Fault> {
    let (vertices, rest) = block(bytes, "vertex", MAX_VERTICES)?;
    let positions = positions(vertices)?;
    let (normals, rest) = match bytes.len() % ELEMENT {
        0 => block(rest, "normal", MAX_VERTICES)?,
        8 => (&[][..], rest),
        _ => return Err(wrong_length(bytes.len())),
    };
    let (faces, rest) = block(rest, "triangle", MAX_TRIANGLES)?;
    if !rest.is_empty() {
        let problem = format!("{} bytes are left behind the triangles", rest.len());
        return Err(Fault::malformed(Place::Byte(bytes.len() - rest.len()), problem, WRITE_AGAIN));
    }
    let triangles = triangles(faces, positions.len())?;
    Ok(RawMesh {
        normals: corner_normals(normals, positions.len())?,
        positions,
        triangles,
        ..RawMesh::default()
    })
}

/// The file of velocities beside the file of a mesh, compressed or not.
pub(super) fn velocity_file(mesh: &Path) -> Option<PathBuf> {
    let name = mesh.file_name()?.to_str()?;
    let lower = name.to_ascii_lowercase();
    let plain = &name[..lower.strip_suffix(".gz").unwrap_or(&lower).len()];
    let names = [format!("velocity{name}"), format!("velocity{plain}"), format!("velocity{plain}.gz")];
    names.into_iter().map(|name| mesh.with_file_name(name)).find(|path| path.is_file())
}

/// Reads a file of velocities for a mesh of so many vertices.
pub(super) fn read_velocities(bytes: &[u8], vertices: usize) -> Result<Vec<Vec3>, Fault> {
    let (velocities, _) = block(bytes, "velocity", MAX_VERTICES)?;
    let velocities = vectors(velocities);
    if velocities.len() == vertices {
        return Ok(velocities);
    }
    let problem = format!("{} velocities, but the mesh has {vertices} vertices", velocities.len());
    Err(Fault::invalid(Place::File, problem, "write both files of this frame again"))
}

fn wrong_length(length: usize) -> Fault {
    let problem = format!("the file has {length} bytes, which is no multiple of 12, nor one and 8 more");
    Fault::malformed(Place::File, problem, WRITE_AGAIN)
}

/// The elements that a count announces, and what follows them.
fn block<'a>(bytes: &'a [u8], name: &str, most: usize) -> Result<(&'a [u8], &'a [u8]), Fault> {
    let Some((count, rest)) = bytes.split_first_chunk() else {
        let problem = format!("the file ends where the count of this list is expected (list '{name}')");
        return Err(Fault::malformed(Place::File, problem, WRITE_AGAIN));
    };
    let declared = i32::from_le_bytes(*count);
    let Ok(count) = usize::try_from(declared) else {
        let problem = format!("{declared} elements are declared (list '{name}')");
        return Err(Fault::malformed(Place::File, problem, WRITE_AGAIN));
    };
    check_count(name, count, ELEMENT, rest.len(), most)?;
    Ok(rest.split_at(ELEMENT * count))
}

/// Three numbers of four bytes each, of every element.
fn triples(bytes: &[u8]) -> impl Iterator<Item = [[u8; 4]; 3]> {
    bytes.as_chunks::<4>().0.as_chunks::<3>().0.iter().copied()
}

fn vectors(bytes: &[u8]) -> Vec<Vec3> {
    triples(bytes).map(|triple| Vec3::from_array(triple.map(f32::from_le_bytes))).collect()
}

fn positions(bytes: &[u8]) -> Result<Vec<DVec3>, Fault> {
    let positions: Vec<DVec3> = vectors(bytes).into_iter().map(Vec3::as_dvec3).collect();
    match positions.iter().position(|position| !position.is_finite()) {
        None => Ok(positions),
        Some(index) => {
            let problem = format!("the coordinates {} are not finite", positions[index]);
            let cure = "the simulation or its writer failed here; coordinates must be finite";
            Err(Fault::invalid(Place::element("vertex", index), problem, cure))
        }
    }
}

fn triangles(bytes: &[u8], vertices: usize) -> Result<Vec<[u32; 3]>, Fault> {
    // A negative index read without its sign is at least 2^31, and so out of range.
    let most = vertices.min(1 << 31);
    let triangles: Vec<[u32; 3]> = triples(bytes).map(|triple| triple.map(u32::from_le_bytes)).collect();
    match triangles.iter().position(|triangle| triangle.iter().any(|&index| index as usize >= most)) {
        None => Ok(triangles),
        Some(t) => {
            let wrong = triangles[t].into_iter().find(|&index| index as usize >= most).unwrap_or_default();
            let problem = format!("vertex index {}, but there are {vertices} vertices", wrong.cast_signed());
            let cure = "indices count from 0; write the file again";
            Err(Fault::invalid(Place::element("triangle", t), problem, cure))
        }
    }
}

fn corner_normals(bytes: &[u8], vertices: usize) -> Result<Option<CornerNormals>, Fault> {
    let values = vectors(bytes);
    match values.len() {
        0 => Ok(None),
        count if count == vertices => Ok(Some(CornerNormals { values, corners: None })),
        count => {
            let problem = format!("{count} normals for {vertices} vertices");
            Err(Fault::malformed(Place::File, problem, "write as many normals as vertices, or none"))
        }
    }
}

#[cfg(test)]
mod tests;
