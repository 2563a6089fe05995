//! Which arrays of a file a mesh takes, and what is in them.

use glam::{DVec3, Vec3};

use super::Cells;
use super::number::whole;
use crate::mesh::error::{Fault, Place};
use crate::mesh::{VelocityName, VelocityProperty};

/// The name of the point array that holds normals.
pub(super) const NORMALS: &str = "Normals";

/// The names of the cell arrays of what lies in front and behind.
const LABELS: [&str; 2] = ["label_front", "label_back"];

/// What an array belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Association {
    Point,
    Cell,
}

/// What a file says of an array before its numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Declared {
    pub association: Association,
    pub name: String,
    /// Numbers a tuple.
    pub components: usize,
}

/// The arrays of a mesh.
#[derive(Debug, Default)]
pub(super) struct Chosen {
    pub normals: Option<Vec<Vec3>>,
    pub velocities: Option<Vec<Vec3>>,
    /// Front and back.
    pub labels: Option<[Vec<f64>; 2]>,
}

impl Chosen {
    /// Takes what a mesh needs of the arrays of a file; `values` gives the numbers of the array of an index.
    pub fn of(
        declared: &[Declared],
        velocity: &VelocityName,
        mut values: impl FnMut(usize) -> Result<Vec<f64>, Fault>,
    ) -> Result<Self, Fault> {
        let find = |association, components, name: &str| {
            declared.iter().position(|array| {
                (array.association, array.components) == (association, components)
                    && array.name.eq_ignore_ascii_case(name)
            })
        };
        let names = |components| {
            let points = declared.iter().filter(move |array| array.association == Association::Point);
            Vec::from_iter(points.filter(|a| a.components == components).map(|array| array.name.as_str()))
        };
        let mut chosen = Self::default();
        if let Some(normals) = find(Association::Point, 3, NORMALS) {
            chosen.normals = Some(vectors(&values(normals)?));
        }
        chosen.velocities = match velocity.find(&names(3), &names(1)) {
            None => None,
            Some(VelocityProperty::Vectors(name)) => match find(Association::Point, 3, &name) {
                Some(array) => Some(vectors(&values(array)?)),
                None => None,
            },
            Some(VelocityProperty::Components(names)) => {
                match names.each_ref().map(|name| find(Association::Point, 1, name)) {
                    [Some(x), Some(y), Some(z)] => Some(joined([values(x)?, values(y)?, values(z)?])),
                    _ => None,
                }
            }
        };
        chosen.labels = match LABELS.map(|name| find(Association::Cell, 1, name)) {
            [None, None] => None,
            [Some(front), Some(back)] => Some([values(front)?, values(back)?]),
            _ => {
                let problem = "cells have only one of label_front and label_back";
                return Err(Fault::invalid(Place::File, problem, "write both labels or none"));
            }
        };
        Ok(chosen)
    }
}

fn vectors(values: &[f64]) -> Vec<Vec3> {
    values.chunks_exact(3).map(|v| DVec3::from_slice(v).as_vec3()).collect()
}

/// Vectors whose components come apart.
fn joined([x, y, z]: [Vec<f64>; 3]) -> Vec<Vec3> {
    x.iter().zip(&y).zip(&z).map(|((&x, &y), &z)| DVec3::new(x, y, z).as_vec3()).collect()
}

impl Cells {
    /// The number of cells.
    pub fn len(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    /// The point indices of each cell.
    pub fn iter(&self) -> impl Iterator<Item = &[i64]> {
        self.offsets.windows(2).map(|run| &self.connectivity[run[0]..run[1]])
    }

    /// Cells of runs that begin where an offset says; the last offset is where the last of them ends.
    pub fn from_offsets(offsets: &[f64], connectivity: &[f64]) -> Result<Self, Fault> {
        let cure = "offsets count corners from 0 and never fall; write the file again";
        let offsets = wholes(offsets, "offset")?;
        let connectivity = wholes(connectivity, "corner")?;
        let mut last = 0;
        for (index, &offset) in offsets.iter().enumerate() {
            if offset < last || offset > connectivity.len() as i64 || (index == 0 && offset != 0) {
                let problem = format!("{offset}, behind {last} and with {} corners", connectivity.len());
                return Err(Fault::malformed(Place::element("offset", index), problem, cure));
            }
            last = offset;
        }
        if last != connectivity.len() as i64 {
            let problem = format!("the cells end at corner {last} of {}", connectivity.len());
            return Err(Fault::malformed(Place::File, problem, cure));
        }
        Ok(Self { offsets: offsets.iter().map(|&offset| offset as usize).collect(), connectivity })
    }

    /// Cells that follow each other, each behind the number of its corners.
    pub fn from_counts(numbers: &[f64], count: usize) -> Result<Self, Fault> {
        let cure = "the file is damaged; write it again";
        let corners = numbers.len().saturating_sub(count);
        let mut cells = Self { offsets: vec![0], connectivity: Vec::with_capacity(corners) };
        let mut rest = numbers;
        for index in 0..count {
            let place = Place::element("cell", index);
            let Some((&corners, after)) = rest.split_first() else {
                return Err(Fault::malformed(place, "the list ends before this cell", cure));
            };
            let run = whole(corners).and_then(|n| after.split_at_checked(usize::try_from(n).ok()?));
            let Some((run, after)) = run else {
                let problem = format!("{corners} corners are announced, {} numbers are left", after.len());
                return Err(Fault::malformed(place, problem, cure));
            };
            for &corner in run {
                let index =
                    whole(corner).ok_or_else(|| not_whole(corner, "corner", cells.connectivity.len()))?;
                cells.connectivity.push(index);
            }
            cells.offsets.push(cells.connectivity.len());
            rest = after;
        }
        if !rest.is_empty() {
            let problem = format!("{} numbers are left behind the last of {count} cells", rest.len());
            return Err(Fault::malformed(Place::File, problem, cure));
        }
        Ok(cells)
    }
}

/// Numbers that must all be whole.
pub(super) fn wholes(values: &[f64], name: &str) -> Result<Vec<i64>, Fault> {
    match values.iter().position(|&value| whole(value).is_none()) {
        Some(index) => Err(not_whole(values[index], name, index)),
        None => Ok(values.iter().map(|&value| value as i64).collect()),
    }
}

fn not_whole(value: f64, name: &str, index: usize) -> Fault {
    let problem = format!("{value} is no whole number");
    Fault::malformed(Place::element(name, index), problem, "write the file again")
}
