//! The examples that ship with the project are what their descriptions say.

// A test that cannot go on fails; what the tests share prints measured numbers.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod common;

use std::path::Path;

use common::render::prepare;
use floe::light::Picture;
use glam::Vec3;

const SKY: (usize, usize) = (128, 64);

/// The sky of the iceberg: blue above, bright at the horizon, a wide warm glow around a low sun.
fn iceberg_sky(direction: Vec3) -> Vec3 {
    let zenith = Vec3::new(0.17, 0.35, 0.72);
    let horizon = Vec3::new(0.70, 0.84, 1.00);
    let glow = Vec3::new(1.5, 1.25, 0.95);
    let towards_sun = Vec3::new(-0.85, -0.35, 0.60).normalize();
    let lobe = (0.5 + 0.5 * direction.dot(towards_sun)).powi(5);
    // Below the horizon, where the sea hides it, the sky goes on as it is there: texels straddle the horizon.
    horizon.lerp(zenith, direction.z.max(0.0).sqrt()) + glow * lobe
}

fn texel_direction(i: usize, j: usize) -> Vec3 {
    let theta = std::f32::consts::PI * (j as f32 + 0.5) / SKY.1 as f32;
    let phi = std::f32::consts::TAU * (i as f32 + 0.5) / SKY.0 as f32 - std::f32::consts::PI;
    Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}

#[test]
fn the_sky_of_the_iceberg_is_its_formula() {
    let picture = Picture::read(Path::new("sequences/iceberg/sky.exr")).unwrap();
    assert_eq!((picture.width, picture.height), SKY);
    for (at, texel) in picture.texels.iter().enumerate() {
        let want = iceberg_sky(texel_direction(at % SKY.0, at / SKY.0));
        // The file holds half-precision numbers: 11 bits.
        assert!((*texel - want).abs().max_element() <= want.max_element() / 1024.0, "texel {at}");
    }
}

/// The waters are closed behind the tiles, and no path leaves them: [`common::render::Prepared::render`] counts labels that
/// disagree.
#[test]
fn the_three_waters_are_closed() {
    let scene = prepare(Path::new("sequences/waters/scene.toml"));
    let picture = scene.render(1, 0);
    assert_eq!((picture.counters.escaped_inside, picture.counters.cut), (0, 0));
    let names: Vec<&str> = scene.frame.media.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["air", "coast", "estuary", "ocean"]);
}

/// Writes the sky: `cargo test --release --test sequences -- --ignored`
#[test]
#[ignore = "writes sequences/iceberg/sky.exr"]
fn write_the_sky_of_the_iceberg() {
    use exr::prelude::*;
    let channels = SpecificChannels::rgb(|p: Vec2<usize>| {
        let rgb = iceberg_sky(texel_direction(p.x(), p.y()));
        (f16::from_f32(rgb.x), f16::from_f32(rgb.y), f16::from_f32(rgb.z))
    });
    Image::from_encoded_channels(SKY, Encoding::SMALL_LOSSLESS, channels)
        .write()
        .to_file("sequences/iceberg/sky.exr")
        .unwrap();
}
