//! The pixels of one frame, tile by tile over all threads.
//!
//! A sample depends on its pixel and index alone and a tile's pixels are its own, so neither the number of threads nor
//! the order of the tiles changes a bit. Neither does it matter when rendering is broken off and how often: what is done
//! is kept in an [`Accumulation`], in which no sample is there twice and none by half.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use rayon::prelude::*;

use super::accumulation::{Accumulation, TilePart};
use crate::film::{FilmSample, Filter, FrameImage, PixelAccumulator, TileRect};
use crate::integrator::{Counters, EyeSample, Integrator, PhotonFrame, PhotonPass, Scratch};
use crate::sampling::{REPLICATES, SampleSeed, SampleStream};
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
    /// Samples a pixel.
    pub samples: u32,
    /// What samples depend on besides pixel and index.
    pub seed: SampleSeed,
}

impl Sampling {
    /// What the scene asks for, at frame 0.
    pub fn new(settings: &RenderDescription) -> Self {
        Self {
            integrator: Integrator::new(settings),
            filter: Filter::new(settings.filter),
            samples: settings.samples,
            seed: SampleSeed::new(settings.seed),
        }
    }
}

/// Watches over the rendering of a frame, from any thread.
pub trait Control: Sync {
    /// Hears of the tiles done, and of their number.
    fn progress(&self, _done: usize, _of: usize) {}
    /// Whether to break off between two samples; asked often.
    fn stops(&self) -> bool {
        false
    }
    /// Whether to rest between two pixels, or two passes, so that what is done can be saved; until it is saved.
    fn wants_save(&self) -> bool {
        false
    }
    /// Saves what is done; nothing is rendered meanwhile.
    fn save(&self, _accumulation: &Accumulation) {}
    /// Sees the radiance of every sample, lane by lane.
    fn sampled(&self, _radiance: Lanes) {}
}

/// Renders all pixels; `progress` hears of the tiles done and their number.
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

/// Goes on with a frame until every pixel has all its samples; false when it was told to stop before.
pub fn accumulate(
    accumulation: &mut Accumulation,
    frame: &Frame,
    sampling: &Sampling,
    control: &dyn Control,
) -> bool {
    let work = Work { frame, sampling, control };
    match &sampling.integrator {
        Integrator::Photon(mapper) => {
            let photons = mapper.prepare(frame, sampling.seed);
            match photons.count() {
                // Nothing emits photons, or nothing takes them.
                0 => work.one_after_the_other(accumulation),
                _ => work.passes(accumulation, &photons),
            }
        }
        _ => work.one_after_the_other(accumulation),
    }
}

/// What is to be done at every pixel.
#[derive(Clone, Copy)]
struct Work<'a> {
    frame: &'a Frame,
    sampling: &'a Sampling,
    control: &'a dyn Control,
}

