//! The files of the Visualization Toolkit: legacy (`.vtk`) and XML (`.vtp`).
//!
//! Both say the same: points; lists of cells, each cell a run of point indices; and arrays over points and over
//! cells. [`surface`] makes a mesh of it, and does not know which of the two it came from:
//!
//! * polygons, triangles, quads, pixels and strips are its triangles; vertices and lines are passed over; a cell
//!   with a volume is an error;
//! * cell arrays `label_front` and `label_back` are its labels;
//! * a point array named `Normals` gives normals, one named as [`VelocityName`] knows gives velocities.
//!
//! Arrays of other names are passed over.

mod arrays;
mod legacy;
mod number;
mod surface;
mod xml;

use super::error::Fault;
use super::{RawMesh, VelocityName};

/// Reads a legacy file.
pub(super) fn read_legacy(bytes: &[u8], velocity: &VelocityName) -> Result<RawMesh, Fault> {
    surface::mesh(legacy::read(bytes, velocity)?)
}

/// Reads an XML file.
pub(super) fn read_xml(bytes: &[u8], velocity: &VelocityName) -> Result<RawMesh, Fault> {
    surface::mesh(xml::read(bytes, velocity)?)
}

/// Everything of a file that a mesh is made of.
#[derive(Debug)]
struct Dataset {
    /// Three coordinates a point.
    coordinates: Vec<f64>,
    cells: CellLists,
    arrays: arrays::Chosen,
}

/// Runs of point indices: cell c has those from `offsets[c]` to `offsets[c + 1]`.
#[derive(Clone, Debug, Default)]
struct Cells {
    offsets: Vec<usize>,
    connectivity: Vec<i64>,
}

/// The cells of a dataset, in the order in which cell arrays count them.
#[derive(Clone, Debug)]
enum CellLists {
    /// Vertices, lines, polygons and strips.
    Poly([Cells; 4]),
    /// Cells and the type of each.
    Typed(Cells, Vec<i64>),
}
