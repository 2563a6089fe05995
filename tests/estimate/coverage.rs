//! How often the error of a picture lies in the interval that it states.

use floe::film::{FrameImage, LUMINANCE_FLOOR, estimate_error};
use floe::integrator::Integrator;
use floe::spectrum::luminance::luminance_f64;

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
        tally(samples, pictures.iter().filter(|(n, _)| *n == samples).map(|(_, image)| image), &mean, own)
    };
    plan.iter().map(tally).collect()
}

fn tally<'a>(samples: u32, images: impl Iterator<Item = &'a FrameImage>, truth: &[f64], own: f64) -> Tally {
    let mut tally = Tally { samples, ..Tally::default() };
    for image in images {
        let square = |(l, mu): (f64, &f64)| (l - mu).powi(2) / (mu * mu + LUMINANCE_FLOOR.powi(2));
        let sum: f64 = luminances(image).into_iter().zip(truth).map(square).sum();
        let error2 = sum / truth.len() as f64 / (1.0 - own);
        let error = error2.sqrt();
        let mut is_held = [false; 2];
        for (is_held, confidence) in is_held.iter_mut().zip([0.95, 0.68]) {
            let Some(estimate) = estimate_error(image, confidence) else { panic!("no estimate") };
            *is_held = estimate.low <= error && error <= estimate.high;
            if confidence > 0.9 {
                let is_warned = estimate.warning().is_some();
                tally.warned += u32::from(is_warned);
                tally.silent += u32::from(!is_warned && !*is_held);
                tally.estimated2 += estimate.relative.powi(2);
                tally.width +=
                    (estimate.high - estimate.low).min(10.0 * estimate.relative) / estimate.relative;
            }
        }
        tally.held.iter_mut().zip(is_held).for_each(|(count, held)| *count += u32::from(held));
        tally.pictures += 1;
        tally.error2 += error2;
    }
    for mean in [&mut tally.error2, &mut tally.estimated2, &mut tally.width] {
        *mean /= f64::from(tally.pictures);
    }
    tally
}
