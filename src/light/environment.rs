//! Light from infinity: constant, a latitude-longitude picture, or a clear sky.
//!
//! The picture lies around the scene with its top row straight up (`sphere_map.rs`). Radiance is interpolated
//! between the texels' centres; directions are drawn in proportion to the interpolated picture's integral over each texel
//! times the sine of the polar angle.

use std::f32::consts::FRAC_1_PI;

use glam::{DVec3, Vec3};

use super::sphere_map::{SphereMap, contrast_of};
use super::{ClearSky, LightSample, Picture};
use crate::sampling::warp;
use crate::spectrum::light_primaries::radiance_lanes;
use crate::spectrum::{LaneCurve, LaneMode, Lanes, Wavelengths};

/// A disc that has half of the light of an otherwise even sky reaches this at a diameter of 29 degrees.
const PEAKED: f64 = 16.0;

/// Light from infinity in all directions.
#[derive(Clone, Debug)]
pub enum Environment {
    /// The same from everywhere.
    Constant(LaneCurve),
    /// A picture of the whole sphere.
    Image(Box<ImageEnvironment>),
    /// A clear sky by day, over even ground.
    Clear(Box<ClearSky>),
}

/// A picture of the sphere with its sampling tables.
#[derive(Clone, Debug)]
pub struct ImageEnvironment {
    picture: Picture,
    map: SphereMap,
    mode: LaneMode,
    /// Mean over the sphere, linear RGB.
    mean: Vec3,
    /// [`Environment::is_peaked`]
    peaked: bool,
}

impl Environment {
    /// A picture whose top is towards the unit vector `up` (a coordinate axis).
    pub fn image(picture: Picture, up: Vec3, mode: LaneMode) -> Self {
        let brightness = brightness_of(&picture);
        let map = SphereMap::new(up, picture.width, &weights_of(picture.width, &brightness));
        let mean = mean_of(&picture);
        let peaked = contrast_of(picture.width, &brightness) > PEAKED;
        Self::Image(Box::new(ImageEnvironment { picture, map, mode, mean, peaked }))
    }

    /// True when it is the same from everywhere and not black.
    pub fn is_constant_light(&self) -> bool {
        matches!(self, Self::Constant(radiance) if !radiance.is_zero())
    }

    /// True when a small part of the sphere has most of its light: chance that runs into it is noisy.
    ///
    /// That is where the mean square over the sphere is more than 16 times the squared mean, which is the relative
    /// variance of a random direction, and 1.
    pub fn is_peaked(&self) -> bool {
        match self {
            Self::Constant(_) => false,
            Self::Image(image) => image.peaked,
            Self::Clear(sky) => sky.contrast() > PEAKED,
        }
    }

    /// True when next-event estimation looks for it.
    pub fn is_sampled(&self) -> bool {
        self.map().is_some_and(SphereMap::is_sampled)
    }

    fn map(&self) -> Option<&SphereMap> {
        match self {
            Self::Constant(_) => None,
            Self::Image(image) => Some(&image.map),
            Self::Clear(sky) => Some(sky.map()),
        }
    }

    /// Radiance that arrives from `direction`.
    pub fn radiance(&self, direction: Vec3, wavelengths: &Wavelengths) -> Lanes {
        match self {
            Self::Constant(curve) => curve.lanes(wavelengths),
            Self::Image(image) => image.radiance(direction, wavelengths),
            Self::Clear(sky) => sky.radiance(direction, wavelengths),
        }
    }

    /// Mean of the radiance over all directions.
    pub fn mean_radiance(&self, wavelengths: &Wavelengths) -> Lanes {
        match self {
            Self::Constant(curve) => curve.lanes(wavelengths),
            Self::Image(image) => radiance_lanes(image.mode, image.mean, wavelengths),
            Self::Clear(sky) => sky.mean_radiance(wavelengths),
        }
    }

    /// A direction drawn in proportion to the radiance; `None` for a constant or black sky.
    pub fn sample(&self, u: [f32; 2], wavelengths: &Wavelengths) -> Option<LightSample> {
        let (wi, pdf_w) = self.map()?.sample(u)?;
        let radiance = self.radiance(wi, wavelengths);
        Some(LightSample { wi, distance: f32::INFINITY, triangle: None, radiance, pdf_w })
    }

