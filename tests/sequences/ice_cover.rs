//! The ice over `sequences/under_ice`: an iceberg that stands in a cover with leads, and waves between them.
//!
//! All of it is heights over the level of the water, in metres. Leads go out from where the sun is seen from the camera,
//! `SUN_AT`: what such a lead lets through is a curtain of light, seen edge on. A shadow is as thick between two of them.

use std::f64::consts::TAU;

use libm::{atan2, cos, exp, hypot, sin, sqrt};

/// A point of the level of the water.
pub type Point = [f64; 2];

/// Half the edge of the square that is meshed.
pub const HALF: f64 = 20.48;

/// What the ice at a point is part of.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Body {
    Berg,
    Cover,
}

/// Length, height above the mean, direction and phase.
const WAVES: [[f64; 4]; 7] = [
    [1.9, 0.0084, 0.3, 0.4],
    [1.25, 0.0056, 1.2, 2.1],
    [0.95, 0.00455, -0.5, 5.0],
    [0.8, 0.0042, 0.9, 1.3],
    [0.67, 0.00315, 2.2, 3.3],
    [0.58, 0.00245, 0.1, 0.2],
    [0.5, 0.00175, -1.1, 4.4],
];

/// The middle of the berg.
const BERG_AT: Point = [2.6, 1.2];

/// Where the line from the camera towards the sun, as it is bent into the water, meets the level.
const SUN_AT: Point = [-1.53, -5.0];

/// Leads by their direction from there and half their width, in degrees, and by where they begin and end.
const LEADS: [[f64; 4]; 10] = [
    [96.0, 2.2, 3.6, 7.2],
    [95.0, 2.0, 8.6, 13.5],
    [107.5, 2.4, 3.6, 9.5],
    [118.5, 2.2, 3.2, 8.5],
    [130.0, 2.8, 3.2, 9.0],
    [142.0, 2.2, 3.2, 8.0],
    [57.0, 3.6, 10.2, 15.0],
    [67.0, 3.4, 10.0, 16.0],
    [77.0, 3.2, 9.8, 15.5],
    [44.0, 3.0, 7.5, 13.0],
];

/// The rim of the square is even, so that it goes on to the horizon.
fn calm([x, y]: Point) -> f64 {
    ((HALF - x.abs().max(y.abs())) / 2.0).clamp(0.0, 1.0)
}

/// The height of the water, also where it only would be.
pub fn wave([x, y]: Point) -> f64 {
    let one = |&[length, height, direction, phase]: &[f64; 4]| {
        height * sin(TAU / length * (x * cos(direction) + y * sin(direction)) + phase)
    };
    calm([x, y]) * WAVES.iter().map(one).sum::<f64>()
}

/// A sine along a direction of the level.
fn ripple([x, y]: Point, along: Point, phase: f64) -> f64 {
    sin(along[0] * x + along[1] * y + phase)
}

/// How far within the outline of the berg, about.
fn within_berg([x, y]: Point) -> f64 {
    let [x, y] = [x - BERG_AT[0], y - BERG_AT[1]];
    let t = atan2(y, x);
    let lobes = 0.35 * cos(2.0 * t + 0.4) + 0.22 * cos(3.0 * t + 2.0);
    2.15 + lobes + 0.12 * cos(5.0 * t) + 0.05 * cos(9.0 * t + 1.0) - hypot(x, y)
}

/// The width of the water around the berg, greatest towards the sun.
fn moat([x, y]: Point) -> f64 {
    let t = atan2(y - BERG_AT[1], x - BERG_AT[0]);
    let towards_sun = 0.5 + 0.5 * cos(t - 3.5);
    0.2 + 1.3 * towards_sun * towards_sun * towards_sun + 0.06 * sin(7.0 * t)
}

