//! How much of the light that particles scatter is followed: all of it, that which is scattered once, or none.
//!
//! Along a way of length d through a medium with light L0 behind it, at [`Scattered::Once`],
//!
//! ```text
//! L = T(d) L0 + integral from 0 to d of T(t) sigma_s J1(t) dt,   T(t) = exp(-sigma_t t)
//! ```
//! where J1 is the light that reaches t without being scattered, times the phase function. At [`Scattered::Ambient`],
//! the fog of the cheapest volume integrators `[PEREZ03]`, nothing is scattered but an ambient radiance:
//!
//! ```text
//! L = T(d) L0 + (1 - T(d)) n^2 (sigma_a Le + sigma_s L_ambient) / sigma_t
//! ```
//! The ambient radiance ([`crate::light::Lights::ambient`]) is the same everywhere: no shadow falls into the medium.

use crate::light::Lights;
use crate::spectrum::{Lanes, Wavelengths};

/// What becomes of the light that the particles of media scatter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scattered {
    /// Paths turn at particles as often as they meet them.
    #[default]
    Always,
    /// Paths turn at one particle; after it media only attenuate.
    Once,
    /// Paths turn at none; an ambient radiance is scattered in.
    Ambient,
}

impl Scattered {
    /// How many particles a path may turn at.
    pub(super) fn most(self) -> u32 {
        match self {
            Self::Always => u32::MAX,
            Self::Once => 1,
            Self::Ambient => 0,
        }
    }

    /// The radiance that particles scatter in besides the light that paths find.
    pub(super) fn ambient(self, lights: &Lights, wavelengths: &Wavelengths) -> Lanes {
        match self {
            Self::Always | Self::Once => Lanes::ZERO,
            Self::Ambient => lights.ambient(wavelengths),
        }
    }
}