    /// A direction from which light arrives, for photons: as [`Environment::sample`], and evenly from a constant sky.
    pub fn emit(&self, u: [f32; 2], wavelengths: &Wavelengths) -> Option<LightSample> {
        let Self::Constant(radiance) = self else { return self.sample(u, wavelengths) };
        let radiance = radiance.lanes(wavelengths);
        let (wi, pdf_w) = (warp::sphere(u), 0.25 * FRAC_1_PI);
        Some(LightSample { wi, distance: f32::INFINITY, triangle: None, radiance, pdf_w })
    }

    /// Density per solid angle of [`Environment::sample`]; 0 where it is not sampled.
    pub fn pdf_w(&self, direction: Vec3) -> f32 {
        self.map().map_or(0.0, |map| map.pdf_w(direction))
    }
}

impl ImageEnvironment {
    fn radiance(&self, direction: Vec3, wavelengths: &Wavelengths) -> Lanes {
        let [x, y] = self.map.square(direction);
        let (width, height) = (self.picture.width, self.picture.height);
        let (x, y) = (x * width as f32 - 0.5, y * height as f32 - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let column = |offset: i64| (left as i64 + offset).rem_euclid(width as i64) as usize;
        let row = |offset: i64| (top as i64 + offset).clamp(0, height as i64 - 1) as usize;
        let texel = |i, j| self.picture.texels[row(j) * width + column(i)];
        let (fx, fy) = (x - left, y - top);
        let upper = texel(0, 0).lerp(texel(1, 0), fx);
        let lower = texel(0, 1).lerp(texel(1, 1), fx);
        radiance_lanes(self.mode, upper.lerp(lower, fy), wavelengths)
    }
}

fn brightness_of(picture: &Picture) -> Vec<f64> {
    picture.texels.iter().map(|t| f64::from(t.element_sum()) / 3.0).collect()
}

/// Weights of the texels: the integral of the interpolated picture over each, times the sine of the polar angle.
fn weights_of(width: usize, brightness: &[f64]) -> Vec<f64> {
    // A tent over three texels integrates to 1/8, 6/8 and 1/8 of them over the middle one.
    const SHARES: [f64; 3] = [0.125, 0.75, 0.125];
    let height = brightness.len() / width;
    let mut weights = Vec::with_capacity(width * height);
    for j in 0..height {
        let sine = libm::sin(std::f64::consts::PI * (j as f64 + 0.5) / height as f64);
        for i in 0..width {
            let mut sum = 0.0;
            for (dj, share_j) in SHARES.iter().enumerate() {
                let row = (j + dj).saturating_sub(1).min(height - 1);
                for (di, share_i) in SHARES.iter().enumerate() {
                    sum += share_j * share_i * brightness[row * width + (i + di + width - 1) % width];
                }
            }
            weights.push(sum * sine);
        }
    }
    weights
}

/// The mean over the sphere of the interpolated picture.
///
/// With h the height of a row and theta_j the polar angle of its centre, the integral of a row's tent times the sine is
///
/// ```text
/// 2 sin(theta_j) (1 - cos(h)) / h;   the first and last row, flat beyond their centres, share what is left of 2
/// ```
fn mean_of(picture: &Picture) -> Vec3 {
    let h = std::f64::consts::PI / picture.height as f64;
    let half_sine = libm::sin(0.5 * h);
    let tent = |j: usize| 4.0 * libm::sin((j as f64 + 0.5) * h) * half_sine * half_sine / h;
    let last = picture.height - 1;
    let inner: f64 = (1..last).map(tent).sum();
    let outer = if last == 0 { 2.0 } else { 0.5 * (2.0 - inner) };
    let rows = picture.texels.chunks_exact(picture.width).enumerate();
    let sum: DVec3 = rows
        .map(|(j, row)| {
            let weight = if j == 0 || j == last { outer } else { tent(j) };
            weight * row.iter().map(|texel| texel.as_dvec3()).sum::<DVec3>()
        })
        .sum();
    (sum / (2.0 * picture.width as f64)).as_vec3()
}

#[cfg(test)]
mod tests {
    use std::f32::consts::PI;

