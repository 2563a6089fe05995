//! The picture that others are measured against, and how well it is known.
//!
//! It is the mean of [`PARTS`] pictures of their own seeds, so the variance V* of the mean follows from their spread,
//! whatever the samples of one picture have to do with each other. Errors of neighbours may be alike (photons are shared),
//! so the variance of a region S of n pixels is
//!
//! ```text
//! v = c sum over S of V* / n^2       c = sum over blocks of s^2 / PARTS  /  sum over blocks of (sum of V* / n^2)     (1)
//! ```
//!
//! where s^2 is the variance of a block's mean between the parts: c is 1 where pixels are independent. Channels are taken as
//! proportional for the luminance of V*, which c makes good on average.
//!
//! The file holds mean, variance and number of samples as any picture of floe's, and c and the rest as attributes. It is
//! taken again when its fingerprint is that of the picture that would be rendered.

use std::path::{Path, PathBuf};

use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};

use super::bias::{Bias, bias, luminances, region_counts, region_means};
use super::run::{Run, Watch};
use crate::driver::fingerprint::Fingerprint;
use crate::driver::picture::{FINGERPRINT, PictureState};
use crate::film::estimate::LUMINANCE_FLOOR;
use crate::film::exr_layers::read_layers;
use crate::film::exr_seal::text_attribute;
use crate::film::{FrameImage, ImageMetadata, Pixel, write_frame};
use crate::integrator::Integrator;
use crate::scene::description::{Aov, RenderDescription};
use crate::scene::frame::Frame;
use crate::spectrum::luminance::luminance_f64;
use crate::study::error::StudyError;
use crate::study::statistics::mean_and_variance;

/// Pictures that a reference is the mean of.
pub const PARTS: u32 = 8;

/// Attribute with what is known of a reference, as JSON.
const FACTS: &str = "floe:reference";

/// A reference.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Columns.
    pub width: usize,
    /// The mean, row after row.
    pub colours: Vec<Vec3>,
    /// V*, of each channel; zero where nothing is known.
    variances: Vec<Vec3>,
    /// What it is.
    pub facts: ReferenceFacts,
}

/// What a reference is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReferenceFacts {
    /// How it was rendered; empty when another program did.
    pub integrator: String,
    /// Samples a pixel; 0 when nothing says so.
    pub samples: u32,
    /// c of (1).
    pub correlation: f64,
    /// How another estimator that leaves nothing out compares.
    pub check: Option<CrossCheck>,
}

/// A picture of the same light by other means.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CrossCheck {
    /// By which.
    pub integrator: String,
    /// Samples a pixel.
    pub samples: u32,
    /// How it differs from the reference.
    pub bias: Bias,
}

/// What the reference's own noise adds to squared errors that are taken against it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Noise {
    /// To the mean squared error.
    pub mse: f64,
    /// To the mean of relMSE.
    pub relative_mse: f64,
    /// To the mean squared relative error of luminance.
    pub luminance: f64,
}

impl Reference {
    /// Reads a picture.
    ///
    /// # Errors
    /// When it cannot be read, or has another size.
    pub fn read(file: &Path, [width, height]: [u32; 2]) -> Result<Self, StudyError> {
        let refused = |reason: String| StudyError::Reference { file: file.into(), reason };
        let bytes = std::fs::read(file).map_err(|error| refused(error.to_string()))?;
        let picture = read_layers(&bytes).map_err(refused)?;
        if [picture.width, picture.height] != [width as usize, height as usize] {
            return Err(refused(format!(
                "it has {} x {} pixels, and the scene {width} x {height}: ask for these with --resolution",
                picture.width, picture.height
            )));
        }
        let samples = text_attribute(&bytes, "floe:samples").and_then(|n| n.parse().ok()).unwrap_or(0);
        let facts = text_attribute(&bytes, FACTS).and_then(|text| serde_json::from_str(text).ok());
        let integrator = text_attribute(&bytes, "floe:integrator").unwrap_or_default().to_owned();
        let facts = facts.unwrap_or(ReferenceFacts { integrator, samples, correlation: 1.0, check: None });
        let variances = picture.variances.unwrap_or_else(|| vec![Vec3::ZERO; picture.colours.len()]);
        Ok(Self { width: picture.width, colours: picture.colours, variances, facts })
    }

    /// What is there under a name, if it is the picture with this fingerprint.
    pub(super) fn again(file: &Path, fingerprint: &Fingerprint, resolution: [u32; 2]) -> Option<Self> {
        let is_it = PictureState::of(file, fingerprint) == PictureState::Complete;
        is_it.then(|| Self::read(file, resolution).ok()).flatten()
    }

