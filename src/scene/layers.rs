//! Meshes that overlap: what a triangle of one of them is depends on which others the ray is in.
//!
//! The medium at a point is that of the strongest mesh that holds it `[SCHMIDT02]`. So a ray keeps account of what it
//! is in, one bit for each region of each of these meshes, the strongest mesh highest:
//!
//! ```text
//! medium(S) = medium of the highest bit in S, or the outside's without any
//! crossing a triangle of mesh m:   S' = (S without the bits of m) + the bit of the region on the far side
//! ```
//! The triangle is an interface where medium(S) and medium(S') differ; elsewhere it is hidden. What a ray believed of m
//! before does not count, as ever. Meshes whose bounds meet no other's are interfaces like any other.

use super::surface::MediumPair;
use crate::optics::medium::MediumId;

/// Faces of two meshes are taken for one where they are no farther apart, relative to their farthest coordinate: a few
/// roundings of positions in single precision, so that faces written with the same coordinates are.
pub const COINCIDENT: f32 = 16.0 * f32::EPSILON;

/// Which regions of overlapping meshes a point is in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Insides(u64);

impl Insides {
    /// Outside of all of them, which is everywhere in scenes without any.
    pub const NONE: Self = Self(0);
    /// Regions of all meshes that overlap others in a frame, at most.
    pub const MOST: usize = u64::BITS as usize;

    /// The region of this number, counted from the weakest; none from [`Insides::MOST`] on.
    pub(super) fn region(number: usize) -> Self {
        Self(1_u64.checked_shl(number as u32).unwrap_or(0))
    }

    /// In what either is in.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

/// A triangle of a mesh that overlaps others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layer {
    /// The media on its two sides where no other mesh is.
    pub pair: MediumPair,
    /// The mesh's region in front; none for its outside.
    pub front: Insides,
    /// The mesh's region behind.
    pub back: Insides,
    /// All regions of the mesh.
    pub mesh: Insides,
}

impl Layer {
    #[inline]
    fn sides(&self, from_front: bool) -> (Insides, Insides) {
        if from_front { (self.front, self.back) } else { (self.back, self.front) }
    }

    /// The mesh's region on the side that a ray comes from.
    #[inline]
    pub fn near(&self, from_front: bool) -> Insides {
        self.sides(from_front).0
    }

    /// True when a ray that is inside of all that can meet the triangle from this side.
    #[inline]
    pub fn is_met_in(&self, insides: Insides, from_front: bool) -> bool {
        insides.0 & self.mesh.0 == self.near(from_front).0
    }

    /// What a ray is in before the triangle, by what the mesh says of itself.
    pub fn before(&self, insides: Insides, from_front: bool) -> Insides {
        Insides(insides.0 & !self.mesh.0 | self.sides(from_front).0.0)
    }

    /// What it is in beyond.
    pub fn beyond(&self, insides: Insides, from_front: bool) -> Insides {
        Insides(insides.0 & !self.mesh.0 | self.sides(from_front).1.0)
    }
}

/// The media of the regions of overlapping meshes, the weakest first.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Layers(pub(super) Vec<MediumId>);

impl Layers {
    /// True where no meshes overlap.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The medium of the strongest mesh.
    #[inline]
    pub fn medium(&self, insides: Insides) -> MediumId {
        let strongest = u64::BITS - insides.0.leading_zeros();
        if strongest == 0 { MediumId(0) } else { self.0[strongest as usize - 1] }
    }
}
