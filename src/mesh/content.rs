//! What tells a mesh that no file holds from others.

use sha2::{Digest, Sha256};

use super::RawMesh;

impl RawMesh {
    /// SHA-256 of its lists: for each, the number of its bytes in 64 bits and the numbers as they are in memory, all in
    /// little-endian order. Lists go as the fields do, the normals' corners behind their values; what is not there counts
    /// as a list of -1 bytes.
    pub fn content_hash(&self) -> [u8; 32] {
        let mut hasher = Sha256::new();
        add(&mut hasher, Some(&self.positions), |p| p.to_array().map(f64::to_le_bytes));
        add(&mut hasher, Some(&self.triangles), |t| t.map(u32::to_le_bytes));
        add(&mut hasher, self.interfaces.as_ref(), |i| [i.front.0, i.back.0].map(i32::to_le_bytes));
        let normals = self.normals.as_ref();
        add(&mut hasher, normals.map(|n| &n.values), |n| n.to_array().map(f32::to_le_bytes));
        add(&mut hasher, normals.and_then(|n| n.corners.as_ref()), |c| c.map(u32::to_le_bytes));
        add(&mut hasher, self.velocities.as_ref(), |v| v.to_array().map(f32::to_le_bytes));
        hasher.finalize().into()
    }
}

/// The length goes first, so that no two meshes run into the same bytes.
fn add<T, const BYTES: usize, const N: usize>(
    hasher: &mut Sha256,
    list: Option<&Vec<T>>,
    numbers: impl Fn(&T) -> [[u8; BYTES]; N],
) {
    let Some(list) = list else { return hasher.update(u64::MAX.to_le_bytes()) };
    hasher.update((list.len() as u64 * (BYTES * N) as u64).to_le_bytes());
    for element in list {
        hasher.update(numbers(element).as_flattened());
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};

    use super::*;
    use crate::mesh::{CornerNormals, Interface, Region};

    #[test]
    fn every_list_and_its_absence_count() {
        let mesh = RawMesh { positions: vec![DVec3::X], triangles: vec![[0, 0, 0]], ..RawMesh::default() };
        let label = Interface { front: Region(0), back: Region(1) };
        let normals = |corners| Some(CornerNormals { values: vec![Vec3::Z], corners });
        let others = [
            RawMesh { positions: vec![-DVec3::X], ..mesh.clone() },
            RawMesh { triangles: vec![[0, 0, 1]], ..mesh.clone() },
            RawMesh { triangles: Vec::new(), ..mesh.clone() },
            RawMesh { interfaces: Some(vec![label]), ..mesh.clone() },
            RawMesh { interfaces: Some(Vec::new()), ..mesh.clone() },
            RawMesh { normals: normals(None), ..mesh.clone() },
            RawMesh { normals: normals(Some(vec![[0, 0, 0]])), ..mesh.clone() },
            RawMesh { velocities: Some(vec![Vec3::Z]), ..mesh.clone() },
            mesh,
        ];
        let mut hashes: Vec<[u8; 32]> = others.iter().map(RawMesh::content_hash).collect();
        hashes.sort_unstable();
        hashes.dedup();
        assert_eq!(hashes.len(), others.len());
    }
}
