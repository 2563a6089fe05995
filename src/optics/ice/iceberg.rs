//! Icebergs: ice with the air and the brine that its temperature, salinity and density say, and algae where it lies in the sea.
//!
//! The host is pure ice `[WARREN08]`. [`PRESETS`] go by the air in it and are **ours and unverified**; without salt at
//! -15 degrees they have
//!
//! | preset | air | kg/m^3 | what it stands for |
//! |---|---|---|---|
//! | `bubbly` | 2.7 % | 894.3 | glacier ice as it calves |
//! | `white` | 6.5 % | 859.4 | young ice near the top of a glacier |
//! | `compacted` | 0.5 % | 914.5 | old ice from the depth, with few bubbles left |
//! | `blue` | 0.02 % | 918.9 | the clearest old ice, and frozen melt water |
//! | `green` | 0.02 % | 918.9 | ice that sea water froze to from below, with algae for a millionth of its volume |

use super::super::RefractiveIndex;
use super::super::particles::{Host, Mixture};
use super::super::water;
use super::{IceError, air, brine, contents};
use crate::spectrum::Spectrum;

/// Ice and what is in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iceberg {
    /// Degrees Celsius, within [`super::TEMPERATURE_RANGE`].
    pub temperature: f64,
    /// Parts per thousand.
    pub salinity: f64,
    /// kg/m^3, with all that is in it.
    pub density: f64,
    /// Share of the volume that is algae.
    pub algae: f64,
}

impl Iceberg {
    /// The host, air, brine and algae; what has no volume is left out.
    ///
    /// # Errors
    /// Ice of this salinity and density cannot be at this temperature.
    pub fn mixture(&self) -> Result<Mixture, IceError> {
        let contents = contents(self.temperature, self.salinity, self.density)?;
        let species = [air(contents.air), brine(contents.brine, self.temperature)?, water::algae(self.algae)];
        let index = RefractiveIndex::Ice;
        Ok(Mixture {
            host: Host {
                absorption: index.absorption().unwrap_or(Spectrum::Constant(0.0)),
                index,
                molecular: None,
            },
            species: species.into_iter().filter(|species| species.volume_fraction != 0.0).collect(),
        })
    }
}

/// What ice of a preset holds; its density follows, see [`super::density`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IcePreset {
    /// Share of the volume that is air.
    pub air: f64,
    /// Share of the volume that is algae.
    pub algae: f64,
}

/// The temperature of ice in degrees Celsius unless it is told.
pub const TEMPERATURE: f64 = -15.0;

/// Ice by name; the first is what ice is unless it is told.
pub const PRESETS: [(&str, IcePreset); 5] = [
    ("bubbly", IcePreset { air: 0.027, algae: 0.0 }),
    ("white", IcePreset { air: 0.065, algae: 0.0 }),
    ("compacted", IcePreset { air: 0.005, algae: 0.0 }),
    ("blue", IcePreset { air: 2e-4, algae: 0.0 }),
    ("green", IcePreset { air: 2e-4, algae: 1e-6 }),
];
