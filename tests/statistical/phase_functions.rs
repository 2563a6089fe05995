//! Every phase function: its samples, its normalisation, its mean cosine, its symmetry.

use std::f64::consts::PI;

use floe::optics::phase::{
    CornetteShanks, Deflection, Draine, EXAMPLES, HenyeyGreenstein, PhaseFunction, Schlick,
    TwoTermHenyeyGreenstein,
};
use glam::Vec3;

use super::tests_of_fit::{SAMPLES, assert_fits, cell_of};
use crate::common::numbers::SplitMix;

/// Cells in log(1 - cos) up to 90 degrees and in log(1 + cos) beyond, which resolve any peak, and in azimuth.
const ROWS: usize = 24;
const COLUMNS: usize = 12;
/// The first row from either end holds all of 1 -+ cos below this.
const LEAST: f64 = 1e-11;

/// The two ends of the sphere that angles are counted from.
pub const ENDS: [fn(f32) -> Deflection; 2] = [Deflection::from_one_minus_cos, Deflection::from_one_plus_cos];

/// Upper edge of a row in 1 - cos or 1 + cos; 90 degrees is the last.
fn edge(row: usize) -> f64 {
    LEAST.powf(1.0 - row as f64 / (ROWS - 1) as f64)
}

/// Integral over the rings between two distances from one end of `function`, by the midpoint rule in the logarithm.
fn ring(end: usize, from: f64, to: f64, steps: u32, function: impl Fn(Deflection) -> f64) -> f64 {
    let (low, high) = (from.max(1e-18).ln(), to.ln());
    let width = (high - low) / f64::from(steps);
    (0..steps)
        .map(|i| {
            // The width of the step is taken around the f32 where the function is.
            let t = (low + (f64::from(i) + 0.5) * width).exp() as f32;
            let dt = 2.0 * f64::from(t) * (0.5 * width).sinh();
            2.0 * PI * function(ENDS[end](t)) * dt
        })
        .sum()
}

/// Integral over the sphere.
pub fn integral(function: impl Fn(Deflection) -> f64) -> f64 {
    (0..2).map(|end| ring(end, 0.0, 1.0, 120_000, &function)).sum()
}

/// The cosine in f64.
pub fn cosine(d: Deflection) -> f64 {
    0.5 * (f64::from(d.one_plus_cos()) - f64::from(d.one_minus_cos()))
}

/// Deflection by an angle in radians.
fn deflection(angle: f64) -> Deflection {
    if angle < 0.5 * PI {
        Deflection::from_one_minus_cos((2.0 * (0.5 * angle).sin().powi(2)) as f32)
    } else {
        Deflection::from_one_plus_cos((2.0 * (0.5 * (PI - angle)).sin().powi(2)) as f32)
    }
}

fn angle_of(d: Deflection) -> f64 {
    let [ahead, back] =
        [d.one_minus_cos(), d.one_plus_cos()].map(|t| 2.0 * (0.5 * f64::from(t)).sqrt().min(1.0).asin());
    if ahead < back { ahead } else { PI - back }
}

