//! Faces of any number of corners, as triangles.

use super::Region;
use super::error::{Fault, Place};
use super::limits::MAX_TRIANGLES;

/// Adds a polygon as a fan around its first corner.
pub(super) fn add_fan(
    indices: &[i64],
    vertices: usize,
    triangles: &mut Vec<[u32; 3]>,
    place: impl Fn() -> Place,
) -> Result<(), Fault> {
    add(indices, vertices, triangles, place, |k| [0, k - 1, k])
}

/// Adds a strip, in which each corner makes a triangle with the two before it; every other one is turned over
/// so that all face the same side.
pub(super) fn add_strip(
    indices: &[i64],
    vertices: usize,
    triangles: &mut Vec<[u32; 3]>,
    place: impl Fn() -> Place,
) -> Result<(), Fault> {
    add(indices, vertices, triangles, place, |k| [k - 2 + k % 2, k - 1 - k % 2, k])
}

/// Adds a triangle for each corner from the third on; `corners` tells which it is made of.
fn add(
    indices: &[i64],
    vertices: usize,
    triangles: &mut Vec<[u32; 3]>,
    place: impl Fn() -> Place,
    corners: impl Fn(usize) -> [usize; 3],
) -> Result<(), Fault> {
    check(indices, vertices, triangles.len(), place)?;
    triangles.extend((2..indices.len()).map(|k| corners(k).map(|corner| indices[corner] as u32)));
    Ok(())
}

/// Refuses too few corners, vertices that are not there, and more triangles than can be numbered.
fn check(indices: &[i64], vertices: usize, triangles: usize, place: impl Fn() -> Place) -> Result<(), Fault> {
    if indices.len() < 3 {
        let problem = format!("a face of {} corners", indices.len());
        let cure = "a face needs three corners or more; leave this one out";
        return Err(Fault::invalid(place(), problem, cure));
    }
    if let Some(index) = indices.iter().find(|&&index| index < 0 || index as u64 >= vertices as u64) {
        let problem = format!("vertex index {index}, but there are {vertices} vertices");
        return Err(Fault::invalid(place(), problem, "indices count from 0; write the file again"));
    }
    if triangles + indices.len() > MAX_TRIANGLES {
        let problem = format!("more than {MAX_TRIANGLES} triangles");
        return Err(Fault::too_large(place(), problem, "split the mesh into several files"));
    }
    Ok(())
}

/// The region of a label.
pub(super) fn region(label: i64, place: impl Fn() -> Place) -> Result<Region, Fault> {
    i32::try_from(label).map(Region).map_err(|_| {
        let problem = format!("label {label} does not fit in 32 bits with a sign");
        Fault::invalid(place(), problem, "use labels up to 2147483647")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fans_and_strips_face_one_side() {
        let place = || Place::File;
        let (mut fan, mut strip) = (Vec::new(), Vec::new());
        add_fan(&[4, 0, 1, 2], 5, &mut fan, place).unwrap();
        assert_eq!(fan, [[4, 0, 1], [4, 1, 2]]);
        add_strip(&[0, 1, 2, 3, 4], 5, &mut strip, place).unwrap();
        assert_eq!(strip, [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
        for bad in [&[0, 1][..], &[0, 1, 5], &[0, -1, 2]] {
            assert!(
                add_fan(bad, 5, &mut fan, place).is_err() && add_strip(bad, 5, &mut strip, place).is_err()
            );
        }
    }
}
