//! Against `tests/data/particles`: midpoint sums by another program, whose spheres agree with arbitrary precision.
//!
//! Sea water has 2000 steps in ln r, air in ice 1500; where its steps were halved the sums changed by up to 2e-4. Of milk
//! the steps are linear, 1 nm of casein and 50 nm of fat. The latter is a fourth of the mean where fat is finest, and
//! leaves 3e-3, so fat is taken at the other's radii.

use std::f64::consts::PI;

use floe::optics::RefractiveIndex;
use floe::optics::particles::{Bulk, Host, Mixture, SizeDistribution, Species};

use crate::mixtures::{host, index, power_law, species};

fn rows(text: &str) -> Vec<Vec<f64>> {
    let numbers = |line: &str| line.split(',').map(|field| field.parse().unwrap()).collect();
    text.lines().skip(1).map(numbers).collect()
}

fn at(host: Host, species: Vec<Species>, lambda: f64) -> Bulk {
    Mixture { host, species }.bulk(&[lambda]).unwrap()
}

/// The greatest relative deviation.
fn worst(pairs: &[[f64; 2]]) -> f64 {
    let deviations = pairs.iter().map(|[got, expected]| (got / expected - 1.0).abs());
    deviations.fold(0.0, |worst, d| if d <= worst { worst } else { d })
}

/// The other divides by a rounded volume of N(r) = (2r)^-exponent, r in um: 4.97 of algae and 10.44 of minerals. This is
/// how much more there is then.
fn excess(exponent: f64, least: f64, greatest: f64) -> f64 {
    let power = 4.0 - exponent;
    let volume = greatest.powf(power) - least.powf(power);
    let volume = 4.0 / 3.0 * PI * 0.5_f64.powf(exponent) * volume / power;
    volume / if exponent == 3.6 { 4.97 } else { 10.44 }
}

fn algae(k: f64, volume: f64) -> Species {
    let volume = volume * excess(3.6, 0.225, 100.0);
    species("algae", index(1.41, k), power_law(3.6, 0.225, 100.0), volume)
}

fn minerals(k: f64, volume: f64) -> Species {
    let volume = volume * excess(3.4, 0.01, 100.0);
    species("minerals", index(1.58, k), power_law(3.4, 0.01, 100.0), volume)
}

/// By the other's 2000 steps these sums are its own to 2e-7; of the bound, both have their part.
#[test]
fn a_millionth_of_algae_or_minerals() {
    let mut all = 0.0_f64;
    for row in rows(include_str!("../data/particles/unit_volume.csv")) {
        let [n, k, exponent, least, greatest, lambda, n_host, k_host, sigma_t, sigma_s, g] = row[..] else {
            panic!("{row:?}")
        };
        let volume = 1e-6 * excess(exponent, least, greatest);
        let particles = species("particles", index(n, k), power_law(exponent, least, greatest), volume);
        let found = &at(host(n_host, k_host, lambda), vec![particles], lambda).species[0];
        all = all.max(worst(&[[found.sigma_t[0], sigma_t], [found.sigma_s[0], sigma_s], [found.g[0], g]]));
    }
    println!("algae and minerals: {all:e}");
    assert!(all < 2e-4, "{all:e}");
}

#[test]
fn natural_waters() {
    let mut all = 0.0_f64;
    for row in rows(include_str!("../data/particles/waters.csv")) {
        let [v_algae, v_minerals, lambda, n, k, k_algae, k_minerals, sigma_t, sigma_s, sigma_a, g] = row[..]
        else {
            panic!("{row:?}")
        };
        let species = vec![algae(k_algae, v_algae), minerals(k_minerals, v_minerals)];
        let found = at(host(n, k, lambda), species, lambda);
        let extinction = found.sigma_a[0] + found.sigma_s[0];
        all = all.max(worst(&[
            [extinction, sigma_t],
            [found.sigma_s[0], sigma_s],
            [found.sigma_a[0], sigma_a],
            [found.g[0], g],
        ]));
    }
    println!("waters: {all:e}");
    // The absorption: a fiftieth of the extinction.
    assert!(all < 5e-4, "{all:e}");
}

