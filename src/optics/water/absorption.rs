//! What water absorbs: pure, with salt, warmer or colder, and with what is dissolved in it.
//!
//! ```text
//! a(lambda, T, S) = a_w(lambda) + (T - 22) da/dT + S da/dS                                            (1)
//! a_cdom = a_440 exp(-0.014 (lambda - 440))                                                           (2)
//! ```
//! a_w is that of pure water at 22 degrees Celsius: Pope and Fry `[POPE97]` from 380 to 725 nm, and from 730 nm Kou et al.
//! `[KOU93]` as compiled in `[IOCCG18]`. Below 420 nm later measurements are lower (0.0046 1/m at 400 nm).
//!
//! (1) is the host of the waters of `[FRISVAD07]`: the slopes are those of `[PEGAU97]`, S in parts per thousand, read in a program. At 20
//! degrees and 35 parts per thousand it has the k of their table within 0.2 %, to which that is rounded
//! (`tests/models/natural_waters.rs`). Beyond 725 nm it has the a_w which that table implies, an older one, 13 % below
//! [`absorption`] at 750 nm. In the violet, salt is what is known least: here 35 parts add 63 % at 400 nm, by the slopes
//! in `[IOCCG18]` 23 %, and from 450 to 550 nm they add a little there where here they take a little away.
//!
//! (2) is the usual form of the absorption of coloured dissolved organic matter, which makes fresh and coastal waters
//! green to brown; its slope, in 1/nm, is the mean of many waters `[BRICAUD81]`.

use crate::spectrum::cie::{KNOTS, interpolate};
use crate::spectrum::curve::interpolate_even;

/// The temperature in degrees Celsius at which pure water was measured.
pub const MEASURED_AT: f64 = 22.0;

/// First wavelength and step in nm of the slopes of (1).
const SLOPES: [f64; 2] = [375.0, 25.0];
/// The same of its far red.
const RED: [f64; 2] = [725.0, 25.0];

/// 1/nm, (2).
const DISSOLVED_SLOPE: f64 = 0.014;

/// Absorption coefficient of pure water in 1/m, linear between 5 nm steps, constant beyond 380 and 780 nm.
pub fn absorption(lambda_nm: f64) -> f64 {
    interpolate(&PURE, lambda_nm)
}

/// Absorption coefficient in 1/m of water of a temperature in degrees Celsius and a salinity in parts per thousand, (1).
pub fn absorption_at(lambda_nm: f64, temperature: f64, salinity: f64) -> f64 {
    let pure =
        if lambda_nm <= RED[0] { absorption(lambda_nm) } else { interpolate_even(&FAR_RED, RED, lambda_nm) };
    let slope = |table| interpolate_even(table, SLOPES, lambda_nm);
    (pure + 1e-4 * ((temperature - MEASURED_AT) * slope(&WARMTH) + salinity * slope(&SALT))).max(0.0)
}

/// Absorption coefficient in 1/m of dissolved organic matter that has `at_440` of it at 440 nm, (2).
pub fn dissolved_matter(lambda_nm: f64, at_440: f64) -> f64 {
    at_440 * libm::exp(-DISSOLVED_SLOPE * (lambda_nm - 440.0))
}

/// 1/m from 380 nm in steps of 5 nm: `[POPE97]` to 725 nm, `[KOU93]` from 730 nm.
#[rustfmt::skip]
const PURE: [f64; KNOTS] = [
    0.01137, 0.00941, 0.00851, 0.00813, 0.00663, 0.00530, 0.00473, 0.00444, 0.00454,
    0.00478, 0.00495, 0.00530, 0.00635, 0.00751, 0.00922, 0.00962, 0.00979, 0.01011,
    0.0106, 0.0114, 0.0127, 0.0136, 0.0150, 0.0173, 0.0204, 0.0256, 0.0325,
    0.0396, 0.0409, 0.0417, 0.0434, 0.0452, 0.0474, 0.0511, 0.0565, 0.0596,
    0.0619, 0.0642, 0.0695, 0.0772, 0.0896, 0.1100, 0.1351, 0.1672, 0.2224,
    0.2577, 0.2644, 0.2678, 0.2755, 0.2834, 0.2916, 0.3012, 0.3108, 0.325,
    0.340, 0.371, 0.410, 0.429, 0.439, 0.448, 0.465, 0.486, 0.516,
    0.559, 0.624, 0.704, 0.827, 1.007, 1.231, 1.489, 1.97, 2.51,
    2.78, 2.83, 2.85, 2.88, 2.86, 2.86, 2.82, 2.76, 2.69,
];

