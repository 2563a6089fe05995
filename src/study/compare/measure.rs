//! The measures of a picture and its reference.
//!
//! Pixels with a number that is not finite in either are left out of all of them, and black in FLIP.

use glam::Vec3;
use serde::Serialize;

use crate::film::exr_layers::StoredPicture;
use crate::study::flip::{PIXELS_PER_DEGREE, hdr_flip};
use crate::study::metrics::{RelativeMse, mean, relative_differences, relative_squared_errors, rmse};
use crate::study::z_test::{NoTest, ZTest, z_test};

/// How a picture A differs from a reference B.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Columns and rows.
    pub size: [usize; 2],
    /// Whether the colours are the same, to the last bit.
    pub identical: bool,
    /// Pixels with a number that is not finite, and other bits, in A or in B.
    pub broken: usize,
    /// Mean colours of A and of B.
    pub means: [[f64; 3]; 2],
    /// Relative mean squared error.
    pub relmse: RelativeMse,
    /// Root of the mean squared error.
    pub rmse: f64,
    /// Mean of the signed relative difference of luminance.
    pub relative_difference: f64,
    /// Mean FLIP.
    pub flip: f64,
    /// The pixel that differs most.
    pub greatest: Option<Greatest>,
    /// The test, where there is one.
    pub z_test: Option<ZTest>,
    /// Why there is none.
    pub no_test: Option<NoTest>,
    /// FLIP of each pixel.
    #[serde(skip)]
    pub flip_map: Vec<f32>,
}

/// The pixel with the greatest difference as a length in RGB.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Greatest {
    /// Its column and row.
    pub at: [usize; 2],
    /// Its colour in A.
    pub a: [f32; 3],
    /// Its colour in B.
    pub b: [f32; 3],
}

/// Compares two pictures of one size.
pub fn compare(a: &StoredPicture, b: &StoredPicture) -> Comparison {
    let is_finite = |p: &usize| a.colours[*p].is_finite() && b.colours[*p].is_finite();
    let same_bits =
        |p: usize| a.colours[p].to_array().map(f32::to_bits) == b.colours[p].to_array().map(f32::to_bits);
    let all = 0..a.colours.len();
    let finite: Vec<usize> = all.clone().filter(is_finite).collect();
    let [of_a, of_b] = [a, b].map(|picture| finite.iter().map(|p| picture.colours[*p]).collect::<Vec<_>>());
    let errors = relative_squared_errors(&of_a, &of_b);
    let nothing = RelativeMse { mean: 0.0, trimmed: 0.0, median: 0.0 };
    let black = |picture: &StoredPicture| {
        all.clone().map(|p| if is_finite(&p) { picture.colours[p] } else { Vec3::ZERO }).collect::<Vec<_>>()
    };
    let flip_map = hdr_flip(&black(a), &black(b), a.width, PIXELS_PER_DEGREE);
    let test = z_test(a, b);
    Comparison {
        size: [a.width, a.height],
        identical: all.clone().all(same_bits),
        broken: all.clone().filter(|p| !is_finite(p) && !same_bits(*p)).count(),
        means: [&of_a, &of_b].map(|colours| mean_colour(colours)),
        relmse: RelativeMse::of(&errors).unwrap_or(nothing),
        rmse: rmse(&of_a, &of_b),
        relative_difference: mean(&relative_differences(&of_a, &of_b)).unwrap_or_default(),
        flip: flip_map.iter().map(|e| f64::from(*e)).sum::<f64>() / flip_map.len().max(1) as f64,
        greatest: greatest(a, b, &finite),
        no_test: test.as_ref().err().copied(),
        z_test: test.ok(),
        flip_map,
    }
}

fn mean_colour(colours: &[Vec3]) -> [f64; 3] {
    let sum: glam::DVec3 = colours.iter().map(|c| c.as_dvec3()).sum();
    (sum / colours.len().max(1) as f64).to_array()
}

fn greatest(a: &StoredPicture, b: &StoredPicture, among: &[usize]) -> Option<Greatest> {
    let difference = |p: usize| (a.colours[p].as_dvec3() - b.colours[p].as_dvec3()).length_squared();
    let p = *among.iter().max_by(|p, q| difference(**p).total_cmp(&difference(**q)))?;
    let at = [p % a.width, p / a.width];
    Some(Greatest { at, a: a.colours[p].to_array(), b: b.colours[p].to_array() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(colours: Vec<Vec3>) -> StoredPicture {
        StoredPicture {
            width: 2,
            height: colours.len() / 2,
            colours,
            alpha: None,
            variances: None,
            samples: None,
            rounding: 0.0,
            shares_noise: false,
        }
    }

    #[test]
    fn measures_are_those_of_the_pixels_that_are_finite() {
        let b = picture(vec![Vec3::ONE, Vec3::splat(2.0), Vec3::splat(3.0), Vec3::ONE]);
        let mut a = b.clone();
        a.colours[1] = Vec3::new(2.0, 2.0, 2.5);
        a.colours[2].x = f32::NAN;
        let found = compare(&a, &b);
        assert_eq!((found.identical, found.broken), (false, 1));
        assert_eq!(found.greatest.unwrap().at, [1, 0]);
        assert!((found.relmse.mean - 0.25 / 12.0004 / 3.0).abs() < 1e-9, "{found:?}");
        assert!(
            (found.means[0][2] - 1.5).abs() < 1e-12 && found.relative_difference > 0.0 && found.flip > 0.0,
            "{found:?}"
        );
        // The same pixel without a number in both is no difference.
        let same = compare(&a, &a);
        assert_eq!((same.identical, same.broken, same.relmse.mean, same.flip), (true, 0, 0.0, 0.0));
    }

    #[test]
    fn pictures_without_a_finite_pixel_have_no_errors_but_differ() {
        let [a, b] = [f32::NAN, f32::INFINITY].map(|value| picture(vec![Vec3::splat(value); 4]));
        let found = compare(&a, &b);
        assert_eq!((found.broken, found.greatest, found.rmse), (4, None, 0.0));
        assert!(!found.identical && found.flip == 0.0);
    }
}