/// The other counts the host's absorption apart from the bubbles, whose extinction is a little below their scattering:
/// they take the place of ice.
#[test]
fn air_in_ice() {
    let mut all = 0.0_f64;
    for row in rows(include_str!("../data/particles/ice_air.csv")) {
        let [lambda, n, k, volume, exponent, least, greatest, sigma_t, sigma_s, _, g] = row[..] else {
            panic!("{row:?}")
        };
        let air = species("air", index(1.0, 0.0), power_law(exponent, least, greatest), volume);
        let found = at(host(n, k, lambda), vec![air], lambda);
        let extinction = found.sigma_a[0] + found.sigma_s[0];
        all = all.max(worst(&[[extinction, sigma_t], [found.sigma_s[0], sigma_s], [found.g[0], g]]));
    }
    println!("air in ice: {all:e}");
    assert!(all < 2e-5, "{all:e}");
}

/// Fat has a log-normal volume over radius, casein one over r / (150 nm - r); both are given by mean and deviation.
#[test]
fn milk() {
    let mut all = 0.0_f64;
    for row in rows(include_str!("../data/particles/milk.csv")) {
        let [fat, protein, r_vs, c_s, lambda, n, k, n_fat, k_fat, sigma_t, sigma_s, _, g] = row[..] else {
            panic!("{row:?}")
        };
        let per_litre = 100.0 / 1.03;
        let casein = species("casein", index(1.503, 0.0), of_casein(), 0.76 * protein / 1.11 / per_litre);
        let mut all_species = of_fat(r_vs, c_s, &index(n_fat, k_fat), fat / 0.915 / per_litre);
        all_species.push(casein);
        let found = at(host(n, k, lambda), all_species, lambda);
        let extinction = found.sigma_a[0] + found.sigma_s[0];
        all = all.max(worst(&[[extinction, sigma_t], [found.sigma_s[0], sigma_s], [found.g[0], g]]));
    }
    println!("milk: {all:e}");
    // What the other's steps of casein leave.
    assert!(all < 6e-5, "{all:e}");
}

/// Mean and deviation of the logarithm.
fn of_logarithm(mean: f64, deviation: f64) -> [f64; 2] {
    let square = (deviation * deviation / (mean * mean) + 1.0).ln();
    [mean.ln() - 0.5 * square, square.sqrt()]
}

/// In the middles of steps of 50 nm from 5 nm to 10 um, each a species of one radius.
fn of_fat(r_vs: f64, c_s: f64, index: &RefractiveIndex, fraction: f64) -> Vec<Species> {
    let [alpha, beta] = of_logarithm(r_vs * 1e6, c_s);
    let middle = |i: u32| 0.005 + 0.05 * (f64::from(i) + 0.5);
    let radii: Vec<f64> = (0..200).map(middle).take_while(|r| *r < 10.0).collect();
    let total: f64 = radii.iter().map(|r| volume(*r, alpha, beta)).sum();
    let step = |r: &f64| {
        let sizes = SizeDistribution::Table { radii: vec![r * 1e-6], number: vec![1.0] };
        species("fat", index.clone(), sizes, fraction * volume(*r, alpha, beta) / total)
    };
    radii.iter().map(step).collect()
}

/// Numbers are volumes over r^3.
fn of_casein() -> SizeDistribution {
    let [alpha, beta] = of_logarithm(43.0 / (150.0 - 43.0), 0.23);
    let (least, greatest) = (5e-10_f64, 1.495e-7);
    let radius = |i: u32| least * (greatest / least).powf(f64::from(i) / 400.0);
    let radii: Vec<f64> = (0..=400).map(radius).collect();
    let number = radii.iter().map(|r| volume(r / (1.5e-7 - r), alpha, beta) / (r * 1e7).powi(3)).collect();
    SizeDistribution::Table { radii, number }
}

fn volume(t: f64, alpha: f64, beta: f64) -> f64 {
    let s = (t.ln() - alpha) / beta;
    (-0.5 * s * s).exp() / t
}
