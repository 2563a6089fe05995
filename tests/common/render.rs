//! Renders a scene file through the library, without a process of its own.

use std::path::Path;

use floe::driver::job::Job;
use floe::driver::preview;
use floe::driver::tiles::{Sampling, render_pixels};
use floe::film::FrameImage;
use floe::integrator::Counters;
use floe::sampling::SampleSeed;
use floe::scene::frame::Frame;
use glam::DVec3;

/// A scene whose first frame is ready for rays.
pub struct Prepared {
    pub frame: Frame,
    pub sampling: Sampling,
}

/// A rendered picture.
pub struct Rendered {
    pub image: FrameImage,
    pub counters: Counters,
}

/// Opens a scene file and assembles its first frame.
pub fn prepare(file: &Path) -> Prepared {
    prepare_task(file, 0)
}

/// As [`prepare`], of the frame that is so many after the first.
///
/// # Panics
/// As [`prepare`], and when there are not so many.
pub fn prepare_task(file: &Path, index: usize) -> Prepared {
    frame_of(&Job::open(file).unwrap_or_else(|e| panic!("{}: {e}", file.display())), index)
}

/// As [`prepare_task`], at a quarter of the width and height.
///
/// # Panics
/// As [`prepare_task`].
pub fn prepare_preview(file: &Path, index: usize) -> Prepared {
    frame_of(&preview::open(file).unwrap_or_else(|e| panic!("{}: {e}", file.display())), index)
}

fn frame_of(job: &Job, index: usize) -> Prepared {
    let task = job.tasks().swap_remove(index);
    let meshes = task.read(&job.world).unwrap_or_else(|e| panic!("{e}")).meshes;
    let assembled = job.world.assemble(task.number, meshes, None).unwrap_or_else(|e| panic!("{e}"));
    let mut sampling = Sampling::new(&job.world.description.render);
    sampling.integrator = sampling.integrator.on(&assembled.frame.needs);
    sampling.seed.frame = task.number.millionths();
    Prepared { frame: assembled.frame, sampling }
}

impl Prepared {
    /// Renders with so many samples a pixel.
    ///
    /// A point in a medium may lie on the wrong side of a surface by its rounding, so about one flight in a million may find
    /// another medium than it expects.
    ///
    /// # Panics
    /// When labels disagree more often, or a radiance is not finite.
    pub fn render(&self, samples: u32, seed: u64) -> Rendered {
        let seed = SampleSeed { seed, ..self.sampling.seed };
        let sampling = Sampling { samples, seed, ..self.sampling.clone() };
        let (image, counters) = render_pixels(&self.frame, &sampling, &|_, _| ());
        let rare = counters.label_mismatches + counters.escaped_inside;
        let limit = ((counters.rays + counters.untraced) as f64 * 2e-6).max(3.0);
        assert!(rare as f64 <= limit, "labels disagree with the path's medium: {counters:?}");
        assert_eq!(counters.non_finite, 0, "radiance that is not finite: {counters:?}");
        Rendered { image, counters }
    }
}

impl Rendered {
    /// The mean of pictures of different seeds.
    pub fn pooled(mut pictures: Vec<Self>) -> Self {
        let count = pictures.len() as f32;
        let mut sum = pictures.swap_remove(0);
        for picture in &pictures {
            for (pixel, other) in sum.image.pixels.iter_mut().zip(&picture.image.pixels) {
                pixel.rgb += other.rgb;
                pixel.variance += other.variance;
            }
            sum.counters += picture.counters;
        }
        for pixel in &mut sum.image.pixels {
            pixel.rgb /= count;
            pixel.variance /= count * count;
        }
        sum
    }

    /// Linear RGB of a pixel.
    pub fn rgb(&self, x: u32, y: u32) -> DVec3 {
        self.image.pixels[(y * self.image.width + x) as usize].rgb.as_dvec3()
    }

    /// Mean over all pixels, and its standard error from the pixels' own variances.
    pub fn mean(&self) -> (DVec3, DVec3) {
        self.block_mean([0, 0], [self.image.width, self.image.height])
    }

    /// Mean and standard error over the block from `start` of `size` pixels.
    pub fn block_mean(&self, start: [u32; 2], size: [u32; 2]) -> (DVec3, DVec3) {
        let (mut sum, mut variance) = (DVec3::ZERO, DVec3::ZERO);
        for y in start[1]..start[1] + size[1] {
            for x in start[0]..start[0] + size[0] {
                let pixel = &self.image.pixels[(y * self.image.width + x) as usize];
                sum += pixel.rgb.as_dvec3();
                variance += pixel.variance.as_dvec3();
            }
        }
        let n = f64::from(size[0] * size[1]);
        (sum / n, DVec3::from_array(variance.to_array().map(f64::sqrt)) / n)
    }

    /// Greatest deviation of any channel of any pixel from `expected`, with its pixel.
    pub fn worst_deviation(&self, expected: DVec3) -> (f64, (u32, u32)) {
        let width = self.image.width;
        let deviation = |p: &floe::film::Pixel| (p.rgb.as_dvec3() - expected).abs().max_element();
        let pixels = self.image.pixels.iter().zip(0_u32..);
        let (worst, at) = pixels
            .map(|(p, i)| (deviation(p), i))
            .fold((0.0, 0), |best, this| if this.0 > best.0 { this } else { best });
        (worst, (at % width, at / width))
    }
}