    /// Renders one; `None` when it is broken off.
    pub(super) fn rendered(
        frame: &Frame,
        settings: &RenderDescription,
        watch: &Watch,
        part_done: impl FnMut(u32),
    ) -> Option<Self> {
        let (spread, regions) = parts(frame, settings, watch, part_done)?;
        let facts = ReferenceFacts {
            integrator: Integrator::new(settings).name().into(),
            samples: samples_of_part(settings.samples) * PARTS,
            correlation: 1.0,
            check: None,
        };
        let [width, _] = frame.views.opening.resolution();
        Some(Self::of_parts(width as usize, &spread, &regions, facts))
    }

    /// The mean of pictures, of which `regions` are the [`region_means`].
    fn of_parts(width: usize, spread: &Spread, regions: &[Vec<f64>], facts: ReferenceFacts) -> Self {
        let colours = spread.means().map(|m| m.as_vec3()).collect();
        let variances = spread.variances().map(|v| (v / regions.len() as f64).as_vec3()).collect();
        let mut reference = Self { width, colours, variances, facts };
        reference.facts.correlation = reference.correlation(regions);
        reference
    }

    /// Compares it with a picture of other settings; `None` when that is broken off.
    pub(super) fn checked_by(
        &self,
        frame: &Frame,
        settings: &RenderDescription,
        watch: &Watch,
        part_done: impl FnMut(u32),
    ) -> Option<CrossCheck> {
        let (_, regions) = parts(frame, settings, watch, part_done)?;
        Some(CrossCheck {
            integrator: Integrator::new(settings).name().into(),
            samples: samples_of_part(settings.samples) * PARTS,
            bias: bias(&regions, self),
        })
    }

    /// c of (1); 1 where nothing has noise.
    fn correlation(&self, parts: &[Vec<f64>]) -> f64 {
        let independent: f64 = self.region_variances().iter().skip(1).sum();
        let n = parts.len() as f64;
        let spread = |region: usize| {
            let means: Vec<f64> = parts.iter().map(|means| means[region]).collect();
            mean_and_variance(&means).1
        };
        let found = (1..parts[0].len()).map(spread).sum::<f64>() / n / independent;
        if found.is_finite() { found } else { 1.0 }
    }

    /// Writes it as a picture of a frame, with what is known of it.
    pub(super) fn write(
        &self,
        file: &Path,
        fingerprint: &Fingerprint,
        metadata: ImageMetadata,
    ) -> Result<(), StudyError> {
        let samples = self.facts.samples;
        let pixel = |(rgb, variance): (&Vec3, &Vec3)| Pixel {
            rgb: *rgb,
            variance: *variance,
            alpha: 1.0,
            samples,
            replicates: PARTS,
            ..Pixel::EMPTY
        };
        let pixels: Vec<Pixel> = self.colours.iter().zip(&self.variances).map(pixel).collect();
        let height = pixels.len() / self.width.max(1);
        let image = FrameImage { width: self.width as u32, height: height as u32, pixels };
        let attributes = vec![
            ("floe:integrator".into(), self.facts.integrator.clone()),
            (FINGERPRINT.into(), fingerprint.to_string()),
            (FACTS.into(), serde_json::to_string(&self.facts).unwrap_or_default()),
        ];
        let metadata = ImageMetadata { attributes, ..metadata };
        write_frame(&image, &metadata, file, None, &[Aov::Variance], 0.0)
            .map_err(|error| StudyError::Render(error.into()))
    }

    /// The root mean square of its noise.
    pub fn noise(&self) -> f64 {
        self.corrections().mse.sqrt()
    }

    pub(super) fn corrections(&self) -> Noise {
        let floor = LUMINANCE_FLOOR * LUMINANCE_FLOOR;
        let n = self.colours.len() as f64;
        let mut noise = Noise::default();
        for (colour, variance) in self.colours.iter().zip(&self.variances) {
            let (colour, sum) = (colour.as_dvec3(), variance.as_dvec3().element_sum());
            let luminance = luminance_f64(colour);
            noise.mse += sum / 3.0 / n;
            noise.relative_mse += sum / (colour.length_squared() + floor) / n;
            noise.luminance += luminance_variance(variance) / (luminance * luminance + floor) / n;
        }
        noise
    }

    /// The mean luminance of the whole and of each block.
    pub(super) fn region_means(&self) -> Vec<f64> {
        let luminance: Vec<f64> = self.colours.iter().map(|c| luminance_f64(c.as_dvec3())).collect();
        region_means(self.width, &luminance)
    }

    /// (1) of the whole and of each block.
    pub(super) fn region_variances(&self) -> Vec<f64> {
        let variances: Vec<f64> = self.variances.iter().map(luminance_variance).collect();
        let counts = region_counts(self.width, variances.len());
        let means = region_means(self.width, &variances);
        means.iter().zip(counts).map(|(mean, count)| self.facts.correlation * mean / count).collect()
    }
}

