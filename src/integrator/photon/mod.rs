//! Progressive photon mapping: light that eye paths do not find.
//!
//! Each sample of every pixel is a pass with photons of its own. Light is parted by its source and by its way, so that
//! nothing counts twice and nothing is lost:
//!
//! | light | found by |
//! |---|---|
//! | of photon lights (suns, emitters, mostly the sky): seen through specular surfaces only | eye paths |
//! | straight onto a diffuse surface | next-event estimation |
//! | turned by specular surfaces and the peaks of phase functions, then onto a diffuse surface | caustic photons |
//! | scattered before, onto the first diffuse surface of an eye path | final gathering, or global photons |
//! | ... onto the second one | global photons |
//! | scattered in a medium by a wide angle | photons around the eye's rays, up to the last surface at which photons are asked |
//! | ... within the peak of its phase function | eye paths that turn there and go on asking (`peak.rs`) |
//! | of any other sky, and of media that emit | eye paths alone, which go on as in path tracing |
//!
//! Where the open air itself scatters there are no photons, which would have to begin at infinity: eye paths find all that
//! path tracing finds. Photons and eye paths may each have as many interactions as `max_depth` says.
//!
//! Photons carry the light of the sky where a medium scatters, since eye paths would have to walk through it, and where
//! a small part of the sky has most of its light; `sky = true` or `false` decides otherwise.
#![doc = include_str!("convergence.md")]

mod emission;
pub(super) mod gather;
pub(super) mod guide;
pub(super) mod kernel;
pub mod map;
pub(super) mod peak;
pub mod radius;
mod stray;
mod suns;
mod trace;

pub use map::{Photon, PhotonMap};
pub use radius::Radii;

pub(super) use emission::Emission;
pub(super) use gather::reflected;
pub(super) use guide::Guide;
pub(super) use peak::is_peak;
pub(super) use radius::holding;
pub(super) use stray::Strays;
pub(super) use suns::SunStarts;
pub(super) use trace::{Arrivals, Tracing};

use peak::has_peak;

use super::Counters;
use super::path::PathTracer;
use crate::sampling::{SampleSeed, SampleStream};
use crate::scene::description::{KernelKind, PhotonDescription};
use crate::scene::frame::Frame;
use crate::scene::needs::Needs;
use crate::spectrum::Wavelengths;

/// Progressive photon mapping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhotonMapper {
    /// How eye paths are followed.
    pub path: PathTracer,
    /// How photons are.
    pub settings: PhotonDescription,
}

/// What all passes of a frame share.
#[derive(Clone, Debug)]
pub struct PhotonFrame {
    mapper: PhotonMapper,
    seed: SampleSeed,
    /// `None` where nothing emits photons or nothing takes them.
    emission: Option<Emission>,
    count: u32,
    volume_share: f32,
    radii: Radii,
    lookups: u8,
    walks: bool,
    sky: bool,
}

/// The photons of one pass.
#[derive(Clone, Debug)]
pub struct PhotonPass {
    /// The wavelengths of all photons and eye paths of the pass.
    pub wavelengths: Wavelengths,
    /// Their time, in frames since the shutter opened: photons are where they are at that time only.
    pub time: f32,
    pub(super) caustic: PhotonMap,
    pub(super) global: PhotonMap,
    pub(super) volume: PhotonMap,
    pub(super) kernel: KernelKind,
    pub(super) guide: bool,
    /// Vertices at which an eye path asks for photons.
    pub(super) lookups: u8,
    /// Eye paths go on for light that photons do not carry.
    pub(super) walks: bool,
    /// Media whose phase functions have a peak ([`is_peak`]).
    pub(super) peaked: Vec<bool>,
    /// The sky is among the lights that photons carry.
    pub(super) sky: bool,
}

/// Photons that tell how many arrive in media, and photons that tell the radii, at most.
const FIRST_PILOT: u32 = 2048;
const PILOT: u32 = 65_536;
/// The part of the collisions in media that the first of these keep.
const FIRST_SHARE: f32 = 1.0 / 64.0;
/// Photons kept in media for each that is emitted, about.
const KEPT_IN_MEDIA: f32 = 4.0;
/// Names the numbers of photons apart from those of pixels.
const PHOTON_COLUMN: u32 = u32::MAX;

/// The wavelengths of all photons and eye paths of a pass, and their time.
pub(super) fn common_of_pass(frame: &Frame, seed: SampleSeed, pass: u32) -> (Wavelengths, f32) {
    let mut stream = SampleStream::new(seed, PHOTON_COLUMN, PHOTON_COLUMN, pass);
    let [w, t, ..] = stream.next4();
    (frame.wavelengths(w, &mut stream), frame.views.time(t))
}