    use super::*;
    use crate::geometry::elementary::sin_cos;

    /// Against the midpoint rule over 400 x 800 directions, whose error for the kinks of a linear interpolation is a
    /// few of (1/400)^2: below 5e-5.
    /// Half of the light from the share s of the sphere: (1 / s + 1 / (1 - s)) / 4 times the squared mean.
    #[test]
    fn a_sky_is_peaked_by_what_a_small_part_of_it_has() {
        let (width, height) = (64, 512);
        for (rows, peaked) in [(32, true), (48, false), (512, false)] {
            let texels = |bright: f32| {
                let row = move |j| Vec3::splat(if j < rows { bright } else { 1.0 });
                (0..width * height).map(|i| row(i / width)).collect()
            };
            let share = 0.5 * (1.0 - (std::f64::consts::PI * rows as f64 / height as f64).cos());
            let bright = if rows == height { 1.0 } else { (1.0 - share) / share };
            let expected = if rows == height { 1.0 } else { 0.25 * (1.0 / share + 1.0 / (1.0 - share)) };
            let picture = Picture { width, height, texels: texels(bright as f32) };
            assert!(
                (contrast_of(width, &brightness_of(&picture)) / expected - 1.0).abs() < 1e-3,
                "{expected}"
            );
            assert_eq!(Environment::image(picture, Vec3::Z, LaneMode::Rgb).is_peaked(), peaked, "{expected}");
        }
    }

    #[test]
    fn the_mean_is_that_of_the_radiance_over_all_directions() {
        for (width, height) in [(1, 1), (3, 1), (5, 2), (4, 3), (8, 5)] {
            let texels = (0..width * height).map(|i| Vec3::new(1.0, (i * 7 % 11) as f32, (i % 3) as f32));
            let picture = Picture { width, height, texels: texels.collect() };
            let sky = Environment::image(picture, Vec3::Y, LaneMode::Rgb);
            let mut sum = DVec3::ZERO;
            let (rows, columns) = (400, 800);
            for j in 0..rows {
                // Rows of equal height on the axis are of equal solid angle (Archimedes).
                let z = 1.0 - (2 * j + 1) as f32 / rows as f32;
                let r = (1.0 - z * z).sqrt();
                for i in 0..columns {
                    let (sin, cos) = sin_cos(2.0 * PI * (i as f32 + 0.5) / columns as f32);
                    let direction = Vec3::new(r * sin, z, r * cos);
                    sum += sky.radiance(direction, &Wavelengths::RGB).truncate().as_dvec3();
                }
            }
            let expected = sum / f64::from(rows * columns);
            let mean = sky.mean_radiance(&Wavelengths::RGB).truncate().as_dvec3();
            assert!(
                (mean - expected).abs().max_element() < 1e-4 * expected.max_element(),
                "{mean} {expected}"
            );
        }
    }

    /// A picture with all its light around the zenith: the density that the path's side of the balance heuristic asks
    /// for is that of the sample, however near the pole it is.
    #[test]
    fn near_the_poles_the_density_is_that_of_the_samples() {
        let (width, height) = (4, 4096);
        let texels = (0..width * height).map(|i| Vec3::splat(if i < width { 1.0 } else { 0.0 })).collect();
        let picture = Picture { width, height, texels };
        for up in [Vec3::Z, Vec3::Y, Vec3::NEG_X] {
            let sky = Environment::image(picture.clone(), up, LaneMode::Rgb);
            for i in 1..1000 {
                let u = [(i * 617 % 1000) as f32 / 1000.0, i as f32 / 1000.0];
                let light = sky.sample(u, &Wavelengths::RGB).unwrap();
                let back = sky.pdf_w(light.wi);
                // A sample on the border of two rows may be found in the other.
                let is_border = (light.wi.cross(up).length() * height as f32 / PI).fract().min(1.0) < 1e-3;
                assert!(is_border || (back / light.pdf_w - 1.0).abs() < 1e-5, "{back} {}", light.pdf_w);
            }
        }
    }
}
