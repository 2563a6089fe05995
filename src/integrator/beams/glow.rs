//! Directions towards the glow around suns, as a turbid medium shows it.
//!
//! Particles that scatter forward send most of a sun's light on to where the sun itself seems to stand. Few of the directions that
//! a sand bed or other particles draw lead there, and those that do bring much. So a vertex in such a medium draws some of
//! its directions with the phase function about the mean direction of the brightest sun's refracted light, and weighs by the
//! mixture of both densities `[VEACH97 section 9.2.4]`:
//!
//! ```text
//! p = (1 - q) p_own + q p_phase(angle to the mean direction)
//! ```
//! Roulette takes a path for what it would be without the mixture: what is drawn towards light is worth as much.

use glam::Vec3;

use super::super::path::Sample;
use crate::optics::medium::MediumId;
use crate::optics::phase::{Deflection, PhaseLanes};
use crate::spectrum::Lanes;

/// q of the head.
const SHARE: f32 = 0.25;

/// How directions towards the glow are drawn.
pub(in crate::integrator) struct Glow<'a> {
    from: Vec3,
    phase: PhaseLanes<'a>,
    throughput: Lanes,
}

impl<'a> Sample<'a> {
    /// For a path of a throughput in a medium; none where it shows no glow.
    #[inline]
    pub(in crate::integrator) fn glow(&self, medium: MediumId, throughput: Lanes) -> Option<Glow<'a>> {
        let from = self.beams?.glow(medium)?;
        Some(Glow { from, phase: self.frame.medium(medium).phase.at(self.wavelengths), throughput })
    }
}

impl Glow<'_> {
    /// True of a vertex that it may light.
    pub(in crate::integrator) fn is_above(&self, ng: Vec3) -> bool {
        self.from.dot(ng) > 0.0
    }

    /// A direction of the mixture, where `own` draws the vertex's own.
    pub(in crate::integrator) fn sample(&self, [x, y]: [f32; 2], own: impl Fn([f32; 2]) -> Vec3) -> Vec3 {
        if x < SHARE {
            self.phase.sample(self.from, [x / SHARE, y], self.throughput).wi
        } else {
            own([((x - SHARE) / (1.0 - SHARE)).min(1.0 - 0.5 * f32::EPSILON), y])
        }
    }

    /// Density of the mixture for a direction of the vertex's own density.
    pub(in crate::integrator) fn pdf_w(&self, wi: Vec3, own: f32) -> f32 {
        let turned = Deflection::between(self.from, wi);
        (1.0 - SHARE) * own + SHARE * self.phase.value_and_pdf_w(turned, self.throughput).1
    }
}
