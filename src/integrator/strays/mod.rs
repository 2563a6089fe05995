//! Sunlight that neither next-event estimation nor beams find, by photons beside both (`photon/stray.rs` says which
//! it is).
//!
//! Each sample of every pixel is a pass with photons of its own, as in photon mapping, and the mean over passes converges as
//! there: they are spread a little less each time. All other light is that of eye paths.
//!
//! Photons start where they are worth it. A pilot emits as many of each sun, evenly over the disc across its light, and tells
//! what each cell of a grid brings; those of the passes are drawn with the density
//!
//! ```text
//! p = EVEN + (1 - EVEN) w / mean(w),     w = sqrt(mean over the photons of a cell of (flux that they leave behind)^2)
//! ```
//! over the suns and the unit square that the disc is drawn from, whose exact value divides their flux. Where the pilot leaves nothing
//! behind there are no passes.
//!
//! In the scene of `tests/bench/hero`, an iceberg in turbid water under waves, of 320 x 180 pixels, they bring 2.7, 4.1 and 2.8 % of
//! the light in red, green and blue. With the pilot twenty times as many of them arrive, and with the same number and radii they add a
//! quarter of the noise that they add without. One for each 32 pixels is enough there: four times as many take 1.2 times the time
//! and leave the variance of the picture as it is.
//!
//! Half spaces are lit straight and by beams alone, and the air must be clear: photons would have to begin at infinity.

mod ask;
mod pilot;

use super::Counters;
use super::beams::Beams;
use super::photon::{
    Arrivals, Emission, PhotonMap, PhotonMapper, Radii, Strays, SunStarts, Tracing, common_of_pass,
};
use crate::sampling::{SampleSeed, SampleStream};
use crate::scene::description::KernelKind;
use crate::scene::frame::Frame;
use crate::scene::needs::Needs;
use crate::spectrum::Wavelengths;

/// What all passes of a frame share.
#[derive(Clone, Debug)]
pub struct StrayFrame<'a> {
    mapper: PhotonMapper,
    seed: SampleSeed,
    strays: Strays<'a>,
    emission: Emission,
    count: u32,
    radii: Radii,
}

/// The photons of one pass.
#[derive(Clone, Debug)]
pub struct StrayPass {
    /// The wavelengths of all photons and eye paths of the pass.
    pub wavelengths: Wavelengths,
    /// Their time, in frames since the shutter opened.
    pub time: f32,
    surface: PhotonMap,
    volume: PhotonMap,
    kernel: KernelKind,
}

impl PhotonMapper {
    /// True where some photons may be worth a pilot.
    pub(super) fn may_stray(needs: &Needs) -> bool {
        let takes = needs.diffuse || needs.scattering;
        needs.specular && takes && !needs.turbid_air
    }

    /// Finds out how photons are emitted in a frame beside these beams; `None` where none bring anything.
    pub fn strays<'a>(
        &self,
        frame: &Frame,
        beams: Option<&'a Beams>,
        seed: SampleSeed,
    ) -> Option<StrayFrame<'a>> {
        let [width, height] = frame.views.opening.resolution();
        let emission = Some(Emission::of_suns(frame, SunStarts::even(frame.lights.suns.len())));
        let emission = emission.filter(|e| Self::may_stray(&frame.needs) && e.is_possible())?;
        let strays = Strays { beams };
        let count = self.settings.count_of_strays(width.saturating_mul(height));
        let radii = Radii { caustic: 0.0, global: 0.0, volume: 0.0 };
        StrayFrame { mapper: *self, seed, strays, emission, count, radii }.guided(frame)
    }
}

impl StrayFrame<'_> {
    /// Emits the photons of pass `index` and puts them into maps; `None` when it is told to stop.
    pub fn pass(
        &self,
        frame: &Frame,
        index: u32,
        stops: &(dyn Fn() -> bool + Sync),
    ) -> Option<(StrayPass, Counters)> {
        let (wavelengths, time) = common_of_pass(frame, self.seed, index);
        let arrivals = self.trace(frame, index, self.count, stops);
        if stops() {
            return None;
        }
        let settings = &self.mapper.settings;
        let radii = self.radii.shrunk(index, settings.shrink.into());
        let pass = StrayPass {
            wavelengths,
            time,
            surface: PhotonMap::new(&arrivals.caustic, radii.caustic),
            volume: PhotonMap::new(&arrivals.volume, radii.volume),
            kernel: settings.kernel,
        };
        Some((pass, arrivals.counters))
    }

    fn trace(&self, frame: &Frame, pass: u32, count: u32, stops: &(dyn Fn() -> bool + Sync)) -> Arrivals {
        let (wavelengths, time) = &common_of_pass(frame, self.seed, pass);
        self.tracing(frame, (wavelengths, *time), count).run(self.stream(pass), stops)
    }

    fn tracing<'b>(
        &'b self,
        frame: &'b Frame,
        (wavelengths, time): (&'b Wavelengths, f32),
        count: u32,
    ) -> Tracing<'b> {
        Tracing {
            frame,
            emission: &self.emission,
            wavelengths,
            time,
            count,
            max_depth: self.mapper.path.interactions(),
            volume_share: 1.0,
            strays: Some(self.strays),
        }
    }

    /// The numbers of the photons of a pass.
    fn stream(&self, pass: u32) -> impl Fn(u32) -> SampleStream + Sync + use<> {
        let (seed, count) = (self.seed, self.count);
        move |photon| SampleStream::of_photon(seed, pass, 0, count, photon)
    }
}
