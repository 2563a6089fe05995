//! The native files of deformable simplicial complexes (`.dsc`): labelled tetrahedra as text.
//!
//! ```text
//! v <x> <y> <z>                    vertex, numbered 0, 1, 2, ... in order
//! t <i0> <i1> <i2> <i3> <label>    tetrahedron
//! ```
//! White space is free and vertices may come after the tetrahedra that use them. The interface is every face
//! between tetrahedra of different labels, and every face of the domain's boundary whose label is not 0. A face
//! has the lower label in front and the higher one behind, as in the surface files of the same programs: its
//! normal points from the higher label to the lower.
//!
//! Tetrahedra come in both orientations, so that faces are oriented by position and label and never by the
//! order of vertices. A flat tetrahedron has no side of its own; it takes it from its neighbours.
//!
//! Label 999 is a shell that programs of several phases put around the domain. It is read as the outside,
//! label 0: faces between the two vanish, and so does the shell's outer boundary.
//!
//! The reference importer may write the last tetrahedron twice; the copy is dropped. Any other repeated
//! tetrahedron and a face of three or more tetrahedra are errors.

mod faces;
mod interface;
mod orientation;
mod parse;

use super::RawMesh;
use super::error::Fault;

/// A tetrahedral mesh with one label a tetrahedron.
#[derive(Debug, Default)]
struct Complex {
    positions: Vec<glam::DVec3>,
    tetrahedra: Vec<[u32; 4]>,
    labels: Vec<i32>,
}

/// Reads a `.dsc` file and extracts its interface.
pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, Fault> {
    let complex = parse::parse(bytes)?;
    interface::extract(&complex).map_err(|error| error.fault(bytes))
}

#[cfg(test)]
mod tests;
