//! The radiance of a clear sky: the model of Hosek and Wilkie.
//!
//! ```text
//! L = L_M (1 + A e^(B / (cos theta + 0.01))) (C + D e^(E gamma) + F cos^2 gamma + G chi + I sqrt(cos theta))
//! chi = (1 + cos^2 gamma) / (1 + H^2 - 2 H cos gamma)^1.5                                          [HOSEK12]
//! each of A .. I, L_M = sum_k (5 over k) x^k (1 - x)^(5 - k) p_k,   x = (h / 90 degrees)^(1/3)      [HOSEK12]
//! ```
//! theta is the angle from the zenith, gamma that from the sun, h the sun's elevation. The p_k were fitted by the authors to
//! a path-traced atmosphere at 11 wavelengths from 320 to 720 nm, turbidities 1 to 10 and ground albedos 0 and 1; all but h is
//! linear in between. L is in W m^-2 sr^-1 nm^-1. The data are theirs (`hosek_wilkie.license.txt`), the code is not.
//!
//! Beyond 720 nm the distribution stays that at 720 nm, and its radiance falls from knot to knot by the factor of the last two:
//! less than 0.1 % of the luminance is there. With the sun at the horizon the fit goes slightly below 0 in places, which
//! counts as 0. The sun below the horizon is outside of the model.

use glam::Vec4;

use crate::geometry::elementary::{atan2, exp4};
use crate::spectrum::Wavelengths;

/// Knots of wavelength that the visible range needs: 360 to 800 nm.
pub(super) const KNOTS: usize = 12;
/// Those of them that the data have.
const KNOWN: usize = 10;
const FIRST_KNOT: f32 = 360.0;
const KNOT_STEP: f32 = 40.0;

const TURBIDITIES: usize = 10;
const CONTROL_POINTS: usize = 6;
/// Wavelengths in the data; the first, 320 nm, is not needed.
const WAVELENGTHS: usize = 11;
/// A .. I, with G, H and I in the order G, I, H of the data, and the radiance.
const PARAMETERS: usize = 10;

static DATA: &[u8; 4 * TURBIDITIES * 2 * CONTROL_POINTS * WAVELENGTHS * PARAMETERS] =
    include_bytes!("hosek_wilkie.bin");

/// The sky above one horizon, for one place of the sun.
#[derive(Clone, Debug)]
pub(super) struct HosekWilkie {
    parameters: [[f32; KNOTS]; PARAMETERS],
}

/// What the radiance of a direction depends on.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    cos_theta: f32,
    gamma: f32,
    cos_gamma: f32,
    one_minus_cos_gamma: f32,
}

impl View {
    /// A direction above the horizon. One minus the cosine from the sun keeps its digits near the sun.
    #[inline]
    pub fn new(cos_theta: f32, one_minus_cos_gamma: f32) -> Self {
        let half = (0.5 * one_minus_cos_gamma).clamp(0.0, 1.0);
        let gamma = 2.0 * atan2(half.sqrt(), (1.0 - half).sqrt());
        Self { cos_theta, gamma, cos_gamma: 1.0 - one_minus_cos_gamma, one_minus_cos_gamma }
    }
}

impl HosekWilkie {
    /// For a turbidity from 1 to 10, a ground albedo from 0 to 1, and the sun's elevation in radians from 0 to pi/2.
    pub fn new(turbidity: f64, albedo: f64, elevation: f64) -> Self {
        let x = libm::cbrt((elevation * std::f64::consts::FRAC_2_PI).clamp(0.0, 1.0));
        let mut parameters = [[0.0; KNOTS]; PARAMETERS];
        for (parameter, knots) in parameters.iter_mut().enumerate() {
            for (knot, value) in knots[..KNOWN].iter_mut().enumerate() {
                *value = fitted(turbidity, albedo, x, [knot + 1, parameter]) as f32;
            }
            let last = knots[KNOWN - 1];
            knots[KNOWN..].fill(last);
        }
        let radiance = &mut parameters[PARAMETERS - 1];
        let [last, before] = [radiance[KNOWN - 1], radiance[KNOWN - 2]];
        let falls = if before > 0.0 { (last / before).clamp(0.0, 1.0) } else { 0.0 };
        for knot in KNOWN..KNOTS {
            radiance[knot] = radiance[knot - 1] * falls;
        }
        Self { parameters }
    }

