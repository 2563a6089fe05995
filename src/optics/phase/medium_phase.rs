//! How a medium scatters: alike at every wavelength, or not.
//!
//! Light transport asks for it on the wavelengths of a path ([`MediumPhase::at`]), and takes values and weights by lane.

use glam::Vec3;

use super::deflection::Deflection;
use super::spectral::{SpectralLanes, SpectralPhase};
use super::{PhaseFunction, PhaseSample};
use crate::geometry::Frame;
use crate::spectrum::{LaneCurve, Lanes, Wavelengths};

/// The phase function of a medium. Copies share their tables.
#[derive(Clone, Debug, PartialEq)]
pub enum MediumPhase {
    /// The same at every wavelength.
    One(PhaseFunction),
    /// One over wavelength.
    Spectral(SpectralPhase),
}

/// A phase function on the wavelengths of a path.
#[derive(Clone, Copy, Debug)]
pub enum PhaseLanes<'a> {
    /// The same in every lane.
    One(&'a PhaseFunction),
    /// One for each.
    Spectral(SpectralLanes<'a>),
}

/// A sampled direction; `weight` is value / pdf of each lane.
#[derive(Clone, Copy, Debug)]
pub struct LanesSample {
    /// New direction of travel.
    pub wi: Vec3,
    /// Value over density.
    pub weight: Lanes,
    /// Density per solid angle.
    pub pdf_w: f32,
    /// The greatest value of all lanes, those without light among them, in 1/sr.
    pub greatest: f32,
}

impl From<PhaseFunction> for MediumPhase {
    fn from(phase: PhaseFunction) -> Self {
        Self::One(phase)
    }
}

impl From<SpectralPhase> for MediumPhase {
    fn from(phase: SpectralPhase) -> Self {
        Self::Spectral(phase)
    }
}

impl From<PhaseSample> for LanesSample {
    #[inline]
    fn from(sample: PhaseSample) -> Self {
        let PhaseSample { wi, weight, pdf_w } = sample;
        Self { wi, weight: Lanes::splat(weight), pdf_w, greatest: weight * pdf_w }
    }
}

impl MediumPhase {
    /// On the wavelengths of a path.
    #[inline]
    pub fn at(&self, wavelengths: &Wavelengths) -> PhaseLanes<'_> {
        match self {
            Self::One(phase) => PhaseLanes::One(phase),
            Self::Spectral(phase) => PhaseLanes::Spectral(phase.at(wavelengths)),
        }
    }

    /// The phase function, where it is the same at every wavelength.
    #[inline]
    pub fn one(&self) -> Option<&PhaseFunction> {
        match self {
            Self::One(phase) => Some(phase),
            Self::Spectral(_) => None,
        }
    }

    /// Mean cosine of the angle of deflection over wavelength; positive is forward.
    pub fn mean_cosine(&self) -> LaneCurve {
        match self {
            Self::One(phase) => LaneCurve::Constant(phase.mean_cosine()),
            Self::Spectral(phase) => phase.mean_cosine(),
        }
    }
}

impl PhaseLanes<'_> {
    /// Density of scattered light per solid angle in each lane, in 1/sr.
    #[inline]
    pub fn value(&self, turned: Deflection) -> Lanes {
        match self {
            Self::One(phase) => Lanes::splat(phase.value(turned)),
            Self::Spectral(phase) => phase.value(turned),
        }
    }

    /// The same, and the density per solid angle with which a path of this throughput draws that angle.
    #[inline]
    pub fn value_and_pdf_w(&self, turned: Deflection, throughput: Lanes) -> (Lanes, f32) {
        match self {
            Self::One(phase) => (Lanes::splat(phase.value(turned)), phase.pdf_w(turned)),
            Self::Spectral(phase) => {
                let value = phase.value(turned);
                (value, SpectralLanes::pdf_w(throughput, value))
            }
        }
    }

    /// A new direction for light (or an eye path) of this throughput that travelled along `forward`.
    #[inline]
    pub fn sample(&self, forward: Vec3, u: [f32; 2], throughput: Lanes) -> LanesSample {
        match self {
            Self::One(phase) => phase.sample(forward, u).into(),
            Self::Spectral(phase) => phase.sample(forward, u, throughput),
        }
    }
}

impl SpectralLanes<'_> {
    /// As [`PhaseLanes::sample`].
    #[inline(never)]
    pub fn sample(&self, forward: Vec3, u: [f32; 2], throughput: Lanes) -> LanesSample {
        let drawn = self.draw(throughput, u);
        let wi = Frame::around(forward).to_world(drawn.turned.around_z(drawn.rest)).normalize();
        let greatest = drawn.value.max_element();
        LanesSample { wi, weight: drawn.weight, pdf_w: drawn.pdf_w, greatest }
    }
}