#[test]
fn phase_functions_are_normalised_and_have_their_mean_cosine() {
    let hg = |g| HenyeyGreenstein { g };
    let two = TwoTermHenyeyGreenstein { share: 0.5, first: hg(0.9999), second: hg(-0.9999) };
    let strong = [0.999_999_f32, 0.3, -0.95, -0.999_999]
        .map(|g| (format!("henyey-greenstein {g}"), PhaseFunction::HenyeyGreenstein(hg(g))))
        .into_iter()
        .chain([
            ("two-term-henyey-greenstein +-0.9999".to_owned(), PhaseFunction::TwoTermHenyeyGreenstein(two)),
            ("schlick 0.9999".to_owned(), PhaseFunction::Schlick(Schlick { k: 0.9999 })),
        ])
        .chain([0.9999, -0.9999].into_iter().flat_map(|g| {
            let shanks = CornetteShanks::new(g).map(PhaseFunction::CornetteShanks);
            let draine = Draine::new(g, 3.0).map(PhaseFunction::Draine);
            [(format!("cornette-shanks {g}"), shanks), (format!("draine {g} 3"), draine)]
                .map(|(name, phase)| (name, phase.unwrap()))
        }));
    let listed = EXAMPLES.iter().map(|(name, phase)| ((*name).to_owned(), phase.clone()));
    for (name, phase) in listed.chain(strong) {
        let whole = integral(|d| f64::from(phase.value(d)));
        let mean = integral(|d| f64::from(phase.value(d)) * cosine(d));
        let g = f64::from(phase.mean_cosine());
        println!("{name}: integral {whole:.7}, mean cosine {mean:.7} for {g:.7}");
        // A kink like a root, at the critical angle of bubbles, costs the quadrature 3.6e-6; elsewhere f32 costs 1e-6.
        assert!((whole - 1.0).abs() < 5e-6, "{name} integrates to {whole}");
        assert!((mean - g).abs() < 5e-6, "{name} has the mean cosine {mean} and states {g}");
        for end in ENDS {
            for step in 0..=2000 {
                let t = if step == 0 { 0.0 } else { 10_f32.powf(-14.0 * (1.0 - step as f32 / 2000.0)) };
                let (value, pdf_w) = (phase.value(end(t)), phase.pdf_w(end(t)));
                assert!(value.is_finite() && value >= 0.0, "{name} is {value} at 1 -+ cos = {t:e}");
                assert!(pdf_w.is_finite() && (pdf_w > 0.0 || value == 0.0), "{name} never samples {t:e}");
            }
        }
    }
}

/// (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^(3/2)) in f64, at either end.
#[test]
fn henyey_greenstein_keeps_its_peak_in_single_precision() {
    for g in [0.9999_f32, 0.99, 0.5, -0.5, -0.9, -0.9999] {
        let phase = PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g });
        for exponent in -12..=0 {
            let t = 10_f32.powi(exponent);
            let end = ENDS[usize::from(g < 0.0)];
            let (g, t64) = (f64::from(g.abs()), f64::from(t));
            let squared = (1.0 - g) * (1.0 - g) + 2.0 * g * t64;
            let exact = (1.0 - g) * (1.0 + g) / (4.0 * PI * squared.powf(1.5));
            let relative = f64::from(phase.value(end(t))) / exact - 1.0;
            // A few roundings to the power 3/2.
            assert!(relative.abs() < 1e-6, "g = {g}, 1 -+ cos = {t:e}: off by {relative:e}");
        }
    }
}

/// Panics unless directions drawn around `forward` follow a density.
pub fn assert_follows(
    name: &str,
    seed: u64,
    density: impl Fn(Deflection) -> f64,
    sample: impl Fn(Vec3, [f32; 2]) -> Vec3,
) {
    let forward = Vec3::new(0.3, -0.8, 0.52).normalize();
    let basis = floe::geometry::Frame::around(forward);
    let share = |end: usize, row: usize| {
        let from = if row == 0 { 0.0 } else { edge(row - 1) };
        ring(end, from, edge(row), 4000, &density)
    };
    let rows: Vec<f64> = (0..2 * ROWS).map(|r| share(r / ROWS, r % ROWS)).collect();
    let total: f64 = rows.iter().sum();
    assert!((total - 1.0).abs() < 1e-5, "{name}: the density integrates to {total}");
    let cells: Vec<f64> =
        rows.iter().flat_map(|p| std::iter::repeat_n(p / total / COLUMNS as f64, COLUMNS)).collect();
    assert_fits(name, seed, &cells, |u| {
        let wi = sample(forward, u);
        let d = basis.to_local(wi);
        let turned = Deflection::between(forward, wi);
        let (end, t) = if turned.one_minus_cos() <= turned.one_plus_cos() {
            (0, f64::from(turned.one_minus_cos()))
        } else {
            (1, f64::from(turned.one_plus_cos()))
        };
        let row = if t < LEAST { 0 } else { 1 + cell_of(1.0 - t.ln() / LEAST.ln(), ROWS - 1) };
        let turn = (f64::from(d.y).atan2(f64::from(d.x)) / (2.0 * PI)).rem_euclid(1.0);
        (end * ROWS + row) * COLUMNS + cell_of(turn, COLUMNS)
    });
}

