//! The pixels of one frame, tile by tile over all threads.
//!
//! A sample depends on its pixel and index alone and a tile's pixels are its own, so neither the number of threads nor
//! the order of the tiles changes a bit.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::film::{FilmSample, Filter, FrameImage, Pixel, PixelAccumulator, Tile, TileRect, tiles};
use crate::integrator::{Counters, EyeSample, Integrator, PhotonFrame, PhotonPass, Scratch};
use crate::sampling::{REPLICATES, SampleSeed, SampleStream};
use crate::scene::description::RenderDescription;
use crate::scene::frame::Frame;
use crate::spectrum::{Wavelengths, film_rgb};

/// Edge of a tile in pixels.
const TILE_SIZE: u32 = 16;

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

/// Renders all pixels; `progress` hears of the tiles done and their number.
pub fn render_pixels(
    frame: &Frame,
    sampling: &Sampling,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> (FrameImage, Counters) {
    let [width, height] = frame.camera.resolution();
    let rects = tiles(width, height, TILE_SIZE);
    let (tiles, mut counters) = match &sampling.integrator {
        Integrator::Photon(mapper) => {
            let photons = mapper.prepare(frame, sampling.seed);
            match photons.count() {
                // Nothing emits photons, or nothing takes them.
                0 => one_after_the_other(frame, sampling, &rects, progress),
                _ => passes(frame, sampling, &photons, &rects, progress),
            }
        }
        _ => one_after_the_other(frame, sampling, &rects, progress),
    };
    let image = FrameImage::from_tiles(width, height, tiles);
    counters.non_finite = image.rejected();
    (image, counters)
}

/// Each tile with all its samples.
fn one_after_the_other(
    frame: &Frame,
    sampling: &Sampling,
    rects: &[TileRect],
    progress: &(dyn Fn(usize, usize) + Sync),
) -> (Vec<Tile>, Counters) {
    let done = AtomicUsize::new(0);
    let rendered: Vec<(Tile, Counters)> = rects
        .par_iter()
        .map_init(Scratch::default, |scratch, rect| {
            scratch.counters = Counters::default();
            let tile = render_tile(frame, sampling, scratch, *rect);
            progress(done.fetch_add(1, Ordering::Relaxed) + 1, rects.len());
            (tile, scratch.counters)
        })
        .collect();
    let mut counters = Counters::default();
    let tiles = rendered.into_iter().map(|(tile, events)| {
        counters += events;
        tile
    });
    (tiles.collect(), counters)
}

/// All tiles with one sample a pixel, each time with other photons; the sums of all pixels are kept in between.
fn passes(
    frame: &Frame,
    sampling: &Sampling,
    of_all: &PhotonFrame,
    rects: &[TileRect],
    progress: &(dyn Fn(usize, usize) + Sync),
) -> (Vec<Tile>, Counters) {
    let mut sums: Vec<Vec<PixelAccumulator>> =
        rects.iter().map(|rect| vec![PixelAccumulator::new(); rect.area()]).collect();
    let mut counters = Counters::default();
    let (done, total) = (AtomicUsize::new(0), rects.len().saturating_mul(sampling.samples as usize));
    for index in 0..sampling.samples {
        let (photons, events) = of_all.pass(frame, index);
        counters += events;
        let tiles = sums.par_iter_mut().zip(rects).map_init(Scratch::default, |scratch, (sums, rect)| {
            scratch.counters = Counters::default();
            for (sum, (x, y)) in sums.iter_mut().zip(rect.pixels()) {
                add_sample(frame, sampling, scratch, sum, [x, y], index, Some(&photons));
            }
            progress(done.fetch_add(1, Ordering::Relaxed) + 1, total);
            scratch.counters
        });
        tiles.collect::<Vec<Counters>>().into_iter().for_each(|events| counters += events);
    }
    let tile = |(sums, rect): (&Vec<PixelAccumulator>, &TileRect)| Tile {
        rect: *rect,
        pixels: sums.iter().map(PixelAccumulator::finish).collect(),
    };
    (sums.iter().zip(rects).map(tile).collect(), counters)
}

fn render_tile(frame: &Frame, sampling: &Sampling, scratch: &mut Scratch, rect: TileRect) -> Tile {
    let pixels = rect.pixels().map(|(x, y)| render_pixel(frame, sampling, scratch, [x, y])).collect();
    Tile { rect, pixels }
}

fn render_pixel(frame: &Frame, sampling: &Sampling, scratch: &mut Scratch, at: [u32; 2]) -> Pixel {
    let mut pixel = PixelAccumulator::new();
    for index in 0..sampling.samples {
        add_sample(frame, sampling, scratch, &mut pixel, at, index, None);
    }
    pixel.finish()
}

/// Adds sample `index` of a pixel; `photons` are those of its pass, whose wavelengths it takes.
fn add_sample(
    frame: &Frame,
    sampling: &Sampling,
    scratch: &mut Scratch,
    pixel: &mut PixelAccumulator,
    [x, y]: [u32; 2],
    index: u32,
    photons: Option<&PhotonPass>,
) {
    let mut stream = SampleStream::new(sampling.seed, x, y, index);
    let [u, v, w, _] = stream.next4();
    let offset = sampling.filter.sample([u, v]);
    let wavelengths = photons.map_or_else(|| Wavelengths::for_mode(frame.mode, w), |pass| pass.wavelengths);
    let point = [x as f32 + 0.5 + offset.x, y as f32 + 0.5 + offset.y];
    let sample = sampling.integrator.sample(frame, scratch, point, &wavelengths, stream, photons);
    pixel.add((index % REPLICATES) as usize, &film_sample(frame, &sample, &wavelengths));
}

fn film_sample(frame: &Frame, sample: &EyeSample, wavelengths: &Wavelengths) -> FilmSample {
    let radiance = film_rgb(frame.mode, wavelengths, sample.radiance);
    match &sample.first {
        None => FilmSample::of_sky(radiance),
        Some(first) => FilmSample {
            radiance,
            alpha: 1.0,
            albedo: frame.colour_of(first.albedo, wavelengths),
            normal: first.normal,
            position: (frame.origin + first.position.as_dvec3()).as_vec3(),
            depth: frame.camera.depth(first.position),
            hit: true,
        },
    }
}
