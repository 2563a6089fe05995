//! What every mesh has to keep before anything is made of it: finite positions, indices in range, lists that fit.

use std::path::Path;

use super::error::{Fault, MeshError, Place};
use super::limits::{MAX_TRIANGLES, MAX_VERTICES};
use super::{CornerNormals, RawMesh};

const CURE: &str = "correct what made the mesh";

impl RawMesh {
    /// Checks a mesh that no reader has checked; `path` is what errors call it.
    ///
    /// # Errors
    /// [`MeshError`], with the first vertex or triangle that is wrong.
    pub fn check(&self, path: &Path) -> Result<(), MeshError> {
        self.fault().map_or(Ok(()), |fault| Err(fault.in_file(path)))
    }

    fn fault(&self) -> Option<Fault> {
        let (vertices, triangles) = (self.positions.len(), self.triangles.len());
        let interfaces = self.interfaces.as_ref().map_or(triangles, Vec::len);
        let velocities = self.velocities.as_ref().map_or(vertices, Vec::len);
        too_many("vertices", vertices, MAX_VERTICES)
            .or_else(|| too_many("triangles", triangles, MAX_TRIANGLES))
            .or_else(|| misfit("pairs of labels", interfaces, "triangles", triangles))
            .or_else(|| misfit("velocities", velocities, "vertices", vertices))
            .or_else(|| self.not_finite())
            .or_else(|| out_of_range("triangle", &self.triangles, "vertex", vertices))
            .or_else(|| self.normals.as_ref()?.fault(vertices, triangles))
    }

    fn not_finite(&self) -> Option<Fault> {
        let index = self.positions.iter().position(|position| !position.is_finite())?;
        let problem = format!("the coordinates {} are not finite", self.positions[index]);
        Some(Fault::invalid(Place::element("vertex", index), problem, CURE))
    }
}

impl CornerNormals {
    fn fault(&self, vertices: usize, triangles: usize) -> Option<Fault> {
        match &self.corners {
            Some(corners) => misfit("corners with normals", corners.len(), "triangles", triangles)
                .or_else(|| out_of_range("triangle", corners, "normal", self.values.len())),
            None => misfit("normals", self.values.len(), "vertices", vertices),
        }
    }
}

fn too_many(what: &str, count: usize, most: usize) -> Option<Fault> {
    let problem = || format!("{count} {what}, at most {most} can be numbered");
    (count > most).then(|| Fault::too_large(Place::File, problem(), "split the mesh"))
}

fn misfit(what: &str, count: usize, of: &str, expected: usize) -> Option<Fault> {
    let problem = || format!("{count} {what} for {expected} {of}");
    (count != expected).then(|| Fault::invalid(Place::File, problem(), "give one for each"))
}

fn out_of_range(element: &str, corners: &[[u32; 3]], what: &str, count: usize) -> Option<Fault> {
    let is_wrong = |index: u32| index as usize >= count;
    let wrong = corners.iter().position(|corners| corners.iter().any(|&index| is_wrong(index)))?;
    let index = corners[wrong].into_iter().find(|&index| is_wrong(index))?;
    let problem = format!("{what} index {index}, but there are {count}; indices count from 0");
    Some(Fault::invalid(Place::element(element, wrong), problem, CURE))
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};

    use super::*;
    use crate::mesh::{Interface, Region};

    fn refused(change: impl FnOnce(&mut RawMesh)) -> String {
        let mut mesh = RawMesh {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            triangles: vec![[0, 1, 2], [0, 2, 1]],
            ..RawMesh::default()
        };
        mesh.check(Path::new("m")).unwrap();
        change(&mut mesh);
        mesh.check(Path::new("m")).unwrap_err().to_string()
    }

    #[test]
    fn the_first_wrong_element_is_named_with_its_value() {
        let text = refused(|mesh| mesh.positions[2].y = f64::NAN);
        assert_eq!(
            text,
            "m: vertex 2: the coordinates [0, NaN, 0] are not finite; correct what made the mesh"
        );
        let text = refused(|mesh| mesh.triangles[1][1] = 3);
        assert!(text.starts_with("m: triangle 1: vertex index 3, but there are 3;"), "{text}");
        let outside = Interface { front: Region(0), back: Region(1) };
        let text = refused(|mesh| mesh.interfaces = Some(vec![outside; 3]));
        assert!(text.starts_with("m: 3 pairs of labels for 2 triangles;"), "{text}");
        let text = refused(|mesh| mesh.velocities = Some(vec![Vec3::ZERO]));
        assert!(text.starts_with("m: 1 velocities for 3 vertices;"), "{text}");
        let values = vec![Vec3::Z];
        let text =
            refused(|mesh| mesh.normals = Some(CornerNormals { values: values.clone(), corners: None }));
        assert!(text.starts_with("m: 1 normals for 3 vertices;"), "{text}");
        let corners = Some(vec![[0, 0, 0], [0, 1, 0]]);
        let text = refused(|mesh| mesh.normals = Some(CornerNormals { values, corners }));
        assert!(text.starts_with("m: triangle 1: normal index 1, but there are 1;"), "{text}");
    }
}
