//! What the luminance of noisy pixels is, as far as they and their neighbours tell.
//!
//! ```text
//! M, S^2, n    mean and variance of the luminance over the 5 x 5 pixels around one, and their number
//! B = max(S^2 - mean of V, 0)          the part of S^2 that is not noise
//! k = B / (B + V)
//! L = M + k (m - M)                                                                 (1)
//! Q = k V + (1 - k)^2 W          W = 1 / n^2  max(sum_r (sum of u_r)^2, sum of V)   (2)
//! ```
//!
//! m is the pixel's own luminance and V its variance. (1) is Lee's filter of local statistics `[LEE80]`: where
//! there is more noise than structure it is the mean of the neighbours, where there is less it is the pixel. Q is the
//! variance that is left of the true luminance around L: that of a normal one of variance B, given m, and that of M.
//! W has the sums over the window of what each replicate brings ([equation (2)](super::accumulate)), so errors that
//! neighbours share, as those of photons, do not cancel in it. Four replicates may cancel by chance, so it is no less than
//! with independent errors, which is all that is known of pixels without u_r.
//!
//! Sums are taken anew for every pixel: those that run along would keep the rounding of the brightest pixel passed.

use super::accumulate::{Pixel, REPLICATES};
use super::frame_image::FrameImage;
use super::sums::sum_of_squares;
use crate::spectrum::luminance::luminance_f64;

/// Pixels to each side of the one in the middle.
const REACH: usize = 2;

/// Luminance of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalLuminance {
    /// (1).
    pub luminance: f64,
    /// (2), the square of what it may be off.
    pub variance: f64,
}

/// Sums over pixels of known variance.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    count: f64,
    luminance: f64,
    squares: f64,
    variance: f64,
    deviations: [f64; REPLICATES],
}

impl Sums {
    fn of(pixel: &Pixel) -> Self {
        if !pixel.has_variance() {
            return Self::default();
        }
        let luminance = luminance_f64(pixel.rgb.as_dvec3());
        let variance = f64::from(pixel.luminance_variance);
        let deviations = pixel.deviations.map(f64::from);
        Self { count: 1.0, luminance, squares: luminance * luminance, variance, deviations }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            count: self.count + other.count,
            luminance: self.luminance + other.luminance,
            squares: self.squares + other.squares,
            variance: self.variance + other.variance,
            deviations: std::array::from_fn(|r| self.deviations[r] + other.deviations[r]),
        }
    }

    /// W of (2).
    fn variance_of_mean(&self) -> f64 {
        sum_of_squares(self.deviations).max(self.variance) / (self.count * self.count)
    }

    /// That of a pixel which is among those of the sums.
    fn luminance_of(self, pixel: &Pixel) -> LocalLuminance {
        let own = Self::of(pixel);
        let (mean, noise) = (self.luminance / self.count, self.variance / self.count);
        let spread = (self.squares - self.luminance * mean) / (self.count - 1.0).max(1.0);
        let structure = (spread - noise).max(0.0);
        // Without noise the pixel is what it is.
        let k = if own.variance > 0.0 { structure / (structure + own.variance) } else { 1.0 };
        LocalLuminance {
            luminance: mean + k * (own.luminance - mean), // (1)
            variance: k * own.variance + (1.0 - k) * (1.0 - k) * self.variance_of_mean(), // (2)
        }
    }
}

