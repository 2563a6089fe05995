//! Every phase function over wavelength: its samples, and in each lane its normalisation, mean cosine and weights.

use floe::optics::phase::{Deflection, MediumPhase, PhaseLanes, SPECTRAL_EXAMPLES};
use floe::spectrum::{Lanes, Wavelengths};
use glam::Vec3;

use super::phase_functions::{ENDS, Mean, assert_follows, cosine, integral};
use super::tests_of_fit::SAMPLES;
use crate::common::numbers::SplitMix;

/// Below, between and beyond the wavelengths of the examples, and on one of them.
const WAVELENGTHS: Wavelengths = Wavelengths { lambda: [410.0, 550.0, 612.5, 700.0], pdf: [1.0; 4] };
/// Lanes that carry light in all, some and one of them.
const THROUGHPUTS: [Lanes; 3] =
    [Lanes::new(1.0, 0.3, 2.0, 0.7), Lanes::new(0.5, 0.0, 1.0, 0.0), Lanes::new(0.0, 0.0, 0.0, 1e-30)];

fn examples() -> impl Iterator<Item = (String, MediumPhase, Lanes)> {
    SPECTRAL_EXAMPLES.iter().flat_map(|(name, phase)| {
        THROUGHPUTS.map(|t| (format!("{name}, throughput {t}"), phase.clone().into(), t))
    })
}

#[test]
fn each_lane_is_normalised_and_has_its_mean_cosine() {
    for (name, phase) in SPECTRAL_EXAMPLES.iter() {
        let (lanes, stated) = (phase.at(&WAVELENGTHS), phase.mean_cosine().lanes(&WAVELENGTHS));
        for lane in 0..4 {
            let value = |d| f64::from(lanes.value(d)[lane]);
            let whole = integral(value);
            let mean = integral(|d| value(d) * cosine(d));
            let g = f64::from(stated[lane]);
            // As of phase functions that are one.
            assert!((whole - 1.0).abs() < 5e-6, "{name}, lane {lane} integrates to {whole}");
            assert!((mean - g).abs() < 5e-6, "{name}, lane {lane} has the mean cosine {mean} and states {g}");
        }
        let ts = (0..=500).map(|i| if i == 0 { 0.0 } else { 10_f32.powf(-14.0 * (1.0 - i as f32 / 500.0)) });
        for (t, end) in ts.flat_map(|t| ENDS.map(|end| (t, end))) {
            let value = lanes.value(end(t));
            assert!(value.is_finite() && value.min_element() >= 0.0, "{name} is {value} at {t:e}");
        }
    }
}

#[test]
fn samples_follow_the_lanes_that_carry_light() {
    for (seed, (name, phase, throughput)) in (300..).zip(examples()) {
        let lanes = phase.at(&WAVELENGTHS);
        let density = |d| f64::from(lanes.value_and_pdf_w(d, throughput).1);
        assert_follows(&name, seed, density, |forward, u| lanes.sample(forward, u, throughput).wi);
    }
}

/// Signed: in each lane that carries light the weighted mean of wi . forward is its g, and the mean weight is 1, within five
/// standard errors. What all lanes carry together stays what it was, but for the rounding of four products.
#[test]
fn weights_make_the_mean_cosine_of_each_lane_and_keep_the_sum() {
    let forward = Vec3::new(-0.1, 0.7, -0.7).normalize();
    for (name, phase, throughput) in examples() {
        let (lanes, g) = (phase.at(&WAVELENGTHS), phase.mean_cosine().lanes(&WAVELENGTHS));
        let mut random = SplitMix(21);
        let (mut cosines, mut weights) = (<[Mean; 4]>::default(), <[Mean; 4]>::default());
        for _ in 0..SAMPLES / 4 {
            let sample = lanes.sample(forward, random.pair(), throughput);
            let sum = (throughput * sample.weight).element_sum() / throughput.element_sum();
            assert!((sum - 1.0).abs() < 1e-6, "{name}: the sum of all lanes becomes {sum} of itself");
            for lane in 0..4 {
                cosines[lane].add(f64::from(sample.wi.dot(forward) * sample.weight[lane]));
                weights[lane].add(f64::from(sample.weight[lane]));
            }
        }
        for lane in 0..4 {
            let (cosine, weight) = (&cosines[lane], &weights[lane]);
            let (g, lit) = if throughput[lane] > 0.0 { (f64::from(g[lane]), 1.0) } else { (0.0, 0.0) };
            println!("{name}, lane {lane}: mean cosine {cosine}, for {g:.6}, weights {weight}");
            assert!((cosine.mean() - g).abs() < 5.0 * cosine.error() + 3e-7, "{name}: {cosine} for {g}");
            assert!((weight.mean() - lit).abs() < 5.0 * weight.error() + 3e-7, "{name}: weights {weight}");
        }
    }
}

/// What `sample` says of a direction is what `value_and_pdf_w` says of it, where the rounding of directions (1e-7 rad)
/// does not change that by more than a hundredth; swapping the directions changes nothing.
#[test]
fn samples_state_their_density_and_scattering_is_reciprocal() {
    for (name, phase, throughput) in examples() {
        let lanes = phase.at(&WAVELENGTHS);
        let mut random = SplitMix(22);
        let mut smooth = 0;
        for _ in 0..2000 {
            let forward = floe::sampling::warp::sphere(random.pair());
            let sample = lanes.sample(forward, random.pair(), throughput);
            assert!((sample.wi.length() - 1.0).abs() < 3e-7 && sample.weight.is_finite(), "{name}");
            let turned = Deflection::between(forward, sample.wi);
            assert_eq!(turned, Deflection::between(sample.wi, forward));
            let (value, pdf_w) = lanes.value_and_pdf_w(turned, throughput);
            assert_eq!(value, lanes.value(turned));
            if !changes_slowly(&lanes, turned) {
                continue;
            }
            smooth += 1;
            let lit = Lanes::select(throughput.cmpgt(Lanes::ZERO), value, Lanes::ZERO);
            let stated = [sample.weight * sample.pdf_w, Lanes::splat(sample.pdf_w)];
            for (stated, found) in stated.into_iter().zip([lit, Lanes::splat(pdf_w)]) {
                let slack = 0.02 * found + Lanes::splat(1e-6);
                assert!((stated - found).abs().cmple(slack).all(), "{name}: {stated}, not {found}");
            }
            assert!((sample.greatest - value.max_element()).abs() <= 0.02 * sample.greatest, "{name}");
        }
        assert!(smooth > 200, "{name}: {smooth} directions were compared");
    }
}

/// True where moving by 3e-7 rad changes no lane by more than a hundredth.
fn changes_slowly(lanes: &PhaseLanes<'_>, turned: Deflection) -> bool {
    let (ahead, back) = (turned.one_minus_cos(), turned.one_plus_cos());
    let t = ahead.min(back);
    let near = [-1.0, 1.0].map(|side| {
        let root = (f64::from(t).sqrt() + side * 2.2e-7).max(0.0);
        let moved = (root * root) as f32;
        lanes.value(if ahead <= back { ENDS[0](moved) } else { ENDS[1](moved) })
    });
    let change = (near[0] - near[1]).abs();
    change.cmple(0.01 * lanes.value(turned) + Lanes::splat(1e-7)).all()
}
