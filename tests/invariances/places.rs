//! Scenes that are larger or smaller, turned, or elsewhere.

use floe::sampling::{SampleSeed, SampleStream};
use glam::{DQuat, DVec3};

use crate::bodies::{CLEAR, Place, TURBID, bodies, scene};
use crate::pictures::{assert_alike, assert_same};

const PHOTONS: &str = "[render]\nintegrator = \"photon\"\nphotons = { count = 2000 }\n";
const FORCED: &str = "[render]\nforced_scattering = 2\n";

/// Numbers from 0 to 1.
fn numbers(draw: u32) -> [f64; 4] {
    SampleStream::new(SampleSeed::new(11), draw, 0, 0).next4().map(f64::from)
}

/// Floating point knows no scale, so every number is the same but for its exponent. The scene's origin is on a grid that
/// grows with it, up to a grid of 1/8 m.
#[test]
fn a_scene_of_micrometres_has_the_pixels_of_one_of_metres() {
    let small = Place { scale: libm::ldexp(1.0, -20), ..Place::HERE };
    for (name, media) in [("clear", CLEAR), ("turbid", TURBID)] {
        for way in ["", PHOTONS, FORCED] {
            let [here, there] =
                [Place::HERE, small].map(|place| scene(place, media, &bodies(), way).render(8, 1));
            assert_same(&format!("{name} {way}"), &here, &there);
        }
    }
}

/// By lengths of no power of two, up to where the square of an area leaves the range of f32.
#[test]
fn radiance_has_no_unit_of_length() {
    let drawn = (0..3).map(|draw| libm::pow(10.0, -6.0 + 13.0 * numbers(draw)[0]));
    let scales: Vec<f64> = drawn.chain([1e-6, 1e7]).collect();
    for (name, media) in [("clear", CLEAR), ("turbid", TURBID)] {
        for way in ["", PHOTONS] {
            let here = scene(Place::HERE, media, &bodies(), way).render(16, 1);
            for &scale in &scales {
                let there = scene(Place { scale, ..Place::HERE }, media, &bodies(), way).render(16, 1);
                assert_alike(&format!("{name} {way} times {scale:.3e}"), &here, &there);
            }
        }
    }
}

#[test]
fn turned_scenes_look_the_same() {
    for (name, media) in [("clear", CLEAR), ("turbid", TURBID)] {
        let here = scene(Place::HERE, media, &bodies(), "").render(32, 1);
        for draw in 0..4 {
            let [x, y, z, w] = numbers(100 + draw).map(|u| 2.0 * u - 1.0);
            let turn = DQuat::from_xyzw(x, y, z, w).normalize();
            let there = scene(Place { turn, ..Place::HERE }, media, &bodies(), "").render(32, 2);
            assert_alike(&format!("{name} {turn:.2}"), &here, &there);
        }
    }
}

#[test]
fn scenes_far_from_zero_look_the_same() {
    for (name, media) in [("clear", CLEAR), ("turbid", TURBID)] {
        let here = scene(Place::HERE, media, &bodies(), "").render(16, 1);
        for shift in [DVec3::splat(1e7), DVec3::new(5e5, 4e6, 31.5), DVec3::new(-1e7, 0.0, 0.3)] {
            let there = scene(Place { shift, ..Place::HERE }, media, &bodies(), "").render(16, 1);
            assert_alike(&format!("{name} by {shift}"), &here, &there);
        }
    }
}
