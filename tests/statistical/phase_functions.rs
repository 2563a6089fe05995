//! Every phase function: its samples, its normalisation, its mean cosine, its symmetry.

use std::f64::consts::PI;

use floe::optics::phase::{EXAMPLES, HenyeyGreenstein, PhaseFunction, one_minus_cos};
use glam::Vec3;

use super::tests_of_fit::{SAMPLES, assert_fits, cell_of};
use crate::common::numbers::SplitMix;

/// Cells in log(1 - cos), which resolve any forward peak, and in azimuth.
const ROWS: usize = 40;
const COLUMNS: usize = 12;
/// The first row holds all of 1 - cos below this.
const LEAST: f64 = 1e-12;

/// Lower edge of a row in 1 - cos; that after the last is 2.
fn edge(row: usize) -> f64 {
    if row == 0 { 0.0 } else { LEAST * (2.0 / LEAST).powf(row as f64 / ROWS as f64) }
}

/// Integral over the sphere of the value times `weight`(cos) between two angles: the midpoint rule in log(1 - cos) from
/// the forward side and, beyond 90 degrees, in log(1 + cos) from the backward side.
fn integral(phase: &PhaseFunction, from: f64, to: f64, weight: impl Fn(f64) -> f64) -> f64 {
    let steps = 8000;
    let part = |from: f64, to: f64, angle: &dyn Fn(f64) -> f64| -> f64 {
        if to <= from {
            return 0.0;
        }
        let (low, high) = (from.max(1e-16).ln(), to.ln());
        let width = (high - low) / f64::from(steps);
        (0..steps)
            .map(|i| {
                let t = (low + (f64::from(i) + 0.5) * width).exp();
                // The width of the step in t itself; the rest is even in it.
                let dt = 2.0 * t * (0.5 * width).sinh();
                2.0 * PI * f64::from(phase.value(angle(t) as f32)) * weight(1.0 - angle(t)) * dt
            })
            .sum()
    };
    part(from.min(1.0), to.min(1.0), &|t| t) + part(2.0 - to.max(1.0), 2.0 - from.max(1.0), &|t| 2.0 - t)
}

#[test]
fn phase_functions_are_normalised_and_have_their_mean_cosine() {
    let strong = [0.999_999_f32, 0.3, -0.95]
        .map(|g| (format!("henyey-greenstein {g}"), PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g })));
    let listed = EXAMPLES.iter().map(|(name, phase)| ((*name).to_owned(), *phase));
    for (name, phase) in listed.chain(strong) {
        let whole = integral(&phase, 0.0, 2.0, |_| 1.0);
        let mean = integral(&phase, 0.0, 2.0, |cos| cos);
        println!("{name}: integral {whole:.7}, mean cosine {mean:.7}");
        // The value's f32 and, for narrow lobes, that of 1 - g; at backward peaks 1 - cos itself is off by 1.2e-7.
        let narrow = 1.0 - f64::from(phase.mean_cosine()).abs();
        let forwards = phase.mean_cosine() >= 0.0;
        let tolerance = 2e-6 + if forwards { 6e-8 / narrow } else { 4e-7 / (narrow * narrow) };
        assert!((whole - 1.0).abs() < tolerance, "{name} integrates to {whole}");
        assert!(
            (mean - f64::from(phase.mean_cosine())).abs() < tolerance,
            "{name} has the mean cosine {mean}"
        );
        for step in 0..=2000 {
            let angle = if step == 0 { 0.0 } else { 2.0 * 10_f32.powf(-12.0 * (1.0 - step as f32 / 2000.0)) };
            let value = phase.value(angle.min(2.0));
            assert!(value.is_finite() && value >= 0.0, "{name} is {value} at 1 - cos = {angle:e}");
        }
    }
}

/// (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^(3/2)) in f64.
#[test]
fn henyey_greenstein_keeps_its_peak_in_single_precision() {
    for g in [0.9999_f32, 0.99, 0.5, -0.5, -0.9] {
        let phase = PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g });
        for exponent in -12..=0 {
            let t = 2.0 * 10_f32.powi(exponent);
            let (g, t64) = (f64::from(g), f64::from(t));
            let squared = (1.0 - g) * (1.0 - g) + 2.0 * g * t64;
            let exact = (1.0 - g) * (1.0 + g) / (4.0 * PI * squared.powf(1.5));
            let relative = f64::from(phase.value(t)) / exact - 1.0;
            // 2 g (1 - cos) beside (1 - g)^2 in f32, to the power 3/2; for g < 0 they cancel.
            let tolerance = if g < 0.0 { 3e-5 } else { 2e-6 };
            assert!(relative.abs() < tolerance, "g = {g}, 1 - cos = {t:e}: off by {relative:e}");
        }
    }
}

