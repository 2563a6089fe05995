//! The CIE 1931 2-degree observer, illuminant D65 and linear Rec. 709.
//!
//! ```text
//! XYZ = integral of L(lambda) (xbar, ybar, zbar)(lambda) d lambda      (no factor 683, no division)
//! RGB = M^-1 XYZ,   M = [primaries of Rec. 709 scaled so that M (1, 1, 1) = XYZ of D65]      [BT709]
//! ```
//! Tables are at 5 nm from 380 to 780 nm `[CIE15]` and linear in between; nothing outside that range is seen. D65 is
//! scaled so that its Y is 1. The matrix is made from the chromaticities of the primaries and the white of the
//! tabulated D65 itself, so that D65 is RGB (1, 1, 1) to rounding. Integrals are exact for spectra that are linear
//! between whole nanometres, so they are what a Monte Carlo estimate over tables of that kind converges to.

use std::sync::LazyLock;

use glam::{DMat3, DVec3};

/// Least wavelength in nm.
pub const LAMBDA_MIN: f64 = 380.0;
/// Greatest wavelength in nm.
pub const LAMBDA_MAX: f64 = 780.0;
/// Number of whole nanometres from the least wavelength to the greatest.
pub const NANOMETRES: usize = 401;
/// Number of tabulated values.
pub const KNOTS: usize = 81;
/// Distance between tabulated values in nm.
pub const KNOT_STEP: f64 = 5.0;

/// Chromaticities (x, y) of the Rec. 709 primaries.
const PRIMARIES: [[f64; 2]; 3] = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]];

struct Rec709 {
    d65_scale: f64,
    rgb_to_xyz: DMat3,
    xyz_to_rgb: DMat3,
}

static REC709: LazyLock<Rec709> = LazyLock::new(|| {
    let unscaled = xyz(|lambda| interpolate(&D65, lambda));
    let d65_scale = 1.0 / unscaled.y;
    let white = unscaled * d65_scale;
    let columns = PRIMARIES.map(|[x, y]| DVec3::new(x / y, 1.0, (1.0 - x - y) / y));
    let primaries = DMat3::from_cols(columns[0], columns[1], columns[2]);
    let rgb_to_xyz = primaries * DMat3::from_diagonal(primaries.inverse() * white);
    Rec709 { d65_scale, rgb_to_xyz, xyz_to_rgb: rgb_to_xyz.inverse() }
});

/// The wavelength of entry `index` of a table at whole nanometres.
pub fn nanometre(index: usize) -> f64 {
    LAMBDA_MIN + index as f64
}

/// The wavelengths of a table at whole nanometres.
pub fn nanometres() -> impl Iterator<Item = f64> {
    (0..NANOMETRES).map(nanometre)
}

/// The wavelengths of a table at the knots.
pub fn knots() -> impl Iterator<Item = f64> {
    (0..KNOTS).map(|index| LAMBDA_MIN + KNOT_STEP * index as f64)
}

/// The colour matching functions at `lambda` nm; zero outside 380 to 780 nm.
pub fn colour_matching(lambda: f64) -> DVec3 {
    if !(LAMBDA_MIN..=LAMBDA_MAX).contains(&lambda) {
        return DVec3::ZERO;
    }
    let (index, t) = knot(lambda);
    DVec3::from_array(COLOUR_MATCHING[index]).lerp(DVec3::from_array(COLOUR_MATCHING[index + 1]), t)
}

/// The weights of linear Rec. 709 at `lambda` nm: M^-1 (xbar, ybar, zbar). Parts are negative.
pub fn rgb_matching(lambda: f64) -> DVec3 {
    xyz_to_rgb(colour_matching(lambda))
}

/// Illuminant D65 with Y = 1, per nm; constant beyond the ends of the table.
pub fn d65(lambda: f64) -> f64 {
    REC709.d65_scale * interpolate(&D65, lambda)
}

/// X, Y, Z of a spectrum that is taken at whole nanometres and is linear in between.
pub fn xyz(spectrum: impl Fn(f64) -> f64) -> DVec3 {
    let at = |index| (spectrum(nanometre(index)), colour_matching(nanometre(index)));
    let mut sum = DVec3::ZERO;
    let (mut f, mut weight) = at(0);
    for index in 1..NANOMETRES {
        let (next_f, next_weight) = at(index);
        // The integral of the product of two linear functions over one nanometre.
        sum += (weight * (2.0 * f + next_f) + next_weight * (f + 2.0 * next_f)) / 6.0;
        (f, weight) = (next_f, next_weight);
    }
    sum
}

