//! Mixtures that the tests share.

use std::f64::consts::PI;

use floe::optics::RefractiveIndex;
use floe::optics::particles::{Host, Mixture, SizeDistribution, Species};
use floe::spectrum::Spectrum;

/// n + ik at every wavelength.
pub fn index(n: f64, k: f64) -> RefractiveIndex {
    RefractiveIndex::Table { wavelengths: vec![550.0], n: vec![n as f32], k: vec![k as f32] }
}

pub fn species(name: &str, index: RefractiveIndex, sizes: SizeDistribution, volume_fraction: f64) -> Species {
    Species { name: name.to_owned(), index, sizes, volume_fraction }
}

/// A host that absorbs what its k says at a wavelength in nm.
pub fn host(n: f64, k: f64, lambda: f64) -> Host {
    let absorption = Spectrum::Constant((4.0 * PI * k / (lambda * 1e-9)) as f32);
    Host { index: index(n, k), absorption, molecular: None }
}

/// Radii in um.
pub fn power_law(exponent: f64, least: f64, greatest: f64) -> SizeDistribution {
    SizeDistribution::PowerLaw { exponent, least: least * 1e-6, greatest: greatest * 1e-6 }
}

/// Of minerals and algae, as they are in a turbid sea.
pub fn sea() -> Mixture {
    let minerals = species("minerals", index(1.58, 1e-3), power_law(3.4, 0.01, 100.0), 5.4e-7);
    let algae = species("algae", index(1.41, 1e-4), power_law(3.6, 0.225, 100.0), 1.9e-6);
    let molecular = Some(Spectrum::Constant(0.002));
    Mixture { host: Host { molecular, ..host(1.34, 2e-9, 550.0) }, species: vec![minerals, algae] }
}

/// Bubbles and pockets of brine in ice.
pub fn sea_ice() -> Mixture {
    let air = species("air", index(1.0, 0.0), power_law(1.24, 4.0, 70.0), 0.01);
    let brine = species("brine", index(1.353, 2e-9), power_law(2.5, 7.5, 150.0), 0.02);
    Mixture { host: host(1.311, 2e-9, 550.0), species: vec![air, brine] }
}

/// Drops of nearly one size in air.
pub fn mist() -> Mixture {
    let sizes = SizeDistribution::LogNormal { median: 1e-5, deviation: 0.05 };
    let drops = species("drops", index(1.334, 2e-9), sizes, 1e-7);
    Mixture { host: host(1.0, 0.0, 550.0), species: vec![drops] }
}
