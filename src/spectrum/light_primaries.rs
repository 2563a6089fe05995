//! RGB lights: three spectra that sum to D65.
//!
//! ```text
//! L(lambda) = D65(lambda) (r rho_r(lambda) + g rho_g(lambda) + b rho_b(lambda))
//! rho_r + rho_g + rho_b = 1,   rho >= 0,   RGB of (D65 rho_r, D65 rho_g, D65 rho_b) = identity
//! ```
//! A decomposition of white in the manner of Mallett and Yuksel `[MALLETT19]`. Lights add, and so do these spectra:
//! two lights are upsampled as their sum is, a filtered environment picture as the mean of its pixels. Every
//! non-negative RGB comes back, however saturated or bright, and white is D65 itself. (The curves of
//! reflectances, [`super::rgb`], are smoother but not linear.)
//!
//! The numbers solve: least sum of squared differences between neighbouring knots, subject to the second line above,
//! for the tables of [`super::cie`]. They are rounded to seven decimals. Sampled at whole nanometres the RGB comes back to 6e-6 of the brightest
//! component.

use std::sync::LazyLock;

use glam::{DVec3, Vec3};

use super::cie::{self, KNOTS, NANOMETRES, d65, interpolate};
use super::wavelength::nanometre_cell;
use super::{LaneMode, Lanes, Wavelengths};

/// The radiance of an RGB light at `lambda` nm, per nm; grey is D65 exactly, negative parts count as zero.
pub fn radiance(rgb: [f32; 3], lambda: f64) -> f64 {
    d65(lambda) * relative(rgb, lambda)
}

/// The radiance relative to D65 of luminance 1.
pub fn relative(rgb: [f32; 3], lambda: f64) -> f64 {
    let rgb = DVec3::from_array(rgb.map(|v| f64::from(v.max(0.0))));
    let (rho_r, rho_g) = (interpolate(&RED, lambda), interpolate(&GREEN, lambda));
    // rho_b = 1 - rho_r - rho_g, ordered so that equal components give exactly themselves.
    (rgb.z + (rgb.x - rgb.z) * rho_r + (rgb.y - rgb.z) * rho_g).max(0.0)
}

/// The radiance of an RGB light on the lanes of a path: the fast route for the pixels of environment pictures.
#[inline]
pub fn radiance_lanes(mode: LaneMode, rgb: Vec3, wavelengths: &Wavelengths) -> Lanes {
    if mode == LaneMode::Rgb {
        return rgb.extend(0.0);
    }
    let rgb = rgb.max(Vec3::ZERO);
    let mixed = Vec3::new(rgb.z, rgb.x - rgb.z, rgb.y - rgb.z);
    let table = &*AT_NANOMETRES;
    let lanes = wavelengths.lambda.map(|lambda| {
        let (index, t) = nanometre_cell(lambda);
        table[index].lerp(table[index + 1], t).dot(mixed).max(0.0)
    });
    Lanes::from_array(lanes)
}

/// D65 times (1, rho_r, rho_g) at whole nanometres.
static AT_NANOMETRES: LazyLock<Box<[Vec3; NANOMETRES]>> = LazyLock::new(|| {
    Box::new(std::array::from_fn(|i| {
        let lambda = cie::nanometre(i);
        let shares = DVec3::new(1.0, interpolate(&RED, lambda), interpolate(&GREEN, lambda));
        (d65(lambda) * shares).as_vec3()
    }))
});

