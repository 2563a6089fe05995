//! The peak of a phase function, which photons cannot resolve.
//!
//! A photon that is seen within a narrow forward peak weighs thousands of times more than others, and makes a blot. So
//! scattering is parted by the value of the phase function,
//!
//! ```text
//! p = p [p <= LIMIT] + p [p > LIMIT]
//! ```
//! and the second part is left to those who turn within the peak as the phase function says, without noise:
//!
//! * Eye paths turn there and ask for photons further on, which they see by the first part.
//! * Photons that have turned only there, and at specular surfaces, count as turned by specular surfaces: on a diffuse
//!   surface they are caustic photons.
//!
//! What is left is light that only peaks and specular surfaces turn all the way from a lamp to the eye, the glow around
//! the sun: the eye's rays see it, in full, by the photons at the last of its turns, before they turn themselves.
//!
//! Where phase functions differ by wavelength, p is the greatest of those of the pass, which its photons and its eye paths
//! share: whoever turns by an angle knows on which side it is.

use crate::optics::phase::{Deflection, PhaseLanes};

/// Greatest density in 1/sr outside of the peak; the isotropic one is 0.08.
const LIMIT: f32 = 0.25;

/// True within the peak, by the value of the phase function in 1/sr.
#[inline]
pub(in crate::integrator) fn is_peak(value: f32) -> bool {
    value > LIMIT
}

/// True when some directions are within the peak.
pub(super) fn has_peak(phase: &PhaseLanes<'_>) -> bool {
    // Twelve decades of the angle's distance from both ends.
    (0..240).any(|step| {
        let distance = libm::exp10f(-12.0 + step as f32 * 0.05);
        [Deflection::from_one_minus_cos(distance), Deflection::from_one_plus_cos(distance)]
            .into_iter()
            .chain([Deflection::FORWARD, Deflection::BACKWARD])
            .any(|deflection| is_peak(phase.value(deflection).max_element()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::phase::EXAMPLES;

    /// What samples find to be a peak has one.
    #[test]
    fn peaks_that_are_sampled_are_known() {
        let mut peaked = 0;
        for (name, phase) in EXAMPLES.iter() {
            let found = (0..4096).any(|i| {
                let turned = phase.sample(glam::Vec3::Z, [(i as f32 + 0.5) / 4096.0, 0.3]);
                is_peak(turned.weight * turned.pdf_w)
            });
            peaked += u32::from(found);
            assert!(!found || has_peak(&PhaseLanes::One(phase)), "{name}");
        }
        assert!(peaked > 5, "{peaked}");
    }
}
