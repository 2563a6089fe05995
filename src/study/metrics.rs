//! How far a picture is from a reference, in one number.
//!
//! I is the picture and R the reference, both linear RGB of one size; i and r are their luminances:
//!
//! ```text
//! e        = |I - R|^2 / (|R|^2 + 0.02^2)        |(r, g, b)|^2 = r^2 + g^2 + b^2         (1)
//! mean     = <e>                                                                        (2)
//! trimmed  = <e> without the greatest hundredth of the pixels                           (3)
//! median   = the middle one of e, or the mean of the two                                (4)
//! rmse     = (<|I - R|^2> / 3)^(1/2)                                                    (5)
//! d        = (i - r) / (r^2 + 0.02^2)^(1/2)                                             (6)
//! ```
//!
//! < > is the mean over pixels. (2) to (4) are what is known as relMSE. In (1) both norms are sums over the channels, so
//! that a difference that all channels of a grey pixel share counts as it does in one of them. The floor keeps black
//! pixels from counting without limit; it is that of [`crate::film::estimate`]. (3) is robust against single fireflies,
//! (4) against any that are fewer than half of the pixels, and blind for light that is missing in fewer. (6) has a sign:
//! its mean tells a bias from noise, which cancels.
//!
//! Pixels with numbers that are not finite have such errors too: leave them out before.

use glam::{DVec3, Vec3};

use crate::film::estimate::LUMINANCE_FLOOR;
use crate::spectrum::luminance::luminance_f64;

/// One in how many pixels [`RelativeMse::trimmed`] leaves out, rounded down.
pub const TRIMMED_PART: usize = 100;

/// Relative mean squared errors, (2) to (4).
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct RelativeMse {
    /// (2).
    pub mean: f64,
    /// (3); the mean where there are fewer than a hundred pixels.
    pub trimmed: f64,
    /// (4).
    pub median: f64,
}

impl RelativeMse {
    /// Of the [`relative_squared_errors`] of some pixels; `None` of none.
    pub fn of(errors: &[f64]) -> Option<Self> {
        let mut sorted = errors.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let n = sorted.len();
        let kept = &sorted[..n - n / TRIMMED_PART];
        Some(Self {
            mean: mean(&sorted)?,                                                      // (2)
            trimmed: mean(kept)?,                                                      // (3)
            median: 0.5 * (sorted.get(n.saturating_sub(1) / 2)? + sorted.get(n / 2)?), // (4)
        })
    }
}

/// (1) of each pixel.
pub fn relative_squared_errors(picture: &[Vec3], reference: &[Vec3]) -> Vec<f64> {
    let floor = LUMINANCE_FLOOR * LUMINANCE_FLOOR;
    pairs(picture, reference).map(|(i, r)| (i - r).length_squared() / (r.length_squared() + floor)).collect()
}

/// (6) of each pixel.
pub fn relative_differences(picture: &[Vec3], reference: &[Vec3]) -> Vec<f64> {
    let relative = |(i, r)| {
        let r = luminance_f64(r);
        (luminance_f64(i) - r) / (r * r + LUMINANCE_FLOOR * LUMINANCE_FLOOR).sqrt()
    };
    pairs(picture, reference).map(relative).collect()
}

/// (5); 0 without pixels.
pub fn rmse(picture: &[Vec3], reference: &[Vec3]) -> f64 {
    let squares: f64 = pairs(picture, reference).map(|(i, r)| (i - r).length_squared()).sum();
    (squares / (3 * picture.len().max(1)) as f64).sqrt()
}

/// Mean of some numbers; `None` of none.
pub fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// What is known of pixels with an alpha above 0: those in which anything but sky is seen.
pub fn where_covered<T: Copy>(values: &[T], alpha: &[f32]) -> Vec<T> {
    values.iter().zip(alpha).filter(|(_, alpha)| **alpha > 0.0).map(|(value, _)| *value).collect()
}

fn pairs(picture: &[Vec3], reference: &[Vec3]) -> impl Iterator<Item = (DVec3, DVec3)> {
    debug_assert_eq!(picture.len(), reference.len(), "pictures of different sizes");
    picture.iter().zip(reference).map(|(i, r)| (i.as_dvec3(), r.as_dvec3()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: f64, b: f64) -> bool {
        // Colours are f32: a product of two is known to 2^-23.
        (a - b).abs() <= 2.4e-7 * b.abs()
    }

    #[test]
    fn errors_are_those_of_the_formulas() {
        let reference = [Vec3::ZERO, Vec3::splat(1.0), Vec3::new(3.0, 0.0, 4.0)];
        let picture = [Vec3::new(0.02, 0.0, 0.0), Vec3::splat(1.5), Vec3::new(3.0, -2.0, 4.0)];
        let errors = relative_squared_errors(&picture, &reference);
        for (got, want) in errors.iter().zip([1.0, 0.75 / 3.0004, 4.0 / 25.0004]) {
            assert!(close(*got, want), "{got} {want}");
        }
        assert!(close(rmse(&picture, &reference), f64::sqrt((4e-4 + 0.75 + 4.0) / 9.0)));
        let differences = relative_differences(&picture, &reference);
        let third = 0.2126 * 3.0 + 0.0722 * 4.0;
        for (got, want) in differences.iter().zip([
            0.2126,
            0.5 / 1.0004_f64.sqrt(),
            -2.0 * 0.7152 / f64::sqrt(third * third + 4e-4),
        ]) {
            assert!(close(*got, want), "{got} {want}");
        }
        assert_eq!(relative_squared_errors(&reference, &reference), [0.0; 3]);
    }

    #[test]
    fn a_common_factor_has_a_closed_form() {
        let reference: Vec<Vec3> = (1..=400).map(|n| Vec3::new(n as f32, 2.0, 0.5 * n as f32)).collect();
        let picture: Vec<Vec3> = reference.iter().map(|r| 1.5 * *r).collect();
        let errors = RelativeMse::of(&relative_squared_errors(&picture, &reference)).unwrap();
        // |R|^2 is at least 5.25, of which the floor is 8e-5.
        for error in [errors.mean, errors.trimmed, errors.median] {
            assert!((error / 0.25 - 1.0).abs() < 8e-5, "{errors:?}");
        }
        let differences = mean(&relative_differences(&picture, &reference)).unwrap();
        assert!((differences / 0.5 - 1.0).abs() < 8e-5, "{differences}");
    }

    #[test]
    fn the_worst_hundredth_is_trimmed() {
        let mut errors: Vec<f64> = (0..200).map(|_| 1.0).collect();
        (errors[7], errors[90], errors[3]) = (1e6, f64::INFINITY, 3.0);
        let of = RelativeMse::of(&errors).unwrap();
        assert_eq!((of.mean, of.trimmed, of.median), (f64::INFINITY, 200.0 / 198.0, 1.0));
        let few = RelativeMse::of(&[1.0, 4.0, 2.0, 101.0]).unwrap();
        assert_eq!((few.mean, few.trimmed, few.median), (27.0, 27.0, 3.0));
        assert_eq!(RelativeMse::of(&[2.0]).unwrap().median, 2.0);
        assert_eq!(RelativeMse::of(&[]), None);
        assert_eq!(mean(&[]), None);
    }

    #[test]
    fn the_sky_is_left_out_on_request() {
        assert_eq!(where_covered(&[1.0, 2.0, 3.0], &[0.0, 0.01, 1.0]), [2.0, 3.0]);
    }
}
