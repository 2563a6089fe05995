//! The pixels of one frame, tile by tile over all threads.
//!
//! A sample depends on its pixel and index alone and a tile's pixels are its own, so neither the number of threads nor
//! the order of the tiles changes a bit. Neither does it matter when rendering is broken off and how often: what is done
//! is kept in an [`Accumulation`], in which no sample is there twice and none by half.

use std::time::Instant;

use super::accumulation::Accumulation;
use super::halves::HalfRounds;
use super::ladder::Ladder;
use super::ledger::BeamRecord;
use super::stopping::{StoppedBy, Target};
use crate::film::{FilmSample, Filter, FrameImage};
use crate::integrator::{Beams, Counters, EyeSample, Integrator, Pass, PreparedLight, Scratch};
use crate::sampling::{SampleSeed, SampleStream};
use crate::scene::camera::Camera;
use crate::scene::description::RenderDescription;
use crate::scene::frame::Frame;
use crate::spectrum::{Lanes, Wavelengths, film_rgb};

/// How a frame's pixels are sampled.
#[derive(Clone, Debug)]
pub struct Sampling {
    /// Radiance of a sample.
    pub integrator: Integrator,
    /// Where samples lie in a pixel.
    pub filter: Filter,
    /// Samples a pixel, at most.
    pub samples: u32,
    /// What samples depend on besides pixel and index.
    pub seed: SampleSeed,
    /// Pixels have fewer samples where these are enough.
    pub target: Option<Target>,
}

impl Sampling {
    /// What the scene asks for, at frame 0.
    pub fn new(settings: &RenderDescription) -> Self {
        Self {
            integrator: Integrator::new(settings),
            filter: Filter::new(settings.filter),
            samples: settings.samples,
            seed: SampleSeed::new(settings.seed),
            target: settings.target_error.map(|error| Target { error, confidence: settings.confidence }),
        }
    }
}

/// Watches over the rendering of a frame, from any thread.
pub trait Control: Sync {
    /// Hears how much is done, and of how much.
    fn progress(&self, _done: usize, _of: usize) {}
    /// Whether to break off between two samples; asked often.
    fn stops(&self) -> bool {
        false
    }
    /// Whether to rest between two pixels, or two passes, so that what is done can be saved; until it is saved.
    fn wants_save(&self) -> bool {
        false
    }
    /// Seconds that are left for the frame; `None` without end.
    fn seconds_left(&self) -> Option<f64> {
        None
    }
    /// Saves what is done; nothing is rendered meanwhile.
    fn save(&self, _accumulation: &Accumulation) {}
    /// Hears what the beams of the frame take, once they are built.
    fn built(&self, _beams: BeamRecord) {}
    /// Sees the radiance of every sample, lane by lane.
    fn sampled(&self, _radiance: Lanes) {}
}

/// Renders all pixels; `progress` hears how much is done, and of how much.
pub fn render_pixels(
    frame: &Frame,
    sampling: &Sampling,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> (FrameImage, Counters) {
    struct Unwatched<'a>(&'a (dyn Fn(usize, usize) + Sync));
    impl Control for Unwatched<'_> {
        fn progress(&self, done: usize, of: usize) {
            (self.0)(done, of);
        }
    }
    let mut accumulation = Accumulation::new(frame.views.opening.resolution());
    accumulate(&mut accumulation, frame, sampling, &Unwatched(progress));
    accumulation.finish()
}

/// Goes on with a frame until it needs no more samples, and says why not; `None` when it was told to stop before.
pub fn accumulate(
    accumulation: &mut Accumulation,
    frame: &Frame,
    sampling: &Sampling,
    control: &dyn Control,
) -> Option<StoppedBy> {
    let sampling = &Sampling { integrator: sampling.integrator.on(&frame.needs), ..sampling.clone() };
    let beams = match &sampling.integrator {
        Integrator::Beams(_) => build_beams(frame, control),
        _ => None,
    };
    let work = Work { frame, sampling, control, beams: beams.as_ref() };
    let seconds_left = control.seconds_left();
    if let Some(emitters) = sampling.integrator.emitters(frame, beams.as_ref(), sampling.seed) {
        return work.passes(accumulation, &emitters, seconds_left);
    }
    match sampling.target {
        None => work.uniform(accumulation),
        Some(target) => {
            let sample =
                |scratch: &mut Scratch, at: (u32, u32), index: u32| work.sample(scratch, at, index, None);
            let ladder = Ladder { limit: sampling.samples };
            HalfRounds { target, ladder, control, sample: &sample }.run(accumulation)
        }
    }
}

fn build_beams(frame: &Frame, control: &dyn Control) -> Option<Beams> {
    let start = Instant::now();
    let beams = Beams::new(frame);
    let seconds = start.elapsed().as_secs_f64();
    let [count, bytes] = beams.as_ref().map_or([0, 0], |beams| [beams.len(), beams.bytes()]);
    control.built(BeamRecord { beams: count, beam_bytes: bytes, beam_seconds: seconds });
    beams
}

/// What is to be done at every pixel.
#[derive(Clone, Copy)]
pub(super) struct Work<'a> {
    pub frame: &'a Frame,
    pub sampling: &'a Sampling,
    pub control: &'a dyn Control,
    pub beams: Option<&'a Beams>,
}

impl Work<'_> {
    /// Sample `index` of a pixel; its wavelengths and time are those of its pass, where it has one.
    pub(super) fn sample(
        &self,
        scratch: &mut Scratch,
        at: (u32, u32),
        index: u32,
        pass: Option<&Pass>,
    ) -> FilmSample {
        let Self { frame, sampling, beams, .. } = *self;
        let (x, y) = at;
        let mut stream = SampleStream::new(sampling.seed, x, y, index);
        let [u, v, w, t] = stream.next4();
        let offset = sampling.filter.sample([u, v]);
        let own = |stream: &mut SampleStream| (frame.wavelengths(w, stream), frame.views.time(t));
        let (wavelengths, time) = pass.map_or_else(|| own(&mut stream), Pass::common);
        let camera = frame.views.at(time);
        let (x, y) = (x as f32 + 0.5 + offset.x, y as f32 + 0.5 + offset.y);
        let eye = if camera.has_lens() {
            let [u, v, ..] = stream.next4();
            camera.ray_through_lens(x, y, [u, v])
        } else {
            camera.ray(x, y)
        };
        let eye = eye.at_time(time);
        let light =
            pass.map_or(PreparedLight { beams, ..PreparedLight::default() }, |pass| pass.light(beams));
        let sample = sampling.integrator.sample(frame, scratch, &eye, &wavelengths, stream, light);
        self.control.sampled(sample.radiance);
        film_sample(frame, (&camera, time), &sample, &wavelengths)
    }
}

fn film_sample(
    frame: &Frame,
    (camera, time): (&Camera, f32),
    sample: &EyeSample,
    wavelengths: &Wavelengths,
) -> FilmSample {
    let radiance = film_rgb(frame.mode, wavelengths, sample.radiance);
    match &sample.first {
        None => FilmSample::of_sky(radiance),
        Some(first) => FilmSample {
            radiance,
            alpha: 1.0,
            albedo: frame.colour_of(first.albedo, wavelengths),
            normal: first.normal,
            position: (frame.origin + first.position.as_dvec3()).as_vec3(),
            depth: camera.depth(first.position),
            motion: frame.views.motion(camera, time, first.position, first.motion),
            hit: true,
        },
    }
}