/// rho_r from 380 nm in steps of 5 nm.
#[rustfmt::skip]
const RED: [f64; KNOTS] = [
    0.0282826, 0.0282808, 0.0282736, 0.0282557, 0.0282142, 0.0281241, 0.0279477, 0.0276140, 0.0270134,
    0.0260101, 0.0245295, 0.0226666, 0.0207509, 0.0194388, 0.0197396, 0.0230409, 0.0282422, 0.0226856,
    0.0117374, 0.0018712, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000,
    0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000,
    0.0000000, 0.0000000, 0.0303003, 0.1045534, 0.2112352, 0.3385018, 0.4745600, 0.6088510, 0.7322440,
    0.8372563, 0.9183507, 0.9721745, 0.9989293, 1.0000000, 1.0000000, 1.0000000, 1.0000000, 1.0000000,
    1.0000000, 1.0000000, 1.0000000, 1.0000000, 1.0000000, 1.0000000, 1.0000000, 1.0000000, 1.0000000,
    1.0000000, 1.0000000, 1.0000000, 1.0000000, 1.0000000, 1.0000000, 1.0000000, 1.0000000, 1.0000000,
    1.0000000, 1.0000000, 1.0000000, 1.0000000, 1.0000000, 1.0000000, 1.0000000, 1.0000000, 1.0000000,
];

/// rho_g from 380 nm in steps of 5 nm.
#[rustfmt::skip]
const GREEN: [f64; KNOTS] = [
    0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000,
    0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0055268, 0.0456781,
    0.1136207, 0.2004819, 0.2970372, 0.4007890, 0.5075672, 0.6130318, 0.7132498, 0.8043426, 0.8823229,
    0.9432183, 0.9834129, 1.0000000, 1.0000000, 1.0000000, 1.0000000, 1.0000000, 1.0000000, 1.0000000,
    0.9985367, 0.9788886, 0.9291737, 0.8460419, 0.7387864, 0.6169360, 0.4899122, 0.3661269, 0.2528813,
    0.1561378, 0.0802598, 0.0278255, 0.0010707, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000,
    0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000,
    0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000,
    0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000, 0.0000000,
];

#[cfg(test)]
mod tests {
    use super::super::{Role, Spectrum};
    use super::*;

    #[test]
    fn every_rgb_comes_back() {
        for rgb in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [3.0, 0.25, 900.0], [0.2, 0.7, 0.1]] {
            let got = cie::rgb(|lambda| radiance(rgb, lambda));
            let want = DVec3::from_array(rgb.map(f64::from));
            // The spectrum between knots is a product of two linear functions, the integral takes it as linear
            // between nanometres: measured 6e-6 of the brightest component.
            let error = (got - want).abs().max_element() / want.max_element();
            assert!(error < 1e-5, "{rgb:?} became {got}: {error}");
        }
    }

    #[test]
    fn grey_is_d65_exactly() {
        for index in 0..cie::NANOMETRES {
            let lambda = cie::nanometre(index);
            assert_eq!(relative([0.3, 0.3, 0.3], lambda), f64::from(0.3_f32));
            assert_eq!(radiance([2.0, 2.0, 2.0], lambda), 2.0 * d65(lambda));
        }
    }

    #[test]
    fn the_fast_route_is_the_prepared_light() {
        for rgb in [[1.0, 1.0, 1.0], [0.9, 0.2, 0.05], [0.0, 0.0, 1e4], [0.1, 0.8, 0.1]] {
            for mode in [LaneMode::Rgb, LaneMode::Spectral] {
                let prepared = Spectrum::Rgb(rgb).prepare(Role::Illuminant, mode);
                for i in 0..64 {
                    let w = Wavelengths::for_mode(mode, i as f32 / 64.0);
                    let fast = radiance_lanes(mode, Vec3::from_array(rgb), &w);
                    // A few roundings of the brightest term.
                    let tolerance = 5e-7 * prepared.maximum();
                    assert!((fast - prepared.lanes(&w)).abs().max_element() <= tolerance, "{rgb:?} {w:?}");
                }
            }
        }
    }

    #[test]
    fn no_primary_is_negative_or_above_one() {
        for index in 0..cie::NANOMETRES {
            let lambda = cie::nanometre(index);
            let red = interpolate(&RED, lambda);
            let green = interpolate(&GREEN, lambda);
            assert!(red >= 0.0 && green >= 0.0 && red + green <= 1.0 + 1e-12, "{lambda} nm: {red} {green}");
        }
        assert_eq!(relative([-1.0, -2.0, 0.0], 500.0), 0.0);
    }
}
