//! What water absorbs: pure, with salt, warmer or colder, and with what is dissolved in it.
//!
//! ```text
//! a(lambda, T, S) = a_w(lambda) + (T - 22) da/dT + S da/dS                                            (1)
//! a_cdom = a_440 exp(-0.014 (lambda - 440))                                                           (2)
//! ```
//! a_w is that of pure water at 22 degrees Celsius: Pope and Fry `[POPE97]` from 380 to 725 nm, and from 730 nm Kou et al.
//! `[KOU93]` as compiled in `[IOCCG18]`. Below 420 nm later measurements are lower (0.0046 1/m at 400 nm). The slopes of (1)
//! are those of `[IOCCG18]`, S in parts per thousand: at 35 of them salt adds 30 % at 400 nm, 5 % at 460 nm and about 1 %
//! above 500 nm; ten degrees add up to 4 % below 725 nm and 6 % near 740 nm. Below 400 nm, where nobody has measured
//! what salt does, the slope at 400 nm goes on.
//!
//! (1) is not what `[PEGAU97]` has, whose figures the published tables of sea water go back to: there salt adds three times
//! as much at 400 nm and takes a little away from 450 nm on. At 20 degrees and 35 parts per thousand (1) absorbs 24 %
//! less than those at 400 nm and 12 % less at 425 nm, 15 % more at 450 nm, 10 % more at 475 nm, up to 6 % more from there
//! to 550 nm, within 3 % of them to 725 nm, and 16 % more beyond, where their table is an older one
//! (`tests/models/natural_waters.rs`).
//!
//! (2) is the usual form of the absorption of coloured dissolved organic matter, which makes fresh and coastal waters
//! green to brown; its slope, in 1/nm, is the mean of many waters `[BRICAUD81]`.

use crate::spectrum::cie::{KNOTS, interpolate};

/// The temperature in degrees Celsius at which pure water was measured.
pub const MEASURED_AT: f64 = 22.0;

/// 1/nm, (2).
const DISSOLVED_SLOPE: f64 = 0.014;

/// Absorption coefficient of pure water in 1/m, linear between 5 nm steps, constant beyond 380 and 780 nm.
pub fn absorption(lambda_nm: f64) -> f64 {
    interpolate(&PURE, lambda_nm)
}

/// Absorption coefficient in 1/m of water of a temperature in degrees Celsius and a salinity in parts per thousand, (1).
pub fn absorption_at(lambda_nm: f64, temperature: f64, salinity: f64) -> f64 {
    let warmer = (temperature - MEASURED_AT) * interpolate(&WARMTH, lambda_nm);
    (absorption(lambda_nm) + 1e-4 * (warmer + salinity * interpolate(&SALT, lambda_nm))).max(0.0)
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

/// da/dT in 1e-4 1/m per degree, from 380 nm in steps of 5 nm `[IOCCG18]`.
#[rustfmt::skip]
const WARMTH: [f64; KNOTS] = [
    0.0, 0.0, 0.0, -0.2, 0.1, 0.1, 0.0, 0.2, 0.0,
    -0.1, -0.1, 0.0, 0.0, 0.1, 0.2, 0.1, 0.1, 0.0,
    -0.1, -0.1, 0.0, -0.1, -0.1, 0.0, 0.1, 0.3, 0.8,
    1.2, 1.1, 0.7, 0.4, 0.1, 0.0, -0.1, 0.0, -0.2,
    -0.4, -0.6, -0.7, -0.6, 0.0, 1.2, 2.5, 4.5, 7.9,
    10.3, 9.5, 7.2, 5.4, 3.0, 0.9, -0.5, -2.0, -3.0,
    -3.0, -2.2, 0.8, 0.9, -0.4, -2.1, -4.0, -4.0, -4.3,
    -4.1, -2.0, 1.7, 11.0, 27.3, 46.3, 65.8, 98.3, 148.5,
    161.0, 137.2, 105.0, 74.4, 44.7, 18.6, -4.4, -24.5, -40.4,
];

/// da/dS in 1e-4 1/m per part in a thousand, from 380 nm in steps of 5 nm `[IOCCG18]`; the first four are that of 400 nm.
#[rustfmt::skip]
const SALT: [f64; KNOTS] = [
    0.43, 0.43, 0.43, 0.43, 0.43, 0.37, 0.36, 0.34, 0.32,
    0.28, 0.26, 0.25, 0.22, 0.19, 0.17, 0.16, 0.14, 0.13,
    0.11, 0.09, 0.08, 0.06, 0.06, 0.05, 0.05, 0.04, 0.02,
    0.08, 0.13, 0.14, 0.15, 0.15, 0.15, 0.13, 0.13, 0.16,
    0.16, 0.15, 0.13, 0.1, 0.04, 0.01, 0.03, -0.02, -0.16,
    0.43, 0.75, 0.83, 0.84, 0.8, 0.77, 0.73, 0.7, 0.66,
    0.6, 0.34, 0.41, 0.63, 0.62, 0.46, 0.25, -0.02, -0.34,
    -0.7, -1.16, -1.4, -1.8, -1.9, -1.8, -2.1, -4.4, -3.7,
    1.8, 4.7, 6.5, 6.8, 6.6, 6.0, 5.3, 4.5, 3.6,
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

    /// Warming from 22 to 32 degrees adds 10 x 65.8e-4 at 725 nm; 35 parts of salt add 35 x 0.43e-4 at 400 nm.
    #[test]
    fn warmth_and_salt_add_what_the_slopes_say() {
        assert!((absorption_at(725.0, 32.0, 0.0) - (1.489 + 0.0658)).abs() < 1e-12);
        assert!((absorption_at(400.0, 22.0, 35.0) - (0.00663 + 0.001_505)).abs() < 1e-12);
        assert_eq!(absorption_at(550.0, 22.0, 0.0), absorption(550.0));
    }

    #[test]
    fn dissolved_matter_falls_to_1_in_e_in_71_nm() {
        assert_eq!(dissolved_matter(440.0, 0.3), 0.3);
        let ratio = dissolved_matter(440.0 + 1.0 / 0.014, 0.3) / 0.3;
        assert!((ratio * std::f64::consts::E - 1.0).abs() < 1e-12);
    }
}
