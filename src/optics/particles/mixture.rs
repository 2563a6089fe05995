//! What is in a fluid or in ice: a host and what it carries.

use super::super::RefractiveIndex;
use super::SizeDistribution;
use crate::spectrum::Spectrum;

/// A host and what it carries.
#[derive(Clone, Debug, PartialEq)]
pub struct Mixture {
    /// What everything else lies in.
    pub host: Host,
    /// Particles of several kinds.
    pub species: Vec<Species>,
}

/// What particles lie in.
#[derive(Clone, Debug, PartialEq)]
pub struct Host {
    /// n + ik that waves at the particles have. The absorption that k implies is not added to [`Self::absorption`].
    pub index: RefractiveIndex,
    /// All that the host absorbs, in 1/m, with what is dissolved in it.
    pub absorption: Spectrum,
    /// Scattering by the host's own molecules, in 1/m.
    pub molecular: Option<Spectrum>,
}

/// Particles of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Species {
    /// What messages call them.
    pub name: String,
    /// n + ik of what they are made of.
    pub index: RefractiveIndex,
    /// How many there are of each radius.
    pub sizes: SizeDistribution,
    /// Their share of the whole volume, from 0 to 1.
    pub volume_fraction: f64,
}