/// How far within the cover, about.
fn within_cover(p: Point) -> f64 {
    let [x, y] = [p[0] - SUN_AT[0], p[1] - SUN_AT[1]];
    let (r, t) = (hypot(x, y), atan2(y, x).to_degrees());
    let rough = 0.05 * ripple(p, [4.1, 1.7], 0.0)
        + 0.05 * ripple(p, [-2.3, 4.6], 1.0)
        + 0.025 * ripple(p, [11.0, -5.0], 0.0)
        + 0.025 * ripple(p, [7.0, 10.0], 0.0);
    let from_lead = |(k, &[direction, half, start, end]): (usize, &[f64; 4])| {
        let k = k as f64;
        let bend = direction + 0.7 * sin(1.1 * r + 2.0 * k);
        let wide = half * (1.0 + 0.35 * sin(1.7 * r + 3.0 * k));
        let aside = r * ((t - bend).abs() - wide).to_radians();
        aside.max(start - r).max(r - end) + rough
    };
    LEADS.iter().enumerate().map(from_lead).fold(-within_berg(p) - moat(p), f64::min)
}

/// How far a point is within ice, about, and of which body; negative over water.
pub fn within_ice(p: Point) -> (f64, Body) {
    let (berg, cover) = (within_berg(p), within_cover(p));
    if berg > cover { (berg, Body::Berg) } else { (cover, Body::Cover) }
}

/// The quarter of an ellipse: 0 at an outline, 1 from a width within it on.
fn rounded(within: f64, width: f64) -> f64 {
    let t = 1.0 - (within / width).clamp(0.0, 1.0);
    sqrt((1.0 - t * t).max(0.0))
}

/// A place of the upper side of the ice.
pub fn above(p: Point) -> [f64; 3] {
    let (within, body) = within_ice(p);
    let [x, y] = [p[0] - BERG_AT[0], p[1] - BERG_AT[1]];
    let height = match body {
        Body::Cover => 0.1 * rounded(within, 0.1),
        Body::Berg => (0.3 + 1.2 * bump([x, y], [0.2, 0.3], 1.0) + 0.1 * sin(4.0 * x)) * rounded(within, 0.4),
    };
    [p[0], p[1], wave(p) + height]
}

/// A place of the lower side of the ice.
pub fn below(p: Point) -> [f64; 3] {
    let (within, body) = within_ice(p);
    match body {
        Body::Cover => {
            let uneven = 1.0 + 0.25 * calm(p) * sin(1.9 * p[0] + 0.3) * sin(2.3 * p[1]);
            [p[0], p[1], wave(p) - 0.55 * uneven * rounded(within, 0.22)]
        }
        Body::Berg => {
            let b = [p[0] - BERG_AT[0], p[1] - BERG_AT[1]];
            let depth = 0.9
                + 2.7 * bump(b, [0.1, -0.1], 0.95)
                + 1.5 * bump(b, [-1.1, -0.5], 0.6)
                + 1.2 * bump(b, [1.4, 0.0], 0.5);
            let ridges = 0.22 * ripple(b, [3.1, 1.1], 0.0)
                + 0.16 * ripple(b, [-1.9, 4.3], 0.7)
                + 0.1 * ripple(b, [7.0, 4.0], 0.0)
                + 0.08 * ripple(b, [-6.0, 8.0], 0.0);
            bent([p[0], p[1], wave(p) - (depth + ridges) * rounded(within, 0.7)])
        }
    }
}

/// A bell of height 1.
fn bump(p: Point, middle: Point, width: f64) -> f64 {
    let [x, y] = [(p[0] - middle[0]) / width, (p[1] - middle[1]) / width];
    exp(-(x * x + y * y))
}

/// Below the cover the keel leans towards the sun and is bent a little, which heights alone cannot be.
fn bent([x, y, z]: [f64; 3]) -> [f64; 3] {
    let depth = (-z - 0.7).max(0.0);
    let deep = depth.min(1.0);
    [
        x - 0.45 * depth + deep * (0.13 * sin(2.1 * z + 1.3 * y) + 0.05 * sin(5.3 * z + 3.0 * y)),
        y - 0.1 * depth + deep * (0.13 * sin(2.4 * z - 1.7 * x + 1.0) + 0.05 * sin(6.1 * z - 3.0 * x)),
        z,
    ]
}