/// Linear Rec. 709 of a spectrum; parts are negative when it lies outside of the gamut.
pub fn rgb(spectrum: impl Fn(f64) -> f64) -> DVec3 {
    xyz_to_rgb(xyz(spectrum))
}

/// XYZ to linear Rec. 709.
pub fn xyz_to_rgb(xyz: DVec3) -> DVec3 {
    REC709.xyz_to_rgb * xyz
}

/// Linear Rec. 709 to XYZ.
pub fn rgb_to_xyz(rgb: DVec3) -> DVec3 {
    REC709.rgb_to_xyz * rgb
}

/// The knot at or below `lambda` (never the last) and the fraction of the way to the next, in [0, 1].
fn knot(lambda: f64) -> (usize, f64) {
    let position = ((lambda - LAMBDA_MIN) / KNOT_STEP).clamp(0.0, (KNOTS - 1) as f64);
    let index = (position as usize).min(KNOTS - 2);
    (index, position - index as f64)
}

/// A table at the knots, linear in between and constant beyond its ends.
pub fn interpolate(table: &[f64; KNOTS], lambda: f64) -> f64 {
    let (index, t) = knot(lambda);
    table[index] + (table[index + 1] - table[index]) * t
}

/// (xbar, ybar, zbar) of the CIE 1931 2-degree observer from 380 nm in steps of 5 nm `[CIE15]`.
#[rustfmt::skip]
const COLOUR_MATCHING: [[f64; 3]; KNOTS] = [
    [0.001368, 3.9e-05, 0.006450001],
    [0.002236, 6.4e-05, 0.01054999],
    [0.004243, 0.00012, 0.02005001],
    [0.00765, 0.000217, 0.03621],
    [0.01431, 0.000396, 0.06785001],
    [0.02319, 0.00064, 0.1102],
    [0.04351, 0.00121, 0.2074],
    [0.07763, 0.00218, 0.3713],
    [0.13438, 0.004, 0.6456],
    [0.21477, 0.0073, 1.0390501],
    [0.2839, 0.0116, 1.3856],
    [0.3285, 0.01684, 1.62296],
    [0.34828, 0.023, 1.74706],
    [0.34806, 0.0298, 1.7826],
    [0.3362, 0.038, 1.77211],
    [0.3187, 0.048, 1.7441],
    [0.2908, 0.06, 1.6692],
    [0.2511, 0.0739, 1.5281],
    [0.19536, 0.09098, 1.28764],
    [0.1421, 0.1126, 1.0419],
    [0.09564, 0.13902, 0.8129501],
    [0.05795001, 0.1693, 0.6162],
    [0.03201, 0.20802, 0.46518],
    [0.0147, 0.2586, 0.3533],
    [0.0049, 0.323, 0.272],
    [0.0024, 0.4073, 0.2123],
    [0.0093, 0.503, 0.1582],
    [0.0291, 0.6082, 0.1117],
    [0.06327, 0.71, 0.07824999],
    [0.1096, 0.7932, 0.05725001],
    [0.1655, 0.862, 0.04216],
    [0.2257499, 0.9148501, 0.02984],
    [0.2904, 0.954, 0.0203],
    [0.3597, 0.9803, 0.0134],
    [0.4334499, 0.9949501, 0.008749999],
    [0.5120501, 1.0, 0.005749999],
    [0.5945, 0.995, 0.0039],
    [0.6784, 0.9786, 0.002749999],
    [0.7621, 0.952, 0.0021],
    [0.8425, 0.9154, 0.0018],
    [0.9163, 0.87, 0.001650001],
    [0.9786, 0.8163, 0.0014],
    [1.0263, 0.757, 0.0011],
    [1.0567, 0.6949, 0.001],
    [1.0622, 0.631, 0.0008],
    [1.0456, 0.5668, 0.0006],
    [1.0026, 0.503, 0.00034],
    [0.9384, 0.4412, 0.00024],
    [0.8544499, 0.381, 0.00019],
    [0.7514, 0.321, 0.0001],
    [0.6424, 0.265, 4.999999e-05],
    [0.5419, 0.217, 3e-05],
    [0.4479, 0.175, 2e-05],
    [0.3608, 0.1382, 1e-05],
    [0.2835, 0.107, 0.0],
    [0.2187, 0.0816, 0.0],
    [0.1649, 0.061, 0.0],
    [0.1212, 0.04458, 0.0],
    [0.0874, 0.032, 0.0],
    [0.0636, 0.0232, 0.0],
    [0.04677, 0.017, 0.0],
    [0.0329, 0.01192, 0.0],
    [0.0227, 0.00821, 0.0],
    [0.01584, 0.005723, 0.0],
    [0.01135916, 0.004102, 0.0],
    [0.008110916, 0.002929, 0.0],
    [0.005790346, 0.002091, 0.0],
    [0.004109457, 0.001484, 0.0],
    [0.002899327, 0.001047, 0.0],
    [0.00204919, 0.00074, 0.0],
    [0.001439971, 0.00052, 0.0],
    [0.0009999493, 0.0003611, 0.0],
    [0.0006900786, 0.0002492, 0.0],
    [0.0004760213, 0.0001719, 0.0],
    [0.0003323011, 0.00012, 0.0],
    [0.0002348261, 8.48e-05, 0.0],
    [0.0001661505, 6e-05, 0.0],
    [0.000117413, 4.24e-05, 0.0],
    [8.307527e-05, 3e-05, 0.0],
    [5.870652e-05, 2.12e-05, 0.0],
    [4.150994e-05, 1.499e-05, 0.0],
];