    /// The wavelength of a knot in nm.
    pub fn wavelength(knot: usize) -> f32 {
        FIRST_KNOT + KNOT_STEP * knot as f32
    }

    /// Radiance on the four wavelengths of a path, linear between the knots.
    #[inline]
    pub fn lanes(&self, view: &View, wavelengths: &Wavelengths) -> Vec4 {
        let position =
            wavelengths.lambda.map(|l| ((l - FIRST_KNOT) / KNOT_STEP).clamp(0.0, KNOTS as f32 - 1.01));
        let below = position.map(|p| p as usize);
        let share = Vec4::from_array(position) - Vec4::from_array(below.map(|k| k as f32));
        let [low, high] = [self.knots(view, below), self.knots(view, below.map(|k| k + 1))];
        low + (high - low) * share
    }

    /// Radiance at four knots.
    #[inline]
    pub fn knots(&self, view: &View, knots: [usize; 4]) -> Vec4 {
        let [a, b, c, d, e, f, g, i, h, radiance] =
            std::array::from_fn(|p| Vec4::from_array(knots.map(|knot| self.parameters[p][knot])));
        let horizon = Vec4::ONE + a * exp4(b / (view.cos_theta + 0.01));
        let square = view.cos_gamma * view.cos_gamma;
        let from_one = Vec4::ONE - h;
        let base = from_one * from_one + h * (2.0 * view.one_minus_cos_gamma);
        let chi = Vec4::splat(1.0 + square) / (base * Vec4::from_array(base.to_array().map(f32::sqrt)));
        let sun = c + d * exp4(e * view.gamma) + f * square + g * chi + i * view.cos_theta.max(0.0).sqrt();
        (radiance * horizon * sun).max(Vec4::ZERO)
    }
}

/// One parameter of one wavelength.
fn fitted(turbidity: f64, albedo: f64, x: f64, which: [usize; 2]) -> f64 {
    let below = (turbidity as usize).clamp(1, TURBIDITIES - 1) - 1;
    let share = turbidity - 1.0 - below as f64;
    let of_albedo = |set: usize, albedo: usize| {
        let rest = 1.0 - x;
        let binomials = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];
        let power = |base: f64, exponent: usize| (0..exponent).fold(1.0, |product, _| product * base);
        let points = (0..CONTROL_POINTS).zip(binomials);
        points.map(|(k, n)| n * power(x, k) * power(rest, 5 - k) * datum(set, albedo, k, which)).sum::<f64>()
    };
    let of_turbidity = |set| of_albedo(set, 0) * (1.0 - albedo) + of_albedo(set, 1) * albedo;
    of_turbidity(below) * (1.0 - share) + of_turbidity(below + 1) * share
}

