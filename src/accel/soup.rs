//! The triangles that a tree is made over.

use glam::Vec3;
use obvhs::aabb::Aabb;

use super::TriangleId;
use super::leaf::{Leaf, LeafIds};
use crate::geometry::Bounds;
use crate::geometry::triangle::triangle_bounds;

/// The triangles that a tree is made over.
#[derive(Clone, Copy)]
pub(super) struct Soup<'a> {
    pub positions: &'a [Vec3],
    pub triangles: &'a [[u32; 3]],
}

impl Soup<'_> {
    fn bounds(&self, id: TriangleId) -> Bounds {
        triangle_bounds(&self.triangles[id as usize].map(|i| self.positions[i as usize]))
    }

    pub fn aabb(&self, id: TriangleId) -> Aabb {
        let Bounds { min, max } = self.bounds(id);
        Aabb::new(min.into(), max.into())
    }

    pub fn around(&self, ids: &[TriangleId]) -> Bounds {
        ids.iter().fold(Bounds::EMPTY, |all, &id| all.union(self.bounds(id)))
    }

    /// A leaf, if its triangles fit.
    pub fn leaf(&self, ids: &[TriangleId]) -> Option<(Leaf, LeafIds)> {
        let leaf = Leaf::over(ids, self.positions, self.triangles)?;
        let mut all = [Leaf::NO_TRIANGLE; Leaf::MOST];
        all[..ids.len()].copy_from_slice(ids);
        Some((leaf, all))
    }
}

pub(super) fn bounds_of(aabb: &Aabb) -> Bounds {
    Bounds { min: aabb.min.into(), max: aabb.max.into() }
}
