//! From linear radiance to what a screen shows: exposure, gamut, tone curve, sRGB.
//!
//! 1. Exposure: times 2^stops, and times [`PRE_EXPOSURE`].
//! 2. Gamut: saturated water lies outside Rec. 709 and has negative components. Such a colour is mixed with the grey
//!    of its own luminance just enough to bring its least component to 0. Hue and luminance stay, which clipping each
//!    channel would not achieve.
//! 3. Tone curve: Khronos PBR Neutral `[KHRONOS24]`. It keeps hue, leaves all but bright colours as saturated as they
//!    are, and lets only what is brighter than the screen go to white:
//!
//! ```text
//! x = min(r, g, b)      o = x - 6.25 x^2  if x < 0.08,  else 0.04        c' = c - o                        (1)
//! p = max(r', g', b')   c' as it is if p < 0.76, else                                                     (2)
//! p' = 1 - 0.24^2 / (p - 0.52)      c'' = c' p' / p                                                       (3)
//! g = 1 / (0.15 (p - p') + 1)       c''' = g c'' + (1 - g) p'                                             (4)
//! ```
//!
//! 4. Transfer: sRGB `[SRGB99]`.
//!
//! Between 0.08 and 0.8 the curve takes 0.04 off greys, so [`PRE_EXPOSURE`] = 0.22 / 0.18 makes middle grey 0.18
//! come out as 0.18. Luminance rises with exposure for every colour, black stays black, and infinities count as very
//! bright. A component that is not a number counts as 0.

use glam::Vec3;

use crate::geometry::elementary::pow;
use crate::spectrum::luminance::luminance;

/// Gain before the tone curve: middle grey is kept.
pub const PRE_EXPOSURE: f32 = 0.22 / 0.18;

const COMPRESSION_START: f32 = 0.76;
const DESATURATION: f32 = 0.15;

/// Beyond this everything is white long since; products stay finite.
const BRIGHTEST: f32 = 1e12;

/// Turns linear Rec. 709 radiance into sRGB values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToneMap {
    gain: f32,
}

impl ToneMap {
    /// `exposure` in stops: +1 doubles the light. Beyond +-60 stops it stays at 60.
    pub fn new(exposure: f32) -> Self {
        let stops = if exposure.is_nan() { 0.0 } else { exposure.clamp(-60.0, 60.0) };
        Self { gain: PRE_EXPOSURE * libm::exp2f(stops) }
    }

    /// sRGB-encoded components in [0, 1].
    pub fn apply(self, radiance: Vec3) -> Vec3 {
        let exposed = (radiance.map(number_or_black) * self.gain).map(|c| c.clamp(-BRIGHTEST, BRIGHTEST));
        neutral(into_gamut(exposed)).map(|c| srgb_encode(c.clamp(0.0, 1.0)))
    }
}

fn number_or_black(component: f32) -> f32 {
    if component.is_nan() { 0.0 } else { component.clamp(-f32::MAX, f32::MAX) }
}

/// Mixes a colour towards the grey of its luminance until no component is negative; black if its luminance is not
/// positive.
pub(crate) fn into_gamut(colour: Vec3) -> Vec3 {
    let least = colour.min_element();
    if least >= 0.0 {
        return colour;
    }
    let grey = luminance(colour);
    if grey <= 0.0 {
        return Vec3::ZERO;
    }
    let kept = grey / (grey - least);
    (Vec3::splat(grey) + (colour - grey) * kept).max(Vec3::ZERO)
}

/// `[KHRONOS24]`, for components >= 0.
fn neutral(colour: Vec3) -> Vec3 {
    let least = colour.min_element();
    let offset = if least < 0.08 { least - 6.25 * least * least } else { 0.04 };
    let colour = colour - offset; // (1)
    let peak = colour.max_element();
    if peak < COMPRESSION_START {
        return colour; // (2)
    }
    let room = 1.0 - COMPRESSION_START;
    let new_peak = 1.0 - room * room / (peak + room - COMPRESSION_START);
    let colour = colour * (new_peak / peak); // (3)
    let kept = 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    colour * kept + Vec3::splat(new_peak) * (1.0 - kept) // (4)
}