/// Renders the parts; `None` when it is broken off.
fn parts(
    frame: &Frame,
    settings: &RenderDescription,
    watch: &Watch,
    mut part_done: impl FnMut(u32),
) -> Option<(Spread, Vec<Vec<f64>>)> {
    let (mut spread, mut regions) = (Spread::default(), Vec::new());
    for part in 0..PARTS {
        let seed = settings.seed.wrapping_add(part.into());
        let image = Run::of(frame, settings, (samples_of_part(settings.samples), seed), watch)?.image;
        spread.add(image.pixels.iter().map(|pixel| pixel.rgb));
        regions.push(region_means(image.width as usize, &luminances(&image)));
        part_done(part + 1);
    }
    Some((spread, regions))
}

/// Samples of each part, so that their sum is at least what was asked for, in whole blocks of four.
fn samples_of_part(samples: u32) -> u32 {
    samples.div_ceil(PARTS).next_multiple_of(4)
}

/// Of a luminance whose channels vary together.
fn luminance_variance(variance: &Vec3) -> f64 {
    let deviation = luminance_f64(variance.as_dvec3().max(DVec3::ZERO).map(f64::sqrt));
    deviation * deviation
}

/// Where the reference of a study is kept.
pub(super) fn place(folder: &Path) -> PathBuf {
    folder.join("reference.exr")
}

/// Mean and variance of colours, one picture after the other, by Welford's update.
#[derive(Clone, Debug, Default)]
pub(super) struct Spread {
    count: f64,
    sums: Vec<(DVec3, DVec3)>,
}

impl Spread {
    pub fn add(&mut self, colours: impl ExactSizeIterator<Item = Vec3>) {
        self.sums.resize(colours.len(), (DVec3::ZERO, DVec3::ZERO));
        self.count += 1.0;
        for ((mean, squares), colour) in self.sums.iter_mut().zip(colours) {
            let difference = colour.as_dvec3() - *mean;
            *mean += difference / self.count;
            *squares += difference * (colour.as_dvec3() - *mean);
        }
    }

    pub fn means(&self) -> impl Iterator<Item = DVec3> {
        self.sums.iter().map(|(mean, _)| *mean)
    }

    /// Of single pictures; not a number of fewer than two.
    pub fn variances(&self) -> impl Iterator<Item = DVec3> {
        self.sums.iter().map(|(_, squares)| *squares / (self.count - 1.0))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::film::SplitMix;

    /// Edges of the pictures.
    pub const SIZE: usize = 24;

    /// A grey picture of luminance 0.2 to 1.2, with noise that pixels have alone and noise that all share.
    pub fn picture(random: &mut SplitMix, own: f64, shared: f64, gain: f64) -> Vec<Vec3> {
        let common = shared * random.normal();
        let n = (SIZE * SIZE) as f64;
        let grey =
            |p: usize| Vec3::splat((gain * (0.2 + p as f64 / n) + own * random.normal() + common) as f32);
        (0..SIZE * SIZE).map(grey).collect()
    }

    pub fn regions(colours: &[Vec3]) -> Vec<f64> {
        region_means(SIZE, &colours.iter().map(|c| luminance_f64(c.as_dvec3())).collect::<Vec<_>>())
    }

    /// The mean of eight pictures.
    pub fn reference(random: &mut SplitMix, own: f64, shared: f64) -> Reference {
        let (mut spread, mut all) = (Spread::default(), Vec::new());
        for _ in 0..PARTS {
            let colours = picture(random, own, shared, 1.0);
            all.push(regions(&colours));
            spread.add(colours.into_iter());
        }
        let facts = ReferenceFacts { integrator: "path".into(), samples: 8, correlation: 1.0, check: None };
        Reference::of_parts(SIZE, &spread, &all, facts)
    }

    /// c is known from 16 blocks to (2 / (7 16))^(1/2) = 13 %; 54 % are four of these. All pixels of a block of 6 x 6 that share
    /// half of their variance make it 1/2 + 36/2, known to (2 / 7)^(1/2) = 53 % since one number is all there is.
    #[test]
    fn errors_that_pixels_share_are_noticed() {
        let mut random = SplitMix(5);
        let alone = reference(&mut random, 0.1, 0.0).facts.correlation;
        assert!((alone - 1.0).abs() < 0.54, "{alone}");
        let mean = (0..50).map(|_| reference(&mut random, 0.1, 0.1).facts.correlation).sum::<f64>() / 50.0;
        // 4 standard errors of the mean of 50: 30 %.
        assert!((mean / 18.5 - 1.0).abs() < 0.3, "{mean}");
        assert_eq!(reference(&mut random, 0.0, 0.0).facts.correlation, 1.0);
    }

    #[test]
    fn parts_are_whole_blocks_that_reach_what_is_asked_for() {
        for (asked, part) in [(1, 4), (32, 4), (33, 8), (4096, 512)] {
            assert_eq!(samples_of_part(asked), part);
        }
    }
}
