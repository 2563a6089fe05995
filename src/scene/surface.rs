//! What a triangle is to a ray.

use super::layers::Layer;
use crate::optics::medium::MediumId;
use crate::spectrum::LaneCurve;

/// What happens to light at a triangle.
#[derive(Clone, Debug)]
pub enum Surface {
    /// A boundary between two media.
    Interface(MediumPair),
    /// A boundary of a mesh that overlaps others; which media it parts depends on what the ray is in.
    Layer(Layer),
    /// Lambertian on both sides.
    Diffuse {
        /// Reflectance in [0, 1].
        reflectance: LaneCurve,
    },
    /// A smooth metal of complex index eta + i k.
    Conductor {
        /// Real part, relative to vacuum.
        eta: LaneCurve,
        /// Imaginary part.
        k: LaneCurve,
    },
    /// A one-sided light; black on its back.
    Emitter {
        /// Emitted radiance.
        radiance: LaneCurve,
    },
}

impl Surface {
    /// The media on its two sides; for a layer, where no other mesh is.
    pub fn pair(&self) -> Option<&MediumPair> {
        match self {
            Self::Interface(pair) | Self::Layer(Layer { pair, .. }) => Some(pair),
            _ => None,
        }
    }
}

/// The media on the two sides of a boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct MediumPair {
    /// On the side of the right-hand normal.
    pub front: MediumId,
    /// On the other side.
    pub back: MediumId,
    /// True when light passes straight through: equal indices, or declared so.
    pub matched: bool,
}

impl MediumPair {
    /// The medium that a ray comes from and the one beyond.
    #[inline]
    pub fn crossed(&self, from_front: bool) -> (MediumId, MediumId) {
        if from_front { (self.front, self.back) } else { (self.back, self.front) }
    }
}

/// Index into the surfaces of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceId(pub u16);