/// 1/m, in steps of [`RED`]: that of `[POPE97]`, and what k of pure and of sea water in the tables of `[FRISVAD07]` imply,
/// which are rounded to 0.3 %.
const FAR_RED: [f64; 3] = [1.489, 2.465, 2.412];

/// da/dT in 1e-4 1/m per degree, in steps of [`SLOPES`] `[PEGAU97]`.
#[rustfmt::skip]
const WARMTH: [f64; 17] = [
    1.0, 1.0, 0.5, 0.0, 0.0, 1.0, 2.0, 1.0, 2.0,
    10.0, 5.0, 0.5, 1.0, 2.0, 65.0, 106.0, 106.0,
];

/// da/dS in 1e-4 1/m per part in a thousand, in steps of [`SLOPES`] `[PEGAU97]`.
#[rustfmt::skip]
const SALT: [f64; 17] = [
    1.2, 1.2, 0.55, -0.2, -0.2, -0.2, -0.25, -0.3, -0.2,
    -0.15, -0.1, 0.0, -0.2, -1.7, -0.1, 6.4, 6.4,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn absorption_is_the_published_one() {
        for (lambda, published) in [
            (380.0, 0.01137),
            (420.0, 0.00454),
            (500.0, 0.0204),
            (550.0, 0.0565),
            (600.0, 0.2224),
            (650.0, 0.340),
            (700.0, 0.624),
            (725.0, 1.489),
            (760.0, 2.86),
            (780.0, 2.69),
        ] {
            assert_eq!(absorption(lambda), published, "{lambda} nm");
        }
        // Pope and Fry also measured between: 417.5 nm 0.00442, 652.5 nm lies between 0.340 and 0.371.
        assert!((absorption(417.5) - 0.00442).abs() < 1e-4);
        assert_eq!(absorption(300.0), 0.01137);
        assert_eq!(absorption(900.0), 2.69);
    }

    /// Warming from 22 to 32 degrees adds 10 x 65e-4 at 725 nm; 35 parts of salt add 35 x 1.2e-4 at 400 nm.
    #[test]
    fn warmth_and_salt_add_what_the_slopes_say() {
        assert!((absorption_at(725.0, 32.0, 0.0) - (1.489 + 0.065)).abs() < 1e-12);
        assert!((absorption_at(400.0, 22.0, 35.0) - (0.00663 + 0.0042)).abs() < 1e-12);
        assert!((absorption_at(775.0, 22.0, 0.0) - 2.412).abs() < 1e-12);
    }

    /// However it is cooled or salted, no water shines.
    #[test]
    fn water_within_its_range_absorbs() {
        for lambda in (380..=780).map(f64::from) {
            assert!(absorption_at(lambda, MEASURED_AT, 0.0) == absorption(lambda) || lambda > 725.0);
            for (temperature, salinity) in [(0.0, 0.0), (30.0, 0.0), (0.0, 35.0), (30.0, 35.0)] {
                assert!(absorption_at(lambda, temperature, salinity) > 1e-3, "{lambda} nm");
            }
        }
    }

    #[test]
    fn dissolved_matter_falls_to_1_in_e_in_71_nm() {
        assert_eq!(dissolved_matter(440.0, 0.3), 0.3);
        let ratio = dissolved_matter(440.0 + 1.0 / 0.014, 0.3) / 0.3;
        assert!((ratio * std::f64::consts::E - 1.0).abs() < 1e-12);
    }
}
