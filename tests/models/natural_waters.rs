//! The published seas beside their reference and Jerlov's types.

use floe::optics::water::natural::{NaturalWater, PRESETS};
use floe::optics::water::{absorption_at, dissolved_matter};

use crate::{REFERENCE, bulk, deviation, number, rows};

const SEAS: &str = include_str!("../data/models/natural_waters.csv");

fn preset(name: &str) -> NaturalWater {
    // The other of the two published values of algae.
    if name == "mediterranean-rich" {
        return NaturalWater { algae: 3.878e-7, ..preset("mediterranean") };
    }
    PRESETS.iter().find(|(other, _)| *other == name).unwrap().1
}

/// 4 pi k / lambda.
fn implied(k: f64, lambda: f64) -> f64 {
    4.0 * std::f64::consts::PI * k / (lambda * 1e-9)
}

#[test]
fn seas_are_those_of_the_reference() {
    let mut worst = [0.0_f64; 4];
    for [name, lambda, _, sigma_t, sigma_s, g] in rows::<6>(SEAS) {
        let found = bulk(&preset(name).mixture(), &[number(lambda)]);
        let found = [found.sigma_a[0] + found.sigma_s[0], found.sigma_a[0], found.sigma_s[0], found.g[0]];
        let [sigma_t, sigma_s, g] = [sigma_t, sigma_s, g].map(number);
        for ((worst, found), expected) in
            worst.iter_mut().zip(found).zip([sigma_t, sigma_t - sigma_s, sigma_s, g])
        {
            *worst = worst.max(deviation(found, expected));
        }
    }
    println!("sigma_t, sigma_a, sigma_s, g: {worst:?}");
    assert!(worst.iter().all(|worst| *worst < REFERENCE), "{worst:?}");
}

/// Within half of the last of the three digits that k of the published table has; measured: 0.2 % at most.
#[test]
fn sea_water_absorbs_what_the_published_host_does() {
    for [_, lambda, k_host, ..] in rows::<6>(SEAS) {
        let lambda = number(lambda);
        let ratio = absorption_at(lambda, 20.0, 35.0) / implied(number(k_host), lambda);
        let mantissa = number(k_host.split('e').next().unwrap());
        println!("{lambda} nm: {ratio:.4}");
        assert!((ratio - 1.0).abs() < 5e-3 / mantissa, "{lambda} nm: {ratio}");
    }
}

/// Dissolved matter of 2 1/m at 440 nm turns the Baltic from blue-green to brown: it then absorbs three times as much
/// at 450 nm as at 550 nm, and less without.
#[test]
fn dissolved_matter_browns_the_baltic() {
    let through = |dissolved: f64| {
        let water = NaturalWater { dissolved, ..preset("baltic") };
        bulk(&water.mixture(), &[450.0, 550.0]).sigma_a
    };
    let [clear, brown] = [0.0, 2.0].map(through);
    for (i, lambda) in [450.0, 550.0].into_iter().enumerate() {
        let added = brown[i] - clear[i];
        assert!(deviation(added, dissolved_matter(lambda, 2.0)) < 1e-5, "{lambda} nm: {added}");
    }
    assert!(clear[0] < clear[1] && brown[0] > 3.0 * brown[1], "{clear:?} {brown:?}");
}

/// Scattering by molecules adds exactly its own.
#[test]
fn molecules_add_what_they_scatter() {
    let [without, with] = [false, true].map(|molecular_scattering| {
        let water = NaturalWater { molecular_scattering, ..preset("atlantic") };
        bulk(&water.mixture(), &[400.0]).sigma_s[0]
    });
    let added = floe::optics::water::molecular_scattering(400.0, 35.0);
    assert!(deviation(with - without, added) < 1e-5, "{}", with - without);
}

const LAMBDA: [f64; 7] = [400.0, 450.0, 500.0, 550.0, 600.0, 650.0, 700.0];

