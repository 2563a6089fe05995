//! The examples that ship with the project are what their descriptions say.

// A test that cannot go on fails; what the tests share prints measured numbers.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod common;

mod sequences {
    mod ice_cover;
    pub mod ice_mesh;
    mod outlined;
}

use std::io::{Read, Write};
use std::path::Path;

use common::render::{prepare, prepare_preview, prepare_task};
use flate2::Compression;
use flate2::read::GzDecoder;
use flate2::write::GzEncoder;
use floe::light::Picture;
use glam::Vec3;

const SKY: (usize, usize) = (128, 64);

/// Radiance from a direction.
type Sky = fn(Vec3) -> Vec3;

/// The skies that ship, with their formulas.
const SKIES: [(&str, Sky); 2] =
    [("sequences/iceberg/sky.exr", iceberg_sky), ("sequences/seas/sky.exr", hazy_sky)];

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

/// The sky of the seas: a haze around the sun, which has three quarters of the light.
fn hazy_sky(direction: Vec3) -> Vec3 {
    let zenith = Vec3::new(0.15, 0.25, 0.44);
    let horizon = Vec3::new(0.50, 0.60, 0.72);
    let glow = Vec3::new(3.4, 3.05, 2.6);
    let towards_sun = Vec3::new(0.25, -0.70, 0.75).normalize();
    let lobe = (0.5 + 0.5 * direction.dot(towards_sun)).powi(8);
    horizon.lerp(zenith, direction.z.max(0.0).sqrt()) + glow * lobe
}

fn texel_direction(i: usize, j: usize) -> Vec3 {
    let theta = std::f32::consts::PI * (j as f32 + 0.5) / SKY.1 as f32;
    let phi = std::f32::consts::TAU * (i as f32 + 0.5) / SKY.0 as f32 - std::f32::consts::PI;
    Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}

#[test]
fn the_skies_are_their_formulas() {
    for (file, sky) in SKIES {
        let picture = Picture::read(Path::new(file)).unwrap();
        assert_eq!((picture.width, picture.height), SKY);
        for (at, texel) in picture.texels.iter().enumerate() {
            let want = sky(texel_direction(at % SKY.0, at / SKY.0));
            // The file holds half-precision numbers: 11 bits.
            assert!((*texel - want).abs().max_element() <= want.max_element() / 1024.0, "{file}, texel {at}");
        }
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

/// Labels agree, but for rounding, and no path has to be cut: [`common::render::Prepared::render`] counts both.
#[test]
fn the_seas_and_the_green_waterline_are_closed() {
    for (scene, frame, media) in [("seas", 0, 7), ("seas", 5, 7), ("waterline", 0, 4)] {
        let scene = prepare_task(Path::new(&format!("sequences/{scene}/scene.toml")), frame);
        assert_eq!((scene.render(1, 0).counters.cut, scene.frame.media.len()), (0, media));
    }
}

/// Labels agree, no path has to be cut, and the sun is found through the surface: with a drop in the air, among rings, from under
/// water.
#[test]
fn the_sun_gets_into_the_pool_of_the_drops_and_under_the_ice() {
    for (scene, frame, media) in [("drop", 0, 2), ("drop", 7, 2), ("under_ice", 0, 4)] {
        let scene = prepare_preview(Path::new(&format!("sequences/{scene}/scene.toml")), frame);
        let counters = scene.render(1, 0).counters;
        assert_eq!((counters.cut, counters.depth_limited, scene.frame.media.len()), (0, 0, media));
        assert!(counters.beam_roots > 0, "{counters:?}");
    }
}

const ICE: &str = "sequences/under_ice/frames/frame_0001.ply.gz";

/// To the last bit: what the mesh is made with has the same bits everywhere.
#[test]
fn the_ice_is_as_it_is_made() {
    let mut file = Vec::new();
    GzDecoder::new(std::fs::File::open(ICE).unwrap()).read_to_end(&mut file).unwrap();
    assert!(file == sequences::ice_mesh::ice_mesh(), "{ICE} is of another description");
}

/// Writes the ice: `cargo test --release --test sequences -- --ignored`
#[test]
#[ignore = "writes the ice of sequences/under_ice"]
fn write_the_ice() {
    let mut file = GzEncoder::new(std::fs::File::create(ICE).unwrap(), Compression::best());
    file.write_all(&sequences::ice_mesh::ice_mesh()).unwrap();
    file.finish().unwrap();
}

/// Writes the skies: `cargo test --release --test sequences -- --ignored`
#[test]
#[ignore = "writes the skies of sequences/"]
fn write_the_skies() {
    use exr::prelude::*;
    for (file, sky) in SKIES {
        let channels = SpecificChannels::rgb(|p: Vec2<usize>| {
            let rgb = sky(texel_direction(p.x(), p.y()));
            (f16::from_f32(rgb.x), f16::from_f32(rgb.y), f16::from_f32(rgb.z))
        });
        Image::from_encoded_channels(SKY, Encoding::SMALL_LOSSLESS, channels).write().to_file(file).unwrap();
    }
}
