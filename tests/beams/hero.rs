//! The scene in which renderers are compared: by beams against photons alone, against other lights told before, and how many
//! of its pixels are fireflies.

use std::path::PathBuf;

use glam::DVec3;

use crate::common::render::{Prepared, Rendered};
use crate::common::scene::SceneFolder;

const SUN: &str = "[sun]\ndirection = [-0.5486301348591981, -0.24937733402690823, 0.7980074688861064]\n\
                   angular_diameter = 0.53\nirradiance = [3.0, 2.85, 2.6]\n";
const SEEDS: u64 = 4;

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
    let means: Vec<DVec3> = (1..=SEEDS).map(|seed| scene.render(samples, seed).mean().0).collect();
    let n = SEEDS as f64;
    let mean = means.iter().sum::<DVec3>() / n;
    let squares = means.iter().map(|m| (*m - mean) * (*m - mean)).sum::<DVec3>();
    let se = (squares / (n * (n - 1.0))).map(f64::sqrt);
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

fn luminance(picture: &Rendered, x: u32, y: u32) -> f64 {
    picture.rgb(x, y).dot(DVec3::new(0.2126, 0.7152, 0.0722))
}

/// Pixels whose error is beyond eight of the standard deviations around them: 1.4826 times the median absolute deviation of
/// the errors of 7 x 7 pixels. A pixel's own estimated error would grow with its firefly and hide it.
#[test]
#[ignore = "takes minutes"]
fn hero_has_few_fireflies() {
    const SIZE: [u32; 2] = [160, 90];
    let scene = hero(SIZE, &[]);
    let (few, many) = (scene.render(64, 1), scene.render(512, 2));
    let error = |x: u32, y: u32| luminance(&few, x, y) - luminance(&many, x, y);
    let mut count = 0;
    for y in 3..SIZE[1] - 3 {
        for x in 3..SIZE[0] - 3 {
            let around = (y - 3..=y + 3).flat_map(|j| (x - 3..=x + 3).map(move |i| (i, j)));
            let mut deviations: Vec<f64> = around.map(|(i, j)| error(i, j).abs()).collect();
            deviations.sort_by(f64::total_cmp);
            count += u32::from(error(x, y).abs() > 8.0 * 1.4826 * deviations[24]);
        }
    }
    let share = f64::from(count) / f64::from((SIZE[0] - 6) * (SIZE[1] - 6));
    println!("{count} fireflies, {share:.1e} of the pixels");
    assert!(share < 1e-4, "{count} fireflies, {share}");
}
