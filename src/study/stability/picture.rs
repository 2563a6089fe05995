//! A rendered picture of the battery, what was seen of its samples one by one, and its means.

use std::sync::Mutex;

use glam::DVec3;

use super::scene::Prepared;
use crate::driver::accumulation::Accumulation;
use crate::driver::tiles::{Control, accumulate};
use crate::film::FrameImage;
use crate::integrator::Counters;
use crate::spectrum::Lanes;

/// A picture and what happened on the way.
#[derive(Clone, Debug)]
pub struct Picture {
    /// The pixels.
    pub image: FrameImage,
    /// Rays, and what ought to be rare.
    pub counters: Counters,
    /// Samples traced.
    pub samples: u64,
    /// What no sample may be.
    pub spoilt: Spoilt,
}

/// Samples whose radiance is not a radiance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Spoilt {
    /// With a lane that is infinite or not a number.
    pub not_finite: u64,
    /// With a lane below zero.
    pub negative: u64,
}

/// Looks at each sample before the film takes means, in which one negative sample would not be noticed.
#[derive(Default)]
struct Inspector(Mutex<Spoilt>);

impl Control for Inspector {
    fn sampled(&self, radiance: Lanes) {
        let negative = radiance.min_element() < 0.0;
        if (negative || !radiance.is_finite())
            && let Ok(mut spoilt) = self.0.lock()
        {
            spoilt.not_finite += u64::from(!radiance.is_finite());
            spoilt.negative += u64::from(negative);
        }
    }
}

/// Renders all pixels.
pub fn render(scene: &Prepared) -> Picture {
    let resolution = scene.frame.views.opening.resolution();
    let mut accumulation = Accumulation::new(resolution);
    let inspector = Inspector::default();
    accumulate(&mut accumulation, &scene.frame, &scene.sampling, &inspector);
    let (image, counters) = accumulation.finish();
    let samples = image.pixels.len() as u64 * u64::from(scene.sampling.samples);
    let spoilt = inspector.0.into_inner().unwrap_or_default();
    Picture { image, counters, samples, spoilt }
}

impl Picture {
    /// Mean over all pixels, and its standard error from the pixels' own variances.
    pub fn mean(&self) -> (DVec3, DVec3) {
        self.block_mean([0, 0], [self.image.width, self.image.height])
    }

    /// Mean and standard error over the block from `start` of `size` pixels.
    pub fn block_mean(&self, start: [u32; 2], size: [u32; 2]) -> (DVec3, DVec3) {
        let (mut sum, mut variance) = (DVec3::ZERO, DVec3::ZERO);
        for y in start[1]..start[1] + size[1] {
            for pixel in &self.image.row(y)[start[0] as usize..(start[0] + size[0]) as usize] {
                sum += pixel.rgb.as_dvec3();
                variance += pixel.variance.as_dvec3();
            }
        }
        let n = f64::from(size[0]) * f64::from(size[1]);
        (sum / n, DVec3::from_array(variance.to_array().map(f64::sqrt)) / n)
    }

    /// The channel of the pixel that is farthest from `expected`.
    pub fn farthest(&self, expected: f64) -> f64 {
        let channels = self.image.pixels.iter().flat_map(|p| p.rgb.to_array()).map(f64::from);
        // What is not a number is farthest of all.
        let distance = |x: &f64| if x.is_nan() { f64::INFINITY } else { (x - expected).abs() };
        channels.max_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(f64::NAN)
    }
}
