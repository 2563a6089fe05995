//! How a picture is compared with a number.

use glam::DVec3;

use crate::common::render::Rendered;

/// Standard errors that a mean may be off.
const SCORES: f64 = 5.0;

/// Panics unless the picture's mean is `expected` within five of its standard errors, of which `most` is the greatest
/// that is still a test.
pub fn assert_mean(name: &str, picture: &Rendered, expected: DVec3, most: f64) {
    let (mean, se) = picture.mean();
    println!("{name}: {mean:.6} +- {se:.6}, expected {expected:.6}");
    assert!(se.max_element() <= most, "{name}: a standard error of {se:.6} shows too little");
    // A millionth for pictures without noise.
    let allowed = SCORES * se + 1e-6 + 2e-6 * expected;
    let off = (mean - expected).abs();
    assert!(off.cmple(allowed).all(), "{name}: {mean} is not {expected}, allowed is {allowed:.6}");
}

/// Panics unless every pixel is `expected`, relative to it or absolutely below 1, within `tolerance`.
pub fn assert_every_pixel(name: &str, picture: &Rendered, expected: DVec3, tolerance: f64) {
    let (worst, at) = picture.worst_deviation(expected);
    println!("{name}: expected {expected:.6}, worst deviation {worst:.1e}");
    let allowed = tolerance * expected.max_element().max(1.0);
    assert!(worst <= allowed, "{name}: pixel {at:?} is {} and not {expected}", picture.rgb(at.0, at.1));
}