/// Calls `take` with every pixel of known variance and its luminance, row after row.
pub fn for_each_pixel(image: &FrameImage, mut take: impl FnMut(&Pixel, LocalLuminance)) {
    let width = image.width as usize;
    let mut columns = vec![Sums::default(); width];
    for y in 0..image.height {
        let rows = y.saturating_sub(REACH as u32)..(y + REACH as u32 + 1).min(image.height);
        columns.fill(Sums::default());
        for row in rows {
            for (sums, pixel) in columns.iter_mut().zip(image.row(row)) {
                *sums = sums.plus(Sums::of(pixel));
            }
        }
        for (x, pixel) in image.row(y).iter().enumerate().filter(|(_, pixel)| pixel.has_variance()) {
            let around = &columns[x.saturating_sub(REACH)..(x + REACH + 1).min(width)];
            let sums = around.iter().fold(Sums::default(), |sums, column| sums.plus(*column));
            take(pixel, sums.luminance_of(pixel));
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::film::splitmix::SplitMix;

    fn pixel(luminance: f64, variance: f64) -> Pixel {
        let rgb = Vec3::splat(luminance as f32);
        Pixel { rgb, luminance_variance: variance as f32, samples: 4, replicates: 4, ..Pixel::EMPTY }
    }

    /// Pixels of a mean and of noise around it.
    fn picture(truth: impl Fn(u32, u32) -> f64, deviation: f64) -> FrameImage {
        let mut random = SplitMix(3);
        let mut image = FrameImage::new(48, 32);
        for (i, p) in image.pixels.iter_mut().enumerate() {
            let (x, y) = (i as u32 % 48, i as u32 / 48);
            *p = pixel(truth(x, y) + deviation * random.normal(), deviation * deviation);
        }
        image
    }

    fn luminances(image: &FrameImage) -> Vec<LocalLuminance> {
        let mut all = Vec::new();
        for_each_pixel(image, |_, luminance| all.push(luminance));
        all
    }

    #[test]
    fn without_noise_every_pixel_is_itself() {
        let image = picture(|x, y| f64::from(x * 7 + y * 5 % 11), 0.0);
        for (local, pixel) in luminances(&image).iter().zip(&image.pixels) {
            assert!((local.luminance - f64::from(pixel.rgb.x)).abs() < 1e-6);
            assert_eq!(local.variance, 0.0);
        }
    }

    /// What is left of the noise, and what is said to be left. On an even picture the latter is too much by half, since
    /// structure is never found to be less than none; on structure of as much variance, which is not normal, they were
    /// measured to differ by a fifth.
    #[test]
    fn the_error_that_is_left_is_known() {
        for (name, contrast, most, ratio) in [("even", 0.0, 0.35, 0.5..1.0), ("rough", 0.1, 0.85, 0.7..1.3)] {
            let truth =
                |x: u32, y: u32| 1.0 + contrast * f64::from((x * 37 + y * 59) % 7) / 2.0 - contrast * 1.5;
            let local = luminances(&picture(truth, 0.1));
            let square = |(l, i): (&LocalLuminance, u32)| (l.luminance - truth(i % 48, i / 48)).powi(2);
            let error: f64 = local.iter().zip(0..).map(square).sum();
            let stated: f64 = local.iter().map(|l| l.variance).sum();
            assert!(error < most * most * 1536.0 * 0.01, "{name}: {}", (error / 1536.0).sqrt());
            assert!(ratio.contains(&(error / stated)), "{name}: {error} is said to be {stated}");
        }
    }

    /// The mean of 25 pixels with one error in common is as uncertain as each; with errors of their own, five times less.
    #[test]
    fn an_error_that_neighbours_share_does_not_cancel() {
        let mut image = FrameImage::new(5, 5);
        let mut middle = |deviations: &dyn Fn(usize) -> [f32; REPLICATES]| {
            for (i, p) in image.pixels.iter_mut().enumerate() {
                *p = Pixel { deviations: deviations(i), ..pixel(1.0, 0.01) };
            }
            luminances(&image)[12].variance
        };
        let shared = middle(&|_| [0.05, 0.05, -0.05, -0.05]);
        let own =
            middle(&|i| if i % 2 == 0 { [0.05, 0.05, -0.05, -0.05] } else { [-0.05, -0.05, 0.05, 0.05] });
        assert!(
            (shared / 0.01 - 1.0).abs() < 1e-6 && (own / 0.01 - 1.0 / 25.0).abs() < 1e-6,
            "{shared} {own}"
        );
        assert_eq!(middle(&|_| [0.0; REPLICATES]), own);
    }

    #[test]
    fn a_firefly_does_not_count_as_light() {
        let mut image = picture(|_, _| 1.0, 0.01);
        image.pixels[500] = pixel(200.0, 200.0 * 200.0);
        let local = luminances(&image)[500];
        assert!(local.luminance < 10.0, "{local:?}");
    }

    #[test]
    fn pixels_of_unknown_variance_are_not_asked() {
        let mut image = FrameImage::new(5, 3);
        image.pixels.fill(Pixel { rgb: Vec3::splat(9.0), samples: 1, replicates: 1, ..Pixel::EMPTY });
        assert!(luminances(&image).is_empty());
        image.pixels[7] = pixel(2.0, 0.5);
        assert_eq!(luminances(&image), [LocalLuminance { luminance: 2.0, variance: 0.5 }]);
    }
}
