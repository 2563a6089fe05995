//! Whole pictures against exact results and against another renderer.

mod common;

use common::reference::{blocks, compare, scene, statistics};
use glam::{DVec3, Vec3};

/// The furnace loses and gains nothing.
///
/// Every sample is 1 up to the rounding of its weights: an interaction multiplies the throughput by a few factors of
/// relative error 2^-24, of either sign.
#[test]
fn s01_white_furnace_is_one_in_every_pixel() {
    let picture = scene("s01_furnace").render(32, 0);
    let (worst, at) = picture.worst_deviation(DVec3::ONE);
    let (mean, _) = picture.mean();
    println!("s01: worst {worst:e} at {at:?}, mean {mean}, {:?}", picture.counters);
    assert!(worst < 1e-4, "pixel {at:?} is off by {worst:e}");
    assert_eq!(picture.counters.cut, 0);
}

#[test]
fn s02_cube_on_a_floor_agrees_with_mitsuba() {
    let picture = scene("s02_cube_floor").render(256, 0);
    compare(&picture, &statistics("s02_cube_floor")).assert_agrees("s02_cube_floor");
}

#[test]
fn s03_absorbing_boxes_agree_with_mitsuba() {
    let picture = scene("s03_beer").render(256, 0);
    compare(&picture, &statistics("s03_beer")).assert_agrees("s03_beer");
}

#[test]
fn s11_underwater() {
    let start = std::time::Instant::now();
    let picture = scene("s11_underwater_furnace").render(16, 0);
    println!("s11 {:?} {:?} {:?}", start.elapsed(), picture.mean(), picture.counters);
}

#[test]
fn speed() {
    for name in ["s01_furnace", "s02_cube_floor", "s03_beer"] {
        let s = scene(name);
        let start = std::time::Instant::now();
        let p = s.render(16, 3);
        println!("{name} 16 spp {:?} {:?}", start.elapsed(), p.counters);
        let _ = (blocks(&p), Vec3::ONE);
    }
}