/// Relative power of CIE illuminant D65 from 380 nm in steps of 5 nm `[CIE15]`.
#[rustfmt::skip]
const D65: [f64; KNOTS] = [
    49.9755, 52.3118, 54.6482, 68.7015, 82.7549, 87.1204, 91.4860, 92.4589, 93.4318,
    90.0570, 86.6823, 95.7736, 104.8650, 110.9360, 117.0080, 117.4100, 117.8120, 116.3360,
    114.8610, 115.3920, 115.9230, 112.3670, 108.8110, 109.0820, 109.3540, 108.5780, 107.8020,
    106.2960, 104.7900, 106.2390, 107.6890, 106.0470, 104.4050, 104.2250, 104.0460, 102.0230,
    100.0000, 98.1671, 96.3342, 96.0611, 95.7880, 92.2368, 88.6856, 89.3459, 90.0062,
    89.8026, 89.5991, 88.6489, 87.6987, 85.4936, 83.2886, 83.4939, 83.6992, 81.8630,
    80.0268, 80.1207, 80.2146, 81.2462, 82.2778, 80.2810, 78.2842, 74.0027, 69.7213,
    70.6652, 71.6091, 72.9790, 74.3490, 67.9765, 61.6040, 65.7448, 69.8856, 72.4863,
    75.0870, 69.3398, 63.5927, 55.0054, 46.4182, 56.6118, 66.8054, 65.0941, 63.3828,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn d65_is_white_to_rounding() {
        let white = rgb(d65);
        assert!((white - DVec3::ONE).abs().max_element() < 1e-14, "{white}");
        assert!((xyz(d65).y - 1.0).abs() < 1e-14);
    }

    /// Published chromaticity of D65 (0.31272, 0.32903). It was computed at 1 nm from a wider range; the 5 nm
    /// table between 380 and 780 nm is measured to be 4e-5 away.
    #[test]
    fn d65_has_its_published_chromaticity() {
        let white = xyz(d65);
        let sum = white.element_sum();
        assert!((white.x / sum - 0.31272).abs() < 5e-5 && (white.y / sum - 0.32903).abs() < 5e-5);
    }

    /// IEC 61966-2-1 gives four decimals for the white (0.3127, 0.3290), which is 3e-4 of a coefficient away.
    #[test]
    fn the_matrix_is_that_of_the_standard() {
        let standard = [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]];
        for (row, expected) in standard.iter().enumerate() {
            for (column, expected) in expected.iter().enumerate() {
                let got = REC709.xyz_to_rgb.row(row)[column];
                assert!((got - expected).abs() < 1e-3, "row {row} column {column}: {got} is not {expected}");
            }
        }
    }

    /// The published integral of ybar is 106.8569 nm from 360 to 830 nm; the ends left out hold 4e-4.
    #[test]
    fn the_integral_of_ybar_is_the_published_one() {
        assert!((xyz(|_| 1.0).y - 106.8569).abs() < 5e-4);
    }

    #[test]
    fn the_equal_energy_spectrum_has_equal_x_y_z() {
        let e = xyz(|_| 1.0);
        assert!((e.x / e.y - 1.0).abs() < 2e-4 && (e.z / e.y - 1.0).abs() < 2e-4, "{e}");
    }

    #[test]
    fn nothing_is_seen_outside_the_table() {
        assert_eq!(colour_matching(379.9), DVec3::ZERO);
        assert_eq!(colour_matching(780.1), DVec3::ZERO);
        assert_eq!(colour_matching(555.0).y, 1.0);
        assert_eq!(colour_matching(780.0), DVec3::from_array(COLOUR_MATCHING[KNOTS - 1]));
    }
}
