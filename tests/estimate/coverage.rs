//! How often the error of a picture lies in the interval that it states.

use std::collections::BTreeMap;

use floe::driver::Target;
use floe::film::{FrameImage, LUMINANCE_FLOOR, estimate_error};
use floe::integrator::Integrator;
use floe::spectrum::luminance::luminance_f64;

use crate::common::render::Prepared;
use crate::scenes::Scene;

/// The pictures of one scene with one number of samples.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    pub samples: u32,
    pub pictures: u32,
    /// Intervals of 95 and of 68 % that hold the error.
    pub held: [u32; 2],
    /// Pictures with a warning.
    pub warned: u32,
    /// Pictures whose interval of 95 % does not hold the error, without a warning.
    pub silent: u32,
    /// Pictures whose pixels have unlike numbers of samples.
    pub uneven: u32,
    /// Mean squared error, and that of the estimates.
    pub error2: f64,
    pub estimated2: f64,
    /// Mean width of the interval of 95 %, relative to the estimate, where it ends.
    pub width: f64,
}

impl Tally {
    pub fn rate(&self, confidence: usize) -> f64 {
        f64::from(self.held[confidence]) / f64::from(self.pictures)
    }

    /// The line of a table.
    pub fn line(&self, name: &str) -> String {
        format!(
            "| {name} | {} | {:.2} % | {:.2} | {:.2} | {:.3} | {:.3} | {:.2} |",
            self.samples,
            100.0 * self.error2.sqrt(),
            (self.estimated2 / self.error2).sqrt(),
            self.width,
            self.rate(0),
            self.rate(1),
            f64::from(self.warned) / f64::from(self.pictures)
        )
    }
}

fn luminances(image: &FrameImage) -> Vec<f64> {
    image.pixels.iter().map(|p| luminance_f64(p.rgb.as_dvec3())).collect()
}

/// Pictures with the samples and seeds of each of `plan`, and one of so many samples more.
///
/// What the pictures converge to is their mean, each counted by its samples: of all of them, or of those with as many
/// samples where photons are spread by how many passes there are. A picture has a part of that mean and is nearer to it
/// than to the truth, by that part of its variance.
pub fn tallies(scene: &Scene, times: u32, plan: &[(u32, u32)], more: u32) -> Vec<Tally> {
    let prepared = scene.prepare(times);
    let is_biased = matches!(prepared.sampling.integrator, Integrator::Photon(_));
    let mut pictures: Vec<(u32, FrameImage)> = Vec::new();
    for &(samples, seeds) in plan {
        pictures
            .extend((0..seeds).map(|seed| (samples, prepared.render(samples, 1000 + u64::from(seed)).image)));
    }
    let further = (!is_biased && more > 0).then(|| (more, prepared.render(more, 1).image));
    let mean_of = |samples: Option<u32>| {
        let mut mean = vec![0.0; pictures[0].1.pixels.len()];
        let mut total = 0.0;
        let counted = |n: u32| samples.is_none_or(|samples| samples == n);
        for (n, image) in pictures.iter().chain(&further).filter(|(n, _)| counted(*n)) {
            total += f64::from(*n);
            mean.iter_mut().zip(luminances(image)).for_each(|(mean, l)| *mean += f64::from(*n) * l);
        }
        mean.iter_mut().for_each(|mean| *mean /= total);
        (mean, total)
    };
    let tally = |&(samples, _): &(u32, u32)| {
        let (mean, total) = mean_of(is_biased.then_some(samples));
        let own = f64::from(samples) / total;
        let truth = Truth { mean, own, noise: 0.0 };
        let mut tally = Tally { samples, ..Tally::default() };
        let images = pictures.iter().filter(|(n, _)| *n == samples);
        images.for_each(|(_, image)| tally.add(image, &truth));
        tally.divided()
    };
    plan.iter().map(tally).collect()
}

