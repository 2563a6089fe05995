//! FLIP of radiance: the greatest error over exposures at which one would look at the reference.
//!
//! ```text
//! T(x)    = (0.9036 x^2 + 0.018 x) / (0.8748 x^2 + 0.354 x + 0.14), clamped to 0 .. 1      (1)
//! T(x_t)  = 0.85                                                                         (2)
//! c_start = log2(x_t / max Y)         c_stop = log2(x_t / median Y)                      (3)
//! c_i     = c_start + i (c_stop - c_start) / (n - 1),  n = max(2, ceil(c_stop - c_start))   (4)
//! FLIP    = max over i of FLIP(T(2^c_i I), T(2^c_i R))                                   (5)
//! ```
//!
//! `[ANDERSSON21 sec. 3]`. Y is the luminance of R. (1) fits the tone curve of ACES. At c_start the brightest pixel of R
//! is just not burnt out, at c_stop half of the pixels are brighter than that. Negative components count as 0.
//!
//! Where more than half of R is black (3) has no end: the median is then that of the pixels that are not. Of a reference
//! that is all black, both exposures are 0. The median of an even number of pixels is the upper one of the middle two.

use glam::Vec3;
use rayon::prelude::*;

use super::flip;
use crate::spectrum::luminance::luminance;

/// Coefficients of (1): of the numerator by falling powers, and of the denominator.
const CURVE: ([f32; 2], [f32; 3]) = ([0.6 * 0.6 * 2.51, 0.6 * 0.03], [0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14]);

/// Shade of (2).
const BRIGHT: f32 = 0.85;

/// The errors (5) of two pictures of any radiance, linear RGB, row after row of `width` columns.
pub fn hdr_flip(picture: &[Vec3], reference: &[Vec3], width: usize, pixels_per_degree: f32) -> Vec<f32> {
    let mut greatest = vec![0.0; reference.len()];
    for stops in exposures(reference) {
        let [picture, reference] = [picture, reference].map(|rgb| shown(rgb, stops));
        let errors = flip(&picture, &reference, width, pixels_per_degree);
        greatest.iter_mut().zip(errors).for_each(|(g, e)| *g = e.max(*g)); // (5)
    }
    greatest
}

fn shown(rgb: &[Vec3], stops: f32) -> Vec<Vec3> {
    let gain = libm::exp2f(stops);
    rgb.par_iter().map(|c| (gain * c.max(Vec3::ZERO)).map(tone_curve)).collect()
}

/// (1).
fn tone_curve(x: f32) -> f32 {
    let ([a2, a1], [b2, b1, b0]) = CURVE;
    // Squares of what is brighter than this, which is white, would be infinite.
    let x = x.min(1e9);
    ((a2 * x * x + a1 * x) / (b2 * x * x + b1 * x + b0)).clamp(0.0, 1.0)
}

/// (2).
fn bright() -> f32 {
    let ([a2, a1], [b2, b1, b0]) = CURVE;
    let half = 0.5 * (a1 - BRIGHT * b1) / (a2 - BRIGHT * b2);
    let rest = -BRIGHT * b0 / (a2 - BRIGHT * b2);
    (half * half - rest).sqrt() - half
}

/// The exposures (4) in stops.
fn exposures(reference: &[Vec3]) -> Vec<f32> {
    let mut luminances: Vec<f32> = reference.iter().map(|c| luminance(*c)).collect();
    luminances.sort_unstable_by(f32::total_cmp);
    let lit = &luminances[luminances.partition_point(|y| *y <= 0.0)..];
    let Some(&greatest) = lit.last() else { return vec![0.0] };
    let middle = luminances[luminances.len() / 2];
    let median = if middle > 0.0 { middle } else { lit[lit.len() / 2] };
    let [start, stop] = [greatest, median].map(|y| libm::log2f(bright() / y)); // (3)
    let n = (stop - start).ceil().max(2.0);
    (0..n as u32).map(|i| start + i as f32 * (stop - start) / (n - 1.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_is_bright_where_it_should_be() {
        assert!((tone_curve(bright()) - BRIGHT).abs() < 1e-6);
        assert_eq!((tone_curve(0.0), tone_curve(f32::INFINITY)), (0.0, 1.0));
    }

    #[test]
    fn exposures_go_from_the_brightest_to_the_median() {
        let grey = |values: &[f32]| values.iter().map(|v| Vec3::splat(*v)).collect::<Vec<_>>();
        let of = exposures(&grey(&[0.25, 1.0, 8.0]));
        assert_eq!(of.len(), 3);
        let start = libm::log2f(bright() / 8.0);
        for (got, want) in of.iter().zip([start, start + 1.5, start + 3.0]) {
            assert!((got - want).abs() < 1e-5, "{of:?}");
        }
        assert_eq!(exposures(&grey(&[1.0; 5])).len(), 2);
        // Black that is more than half of the picture does not count, and black alone has one exposure.
        assert_eq!(exposures(&grey(&[0.0, 0.0, -1.0, 0.0, 2.0, 8.0])), exposures(&grey(&[8.0, 8.0, 8.0])));
        assert_eq!(exposures(&grey(&[0.0, -1.0])), [0.0]);
        assert_eq!(exposures(&[]), [0.0]);
    }
}
