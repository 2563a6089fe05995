//! FLIP against `flip-evaluator` 1.7 of its authors.

use super::*;

const SIDES: [usize; 2] = [48, 36];

/// A picture with gradients, a disc and steps, and one with noise, dots and wrong colours in it: sRGB values.
fn pictures() -> [Vec<Vec3>; 2] {
    let [width, height] = SIDES;
    let colours = |p: usize| {
        let (x, y) = (p % width, p / width);
        let mut base = Vec3::new(
            x as f32 / (width - 1) as f32,
            y as f32 / (height - 1) as f32,
            ((x + 2 * y) % 24) as f32 / 23.0,
        );
        if x.abs_diff(20).pow(2) + y.abs_diff(14).pow(2) < 90 {
            (base.x, base.z) = (1.0, 0.25);
        }
        let noise = ((x * 73 + y * 151 + x * y * 29) % 97) as f32 / 97.0;
        let mut test = if x >= 24 { 0.75 * base + 0.25 * noise } else { base };
        if x == 7 && y % 5 == 2 {
            test = 1.0 - test;
        }
        if y >= 30 && x < 20 {
            test = Vec3::new(base.y, base.z, base.x);
        }
        (test, base)
    };
    let (test, reference) = (0..width * height).map(colours).unzip();
    [test, reference]
}

fn linear(srgb: f32) -> f32 {
    if srgb <= 0.04045 { srgb / 12.92 } else { libm::powf((srgb + 0.055) / 1.055, 2.4) }
}

const PLACES: [[usize; 2]; 10] =
    [[0, 0], [7, 12], [20, 4], [11, 14], [30, 20], [47, 35], [10, 33], [24, 18], [40, 2], [3, 20]];

/// Both programs compute in single precision. Measured: 2e-7 of the mean, and 1.4e-6 of a pixel, whose values are given to
/// 5e-7.
fn check(errors: &[f32], mean: f64, at_places: [f32; 10]) {
    let found = errors.iter().map(|e| f64::from(*e)).sum::<f64>() / errors.len() as f64;
    let at: Vec<f32> = PLACES.iter().map(|[x, y]| errors[y * SIDES[0] + x]).collect();
    assert!((found - mean).abs() < 1e-6, "{found} {mean}");
    assert!(at.iter().zip(at_places).all(|(got, want)| (got - want).abs() < 5e-6), "{at:?}");
}

/// `evaluate(reference, test, "LDR", applyMagma=False)`
#[test]
fn displayed_pictures_have_the_errors_that_its_authors_give() {
    let [test, reference] = pictures().map(|p| p.into_iter().map(|c| c.map(linear)).collect::<Vec<_>>());
    check(
        &flip(&test, &reference, SIDES[0], PIXELS_PER_DEGREE),
        0.307_251_96,
        [0.012852, 0.360655, 0.025661, 0.032379, 0.31433, 0.515035, 0.981315, 0.330813, 0.372606, 0.011301],
    );
    // With parameters={"ppd": 20.0}.
    check(
        &flip(&test, &reference, SIDES[0], 20.0),
        0.325_973_48,
        [0.0, 0.972086, 0.0, 0.0, 0.589512, 0.495178, 0.9847, 0.566752, 0.609453, 0.0],
    );
}

/// `evaluate(64 * reference**3, 64 * test**3, "HDR", applyMagma=False)`
#[test]
fn radiance_has_the_errors_that_its_authors_give() {
    let [test, reference] = pictures().map(|p| p.into_iter().map(|c| 64.0 * c * c * c).collect::<Vec<_>>());
    check(
        &hdr_flip(&test, &reference, SIDES[0], PIXELS_PER_DEGREE),
        0.308_257_34,
        [0.01517, 0.431226, 0.04291, 0.041464, 0.312782, 0.233165, 0.986852, 0.303353, 0.307562, 0.012884],
    );
}

/// The same of pictures of one colour. Their features are rounding, of 1e-9, and (1) takes a root of that. Measured: 1.1e-5.
#[test]
fn flat_colours_have_the_errors_that_its_authors_give() {
    for (reference, test, error) in [
        ([0.0, 0.0, 0.0], [1.0, 1.0, 1.0], 0.967_388_2),
        ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0], 1.0),
        ([0.5, 0.5, 0.5], [0.6, 0.5, 0.5], 0.249_646_95),
        ([0.2, 0.3, 0.7], [0.25, 0.3, 0.6], 0.227_518_14),
        ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], 0.986_664_8),
    ] {
        let flat = |c: [f32; 3]| vec![Vec3::from(c).map(linear); 16];
        let found = flip(&flat(test), &flat(reference), 4, PIXELS_PER_DEGREE);
        assert!(found.iter().all(|e| (e - error).abs() < 5e-5), "{found:?} {error}");
    }
}

#[test]
fn equal_pictures_have_no_error_and_pictures_of_any_size_have_some() {
    let [test, reference] = pictures();
    let same = flip(&reference, &reference, SIDES[0], PIXELS_PER_DEGREE);
    assert!(same.iter().all(|e| *e == 0.0));
    for (width, height) in [(1, 1), (1, 7), (7, 1), (3, 2)] {
        let n = width * height;
        let errors = hdr_flip(&test[1000..1000 + n], &reference[1000..1000 + n], width, PIXELS_PER_DEGREE);
        assert!(errors.len() == n && errors.iter().all(|e| *e > 0.0 && *e <= 1.0), "{errors:?}");
    }
    assert_eq!(hdr_flip(&[], &[], 0, PIXELS_PER_DEGREE), [0.0; 0]);
}
