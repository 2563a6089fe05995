//! What happens while paths are traced, and how often.

use std::ops::AddAssign;

use serde::{Deserialize, Serialize};

/// Rays, and events that ought to be rare.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Counters {
    /// Rays traced for paths.
    pub rays: u64,
    /// Flights between two collisions that needed no ray, since no surface is near.
    pub untraced: u64,
    /// Photons emitted.
    pub photons: u64,
    /// Photons that met a boundary of another medium than they were in, and ended there.
    pub astray_photons: u64,
    /// Rays traced towards lights.
    pub shadow_rays: u64,
    /// Vertices at which the sun was looked for through refracting interfaces.
    pub beam_queries: u64,
    /// Triangles that were tried there.
    pub beam_candidates: u64,
    /// Ways of the sun that were found, whatever blocks them.
    pub beam_roots: u64,
    /// Hits at which the medium that the triangle states is not the one that the path believed to be in.
    pub label_mismatches: u64,
    /// Samples whose radiance was not finite; they are left out of the mean.
    pub non_finite: u64,
    /// Paths that met nothing although they were inside a fluid that ends somewhere, or walked on in it farther from everything
    /// than the scene is wide.
    pub escaped_inside: u64,
    /// Paths ended by the scene's `max_depth`: the picture lacks their light, as was asked for.
    pub depth_limited: u64,
    /// Paths cut at the hard limit of interactions.
    pub cut: u64,
    /// Loss-free specular chains (total internal reflection for ever) that ended at the hard limit.
    pub trapped: u64,
}

impl Counters {
    /// Greatest part of the rays, and of the flights that needed none, that may be label mismatches in a sound frame whose free
    /// paths are long.
    pub const MISMATCH_LIMIT: f64 = 1e-6;

    /// So many times the [roughness] may be mismatches besides: three times what was measured, 0.003 to 0.007 of balls of index 1
    /// to 2.4, 3 to 30 m from the eye, whose free paths are 0.1 to 1 mm, before particles next to a surface were kept off it;
    /// since then there were none in a million flights of each.
    ///
    /// [roughness]: crate::scene::frame::Frame::roughness
    const BY_ROUGHNESS: f64 = 0.02;

    /// True when so many labels disagree that the mesh cannot be what it says, in a frame of this [roughness].
    ///
    /// A handful is allowed whatever the number of rays: below it a rate means nothing.
    ///
    /// [roughness]: crate::scene::frame::Frame::roughness
    pub fn too_many_mismatches(&self, roughness: f32) -> bool {
        let flights = (self.rays + self.untraced) as f64;
        let share = Self::MISMATCH_LIMIT + Self::BY_ROUGHNESS * f64::from(roughness);
        let allowed = (flights * share).max(8.0);
        self.label_mismatches as f64 > allowed
    }
}

impl AddAssign for Counters {
    /// Counts that were read may be anything, and end at the greatest.
    fn add_assign(&mut self, other: Self) {
        let add = |own: &mut u64, other: u64| *own = own.saturating_add(other);
        add(&mut self.rays, other.rays);
        add(&mut self.untraced, other.untraced);
        add(&mut self.photons, other.photons);
        add(&mut self.astray_photons, other.astray_photons);
        add(&mut self.shadow_rays, other.shadow_rays);
        add(&mut self.beam_queries, other.beam_queries);
        add(&mut self.beam_candidates, other.beam_candidates);
        add(&mut self.beam_roots, other.beam_roots);
        add(&mut self.label_mismatches, other.label_mismatches);
        add(&mut self.non_finite, other.non_finite);
        add(&mut self.escaped_inside, other.escaped_inside);
        add(&mut self.depth_limited, other.depth_limited);
        add(&mut self.cut, other.cut);
        add(&mut self.trapped, other.trapped);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At a roughness of 0.01 one flight in five thousand may be led astray, and no more.
    #[test]
    fn labels_may_disagree_as_coordinates_are_rough() {
        let with = |rays, label_mismatches| Counters { rays, label_mismatches, ..Counters::default() };
        for (rays, mismatches, roughness, too_many) in [
            (1_000_000, 8, 0.0, false),
            (1_000_000, 9, 0.0, true),
            (1_000_000, 200, 0.01, false),
            (1_000_000, 202, 0.01, true),
            (100_000_000, 100, 0.0, false),
            (100_000_000, 101, 0.0, true),
        ] {
            let counters = with(rays, mismatches);
            assert_eq!(counters.too_many_mismatches(roughness), too_many, "{mismatches} at {roughness}");
        }
    }
}