/// Samples follow the density; their weights make the value of it.
#[test]
fn samples_follow_the_phase_function() {
    for (seed, (name, phase)) in (100..).zip(EXAMPLES.iter()) {
        let density = |d| f64::from(phase.pdf_w(d));
        assert_follows(name, seed, density, |forward, u| phase.sample(forward, u).wi);
    }
}

/// Signed: the weighted mean of wi . forward is g and not -g, and the mean weight is 1, within five standard errors.
#[test]
fn the_mean_cosine_of_samples_has_the_sign_of_g() {
    let forward = Vec3::new(-0.1, 0.7, -0.7).normalize();
    for (name, phase) in EXAMPLES.iter() {
        let mut random = SplitMix(11);
        let mut cosines = Mean::default();
        let mut weights = Mean::default();
        let mut extremes = [f32::INFINITY, 0.0_f32];
        for _ in 0..SAMPLES {
            let sample = phase.sample(forward, random.pair());
            cosines.add(f64::from(sample.wi.dot(forward) * sample.weight));
            weights.add(f64::from(sample.weight));
            extremes = [extremes[0].min(sample.weight), extremes[1].max(sample.weight)];
        }
        let g = f64::from(phase.mean_cosine());
        println!("{name}: mean cosine of samples {cosines}, weights {weights} in {extremes:?}");
        assert!((cosines.mean() - g).abs() < 5.0 * cosines.error() + 3e-7, "{name}: {cosines} for {g}");
        assert!((weights.mean() - 1.0).abs() < 5.0 * weights.error() + 3e-7, "{name}: weights {weights}");
        if g.abs() > 0.01 {
            assert_eq!(cosines.mean() > 0.0, g > 0.0, "{name} scatters the other way");
        }
    }
}

/// Running mean with its standard error.
#[derive(Default)]
pub struct Mean {
    sum: f64,
    squares: f64,
    count: f64,
}

impl Mean {
    pub fn add(&mut self, x: f64) {
        self.sum += x;
        self.squares += x * x;
        self.count += 1.0;
    }

    pub fn mean(&self) -> f64 {
        self.sum / self.count
    }

    pub fn error(&self) -> f64 {
        ((self.squares / self.count - self.mean() * self.mean()).max(0.0) / self.count).sqrt()
    }
}

impl std::fmt::Display for Mean {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.6} +- {:.6}", self.mean(), self.error())
    }
}

/// What `sample` says of a direction is what `pdf_w` and `value` say of it, and swapping the directions changes nothing.
#[test]
fn samples_state_their_density_and_scattering_is_reciprocal() {
    for (name, phase) in EXAMPLES.iter() {
        let mut random = SplitMix(12);
        for _ in 0..2000 {
            let forward = floe::sampling::warp::sphere(random.pair());
            let sample = phase.sample(forward, random.pair());
            assert!((sample.wi.length() - 1.0).abs() < 3e-7 && sample.weight.is_finite(), "{name}");
            let turned = Deflection::between(forward, sample.wi);
            assert_eq!(turned, Deflection::between(sample.wi, forward));
            assert_eq!(phase.value(turned), phase.value(Deflection::between(-sample.wi, -forward)));
            // Both directions are off by 1e-7 rad, which matters beside narrow peaks.
            let near = |f: &dyn Fn(Deflection) -> f32| {
                let angle = angle_of(turned);
                let values = (-8..=8).map(|i| {
                    let moved = (angle + 5e-8 * f64::from(i)).clamp(0.0, PI);
                    f64::from(f(deflection(moved)))
                });
                values.fold([f64::INFINITY, 0.0_f64], |[a, b], v| [a.min(v), b.max(v)])
            };
            for (what, stated, [least, greatest]) in [
                ("density", sample.pdf_w, near(&|d| phase.pdf_w(d))),
                ("value", sample.weight * sample.pdf_w, near(&|d| phase.value(d))),
            ] {
                let stated = f64::from(stated);
                // Interpolation and elementary functions in f32.
                let slack = 2e-5 * greatest + 1e-9;
                assert!(
                    stated > least - slack && stated < greatest + slack,
                    "{name}: the sample states the {what} {stated} and not {least} to {greatest}"
                );
            }
        }
    }
}
