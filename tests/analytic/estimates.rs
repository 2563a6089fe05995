//! How a picture is compared with a number, and the number that most of them come from.

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

/// Irradiance at a point with normal `n` from a polygon above its horizon that emits 1 (Lambert): half the sum over the
/// edges of the angle each subtends times the cosine of n with the normal of the plane through it and the point.
pub fn polygon_irradiance(point: DVec3, n: DVec3, polygon: &[DVec3]) -> f64 {
    let edges = polygon.iter().zip(polygon.iter().cycle().skip(1));
    let sum: f64 = edges
        .map(|(a, b)| {
            let (a, b) = ((*a - point).normalize(), (*b - point).normalize());
            a.angle_between(b) * a.cross(b).normalize().dot(n)
        })
        .sum();
    (0.5 * sum).abs()
}