impl Work<'_> {
    /// Each pixel with all its samples.
    fn one_after_the_other(&self, accumulation: &mut Accumulation) -> bool {
        while !accumulation.is_traced() {
            if self.control.stops() {
                return false;
            }
            if self.control.wants_save() {
                self.control.save(accumulation);
            }
            let total = accumulation.rects.len();
            let done = AtomicUsize::new(accumulation.traced());
            let gets_on = AtomicBool::new(false);
            let tiles = accumulation.parts.par_iter_mut().zip(&accumulation.rects);
            tiles.for_each_init(Scratch::default, |scratch, (part, rect)| {
                let was_done = part.pixels.len() == rect.area();
                if !was_done && self.trace(part, *rect, scratch, &gets_on) {
                    self.control.progress(done.fetch_add(1, Ordering::Relaxed) + 1, total);
                }
            });
        }
        true
    }

    /// Goes on with a tile; true when it is done. A pixel that is broken off begins anew. However often it rests to be
    /// saved, the frame `gets_on` by a pixel in between.
    fn trace(
        &self,
        part: &mut TilePart,
        rect: TileRect,
        scratch: &mut Scratch,
        gets_on: &AtomicBool,
    ) -> bool {
        part.pixels.reserve_exact(rect.area() - part.pixels.len());
        for at in rect.pixels().skip(part.pixels.len()) {
            if self.control.wants_save() && gets_on.load(Ordering::Relaxed) {
                return false;
            }
            scratch.counters = Counters::default();
            let mut pixel = PixelAccumulator::new();
            for index in 0..self.sampling.samples {
                if self.control.stops() {
                    return false;
                }
                self.add_sample(scratch, &mut pixel, at, index, None);
            }
            part.pixels.push(pixel.finish());
            gets_on.store(true, Ordering::Relaxed);
            part.counters += scratch.counters;
        }
        true
    }

    /// All tiles with one sample a pixel, each time with other photons; the sums of all pixels are kept in between.
    fn passes(&self, accumulation: &mut Accumulation, of_all: &PhotonFrame) -> bool {
        let Accumulation { rects, parts, .. } = accumulation;
        for (part, rect) in parts.iter_mut().zip(rects.iter()) {
            part.sums.resize(rect.area(), PixelAccumulator::new());
        }
        let first = parts.iter().map(|part| part.passes).min().unwrap_or(0);
        let total = rects.len().saturating_mul(self.sampling.samples as usize);
        let done = AtomicUsize::new(parts.iter().map(|part| part.passes as usize).sum());
        for index in first..self.sampling.samples {
            let Some((photons, events)) = of_all.pass(self.frame, index, &|| self.control.stops()) else {
                return false;
            };
            let tiles = accumulation.parts.par_iter_mut().zip(&accumulation.rects);
            let left = tiles.filter(|(part, _)| part.passes == index);
            left.for_each_init(Scratch::default, |scratch, (part, rect)| {
                if self.add_pass(part, *rect, scratch, index, &photons) {
                    self.control.progress(done.fetch_add(1, Ordering::Relaxed) + 1, total);
                }
            });
            if accumulation.parts.iter().any(|part| part.passes == index) {
                return false;
            }
            accumulation.counters += events;
            if self.control.wants_save() {
                self.control.save(accumulation);
            }
        }
        true
    }

    /// Goes on with the pass of a tile; true when it is done.
    fn add_pass(
        &self,
        part: &mut TilePart,
        rect: TileRect,
        scratch: &mut Scratch,
        index: u32,
        photons: &PhotonPass,
    ) -> bool {
        scratch.counters = Counters::default();
        for (pixel, at) in part.sums.iter_mut().zip(rect.pixels()).skip(part.ahead) {
            if self.control.stops() {
                break;
            }
            self.add_sample(scratch, pixel, at, index, Some(photons));
            part.ahead += 1;
        }
        part.counters += scratch.counters;
        let is_done = part.ahead == rect.area();
        if is_done {
            (part.passes, part.ahead) = (index + 1, 0);
        }
        is_done
    }

    /// Adds sample `index` of a pixel; `photons` are those of its pass, whose wavelengths and time it takes.
    fn add_sample(
        &self,
        scratch: &mut Scratch,
        pixel: &mut PixelAccumulator,
        at: (u32, u32),
        index: u32,
        photons: Option<&PhotonPass>,
    ) {
        let Self { frame, sampling, .. } = *self;
        let (x, y) = at;
        let mut stream = SampleStream::new(sampling.seed, x, y, index);
        let [u, v, w, t] = stream.next4();
        let offset = sampling.filter.sample([u, v]);
        let wavelengths =
            photons.map_or_else(|| Wavelengths::for_mode(frame.mode, w), |pass| pass.wavelengths);
        let time = photons.map_or_else(|| frame.views.time(t), |pass| pass.time);
        let camera = frame.views.at(time);
        let (x, y) = (x as f32 + 0.5 + offset.x, y as f32 + 0.5 + offset.y);
        let eye = if camera.has_lens() {
            let [u, v, ..] = stream.next4();
            camera.ray_through_lens(x, y, [u, v])
        } else {
            camera.ray(x, y)
        };
        let eye = eye.at_time(time);
        let sample = sampling.integrator.sample(frame, scratch, &eye, &wavelengths, stream, photons);
        self.control.sampled(sample.radiance);
        pixel.add((index % REPLICATES) as usize, &film_sample(frame, (&camera, time), &sample, &wavelengths));
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