impl PhotonMapper {
    /// Finds out how photons are emitted in a frame and how wide they are spread.
    pub fn prepare(&self, frame: &Frame, seed: SampleSeed) -> PhotonFrame {
        let [width, height] = frame.views.opening.resolution();
        let count = self.settings.count_of(width.saturating_mul(height));
        let sky = self.carries_sky(&frame.needs);
        let takes = (frame.needs.diffuse || frame.needs.scattering) && !frame.needs.turbid_air;
        let emission = Some(Emission::new(frame, sky)).filter(|e| takes && e.is_possible());
        let path_sky = frame.needs.sky && !sky;
        let mut prepared = PhotonFrame {
            mapper: *self,
            seed,
            walks: path_sky || frame.needs.emission,
            lookups: match (&emission, self.settings.final_gather) {
                (None, _) => 0,
                (_, false) => 1,
                (_, true) => 2,
            },
            sky: sky && emission.is_some(),
            emission,
            count,
            volume_share: FIRST_SHARE,
            radii: Radii { caustic: 0.0, global: 0.0, volume: 0.0 },
        };
        prepared.run_pilots(frame);
        prepared
    }

    /// True when the light of the sky is that of photons.
    pub(super) fn carries_sky(&self, needs: &Needs) -> bool {
        needs.sky && self.settings.sky.unwrap_or(needs.scattering || needs.peaked_sky)
    }
}

impl PhotonFrame {
    /// Emits the photons of pass `index` and puts them into maps; `None` when it is told to stop.
    pub fn pass(
        &self,
        frame: &Frame,
        index: u32,
        stops: &(dyn Fn() -> bool + Sync),
    ) -> Option<(PhotonPass, Counters)> {
        let (common, stream) = self.numbers(frame, index);
        let arrivals = self.trace(frame, &common, self.count, &stream, stops);
        if stops() {
            return None;
        }
        let settings = &self.mapper.settings;
        let radii = self.radii.shrunk(index, settings.shrink.into());
        let pass = PhotonPass {
            wavelengths: common.0,
            time: common.1,
            caustic: PhotonMap::new(&arrivals.caustic, radii.caustic),
            global: PhotonMap::new(&arrivals.global, radii.global),
            volume: PhotonMap::new(&arrivals.volume, radii.volume),
            kernel: settings.kernel,
            guide: settings.guide,
            lookups: self.lookups,
            walks: self.walks,
            peaked: frame.media.iter().map(|medium| has_peak(&medium.phase.at(&common.0))).collect(),
            sky: self.sky,
        };
        Some((pass, arrivals.counters))
    }

    /// Photons a pass; 0 where none are needed.
    pub fn count(&self) -> u32 {
        if self.emission.is_some() { self.count } else { 0 }
    }

    /// Wavelengths and time of a pass, and the numbers of its photons.
    fn numbers(
        &self,
        frame: &Frame,
        pass: u32,
    ) -> ((Wavelengths, f32), impl Fn(u32) -> SampleStream + Sync + use<>) {
        let seed = self.seed;
        let common = common_of_pass(frame, seed, pass);
        let kinds = self.emission.as_ref().map_or(1, Emission::kinds);
        let of_kind = self.count.div_ceil(kinds);
        let stream =
            move |photon| SampleStream::of_photon(seed, pass, photon % kinds, of_kind, photon / kinds);
        (common, stream)
    }

    fn trace(
        &self,
        frame: &Frame,
        (wavelengths, time): &(Wavelengths, f32),
        count: u32,
        stream: &(impl Fn(u32) -> SampleStream + Sync),
        stops: &(dyn Fn() -> bool + Sync),
    ) -> Arrivals {
        let Some(emission) = &self.emission else { return Arrivals::default() };
        let max_depth = self.mapper.path.interactions();
        Tracing {
            frame,
            emission: &emission.at(frame, *time, count),
            wavelengths,
            time: *time,
            count,
            max_depth,
            volume_share: self.volume_share,
            strays: None,
        }
        .run(stream, stops)
    }

    /// A few photons tell how many of the many collisions in media are worth keeping, and some more the radii.
    fn run_pilots(&mut self, frame: &Frame) {
        let (common, stream) = self.numbers(frame, 0);
        let first = self.trace(frame, &common, FIRST_PILOT, &stream, &|| false);
        let in_media = first.volume.len() as f32 / (FIRST_PILOT as f32 * FIRST_SHARE);
        self.volume_share = (KEPT_IN_MEDIA / in_media).min(1.0);
        let count = self.count.min(PILOT);
        let pilot = self.trace(frame, &common, count, &stream, &|| false);
        // Photons of one pilot stand for so many photons of a pass.
        let share = count as f32 / self.count as f32;
        let natural = |photons: &[Photon]| radius::natural(photons, share);
        let settings = &self.mapper.settings;
        let widest = 0.1 * self.emission.as_ref().map_or(1.0, Emission::seen_radius);
        let or_widest = |given: Option<f32>, found: Option<f32>| {
            given.or(found).unwrap_or(widest).min(given.unwrap_or(widest))
        };
        self.radii = Radii {
            caustic: or_widest(settings.radius, natural(&pilot.caustic)),
            global: or_widest(settings.radius, natural(&pilot.global)),
            volume: or_widest(settings.volume_radius, natural(&pilot.volume)),
        };
    }
}