/// Attenuation of sunlight in the sea in 1/m at [`LAMBDA`], by type, as Austin and Petzold, and Jerlov, have it.
#[rustfmt::skip]
const JERLOV: [(&str, [f64; 7]); 10] = [
    ("I",   [0.0217, 0.0176, 0.0280, 0.0640, 0.2408, 0.3559, 0.6513]),
    ("IA",  [0.0316, 0.0257, 0.0332, 0.0674, 0.2437, 0.3601, 0.6530]),
    ("IB",  [0.0438, 0.0355, 0.0396, 0.0715, 0.2471, 0.3652, 0.6550]),
    ("II",  [0.0878, 0.0714, 0.0627, 0.0863, 0.2595, 0.3837, 0.6623]),
    ("III", [0.1697, 0.1381, 0.1056, 0.1139, 0.2826, 0.4181, 0.6760]),
    ("1C",  [0.2516, 0.2048, 0.1486, 0.1415, 0.3057, 0.4525, 0.6896]),
    ("3C",  [0.78, 0.39, 0.22, 0.19, 0.33, 0.46, 0.71]),
    ("5C",  [1.1, 0.56, 0.36, 0.30, 0.40, 0.54, 0.80]),
    ("7C",  [1.6, 0.89, 0.58, 0.46, 0.48, 0.63, 0.92]),
    ("9C",  [2.4, 1.6, 0.99, 0.63, 0.60, 0.76, 1.1]),
];

/// Cosine under water of a sun that stands 35 degrees from the zenith.
const SUN: f64 = 0.904;

/// (a + b_b) / mu_0 at [`LAMBDA`].
fn attenuation(water: &NaturalWater) -> Vec<f64> {
    let mixture = NaturalWater { molecular_scattering: true, ..*water }.mixture();
    let (bulk, phase) = (bulk(&mixture, &LAMBDA), mixture.phase(&LAMBDA).unwrap());
    let lost = |i: usize| bulk.sigma_a[i] + bulk.sigma_s[i] * backward_share(&phase.angles, &phase.values[i]);
    (0..LAMBDA.len()).map(|i| lost(i) / SUN).collect()
}

/// The share of a phase function that goes back: trapezoids over the cosine.
fn backward_share(angles: &[f64], values: &[f64]) -> f64 {
    let mut sums = [0.0; 2];
    for i in 1..angles.len() {
        let width = angles[i - 1].cos() - angles[i].cos();
        let back = usize::from(angles[i - 1] + angles[i] > std::f64::consts::PI);
        sums[back] += 0.5 * (values[i - 1] + values[i]) * width;
    }
    sums[1] / (sums[0] + sums[1])
}

/// Root of the mean square of ln of the ratio.
fn distance(found: &[f64], expected: &[f64]) -> f64 {
    let square = |(f, e): (&f64, &f64)| (f / e).ln().powi(2);
    (found.iter().zip(expected).map(square).sum::<f64>() / found.len() as f64).sqrt()
}

/// The table of the module's documentation.
#[test]
fn seas_are_of_the_types_that_are_said() {
    let mut nearest = Vec::new();
    for (name, water) in PRESETS {
        let found = attenuation(&water);
        let of_type = |(_, expected): &&(&str, [f64; 7])| distance(&found, expected);
        let best = JERLOV.iter().min_by(|a, b| of_type(a).total_cmp(&of_type(b))).unwrap();
        let cells: Vec<String> = found.iter().map(|k| format!("{k:.3}")).collect();
        println!(
            "| `{name}` | {} | {} | {:.0} % |",
            cells.join(" | "),
            best.0,
            100.0 * (of_type(&best).exp() - 1.0)
        );
        nearest.push((name, best.0));
    }
    let said = ["I", "IB", "IA", "IA", "II", "III"];
    assert_eq!(nearest.iter().map(|(_, kind)| *kind).collect::<Vec<_>>(), said, "{nearest:?}");
    let rich = attenuation(&preset("mediterranean-rich"));
    println!("mediterranean with 3.878e-7 of algae: {rich:.3?}");
}

/// What the README says of them.
#[test]
fn presets_in_numbers() {
    for (name, water) in PRESETS {
        let mixture = water.mixture();
        let found = bulk(&mixture, &[550.0]);
        println!(
            "| `{name}` | {:.4} | {:.4} | {:.3} | {:.2} m | {:.0e}",
            found.sigma_a[0],
            found.sigma_s[0],
            found.g[0],
            1.0 / (found.sigma_a[0] + found.sigma_s[0]),
            found.relative_error
        );
        assert!(found.sigma_a[0] > 0.05 && found.sigma_s[0] > 0.0 && found.g[0] > 0.85, "{name}: {found:?}");
    }
}