/// Linear to sRGB, for components in [0, 1].
pub(crate) fn srgb_encode(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * pow(linear, 1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn srgb_decode(encoded: f32) -> f32 {
        if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
    }

    fn displayed(radiance: Vec3, exposure: f32) -> Vec3 {
        ToneMap::new(exposure).apply(radiance).map(srgb_decode)
    }

    #[test]
    fn middle_grey_is_kept_and_stops_are_factors_of_two() {
        // sRGB and back in f32: a few 1e-7.
        assert!((displayed(Vec3::splat(0.18), 0.0) - 0.18).abs().max_element() < 2e-6);
        assert!((displayed(Vec3::splat(0.09), 1.0) - 0.18).abs().max_element() < 2e-6);
        assert_eq!(ToneMap::new(-3.0).apply(Vec3::ONE), ToneMap::new(0.0).apply(Vec3::splat(0.125)));
    }

    #[test]
    fn ends_of_the_range() {
        for exposure in [-5.0, 0.0, 5.0] {
            assert_eq!(ToneMap::new(exposure).apply(Vec3::ZERO), Vec3::ZERO);
        }
        let white = |c: Vec3| ToneMap::new(0.0).apply(c).min_element() > 1.0 - 1e-4;
        assert!(white(Vec3::splat(1e6)) && white(Vec3::splat(f32::MAX)) && white(Vec3::splat(f32::INFINITY)));
        assert!(white(Vec3::new(1e8, 0.0, 0.0)), "a very bright colour goes to white");
        assert!(ToneMap::new(60.0).apply(Vec3::new(f32::MAX, f32::NEG_INFINITY, 1.0)).is_finite());
        assert_eq!(ToneMap::new(0.0).apply(Vec3::NAN), Vec3::ZERO);
        assert_eq!(ToneMap::new(f32::NAN), ToneMap::new(0.0));
        assert_eq!(ToneMap::new(f32::INFINITY), ToneMap::new(60.0));
    }

    #[test]
    fn colours_of_moderate_brightness_keep_their_saturation() {
        // x = 0: nothing is taken off, and 0.5 PRE_EXPOSURE is below the compression.
        let shown = displayed(Vec3::new(0.0, 0.2, 0.5), 0.0);
        assert!((shown - Vec3::new(0.0, 0.2, 0.5) * PRE_EXPOSURE).abs().max_element() < 2e-6, "{shown}");
    }

    #[test]
    fn saturated_water_is_mixed_with_grey_only_as_far_as_needed() {
        let water = Vec3::new(-0.05, 0.2, 0.4);
        let mapped = into_gamut(water);
        assert_eq!(mapped.x, 0.0);
        assert!((luminance(mapped) - luminance(water)).abs() < 1e-6);
        // The same hue: the differences between components keep their ratio.
        let ratio = |c: Vec3| (c.z - c.y) / (c.y - c.x);
        assert!((ratio(mapped) - ratio(water)).abs() < 1e-5);
        assert_eq!(into_gamut(Vec3::new(-1.0, 0.1, 0.1)), Vec3::ZERO);
        assert_eq!(into_gamut(Vec3::new(0.0, 3.0, 0.2)), Vec3::new(0.0, 3.0, 0.2));
    }

    proptest! {
        #[test]
        fn brighter_light_never_shows_darker(r in -0.3_f32..1.0, g in 0.0_f32..1.0, b in 0.0_f32..1.0) {
            let colour = Vec3::new(r, g, b);
            let mut last = 0.0;
            for quarter_stop in -40..60 {
                let shown = luminance(displayed(colour, quarter_stop as f32 / 4.0));
                // Rounding of sRGB and back near white.
                prop_assert!(shown >= last - 1e-6, "{} after {} at {}", shown, last, quarter_stop);
                last = shown;
            }
        }

        #[test]
        fn results_are_displayable(r in any::<f32>(), g in any::<f32>(), b in any::<f32>(), e in -70.0_f32..70.0) {
            let shown = ToneMap::new(e).apply(Vec3::new(r, g, b));
            prop_assert!(shown.min_element() >= 0.0 && shown.max_element() <= 1.0, "{}", shown);
        }
    }

    #[test]
    fn the_curve_and_its_slope_are_continuous() {
        let slope = |x: f32| (neutral(Vec3::splat(x + 1e-3)).x - neutral(Vec3::splat(x - 1e-3)).x) / 2e-3;
        for joint in [0.08_f32, 0.8] {
            let step = neutral(Vec3::splat(joint.next_up())).x - neutral(Vec3::splat(joint.next_down())).x;
            assert!(step.abs() < 1e-6, "a step at {joint}");
            // Curvature 12.5 below and 8.3 above, over 2e-3.
            assert!((slope(joint - 2e-3) - slope(joint + 2e-3)).abs() < 0.05, "a kink at {joint}");
        }
    }
}
