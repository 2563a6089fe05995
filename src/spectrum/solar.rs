//! The sun's spectrum of ASTM G173-03: above the atmosphere, and on the ground at air mass 1.5.
//!
//! `[ASTMG173]`: W m^-2 nm^-1 on a plane perpendicular to the beam. The table has values every half nanometre; here it is
//! averaged with a tent of 5 nm to either side, so that what is linear between the knots has the integral of the table
//! (to 3e-4), though none of its Fraunhofer lines. The atmosphere of the direct beam is the U.S. Standard Atmosphere
//! with an aerosol of optical depth 0.084 at 500 nm, 0.34 cm of ozone and 1.42 cm of water.

use super::Spectrum;
use super::cie::{KNOTS, interpolate, knots};

/// Irradiance above the atmosphere at the mean distance of the earth, in W m^-2 nm^-1.
pub fn extraterrestrial(lambda: f64) -> f64 {
    interpolate(&EXTRATERRESTRIAL, lambda)
}

/// Direct normal irradiance on the ground at air mass 1.5 (with the sky up to 2.5 degrees around the sun), times `scale`.
pub fn direct(scale: f64) -> Spectrum {
    tabulated(|lambda| scale * interpolate(&DIRECT, lambda))
}

/// A spectrum at the wavelengths of the tables.
pub fn tabulated(value: impl Fn(f64) -> f64) -> Spectrum {
    Spectrum::tabulated(knots(), value)
}

/// From 380 nm in steps of 5 nm.
#[rustfmt::skip]
const EXTRATERRESTRIAL: [f64; KNOTS] = [
    1.1375, 0.9674, 1.1166, 1.0535, 1.5629, 1.7185, 1.6998, 1.7557, 1.7269, 1.7037,
    1.4806, 1.7062, 1.7987, 1.9164, 2.0242, 2.0216, 2.0408, 2.0147, 1.9913, 2.0335,
    2.0517, 1.9044, 1.9077, 1.9635, 1.9087, 1.9246, 1.9293, 1.8237, 1.8063, 1.8662,
    1.8942, 1.8859, 1.8424, 1.8688, 1.8651, 1.8577, 1.8221, 1.8335, 1.8332, 1.8433,
    1.8337, 1.8262, 1.7612, 1.7884, 1.7609, 1.7579, 1.7291, 1.6875, 1.6959, 1.6695,
    1.6626, 1.6428, 1.6296, 1.6087, 1.5781, 1.5030, 1.5328, 1.5559, 1.5325, 1.5084,
    1.4928, 1.4669, 1.4685, 1.4443, 1.4202, 1.4132, 1.3941, 1.3658, 1.3461, 1.3461,
    1.3217, 1.3175, 1.2826, 1.2867, 1.2754, 1.2689, 1.2551, 1.2346, 1.2138, 1.2078,
    1.1967,
];

/// From 380 nm in steps of 5 nm.
#[rustfmt::skip]
const DIRECT: [f64; KNOTS] = [
    0.4914, 0.4359, 0.5213, 0.5088, 0.7793, 0.8805, 0.8951, 0.9486, 0.9556, 0.9640,
    0.8562, 1.0068, 1.0812, 1.1712, 1.2594, 1.2783, 1.3076, 1.3093, 1.3092, 1.3450,
    1.3721, 1.2944, 1.3118, 1.3629, 1.3320, 1.3439, 1.3628, 1.3013, 1.2963, 1.3416,
    1.3622, 1.3636, 1.3391, 1.3612, 1.3657, 1.3650, 1.3382, 1.3429, 1.3302, 1.3323,
    1.3448, 1.3584, 1.2791, 1.3082, 1.3174, 1.3328, 1.3268, 1.3059, 1.3123, 1.2760,
    1.2681, 1.2967, 1.3082, 1.2931, 1.2614, 1.2146, 1.2407, 1.2743, 1.2829, 1.2714,
    1.2638, 1.1728, 1.0762, 1.1584, 1.1690, 1.1817, 1.1879, 1.1145, 0.9713, 0.9894,
    1.0061, 1.0964, 1.1086, 1.1337, 1.1285, 1.1199, 0.6470, 0.6564, 1.0314, 1.0792,
    1.0720,
];

#[cfg(test)]
mod tests {
    use super::super::Role;
    use super::super::cie::KNOT_STEP;
    use super::super::luminance::{LUMENS_PER_WATT, luminance_f64};
    use super::*;

    /// The integrals of the published half nanometres from 380 to 780 nm by the trapezoidal rule are 655.877 and
    /// 467.824 W m^-2; the tents at the two ends also have a share in what is beyond: 3.3e-4 and 1.6e-4.
    #[test]
    fn the_knots_keep_the_integrals_of_the_table() {
        for (table, published) in [(&EXTRATERRESTRIAL, 655.877), (&DIRECT, 467.824)] {
            let ends = 0.5 * (table[0] + table[KNOTS - 1]);
            let sum = KNOT_STEP * (table.iter().sum::<f64>() - ends);
            assert!((sum / published - 1.0).abs() < 4e-4, "{sum} {published}");
        }
    }

    /// The half nanometres and the CIE's observer at whole nanometres have 133,100 and 97,142 lx; both observers are
    /// smooth over a tent of 5 nm, whose second moment (4.2 nm^2) times half their relative curvature there is a few 1e-4.
    #[test]
    fn illuminances_are_those_of_the_table() {
        for (spectrum, lux) in [(tabulated(extraterrestrial), 133_100.0), (direct(1.0), 97_142.0)] {
            let found = LUMENS_PER_WATT * luminance_f64(spectrum.to_rgb(Role::Illuminant).as_dvec3());
            assert!((found / lux - 1.0).abs() < 1e-3, "{found} {lux}");
        }
    }
}
