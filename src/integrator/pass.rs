//! Passes: photons that one sample of every pixel shares.

use super::photon::{PhotonFrame, PhotonPass};
use super::strays::{StrayFrame, StrayPass};
use super::{Beams, Counters, Integrator, PreparedLight};
use crate::sampling::SampleSeed;
use crate::scene::frame::Frame;
use crate::spectrum::Wavelengths;

/// What emits the photons of a frame's passes.
#[derive(Clone, Debug)]
pub enum Emitters<'a> {
    /// Photon mapping.
    Photon(Box<PhotonFrame>),
    /// Path tracing beside beams.
    Strays(Box<StrayFrame<'a>>),
}

/// The photons of one pass.
#[derive(Clone, Debug)]
pub enum Pass {
    /// Those of photon mapping.
    Photon(PhotonPass),
    /// Those beside beams.
    Strays(StrayPass),
}

impl Integrator {
    /// Finds out how photons are emitted in a frame; `None` where nothing emits any, or nothing takes them.
    pub fn emitters<'a>(
        &self,
        frame: &Frame,
        beams: Option<&'a Beams>,
        seed: SampleSeed,
    ) -> Option<Emitters<'a>> {
        match self {
            Self::Photon(mapper) => {
                let prepared = mapper.prepare(frame, seed);
                (prepared.count() > 0).then(|| Emitters::Photon(Box::new(prepared)))
            }
            Self::Beams(mapper) => {
                mapper.strays(frame, beams, seed).map(|strays| Emitters::Strays(Box::new(strays)))
            }
            Self::Auto(_) | Self::Path(_) | Self::AmbientOcclusion(_) => None,
        }
    }
}

impl Emitters<'_> {
    /// The photons of pass `index`; `None` when it is told to stop.
    pub fn pass(
        &self,
        frame: &Frame,
        index: u32,
        stops: &(dyn Fn() -> bool + Sync),
    ) -> Option<(Pass, Counters)> {
        match self {
            Self::Photon(of_all) => {
                of_all.pass(frame, index, stops).map(|(pass, events)| (Pass::Photon(pass), events))
            }
            Self::Strays(of_all) => {
                of_all.pass(frame, index, stops).map(|(pass, events)| (Pass::Strays(pass), events))
            }
        }
    }
}

impl Pass {
    /// The wavelengths of all photons and eye paths of the pass, and their time in frames since the shutter opened.
    pub fn common(&self) -> (Wavelengths, f32) {
        match self {
            Self::Photon(pass) => (pass.wavelengths, pass.time),
            Self::Strays(pass) => (pass.wavelengths, pass.time),
        }
    }

    /// The light that its paths take part of.
    pub fn light<'a>(&'a self, beams: Option<&'a Beams>) -> PreparedLight<'a> {
        match self {
            Self::Photon(pass) => PreparedLight { photons: Some(pass), beams, strays: None },
            Self::Strays(pass) => PreparedLight { photons: None, beams, strays: Some(pass) },
        }
    }
}
