//! Radiance along a path.
//!
//! A tracer follows the light transport of one sample of one pixel: no threads, no film. It reads a
//! [`crate::scene::frame::Frame`] and gives an [`EyeSample`].

#![doc = include_str!("thick_media.md")]

mod ahead;
pub mod ambient_occlusion;
pub mod beams;
mod beneath;
pub mod counters;
mod diffuse;
mod direct;
mod dispersion;
mod flight;
mod forced;
mod half_space;
mod interface;
mod layers;
mod led;
mod left_out;
mod pass;
pub mod path;
pub mod photon;
mod roulette;
pub mod scattered;
pub mod strays;
mod vertex;
mod walk;

use glam::Vec3;

pub use ambient_occlusion::AmbientOcclusion;
pub use beams::Beams;
pub use counters::Counters;
pub use pass::{Emitters, Pass};
pub use path::PathTracer;
pub use photon::{PhotonFrame, PhotonMapper, PhotonPass};
pub use scattered::Scattered;
pub use strays::{StrayFrame, StrayPass};

use crate::accel::Hit;
use crate::geometry::Ray;
use crate::optics::dwivedi::Dwivedi;
use crate::optics::medium::MediumLanes;
use crate::sampling::SampleStream;
use crate::scene::description::{IntegratorKind, RenderDescription};
use crate::scene::frame::Frame;
use crate::scene::needs::Needs;
use crate::spectrum::{LaneMode, Lanes, Wavelengths};

/// What one sample of a pixel brings back.
#[derive(Clone, Copy, Debug)]
pub struct EyeSample {
    /// Radiance on the lanes of the sample's wavelengths.
    pub radiance: Lanes,
    /// The first surface or particle that the eye ray meets; `None` when it escapes.
    pub first: Option<FirstHit>,
}

/// The first surface or particle that an eye ray meets (index-matched boundaries are looked through).
#[derive(Clone, Copy, Debug)]
pub struct FirstHit {
    /// Distance along the ray in metres.
    pub distance: f32,
    /// Point in metres from the scene's origin.
    pub position: Vec3,
    /// Shading normal on the side of the eye.
    pub normal: Vec3,
    /// Colour of the surface; white for interfaces and lights.
    pub albedo: Lanes,
    /// What the point moves by in a frame, in metres.
    pub motion: Vec3,
}

/// What a worker keeps between the samples of one frame by one integrator: no allocation in the inner loop.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    /// Whether media and sources are there already, which where lanes are RGB are those of every sample.
    prepared: bool,
    /// Coefficients of every medium at the wavelengths of the current sample.
    pub(crate) media: Vec<MediumLanes>,
    /// What an endless depth of every medium adds to a path ([`crate::optics::medium::Medium::source`]); empty where
    /// none adds anything.
    pub(crate) sources: Vec<Lanes>,
    /// How every medium leads its walks; empty where none does.
    pub(crate) led: Vec<Option<Dwivedi>>,
    /// What the current branch knows of the medium around it.
    pub(crate) around: flight::Around,
    /// Branches of the current sample that are still to be followed.
    pub(crate) branches: Vec<path::Branch>,
    /// Boundaries that the current shadow ray crosses, nearest first; none where the scene has none.
    pub(crate) crossings: Vec<Hit>,
    /// Ways of the sun to the current vertex.
    pub(in crate::integrator) ways: beams::Ways,
    /// Events of all samples so far.
    pub counters: Counters,
}

impl Scratch {
    /// Takes the media at the wavelengths of a new sample, and an ambient radiance that they scatter in.
    pub(crate) fn start(&mut self, frame: &Frame, wavelengths: &Wavelengths, ambient: Lanes) {
        self.branches.clear();
        if self.prepared && frame.mode == LaneMode::Rgb {
            return;
        }
        self.prepared = true;
        self.media.clear();
        self.media.extend(frame.media.iter().map(|m| m.lanes(wavelengths)));
        self.sources.clear();
        if frame.needs.emission || ambient != Lanes::ZERO {
            self.sources.extend(frame.media.iter().map(|m| m.source(wavelengths, ambient)));
        }
        self.led.clear();
    }
}

/// Light that was prepared for a frame or a pass, of which paths take their part.
#[derive(Clone, Copy, Debug, Default)]
pub struct PreparedLight<'a> {
    /// The photons of the pass; without them photon mapping finds what path tracing does.
    pub photons: Option<&'a PhotonPass>,
    /// Through which triangles the sun is looked for.
    pub beams: Option<&'a Beams>,
    /// The photons of the pass beside them.
    pub strays: Option<&'a StrayPass>,
}

/// A way to compute the radiance of a sample.
#[derive(Clone, Copy, Debug)]
pub enum Integrator {
    /// Beams in frames where the sun is behind a refracting interface, paths in others ([`Self::on`]).
    Auto(PhotonMapper),
    /// Volumetric path tracing.
    Path(PathTracer),
    /// Volumetric path tracing that finds the sun through one refracting interface ([`beams`]), and what of it is bent
    /// otherwise by photons ([`strays`]).
    Beams(PhotonMapper),
    /// Progressive photon mapping.
    Photon(PhotonMapper),
    /// The open part of the hemisphere over the first surface.
    AmbientOcclusion(AmbientOcclusion),
}

impl Integrator {
    /// What the scene asks for.
    pub fn new(settings: &RenderDescription) -> Self {
        let path = |scattered| PathTracer {
            max_depth: settings.max_depth,
            split: settings.split,
            forced: settings.forced_scattering,
            scattered,
        };
        let with_photons = || PhotonMapper { path: path(Scattered::Always), settings: settings.photons };
        match settings.integrator {
            IntegratorKind::Path => Self::Path(path(Scattered::Always)),
            IntegratorKind::Auto => Self::Auto(with_photons()),
            IntegratorKind::Beams => Self::Beams(with_photons()),
            IntegratorKind::SingleScattering => Self::Path(path(Scattered::Once)),
            IntegratorKind::Fog => Self::Path(path(Scattered::Ambient)),
            IntegratorKind::Photon => Self::Photon(with_photons()),
            IntegratorKind::AmbientOcclusion => Self::AmbientOcclusion(AmbientOcclusion),
        }
    }

    /// What runs in a frame with these needs.
    #[must_use]
    pub fn on(self, needs: &Needs) -> Self {
        match self {
            Self::Auto(mapper) if needs.sun_behind_interface => Self::Beams(mapper),
            Self::Auto(mapper) => Self::Path(mapper.path),
            other => other,
        }
    }

    /// The radiance along an eye ray.
    pub fn sample(
        &self,
        frame: &Frame,
        scratch: &mut Scratch,
        eye: &Ray,
        wavelengths: &Wavelengths,
        stream: SampleStream,
        light: PreparedLight,
    ) -> EyeSample {
        match self {
            Self::Path(tracer) => {
                tracer.trace(frame, scratch, eye, wavelengths, stream, PreparedLight::default())
            }
            Self::Auto(mapper) | Self::Beams(mapper) | Self::Photon(mapper) => {
                mapper.path.trace(frame, scratch, eye, wavelengths, stream, light)
            }
            Self::AmbientOcclusion(tracer) => tracer.trace(frame, scratch, eye, stream),
        }
    }

    /// The name in the scene file.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Path(tracer) => match tracer.scattered {
                Scattered::Always => "path",
                Scattered::Once => "single-scattering",
                Scattered::Ambient => "fog",
            },
            Self::Auto(_) => "auto",
            Self::Beams(_) => "beams",
            Self::Photon(_) => "photon",
            Self::AmbientOcclusion(_) => "ambient-occlusion",
        }
    }
}