#[test]
fn samples_follow_the_phase_function() {
    let forward = Vec3::new(0.3, -0.8, 0.52).normalize();
    let basis = floe::geometry::Frame::around(forward);
    for (seed, (name, phase)) in (100..).zip(EXAMPLES) {
        // Around z, where 1 - cos comes from the sine without loss.
        let rows: Vec<f64> = (0..ROWS).map(|r| integral(phase, edge(r), edge(r + 1), |_| 1.0)).collect();
        let total: f64 = rows.iter().sum();
        let cells: Vec<f64> =
            rows.iter().flat_map(|p| std::iter::repeat_n(p / total / COLUMNS as f64, COLUMNS)).collect();
        assert_fits(name, seed, &cells, |u| {
            let sample = phase.sample(forward, u);
            let d = basis.to_local(sample.wi);
            let angle = f64::from(one_minus_cos(forward, sample.wi));
            let row =
                if angle < LEAST { 0 } else { cell_of((angle / LEAST).ln() / (2.0 / LEAST).ln(), ROWS) };
            let turn = (f64::from(d.y).atan2(f64::from(d.x)) / (2.0 * PI)).rem_euclid(1.0);
            row * COLUMNS + cell_of(turn, COLUMNS)
        });
    }
}

/// Signed: the mean of wi . forward is g and not -g, within five standard errors.
#[test]
fn the_mean_cosine_of_samples_has_the_sign_of_g() {
    let forward = Vec3::new(-0.1, 0.7, -0.7).normalize();
    for (name, phase) in EXAMPLES {
        let mut random = SplitMix(11);
        let (mut sum, mut squares) = (0.0, 0.0);
        for _ in 0..SAMPLES {
            let cos = f64::from(phase.sample(forward, random.pair()).wi.dot(forward));
            sum += cos;
            squares += cos * cos;
        }
        let n = SAMPLES as f64;
        let mean = sum / n;
        let se = ((squares / n - mean * mean).max(0.0) / n).sqrt();
        let g = f64::from(phase.mean_cosine());
        println!("{name}: mean cosine of samples {mean:.6} +- {se:.6}");
        assert!((mean - g).abs() < 5.0 * se + 3e-7, "{name}: mean cosine {mean} +- {se}");
    }
}

/// What `sample` says of a direction is what `pdf_w` and `value` say of it, and swapping the directions changes nothing.
#[test]
fn samples_state_their_density_and_scattering_is_reciprocal() {
    for (name, phase) in EXAMPLES {
        let mut random = SplitMix(12);
        for _ in 0..2000 {
            let forward = floe::sampling::warp::sphere(random.pair());
            let sample = phase.sample(forward, random.pair());
            let angle = one_minus_cos(forward, sample.wi);
            assert_eq!(angle, one_minus_cos(sample.wi, forward));
            assert_eq!(phase.value(angle), phase.value(one_minus_cos(-sample.wi, -forward)));
            // d ln p = 3 g d(1 - cos) / (1 + g^2 - 2 g cos). Unit vectors are off by 1e-7, which changes 1 - cos by
            // 1e-7 (1 - g) at the edge of a forward peak and by 5e-7 at a backward one.
            let narrow = 1.0 - f64::from(phase.mean_cosine()).abs();
            let forwards = phase.mean_cosine() >= 0.0;
            let tolerance = 1e-5 + if forwards { 3e-7 / narrow } else { 1.5e-6 / (narrow * narrow) };
            let pdf_w = f64::from(phase.pdf_w(angle));
            let relative = f64::from(sample.pdf_w) / pdf_w - 1.0;
            assert!(relative.abs() < tolerance, "{name}: sample states {} for {pdf_w}", sample.pdf_w);
            let weight = f64::from(phase.value(angle)) / pdf_w;
            assert!((f64::from(sample.weight) - weight).abs() < 1e-6, "{name}: weight {}", sample.weight);
        }
    }
}
