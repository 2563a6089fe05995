//! Natural waters: what they are made of, and five seas and a lake ready to use `[FRISVAD07]`, `[IRWIN78]`, beside
//! Jerlov's types `[AUSTIN84]`, `[JERLOV76]`.
#![doc = include_str!("natural.md")]

use super::super::RefractiveIndex;
use super::super::particles::{Host, Mixture};
use super::{absorption_at, algae, dissolved_matter, mineral, molecular_scattering, rock_flour};
use crate::spectrum::Spectrum;
use crate::spectrum::cie::knots;

/// Water and what is in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NaturalWater {
    /// Degrees Celsius.
    pub temperature: f64,
    /// Parts per thousand.
    pub salinity: f64,
    /// Share of the volume that is minerals.
    pub mineral: f64,
    /// Share of the volume that is algae.
    pub algae: f64,
    /// Share of the volume that is rock flour.
    pub rock_flour: f64,
    /// Absorption of dissolved organic matter at 440 nm in 1/m.
    pub dissolved: f64,
    /// Whether the molecules of the water scatter.
    pub molecular_scattering: bool,
}

impl NaturalWater {
    /// Sea water at 20 degrees with nothing in it, as the published presets have it.
    pub const SEA: Self = Self {
        temperature: 20.0,
        salinity: 35.0,
        mineral: 0.0,
        algae: 0.0,
        rock_flour: 0.0,
        dissolved: 0.0,
        molecular_scattering: false,
    };

    const fn sea(algae: f64, mineral: f64) -> Self {
        Self { algae, mineral, ..Self::SEA }
    }

    /// The host and the particles; what has no volume is left out.
    pub fn mixture(&self) -> Mixture {
        let Self { temperature, salinity, .. } = *self;
        let absorbed = |lambda: f64| {
            absorption_at(lambda, temperature, salinity) + dissolved_matter(lambda, self.dissolved)
        };
        let scattered = |lambda: f64| molecular_scattering(lambda, salinity);
        let species = [mineral(self.mineral), algae(self.algae), rock_flour(self.rock_flour)];
        Mixture {
            host: Host {
                index: RefractiveIndex::Water { temperature: temperature as f32, salinity: salinity as f32 },
                absorption: Spectrum::tabulated(knots(), absorbed),
                molecular: self.molecular_scattering.then(|| Spectrum::tabulated(knots(), scattered)),
            },
            species: species.into_iter().filter(|species| species.volume_fraction != 0.0).collect(),
        }
    }
}

/// Ours and unverified.
const PUKAKI: NaturalWater =
    NaturalWater { temperature: 8.0, salinity: 0.0, rock_flour: 2e-6, dissolved: 0.05, ..NaturalWater::SEA };

/// Waters by name. All but the last are those of `[FRISVAD07]`.
pub const PRESETS: [(&str, NaturalWater); 6] = [
    ("atlantic", NaturalWater::sea(1.880e-7, 2.477e-10)),
    ("baltic", NaturalWater::sea(1.904e-6, 5.429e-7)),
    ("channel", NaturalWater::sea(4.999e-7, 2.300e-7)),
    ("mediterranean", NaturalWater::sea(3.878e-8, 3.075e-7)),
    ("north-sea", NaturalWater::sea(2.171e-6, 2.077e-6)),
    ("pukaki", PUKAKI),
];
