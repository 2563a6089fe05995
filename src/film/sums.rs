//! Sums over samples of a pixel: radiance of each replicate, and what else a picture shows.

use std::ops::AddAssign;

use glam::{DVec2, DVec3, Vec2, Vec3};
use serde::{Deserialize, Serialize};

use super::accumulate::{FAR_DEPTH, FilmSample, Pixel, REPLICATES};
use crate::spectrum::luminance::luminance_f64;

/// The samples of one replicate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Replicate {
    pub radiance: DVec3,
    pub samples: u32,
}

impl Replicate {
    pub fn add(&mut self, sample: &FilmSample) {
        self.radiance += sample.radiance.as_dvec3();
        self.samples += 1;
    }
}

impl AddAssign for Replicate {
    fn add_assign(&mut self, other: Self) {
        self.radiance += other.radiance;
        self.samples += other.samples;
    }
}

/// Those with samples.
pub(super) fn filled(replicates: &[Replicate]) -> impl Iterator<Item = &Replicate> {
    replicates.iter().filter(|r| r.samples > 0)
}

/// Samples in all of them.
pub(super) fn samples(replicates: &[Replicate]) -> u32 {
    replicates.iter().map(|r| r.samples).sum()
}

/// Variance of the mean of some replicates with n samples, by [equation (1)](super::accumulate), for each channel, and what
/// each brings to that of luminance, by equation (2) there; `None` with fewer than two replicates.
pub(super) fn variance_of_mean(
    replicates: &[Replicate],
    mean: DVec3,
    n: f64,
) -> Option<(DVec3, [f64; REPLICATES])> {
    if filled(replicates).count() < 2 {
        return None;
    }
    let (mut channels, mut luminance, mut squared_weights) = (DVec3::ZERO, [0.0; REPLICATES], 0.0);
    for (replicate, luminance) in replicates.iter().zip(&mut luminance).filter(|(r, _)| r.samples > 0) {
        let n_r = f64::from(replicate.samples);
        let w = n_r / n;
        let difference = w * (replicate.radiance / n_r - mean);
        channels += difference * difference;
        *luminance = luminance_f64(difference);
        squared_weights += w * w;
    }
    let scale = 1.0 / (1.0 - squared_weights); // (1)
    Some((channels * scale, luminance.map(|d| d * scale.sqrt()))) // (2)
}

/// A variance as pictures have it: it may leave the range of f32 where its root does not, and infinite it would spoil
/// every mean.
pub(super) fn in_range(channels: DVec3, luminance: f64) -> (Vec3, f32) {
    (channels.as_vec3().min(Vec3::MAX), (luminance as f32).min(f32::MAX))
}

/// The variance that deviations make.
pub(super) fn sum_of_squares(deviations: [f64; REPLICATES]) -> f64 {
    deviations.iter().map(|d| d * d).sum()
}

/// What a picture shows besides radiance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Features {
    alpha: f64,
    albedo: DVec3,
    normal: DVec3,
    position: DVec3,
    depth: f64,
    motion: DVec2,
    /// Samples with a first surface.
    hits: f64,
    /// Samples left out because a number in them was not finite.
    pub rejected: u32,
}

impl Features {
    /// Of sums in the order of the fields, and of the samples with a first surface.
    pub fn of(sums: &[f64], hits: u32) -> Self {
        Self {
            alpha: sums[0],
            albedo: DVec3::from_slice(&sums[1..]),
            normal: DVec3::from_slice(&sums[4..]),
            position: DVec3::from_slice(&sums[7..]),
            depth: sums[10],
            motion: DVec2::from_slice(&sums[11..]),
            hits: hits.into(),
            rejected: 0,
        }
    }

    pub fn add(&mut self, sample: &FilmSample) {
        self.alpha += f64::from(sample.alpha);
        self.albedo += sample.albedo.as_dvec3();
        self.normal += sample.normal.as_dvec3();
        if sample.hit {
            self.position += sample.position.as_dvec3();
            self.depth += f64::from(sample.depth);
            self.motion += sample.motion.as_dvec2();
            self.hits += 1.0;
        }
    }

    /// Means instead of sums over n samples.
    pub fn over(self, n: f64) -> Self {
        Self {
            alpha: self.alpha / n,
            albedo: self.albedo / n,
            normal: self.normal / n,
            position: self.position / n,
            depth: self.depth / n,
            motion: self.motion / n,
            hits: self.hits / n,
            rejected: self.rejected,
        }
    }

    /// The pixel of these sums over n samples; its radiance is still to be told.
    pub fn pixel(&self, n: f64) -> Pixel {
        let hits = self.hits;
        let (position, depth, motion) = if hits > 0.0 {
            ((self.position / hits).as_vec3(), (self.depth / hits) as f32, (self.motion / hits).as_vec2())
        } else {
            (Vec3::ZERO, FAR_DEPTH, Vec2::ZERO)
        };
        Pixel {
            alpha: (self.alpha / n) as f32,
            albedo: (self.albedo / n).as_vec3(),
            normal: (self.normal / n).as_vec3(),
            position,
            depth,
            motion,
            rejected: self.rejected,
            ..Pixel::EMPTY
        }
    }
}

impl AddAssign for Features {
    fn add_assign(&mut self, other: Self) {
        self.alpha += other.alpha;
        self.albedo += other.albedo;
        self.normal += other.normal;
        self.position += other.position;
        self.depth += other.depth;
        self.motion += other.motion;
        self.hits += other.hits;
        self.rejected += other.rejected;
    }
}
