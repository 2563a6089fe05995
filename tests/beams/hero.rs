//! The scene in which renderers are compared: by beams against photons alone, against other lights told before, and how many
//! of its pixels are fireflies.

use std::path::PathBuf;

use floe::film::Pixel;
use floe::spectrum::luminance::luminance_f64;
use floe::study::TemporalErrors;
use glam::DVec3;

use crate::common::render::{Prepared, Rendered};
use crate::common::scene::SceneFolder;
use crate::seeds::Seeds;

const SUN: &str = "[sun]\ndirection = [-0.5486301348591981, -0.24937733402690823, 0.7980074688861064]\n\
                   angular_diameter = 0.53\nirradiance = [3.0, 2.85, 2.6]\n";
const SEEDS: u64 = 4;
/// Pictures that `floe study` takes in at once.
const WINDOW: u64 = 8;

/// The scene with some of its text replaced; its means are those of any resolution.
fn hero(resolution: [u32; 2], changes: &[(&str, &str)]) -> Prepared {
    let folder: PathBuf = [env!("CARGO_MANIFEST_DIR"), "tests", "bench", "hero"].iter().collect();
    let mut text = std::fs::read_to_string(folder.join("scene.toml")).unwrap();
    let size = format!("resolution = {resolution:?}");
    for (from, to) in changes.iter().chain(&[("resolution = [320, 180]", size.as_str())]) {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let meshes = ["water_air", "ice_air", "ice_water", "sand", "walls"].map(|name| format!("{name}.ply"));
    let copied =
        |copy: SceneFolder, name: &String| copy.file(name, &std::fs::read(folder.join(name)).unwrap());
    meshes.iter().fold(SceneFolder::new(), copied).scene(&text)
}

/// Mean of the picture over seeds, and its standard error by their spread.
fn mean(name: &str, scene: &Prepared, samples: u32) -> (DVec3, DVec3) {
    let (mean, se) = Seeds::render(scene, samples, SEEDS, [1, 1]).means()[0];
    println!("{name}: {mean:.5} +- {se:.5}");
    (mean, se)
}

/// Within 0.5 % and three joint standard errors, in each channel.
#[test]
#[ignore = "takes minutes"]
fn hero_is_as_by_photons() {
    let (beams, a) = mean("beams", &hero([96, 54], &[]), 64);
    // Radii that stay: photons at their own are up to 0.7 % darker, by their blur.
    let alone = "integrator = \"photon\"\nphotons = { radius = 0.03, volume_radius = 0.03, shrink = 1 }";
    let photon = ("integrator = \"beams\"", alone);
    let (photons, b) = mean("photons", &hero([96, 54], &[photon]), 64);
    let apart = (beams / photons - 1.0).abs();
    let error = (a * a + b * b).map(f64::sqrt) / photons;
    println!("apart {apart:.4}, standard errors {error:.4}");
    assert!(apart.cmple(5e-3 + 3.0 * error).all(), "{apart} for {error}");
}

/// Within 0.3 % of what was told of the sky alone, and three standard errors.
#[test]
#[ignore = "takes minutes"]
fn hero_under_the_sky_alone() {
    let (sky, se) = mean("sky", &hero([96, 54], &[(SUN, "")]), 64);
    let expected = DVec3::new(0.0780, 0.1348, 0.1889);
    assert!((sky - expected).abs().cmple(3e-3 * expected + 3.0 * se).all(), "{sky} +- {se}");
}

/// Under a disc 10 degrees wide that the path tracing of another renderer finds by chance; three joint standard errors.
#[test]
#[ignore = "takes minutes"]
fn hero_under_a_wide_sun() {
    let wide = [("angular_diameter = 0.53", "angular_diameter = 10")];
    let (sun, se) = mean("wide sun", &hero([96, 54], &wide), 64);
    let (expected, theirs) = (DVec3::new(0.0975, 0.2035, 0.2460), DVec3::new(3e-4, 8e-4, 6e-4));
    let z = (sun - expected) / (se * se + theirs * theirs).map(f64::sqrt);
    println!("scores {z:.2}");
    assert!(z.abs().cmple(DVec3::splat(3.0)).all(), "{sun} +- {se}: {z}");
}

/// What a screen shows of a luminance, from 0 to 1, coded as sRGB.
fn shown(luminance: f64) -> f64 {
    let linear = luminance.min(1.0);
    if linear < 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055 }
}

/// The share of fireflies among the pixels of some pictures, as `floe study` counts them.
fn fireflies(pictures: &[Rendered], truth: &Rendered, coded: impl Fn(f64) -> f64) -> f64 {
    let coded = |pixel: &Pixel| coded(luminance_f64(pixel.rgb.as_dvec3()));
    let mut errors = TemporalErrors::new(truth.image.width as usize, truth.image.height as usize);
    for picture in pictures {
        let pairs = picture.image.pixels.iter().zip(&truth.image.pixels);
        errors.push(pairs.map(|(own, true_one)| (coded(own) - coded(true_one)) as f32).collect());
    }
    errors.metrics().unwrap().fireflies
}

/// Of what a screen shows, at 64 samples; of luminance itself there are more.
#[test]
#[ignore = "takes minutes"]
fn hero_has_few_fireflies() {
    let scene = hero([160, 90], &[]);
    let truth = scene.render(512, 9);
    let pictures: Vec<Rendered> = (1..=WINDOW).map(|seed| scene.render(64, seed)).collect();
    let [seen, linear] = [fireflies(&pictures, &truth, shown), fireflies(&pictures, &truth, |l| l)];
    println!("fireflies: {seen:.1e} of the pixels on a screen, {linear:.1e} of luminance");
    assert!(seen < 1e-4, "{seen}, {linear}");
}
