//! The columns of a report: what stands over them in tables and in files, and their numbers.

use super::MediumReport;
use crate::optics::particles::SpeciesBulk;

/// A quantity over wavelength.
#[derive(Clone, Copy, Debug)]
pub struct Quantity {
    /// Its key in JSON and, with its unit, its head in files.
    pub key: &'static str,
    /// Its head in tables.
    pub symbol: &'static str,
    /// The end of its head in files.
    pub unit: &'static str,
    /// Its numbers.
    pub values: fn(&MediumReport) -> &[f64],
}

/// All of a medium.
pub const QUANTITIES: [Quantity; 10] = [
    Quantity { key: "n", symbol: "n", unit: "", values: |r| &r.n },
    Quantity { key: "sigma_a", symbol: "sigma_a", unit: "_per_m", values: |r| &r.sigma_a },
    Quantity { key: "sigma_s", symbol: "sigma_s", unit: "_per_m", values: |r| &r.sigma_s },
    Quantity { key: "sigma_t", symbol: "sigma_t", unit: "_per_m", values: |r| &r.sigma_t },
    Quantity { key: "albedo", symbol: "albedo", unit: "", values: |r| &r.albedo },
    Quantity { key: "g", symbol: "g", unit: "", values: |r| &r.g },
    Quantity { key: "reduced_sigma_s", symbol: "sigma_s'", unit: "_per_m", values: |r| &r.reduced_sigma_s },
    Quantity { key: "backscattering", symbol: "b_b", unit: "_per_m", values: |r| &r.backscattering },
    Quantity { key: "diffuse_attenuation", symbol: "K", unit: "_per_m", values: |r| &r.diffuse_attenuation },
    Quantity { key: "reflectance", symbol: "R", unit: "", values: |r| &r.reflectance },
];

/// A quantity of a species: its key, its unit and its numbers.
pub type SpeciesQuantity = (&'static str, &'static str, fn(&SpeciesBulk) -> &[f64]);

/// All of a species.
pub const OF_SPECIES: [SpeciesQuantity; 3] =
    [("sigma_t", "_per_m", |s| &s.sigma_t), ("sigma_s", "_per_m", |s| &s.sigma_s), ("g", "", |s| &s.g)];
