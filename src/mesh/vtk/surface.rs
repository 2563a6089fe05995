//! The mesh of a dataset.

use glam::DVec3;

use super::arrays::Chosen;
use super::number::whole;
use super::{CellLists, Cells, Dataset};
use crate::mesh::error::{Fault, Place};
use crate::mesh::limits::{MAX_TRIANGLES, MAX_VERTICES};
use crate::mesh::polygons::{add_fan, add_strip, region};
use crate::mesh::{CornerNormals, Interface, RawMesh, Region};

/// What the indices of a cell mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shape {
    /// Nothing of a surface.
    Skipped,
    /// Corners around a polygon; of a fixed number where there is one.
    Polygon(Option<usize>),
    /// Corners of a rectangle, row by row.
    Pixel,
    /// Each corner makes a triangle with the two before it.
    Strip,
}

/// Triangles, and the cell that each came from.
#[derive(Debug, Default)]
struct Faces {
    triangles: Vec<[u32; 3]>,
    cell_of: Vec<u32>,
    cells: usize,
}

impl Faces {
    fn add(
        &mut self,
        indices: &[i64],
        shape: Shape,
        points: usize,
        place: impl Fn() -> Place,
    ) -> Result<(), Fault> {
        let wanted = match shape {
            Shape::Polygon(corners) => corners,
            Shape::Pixel => Some(4),
            Shape::Skipped | Shape::Strip => None,
        };
        if let Some(wanted) = wanted.filter(|&wanted| wanted != indices.len()) {
            let problem = format!("a cell of {} corners that ought to have {wanted}", indices.len());
            return Err(Fault::malformed(place(), problem, "write the file again"));
        }
        match (shape, indices) {
            (Shape::Skipped, _) => {}
            (Shape::Pixel, &[a, b, c, d]) => add_fan(&[a, b, d, c], points, &mut self.triangles, place)?,
            (Shape::Strip, _) => add_strip(indices, points, &mut self.triangles, place)?,
            (Shape::Polygon(_) | Shape::Pixel, _) => add_fan(indices, points, &mut self.triangles, place)?,
        }
        self.cell_of.resize(self.triangles.len(), self.cells as u32);
        self.cells += 1;
        Ok(())
    }
}

/// Makes the mesh of a dataset.
pub(super) fn mesh(dataset: Dataset) -> Result<RawMesh, Fault> {
    let positions = positions(&dataset.coordinates)?;
    let mut faces = Faces::default();
    match &dataset.cells {
        CellLists::Poly(lists) => add_lists(&mut faces, lists, positions.len())?,
        CellLists::Typed(cells, types) => add_typed(&mut faces, cells, types, positions.len())?,
    }
    let Chosen { normals, velocities, labels } = dataset.arrays;
    let interfaces = labels.map(|labels| interfaces(&labels, &faces)).transpose()?;
    let normals = normals.map(|values| CornerNormals { values, corners: None });
    Ok(RawMesh { positions, triangles: faces.triangles, interfaces, normals, velocities })
}

fn positions(coordinates: &[f64]) -> Result<Vec<DVec3>, Fault> {
    if coordinates.len() / 3 > MAX_VERTICES {
        let problem = format!("more than {MAX_VERTICES} points");
        return Err(Fault::too_large(Place::File, problem, "split the mesh into several files"));
    }
    let positions: Vec<DVec3> = coordinates.chunks_exact(3).map(DVec3::from_slice).collect();
    match positions.iter().position(|position| !position.is_finite()) {
        None => Ok(positions),
        Some(index) => {
            let problem = format!("the coordinates {} are not finite", positions[index]);
            let cure = "the simulation or its writer failed here; coordinates must be finite";
            Err(Fault::invalid(Place::element("point", index), problem, cure))
        }
    }
}

fn add_lists(faces: &mut Faces, lists: &[Cells; 4], points: usize) -> Result<(), Fault> {
    let shapes = [
        ("vertex cell", Shape::Skipped),
        ("line", Shape::Skipped),
        ("polygon", Shape::Polygon(None)),
        ("strip", Shape::Strip),
    ];
    check_cells(lists.iter().map(Cells::len).sum())?;
    for (cells, (name, shape)) in lists.iter().zip(shapes) {
        for (index, indices) in cells.iter().enumerate() {
            faces.add(indices, shape, points, || Place::element(name, index))?;
        }
    }
    Ok(())
}

fn add_typed(faces: &mut Faces, cells: &Cells, types: &[i64], points: usize) -> Result<(), Fault> {
    if cells.len() != types.len() {
        let problem = format!("{} cells, but types of {}", cells.len(), types.len());
        return Err(Fault::malformed(Place::File, problem, "write CELLS and CELL_TYPES of the same length"));
    }
    check_cells(cells.len())?;
    for (index, (indices, &cell_type)) in cells.iter().zip(types).enumerate() {
        let place = || Place::element("cell", index);
        let shape = match cell_type {
            0..=4 => Shape::Skipped,
            5 => Shape::Polygon(Some(3)),
            6 => Shape::Strip,
            7 => Shape::Polygon(None),
            8 => Shape::Pixel,
            9 => Shape::Polygon(Some(4)),
            _ => {
                let problem =
                    format!("a cell of type {cell_type}{}, which is no flat face", name_of(cell_type));
                let cure = "extract the surface or an isosurface and write that (ParaView: Extract Surface, Contour)";
                return Err(Fault::unsupported(place(), problem, cure));
            }
        };
        faces.add(indices, shape, points, place)?;
    }
    Ok(())
}

/// The name of the commonest types that have a volume.
fn name_of(cell_type: i64) -> &'static str {
    match cell_type {
        10 => " (tetrahedron)",
        11 => " (voxel)",
        12 => " (hexahedron)",
        13 => " (wedge)",
        14 => " (pyramid)",
        42 => " (polyhedron)",
        _ => "",
    }
}

fn check_cells(cells: usize) -> Result<(), Fault> {
    if cells <= MAX_TRIANGLES {
        return Ok(());
    }
    let problem = format!("more than {MAX_TRIANGLES} cells");
    Err(Fault::too_large(Place::File, problem, "split the mesh into several files"))
}

/// The labels of each triangle, which are those of its cell.
fn interfaces(labels: &[Vec<f64>; 2], faces: &Faces) -> Result<Vec<Interface>, Fault> {
    let [front, back] = labels.each_ref().map(|labels| regions(labels, faces.cells));
    let (front, back) = (front?, back?);
    let interface = |&cell: &u32| Interface { front: front[cell as usize], back: back[cell as usize] };
    Ok(faces.cell_of.iter().map(interface).collect())
}

fn regions(labels: &[f64], cells: usize) -> Result<Vec<Region>, Fault> {
    if labels.len() != cells {
        let problem = format!("{} labels for {cells} cells", labels.len());
        return Err(Fault::malformed(Place::File, problem, "write one label a cell"));
    }
    let label = |(index, &value): (usize, &f64)| {
        let place = || Place::element("cell", index);
        match whole(value) {
            Some(label) => region(label, place),
            None => Err(Fault::invalid(place(), format!("label {value}"), "labels are whole numbers")),
        }
    };
    labels.iter().enumerate().map(label).collect()
}
