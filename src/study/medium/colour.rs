//! The colour of white light after something was done to it.

use glam::{DVec3, Vec3};
use serde::Serialize;

use crate::film::tonemap::{into_gamut, srgb_encode};
use crate::spectrum::cie::{self, NANOMETRES, nanometre};

/// A colour under D65 of luminance 1.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Colour {
    /// Y: 1 is that of white.
    pub luminance: f64,
    /// x of CIE 1931.
    pub x: f64,
    /// y of CIE 1931.
    pub y: f64,
    /// As a screen shows it, such as `#1f6f8f`: what lies outside of its gamut is mixed with grey.
    pub srgb: String,
    /// The same as bright as a screen can.
    pub srgb_bright: String,
}

impl Colour {
    /// Of light of which exp(-depth) is left at each wavelength in nm. The hue is known also where nothing is left that
    /// can be written.
    pub fn dimmed(depth: impl Fn(f64) -> f64) -> Self {
        let least = (0..NANOMETRES).map(|i| depth(nanometre(i))).fold(f64::INFINITY, f64::min);
        Self::of(libm::exp(-least), |lambda| libm::exp(least - depth(lambda)))
    }

    /// Of light of which a share is left at each wavelength in nm.
    pub fn reflected(share: impl Fn(f64) -> f64) -> Self {
        Self::of(1.0, share)
    }

    /// `share` times `scale`.
    fn of(scale: f64, share: impl Fn(f64) -> f64) -> Self {
        let xyz = cie::xyz(|lambda| share(lambda) * cie::d65(lambda));
        // What has no light has no hue; white stands in.
        let hue = if xyz.element_sum() > 0.0 { xyz } else { cie::rgb_to_xyz(DVec3::ONE) };
        let rgb = into_gamut(cie::xyz_to_rgb(hue).as_vec3());
        let shown = if xyz.element_sum() > 0.0 { rgb * scale as f32 } else { Vec3::ZERO };
        let sum = hue.element_sum();
        Self {
            luminance: scale * xyz.y,
            x: hue.x / sum,
            y: hue.y / sum,
            srgb: hex(shown),
            srgb_bright: hex(rgb / rgb.max_element()),
        }
    }
}

fn hex(rgb: Vec3) -> String {
    let [r, g, b] = rgb.to_array().map(|c| (255.0 * srgb_encode(c.clamp(0.0, 1.0))).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_stays_white_and_grey_grey() {
        let white = Colour::dimmed(|_| 0.0);
        // D65 of the tables at 5 nm: CIE 15 has 0.3127 and 0.3290.
        assert!((white.luminance - 1.0).abs() < 1e-12, "{white:?}");
        assert!((white.x - 0.3127).abs() < 1e-4 && (white.y - 0.3290).abs() < 1e-4, "{white:?}");
        assert_eq!((white.srgb.as_str(), white.srgb_bright.as_str()), ("#ffffff", "#ffffff"));
        // sRGB's middle grey: 0.2140 is 0.5 in its code.
        let grey = Colour::reflected(|_| 0.2140);
        assert_eq!((grey.srgb.as_str(), grey.srgb_bright.as_str()), ("#7f7f7f", "#ffffff"));
    }

    #[test]
    fn black_has_the_hue_of_white_and_what_is_too_dark_to_write_its_own() {
        let black = Colour::reflected(|_| 0.0);
        assert_eq!((black.luminance, black.srgb.as_str()), (0.0, "#000000"));
        assert!((black.x - 0.3127).abs() < 1e-4);
        // Red gets farthest.
        let dark = Colour::dimmed(|lambda| 1e6 * (1000.0 - lambda));
        assert_eq!((dark.luminance, dark.srgb.as_str()), (0.0, "#000000"));
        assert!(dark.x > 0.7 && dark.srgb_bright.starts_with("#ff00"), "{dark:?}");
    }

    #[test]
    fn blue_is_blue() {
        let blue = Colour::dimmed(|lambda| if lambda < 490.0 { 0.0 } else { 3.0 });
        assert!(blue.x < 0.2 && blue.y < 0.2 && blue.srgb_bright.ends_with("ff"), "{blue:?}");
    }
}