fn datum(turbidity: usize, albedo: usize, point: usize, [wavelength, parameter]: [usize; 2]) -> f64 {
    let set = (turbidity * 2 + albedo) * CONTROL_POINTS + point;
    let at = 4 * ((set * WAVELENGTHS + wavelength) * PARAMETERS + parameter);
    f64::from(f32::from_le_bytes([DATA[at], DATA[at + 1], DATA[at + 2], DATA[at + 3]]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Turbidity, albedo, elevation in degrees; then for three directions (cos theta, and the azimuth from the sun's in
    /// radians) the radiance at 400, 487, 555 and 711 nm, as `sunsky` of the Python package mitsuba 3.9.1
    /// (`scalar_spectral`, `sun_scale` 0) has it.
    const DIRECTIONS: [[f64; 2]; 3] = [[0.9, 0.3], [0.35, 1.7], [0.03, -2.9]];
    #[rustfmt::skip]
    const MITSUBA: [([f64; 3], [[f32; 4]; 3]); 5] = [
        ([3.0, 0.1, 60.0], [[0.158899, 0.170415, 0.122557, 0.069911], [0.152871, 0.132798, 0.0749027, 0.0258735],
                            [0.171122, 0.227032, 0.160942, 0.0736865]]),
        ([1.7, 0.0, 30.0], [[0.0724387, 0.0598514, 0.0332489, 0.0107079], [0.104658, 0.103929, 0.0597363, 0.0192322],
                            [0.140851, 0.24752, 0.187147, 0.0817925]]),
        ([5.5, 0.6, 8.0], [[0.0296652, 0.0360039, 0.0242504, 0.0104204], [0.0441141, 0.0691937, 0.0517219, 0.0245522],
                           [0.0350439, 0.0864773, 0.0823341, 0.0589487]]),
        ([10.0, 1.0, 85.0], [[0.357412, 0.548919, 0.476198, 0.329691], [0.218682, 0.263126, 0.206524, 0.138773],
                             [0.222681, 0.332804, 0.296071, 0.250783]]),
        ([2.0, 0.2, 1.0], [[0.00704266, 0.0104324, 0.0081998, 0.00395565], [0.00988974, 0.0218782, 0.0204501, 0.0115161],
                           [0.00443155, 0.0209523, 0.036285, 0.0447618]]),
    ];

    /// Six digits are printed; single precision loses one or two where terms of 50 leave a few.
    #[test]
    fn radiance_is_that_of_another_implementation() {
        let wavelengths = Wavelengths { lambda: [400.0, 487.0, 555.0, 711.0], pdf: [1.0; 4] };
        let mut worst: f32 = 0.0;
        for ([turbidity, albedo, degrees], expected) in MITSUBA {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let sky = HosekWilkie::new(turbidity, albedo, degrees.to_radians());
            for ([z, azimuth], expected) in DIRECTIONS.into_iter().zip(expected) {
                let gamma = z * sin + (1.0 - z * z).sqrt() * cos * azimuth.cos();
                let found = sky.lanes(&View::new(z as f32, (1.0 - gamma) as f32), &wavelengths);
                let error = (found / Vec4::from_array(expected) - Vec4::ONE).abs().max_element();
                worst = worst.max(error);
            }
        }
        println!("greatest relative difference {worst:e}");
        assert!(worst < 2e-5, "{worst}");
    }

    /// At the ends of turbidity, albedo and elevation nothing is outside of the data, and the sky goes on evenly beyond them.
    #[test]
    fn every_sky_is_finite_and_not_negative() {
        let red = |sky: &HosekWilkie, view: &View| {
            let at = |lambda: [f32; 4]| sky.lanes(view, &Wavelengths { lambda, pdf: [1.0; 4] });
            [at([380.0, 400.0, 680.0, 719.999]), at([720.001, 740.0, 760.0, 780.0])]
        };
        for turbidity in [1.0, 1.5, 9.5, 10.0] {
            for albedo in [0.0, 0.3, 1.0] {
                for degrees in [0.0, 0.01, 5.0, 45.0, 90.0_f64] {
                    let sky = HosekWilkie::new(turbidity, albedo, degrees.to_radians());
                    for z in [0.0, 1e-6, 0.01, 0.3, 1.0] {
                        for gamma in [0.0, 1e-6, 0.1, 1.0, 2.0] {
                            let [visible, beyond] = red(&sky, &View::new(z, gamma));
                            assert!(
                                (visible + beyond).is_finite() && (visible + beyond).min_element() >= 0.0
                            );
                            // 0.002 nm of the slope from 680 nm on.
                            let step = (visible.w - beyond.x).abs();
                            assert!(step <= 1e-4 * visible.z + 1e-3 * visible.w, "{visible} {beyond}");
                            assert!(beyond.x >= beyond.y && beyond.y >= beyond.z && beyond.z >= beyond.w);
                        }
                    }
                }
            }
        }
    }
}
