//! Phase functions over angle, for reports.

use std::f64::consts::PI;

use crate::optics::particles::EnsemblePhase;
use crate::optics::phase::{Deflection, MediumPhase};
use crate::spectrum::Wavelengths;

/// Angles for a phase function that is given as a formula, to either side of pi / 2: even in their logarithm.
const STEPS: u32 = 480;
/// The least of them but 0, in radians.
const LEAST: f64 = 1e-4;

/// A phase function that a medium is given with: at one wavelength where it is the same at all.
pub(super) fn tabulated(phase: &MediumPhase) -> EnsemblePhase {
    let wavelengths: Vec<f64> = match phase {
        MediumPhase::One(_) => vec![550.0],
        MediumPhase::Spectral(_) => (380..=780).step_by(20).map(f64::from).collect(),
    };
    let paths: Vec<_> = wavelengths.iter().map(|lambda| Wavelengths::single(*lambda as f32)).collect();
    sampled(wavelengths, |i, deflection| f64::from(phase.at(&paths[i]).value(deflection).x))
}

/// One lobe of Henyey and Greenstein's of its mean cosine g at each wavelength.
pub(super) fn one_lobe(wavelengths: &[f64], g: &[f64]) -> EnsemblePhase {
    sampled(wavelengths.to_vec(), |i, deflection| {
        let (g, turned) = (g[i], f64::from(deflection.one_minus_cos()));
        let squared = (1.0 - g) * (1.0 - g) + 2.0 * g * turned;
        (1.0 - g) * (1.0 + g) / (4.0 * PI * squared * squared.sqrt())
    })
}

fn sampled(wavelengths: Vec<f64>, value: impl Fn(usize, Deflection) -> f64) -> EnsemblePhase {
    let ratio = libm::log(0.5 * PI / LEAST) / f64::from(STEPS);
    let from_end = |i: u32| if i == 0 { 0.0 } else { LEAST * libm::exp(ratio * f64::from(i)) };
    let half_square = |angle: f64| {
        let sin = libm::sin(0.5 * angle);
        (2.0 * sin * sin) as f32
    };
    let ahead = (0..=STEPS).map(from_end);
    let angles: Vec<f64> = ahead.clone().chain((0..STEPS).rev().map(|i| PI - from_end(i))).collect();
    let deflections = ahead.clone().map(|angle| Deflection::from_one_minus_cos(half_square(angle)));
    let back = (0..STEPS).rev().map(|i| Deflection::from_one_plus_cos(half_square(from_end(i))));
    let deflections: Vec<Deflection> = deflections.chain(back).collect();
    let values = (0..wavelengths.len()).map(|i| deflections.iter().map(|d| value(i, *d)).collect());
    EnsemblePhase { values: values.collect(), wavelengths, angles }
}

/// Values at a wavelength in nm: linear between two, and those of the ends beyond.
pub(super) fn at(phase: &EnsemblePhase, lambda: f64) -> Vec<f64> {
    let last = phase.wavelengths.len() - 1;
    let above = phase.wavelengths.partition_point(|w| *w < lambda).min(last);
    let below = above.saturating_sub(1);
    let [start, end] = [below, above].map(|i| phase.wavelengths[i]);
    let t = if end > start { ((lambda - start) / (end - start)).clamp(0.0, 1.0) } else { 1.0 };
    let pairs = phase.values[below].iter().zip(&phase.values[above]);
    pairs.map(|(from, to)| from + (to - from) * t).collect()
}

/// Wavelengths in nm, angles in degrees, and a list of values in 1/sr for each wavelength.
pub(super) fn json(phase: &EnsemblePhase) -> serde_json::Value {
    let degrees: Vec<f64> = phase.angles.iter().map(|angle| angle.to_degrees()).collect();
    serde_json::json!({ "wavelengths": phase.wavelengths, "angles": degrees, "values": phase.values })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::apparent::backscattered_share;
    use crate::optics::phase::{HenyeyGreenstein, Isotropic, PhaseFunction, SpectralPhase};
    use crate::spectrum::Spectrum;

    fn integral(phase: &EnsemblePhase, i: usize) -> f64 {
        // Linear in the cosine.
        let pairs = phase.angles.windows(2).zip(phase.values[i].windows(2));
        pairs.map(|(a, v)| PI * (v[0] + v[1]) * (a[0].cos() - a[1].cos())).sum()
    }

    #[test]
    fn formulas_are_tabulated_finely_enough() {
        let even = tabulated(&PhaseFunction::Isotropic(Isotropic).into());
        assert_eq!((even.angles[0], even.angles.len()), (0.0, 961));
        assert!((even.angles[960] - PI).abs() < 1e-15 && even.angles.windows(2).all(|a| a[0] < a[1]));
        assert!((integral(&even, 0) - 1.0).abs() < 1e-6, "f32 values");
        let given = tabulated(&PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g: 0.95 }).into());
        let lobes = one_lobe(&[400.0, 600.0], &[0.95, 0.5]);
        // Trapezia over steps of 2 %: a quarter of a thousandth. The lobe of f32 is that of f64 to its rounding.
        for (phase, i) in [(&given, 0), (&lobes, 0), (&lobes, 1)] {
            assert!((integral(phase, i) - 1.0).abs() < 5e-4, "{}", integral(phase, i));
        }
        let over_wavelength = Spectrum::Table { wavelengths: vec![400.0, 600.0], values: vec![0.95, 0.5] };
        let spectral = tabulated(&SpectralPhase::henyey_greenstein(over_wavelength).unwrap().into());
        assert!((at(&spectral, 400.0)[0] / at(&lobes, 400.0)[0] - 1.0).abs() < 1e-4);
        assert!(at(&spectral, 700.0).iter().zip(&lobes.values[1]).all(|(a, b)| (a / b - 1.0).abs() < 1e-4));
        let pairs = given.values[0].iter().zip(&lobes.values[0]);
        assert!(pairs.clone().all(|(a, b)| (a / b - 1.0).abs() < 1e-4));
        assert!((backscattered_share(&even.angles, &even.values[0]) - 0.5).abs() < 1e-6);
    }

    #[test]
    fn wavelengths_in_between_are_blended() {
        let phase = EnsemblePhase {
            wavelengths: vec![400.0, 500.0, 600.0],
            angles: vec![0.0, PI],
            values: vec![vec![1.0, 2.0], vec![3.0, 6.0], vec![5.0, 0.0]],
        };
        for (lambda, values) in [
            (380.0, [1.0, 2.0]),
            (400.0, [1.0, 2.0]),
            (450.0, [2.0, 4.0]),
            (500.0, [3.0, 6.0]),
            (575.0, [4.5, 1.5]),
            (700.0, [5.0, 0.0]),
        ] {
            assert_eq!(at(&phase, lambda), values, "{lambda}");
        }
        let one = tabulated(&PhaseFunction::Isotropic(Isotropic).into());
        assert_eq!(at(&one, 400.0), one.values[0]);
    }
}
