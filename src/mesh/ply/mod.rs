//! The polygon file format (PLY).
//!
//! Text and both byte orders, every scalar type in both spellings, any list types, polygons (as fans), elements
//! and properties of any name. Of these the reader takes, from `vertex`, the coordinates `x y z` and the normals
//! `nx ny nz` (where all three are there), velocities where they are asked for, and from `face` the list `vertex_indices` or `vertex_index` and the
//! labels `label_front label_back`. The right-hand normal of a face points into `label_front`; labels are whole
//! numbers of any integer type within 32 bits.
//!
//! Two readers share the header: a direct one for the layout that nearly every simulator writes, and one for
//! everything else. Where both apply they give the same mesh. The direct one never fails: it leaves whatever is
//! unusual, errors included, to the other.

mod direct;
mod elements;
mod general;
mod header;

use super::error::Fault;
use super::{RawMesh, VelocityName};

/// Reads a PLY file.
pub(super) fn read(bytes: &[u8], velocity: &VelocityName) -> Result<RawMesh, Fault> {
    let header = header::read(bytes, velocity)?;
    let payload = &bytes[header.length..];
    match direct::read(&header, payload) {
        Some(mesh) => Ok(mesh),
        None => general::read(&header, payload),
    }
}

#[cfg(test)]
mod tests;
