//! The faces of a tetrahedral mesh, each with the tetrahedra that share it.
//!
//! Face k of tetrahedron t lies opposite its vertex k and has the number 4 t + k. Faces are gathered by their
//! least vertex, so that the tetrahedra of a face meet in a short list that is sorted.

use super::Complex;

/// Vertices of face k; its right-hand normal points out of a tetrahedron of positive volume.
const OUTWARD: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// The number of a face: four times its tetrahedron and the corner that it lies opposite of.
pub(super) type FaceId = u32;

/// The tetrahedron of a face.
pub(super) fn owner(face: FaceId) -> usize {
    (face / 4) as usize
}

/// Vertices of a face; its normal points out of its tetrahedron if that has a positive volume.
pub(super) fn outward(complex: &Complex, face: FaceId) -> [u32; 3] {
    OUTWARD[(face % 4) as usize].map(|corner| complex.tetrahedra[owner(face)][corner])
}

/// Faces gathered by their least vertex.
pub(super) struct FacesByVertex {
    /// Where the faces of each vertex begin in `faces`; one more than there are vertices.
    starts: Vec<u32>,
    faces: Vec<FaceId>,
}

impl FacesByVertex {
    /// Gathers the faces of a mesh.
    pub fn of(complex: &Complex) -> Self {
        let all = || 0..4 * complex.tetrahedra.len() as u32;
        let least = |face| outward(complex, face).into_iter().fold(u32::MAX, u32::min) as usize;
        let mut starts = vec![0; complex.positions.len() + 1];
        for face in all() {
            starts[least(face) + 1] += 1;
        }
        for vertex in 1..starts.len() {
            starts[vertex] += starts[vertex - 1];
        }
        let mut next = starts.clone();
        let mut faces = vec![0; 4 * complex.tetrahedra.len()];
        for face in all() {
            let slot = &mut next[least(face)];
            faces[*slot as usize] = face;
            *slot += 1;
        }
        Self { starts, faces }
    }

    /// Visits each face once: its numbers in all tetrahedra that share it, in rising order.
    pub fn try_for_each<E>(
        &self,
        complex: &Complex,
        mut visit: impl FnMut(&[FaceId]) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut keyed = Vec::new();
        let mut sharing = Vec::new();
        for range in self.starts.windows(2) {
            let faces = &self.faces[range[0] as usize..range[1] as usize];
            keyed.clear();
            keyed.extend(faces.iter().map(|&face| (key(complex, face), face)));
            keyed.sort_unstable();
            for group in keyed.chunk_by(|a, b| a.0 == b.0) {
                sharing.clear();
                sharing.extend(group.iter().map(|&(_, face)| face));
                visit(&sharing)?;
            }
        }
        Ok(())
    }
}

/// The same for every tetrahedron that shares the face.
fn key(complex: &Complex, face: FaceId) -> [u32; 3] {
    let mut vertices = outward(complex, face);
    vertices.sort_unstable();
    vertices
}
