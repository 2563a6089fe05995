//! Keys, a turntable and a lens, seen in pictures.

use floe::scene::camera_path::StartPlaces;
use floe::scene::frame::Place;
use glam::DVec3;

use crate::common::mesh::{cuboid, parallelogram};
use crate::common::render::Rendered;
use crate::common::scene::SceneFolder;

/// Weights, and pixels from the upper left corner.
fn lights(picture: &Rendered) -> Vec<(f64, f64, f64)> {
    let width = picture.image.width;
    let pixels = picture.image.pixels.iter().zip(0_u32..);
    let place = |i: u32| (f64::from(i % width) + 0.5, f64::from(i / width) + 0.5);
    pixels.map(|(p, i)| (f64::from(p.rgb.y), place(i).0, place(i).1)).collect()
}

/// The blur of a point at depth z is a disc of diameter aperture |z - f| / f in the plane at z: with n pixels a metre there,
/// and light spread evenly over it, the mean square of the distance from its centre is (n diameter)^2 / 8 pixels^2.
///
/// A small lamp of edge e adds (n e)^2 / 6, and that light is told by whole pixels 1 / 6 (Sheppard's correction, where the
/// disc has many). The squared distance in an even disc has a standard deviation of
/// 1 / sqrt(3) of its mean; 5 standard errors of as many samples as see the lamp.
#[test]
fn the_circle_of_confusion_is_that_of_a_thin_lens() {
    let (edge, samples, size) = (0.02, 2048_u32, 48.0);
    let (distance, fov) = (5.0, 20.0_f64);
    let half = 0.5 * edge;
    let lamp = parallelogram(DVec3::new(-half, -half, 0.0), DVec3::X * edge, DVec3::Y * edge);
    let folder = SceneFolder::new().mesh("lamp.ply", &lamp);
    let per_metre = size / (2.0 * distance * (0.5 * fov).to_radians().tan());
    for (aperture, focus) in [(0.8, 3.5), (0.8, 8.0), (0.2, 2.0)] {
        let scene = folder.scene(&format!(
            "[[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = {{ kind = \"emitter\", radiance = 1 }}\n[camera]\n\
             eye = [0, 0, {distance}]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nvertical_fov = {fov}\naperture = {aperture}\n\
             focus_distance = {focus}\nresolution = [48, 48]\n"
        ));
        let picture = scene.render(samples, 1);
        let lights = lights(&picture);
        let sum: f64 = lights.iter().map(|p| p.0).sum();
        let square = lights.iter().map(|&(w, x, y)| w * ((x - 24.0).powi(2) + (y - 24.0).powi(2)));
        let measured = square.sum::<f64>() / sum;
        let diameter = per_metre * aperture * (distance / focus - 1.0_f64).abs();
        let expected = diameter * diameter / 8.0 + (per_metre * edge).powi(2) / 6.0 + 1.0 / 6.0;
        let error = expected / 3.0_f64.sqrt() / (sum * f64::from(samples)).sqrt();
        println!("aperture {aperture}, focus {focus}: {measured:.4}, expected {expected:.4} +- {error:.4}");
        assert!((measured - expected).abs() < 5.0 * error, "{measured} and {expected} +- {error}");
        // As much light as the pinhole sees: the lamp covers so many pixels.
        let covered = (per_metre * edge).powi(2);
        assert!(
            (sum / covered - 1.0).abs() < 5.0 / (sum * f64::from(samples)).sqrt() + 1e-3,
            "{sum} {covered}"
        );
    }
}

/// The camera goes up through the surface of a fluid under white surroundings while the shutter is open: within the fluid
/// it sees n^2, above it 1.
#[test]
fn a_camera_passes_through_a_surface_while_the_shutter_is_open() {
    let sea = cuboid(DVec3::new(-50.0, -50.0, -40.0), DVec3::new(50.0, 50.0, 0.0));
    let folder = SceneFolder::new().mesh("sea.ply", &sea);
    let scene = folder.scene(
        "[media.sea]\nior = 1.33\n[[surfaces]]\nmesh = \"sea.ply\"\nfront = \"air\"\nback = \"sea\"\n\
         material = { kind = \"dielectric\" }\n[sky]\nradiance = 1\n[camera]\nvertical_fov = 10\nup = [0, 1, 0]\n\
         eye = [{ frame = 1, eye = [0, 0, -0.3], target = [0.1, 0.2, 9] }, { frame = 2, eye = [0, 0, 0.7], target = [0.1, 0.2, 9] }]\n\
         shutter = 1\nresolution = [8, 8]\n",
    );
    assert_eq!(scene.frame.starts, StartPlaces::Several);
    // The share of the time at which -0.3 + s^2 (3 - 2 s) is below 0.
    let height = |s: f64| s * s * (3.0 - 2.0 * s) - 0.3;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if height(middle) < 0.0 { low = middle } else { high = middle }
    }
    let picture = scene.render(1024, 0);
    let expected = low * 1.33 * 1.33 + (1.0 - low);
    let (mean, se) = picture.mean();
    println!("{mean:.5} +- {se:.5}, expected {expected:.5}");
    assert!((mean.x - expected).abs() < 5.0 * se.x + 1e-5, "{mean} and {expected}");
    assert!(se.x < 0.002 && picture.counters.label_mismatches == 0);

    let above = folder.scene(
        "[media.sea]\nior = 1.33\n[[surfaces]]\nmesh = \"sea.ply\"\nfront = \"air\"\nback = \"sea\"\n\
         material = { kind = \"dielectric\" }\n[camera]\neye = [0, 0, 0.1]\ntarget = [0, 3, 0]\naperture = 0.3\n",
    );
    assert_eq!(above.frame.starts, StartPlaces::Several, "the lens reaches into the sea");
    let higher = folder.scene("[media.sea]\nior = 1.33\n[[surfaces]]\nmesh = \"sea.ply\"\nfront = \"air\"\nback = \"sea\"\n\
         material = { kind = \"dielectric\" }\n[camera]\neye = [0, 0, 0.2]\ntarget = [0, 3, 0.2]\naperture = 0.3\n");
    assert_eq!(higher.frame.starts, StartPlaces::One(Place::OPEN_AIR));
}