/// Pictures of so many seeds that stop at a target, against one of `more` samples; by photons against the mean of the
/// plain pictures of all seeds with as many passes as each has.
pub fn stopped(scene: &Scene, error: f64, seeds: u32, more: u32) -> Tally {
    let mut prepared = scene.prepare(2);
    let plain = |prepared: &Prepared, samples, seed| prepared.render(samples, seed).image;
    let is_biased = matches!(prepared.sampling.integrator, Integrator::Photon(_));
    let mut truths: BTreeMap<u32, Truth> = BTreeMap::new();
    if !is_biased {
        truths.insert(0, Truth::of(&plain(&prepared, more, 1)));
    }
    let mut tally = Tally::default();
    for seed in 1000..1000 + u64::from(seeds) {
        prepared.sampling.target = Some(Target { error, confidence: 0.95 });
        let image = prepared.render(4096, seed).image;
        prepared.sampling.target = None;
        let samples = if is_biased { image.pixels[0].samples } else { 0 };
        let truth = truths.entry(samples).or_insert_with(|| {
            let pictures = (1000..1000 + u64::from(seeds)).map(|seed| plain(&prepared, samples, seed));
            Truth::mean_of(&pictures.collect::<Vec<_>>())
        });
        tally.add(&image, truth);
        tally.samples += (image.samples() / image.pixels.len() as u64) as u32;
        tally.uneven += u32::from(image.pixels.iter().any(|p| p.samples != image.pixels[0].samples));
    }
    tally.samples /= seeds;
    tally.divided()
}

/// What the pictures of a scene converge to.
struct Truth {
    mean: Vec<f64>,
    /// Part of the mean that each of the pictures has.
    own: f64,
    /// Squared error of the mean, of which the pictures know nothing.
    noise: f64,
}

impl Truth {
    /// Of a picture with many samples.
    fn of(image: &FrameImage) -> Self {
        let mean = luminances(image);
        let variances = image.pixels.iter().map(|p| f64::from(p.luminance_variance));
        let noise = variances.zip(&mean).map(|(v, mu)| v / floored(*mu)).sum::<f64>() / mean.len() as f64;
        Self { mean, own: 0.0, noise }
    }

    /// Of pictures that are themselves compared with it.
    fn mean_of(images: &[FrameImage]) -> Self {
        let n = images.len() as f64;
        let mut mean = vec![0.0; images[0].pixels.len()];
        for image in images {
            mean.iter_mut().zip(luminances(image)).for_each(|(mean, l)| *mean += l / n);
        }
        Self { mean, own: 1.0 / n, noise: 0.0 }
    }
}

fn floored(luminance: f64) -> f64 {
    luminance * luminance + LUMINANCE_FLOOR.powi(2)
}

impl Tally {
    fn add(&mut self, image: &FrameImage, truth: &Truth) {
        let square = |(l, mu): (f64, &f64)| (l - mu).powi(2) / floored(*mu);
        let sum: f64 = luminances(image).into_iter().zip(&truth.mean).map(square).sum();
        let error2 = (sum / truth.mean.len() as f64 - truth.noise) / (1.0 - truth.own);
        let error = error2.sqrt();
        let mut is_held = [false; 2];
        for (is_held, confidence) in is_held.iter_mut().zip([0.95, 0.68]) {
            let Some(estimate) = estimate_error(image, confidence) else { panic!("no estimate") };
            *is_held = estimate.low <= error && error <= estimate.high;
            if confidence > 0.9 {
                let is_warned = estimate.warning().is_some();
                self.warned += u32::from(is_warned);
                self.silent += u32::from(!is_warned && !*is_held);
                self.estimated2 += estimate.relative.powi(2);
                self.width +=
                    (estimate.high - estimate.low).min(10.0 * estimate.relative) / estimate.relative;
            }
        }
        self.held.iter_mut().zip(is_held).for_each(|(count, held)| *count += u32::from(held));
        self.pictures += 1;
        self.error2 += error2;
    }

    /// With means in place of sums.
    fn divided(mut self) -> Self {
        let n = f64::from(self.pictures);
        [&mut self.error2, &mut self.estimated2, &mut self.width].into_iter().for_each(|sum| *sum /= n);
        self
    }
}
