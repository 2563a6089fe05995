//! Interfaces between regions, read from what simulators write.
//!
//! [`read()`] takes a mesh from a file as it is; [`prepare()`] makes it fit for rays: it drops what has no area,
//! joins the vertices of triangle soups, and gives closed meshes without labels the outside in front and a region
//! behind. What it changes or doubts it tells as [`MeshWarning`]s. [`topology`] looks at the edges, [`canonical`]
//! compares surfaces whatever their order.
//!
//! Adding a format takes a reader, a variant of [`Syntax`] and its lines in [`FORMATS`], which the tests walk.

pub mod canonical;
pub mod normals;
pub mod topology;

mod bobj;
mod check;
mod coarse;
mod coincident;
mod content;
mod corner_classes;
pub(crate) mod disjoint;
mod dsc;
mod edges;
mod error;
mod follow;
mod limits;
mod obj;
mod ply;
mod polygons;
mod prepare;
mod read;
mod slices;
mod stl;
mod velocity;
mod vtk;
mod weld;
mod words;

pub use coarse::Coarse;
pub use error::{MeshError, Place};
pub use follow::{NotFollowed, follow};
pub use prepare::{MeshWarning, prepare, prepare_sheets};
pub use read::{
    FORMATS, Format, Syntax, add_velocities, parse, read, read_bytes, read_with, velocities_beside,
};
pub use slices::{MeshSlices, Positions};
pub use velocity::{VelocityName, VelocityProperty};
pub use weld::weld;

use glam::{DVec3, Vec3};

/// The label of a phase in the simulation's files; 0 is the outside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Region(pub i32);

impl Region {
    /// Label 0: what surrounds the simulated phases.
    pub const OUTSIDE: Self = Self(0);
}

/// The regions on the two sides of a triangle; its right-hand normal points into `front`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Interface {
    /// The side that the normal points to.
    pub front: Region,
    /// The other side.
    pub back: Region,
}

/// A mesh as its file has it: positions in the file's units and double precision.
///
/// Every index is below the number of positions, every position is finite (the readers see to both).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RawMesh {
    /// Vertex positions in the file's units.
    pub positions: Vec<DVec3>,
    /// Three vertex indices a triangle, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// What lies on the two sides of each triangle; `None` when the file carries no labels.
    pub interfaces: Option<Vec<Interface>>,
    /// Normals that the file gives, if any; not to be trusted before they are compared with the faces.
    pub normals: Option<CornerNormals>,
    /// One velocity a vertex, in the file's units per second; `None` when the file has none or nobody asked for them.
    /// They may not be finite before [`prepare()`].
    pub velocities: Option<Vec<Vec3>>,
}

/// Normals and which of them belongs to each corner of each triangle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CornerNormals {
    /// The normals; unit length is not promised.
    pub values: Vec<Vec3>,
    /// Three indices into `values` a triangle; `None` when each vertex has the normal of the same index.
    pub corners: Option<Vec<[u32; 3]>>,
}
