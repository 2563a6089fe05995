//! The warps of the unit square.

use std::f64::consts::PI;

use floe::sampling::warp;
use glam::Vec3;

use super::tests_of_fit::{assert_fits, cell_of};

const ROWS: usize = 12;
const COLUMNS: usize = 16;

fn azimuth(x: f32, y: f32) -> f64 {
    (f64::from(y).atan2(f64::from(x)) / (2.0 * PI)).rem_euclid(1.0)
}

/// Cells of equal probability: `height` maps a sample to a number that has to be uniform in [0, 1].
fn assert_even(name: &str, seed: u64, sample: impl Fn([f32; 2]) -> (f64, f64)) {
    let probabilities = vec![1.0 / (ROWS * COLUMNS) as f64; ROWS * COLUMNS];
    assert_fits(name, seed, &probabilities, |u| {
        let (height, turn) = sample(u);
        cell_of(height, ROWS) * COLUMNS + cell_of(turn, COLUMNS)
    });
}

#[test]
fn warps_follow_their_densities() {
    // The share of the disc within r is r^2, of the cosine lobe within theta sin^2(theta), of a cone 1 - cos over its own.
    assert_even("disc", 1, |u| {
        let p = warp::disc(u);
        (p.as_dvec2().length_squared(), azimuth(p.x, p.y))
    });
    assert_even("cosine hemisphere", 2, |u| {
        let d = warp::cosine_hemisphere(u);
        assert!(d.z >= 0.0);
        (d.truncate().as_dvec2().length_squared(), azimuth(d.x, d.y))
    });
    assert_even("sphere", 3, |u| {
        let d = warp::sphere(u);
        (0.5 + 0.5 * f64::from(d.z), azimuth(d.x, d.y))
    });
    for (seed, one_minus_cos) in (4..).zip([2.0_f32, 1.0, 0.1, 1e-5, 1e-10]) {
        assert_even(&format!("cone {one_minus_cos:e}"), seed, |u| {
            let d = warp::cone(u, one_minus_cos);
            // 1 - cos from the sine, which has all its digits near the axis.
            let sine_squared = d.truncate().as_dvec2().length_squared();
            let from_axis =
                if d.z > 0.5 { sine_squared / (1.0 + f64::from(d.z)) } else { 1.0 - f64::from(d.z) };
            (from_axis / f64::from(one_minus_cos), azimuth(d.x, d.y))
        });
    }
}

#[test]
fn triangles_are_covered_evenly() {
    // A triangle of n^2 equal ones: 2 floor(b) - ... counted by the strips of two weights and the half of the cell.
    let n = 12;
    let probabilities: Vec<f64> = (0..n * n * 2)
        .map(|i| {
            let (row, column, upper) = (i / 2 / n, i / 2 % n, i % 2);
            f64::from(u8::from(row + column + upper < n)) / (n * n) as f64
        })
        .collect();
    assert_fits("triangle", 20, &probabilities, |u| {
        let b = warp::triangle(u);
        assert!(b.min_element() >= -1e-7 && (b.element_sum() - 1.0).abs() < 1e-6, "{b}");
        let (x, y) = (f64::from(b.x) * n as f64, f64::from(b.y) * n as f64);
        let (row, column) = ((x as usize).min(n - 1), (y as usize).min(n - 1));
        let upper = usize::from(x.fract() + y.fract() > 1.0 && row + column + 1 < n);
        (row * n + column) * 2 + upper
    });
}

/// Densities integrate to one over what they cover, by the midpoint rule.
#[test]
fn densities_integrate_to_one() {
    let steps = 100_000;
    let cosine: f64 = (0..steps)
        .map(|i| (f64::from(i) + 0.5) / f64::from(steps))
        .map(|cos| f64::from(warp::cosine_hemisphere_pdf_w(cos as f32)) * 2.0 * PI / f64::from(steps))
        .sum();
    assert!((cosine - 1.0).abs() < 1e-6, "{cosine}");
    assert_eq!(warp::cosine_hemisphere_pdf_w(-0.5), 0.0);
    for one_minus_cos in [2.0_f32, 0.3, 1e-9] {
        let whole = f64::from(warp::cone_pdf_w(one_minus_cos)) * 2.0 * PI * f64::from(one_minus_cos);
        assert!((whole - 1.0).abs() < 1e-6, "{whole}");
    }
    assert_eq!(warp::around_z(0.0, 0.3), Vec3::Z);
}
