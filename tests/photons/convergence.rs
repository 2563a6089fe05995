//! How the error of progressive photon mapping falls with the passes, and how its bias vanishes with the radius.

use floe::integrator::Integrator;
use glam::DVec3;

use crate::common::render::{Prepared, Rendered};
use crate::references::by_photons;
use crate::seeds::with_radius;

/// The middle of the picture: the front of the box away from its edges, where the radiance is smooth.
fn middle<T>(pixels: &[T]) -> impl Iterator<Item = &T> {
    (24..48).flat_map(move |y| pixels[y * 96 + 24..y * 96 + 72].iter())
}

/// Root of the mean square of the difference from a picture, over the mean of that.
fn error(picture: &Rendered, truth: &[DVec3]) -> f64 {
    let pixels = middle(&picture.image.pixels).zip(middle(truth));
    let squares: f64 = pixels.map(|(p, t)| (f64::from(p.rgb.y) - t.y).powi(2)).sum();
    let (sum, count) = middle(truth).fold((0.0, 0.0), |(sum, count), t| (sum + t.y, count + 1.0));
    (squares / count).sqrt() / (sum / count)
}

/// The mean over pictures of other seeds.
fn mean_picture(scene: &Prepared, samples: u32, seeds: std::ops::Range<u64>) -> Vec<DVec3> {
    let count = (seeds.end - seeds.start) as f64;
    let mut mean = Vec::new();
    for seed in seeds {
        let picture = scene.render(samples, seed);
        mean.resize(picture.image.pixels.len(), DVec3::ZERO);
        for (sum, pixel) in mean.iter_mut().zip(&picture.image.pixels) {
            *sum += pixel.rgb.as_dvec3() / count;
        }
    }
    mean
}

/// Slope of the logarithm of y over that of x, by least squares.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let (mx, my) = logs.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + x / n, b + y / n));
    let top: f64 = logs.iter().map(|(x, y)| (x - mx) * (y - my)).sum();
    top / logs.iter().map(|(x, _)| (x - mx) * (x - mx)).sum::<f64>()
}

/// The box of fog, all of whose light is that of photons around the eye's rays: its error falls with the passes, and
/// the bias of fixed radii with the radius: about in proportion to it, since it stems from the edges of the box, so that
/// errors are measured in the middle.
#[test]
#[ignore = "some minutes: the error of progressive passes, and the bias of fixed radii"]
fn errors_fall_as_the_cube_root_of_the_passes() {
    let progressive = by_photons("s04_iso_box_null", 10_000);
    let Integrator::Path(path) = crate::common::reference::scene("s04_iso_box_null").sampling.integrator
    else {
        panic!()
    };
    let mut by_paths = by_photons("s04_iso_box_null", 1);
    by_paths.sampling.integrator = Integrator::Path(path);
    let truth = mean_picture(&by_paths, 2048, 100..104);
    let mut points = Vec::new();
    for passes in [4, 16, 64, 256] {
        let runs = 4;
        let square =
            (0..runs).map(|seed| error(&progressive.render(passes, seed), &truth).powi(2)).sum::<f64>();
        let rmse = (square / f64::from(runs as u32)).sqrt();
        println!("{passes} passes: RMSE {rmse:.4}");
        points.push((f64::from(passes), rmse));
    }
    let fall = slope(&points[1..]);
    println!("slope {fall:.3}");
    let mut biases: Vec<(f64, f64)> = Vec::new();
    for radius in [0.08_f32, 0.04, 0.02] {
        let fixed = with_radius(by_photons("s04_iso_box_null", 60_000), radius);
        let mean = mean_picture(&fixed, 64, 0..2);
        let bias = mean.iter().map(|p| p.y).sum::<f64>() / truth.iter().map(|p| p.y).sum::<f64>() - 1.0;
        println!("radius {radius}: relative bias of the mean {bias:.4}");
        biases.push((radius.into(), -bias));
    }
    let order = slope(&biases);
    println!("order of the bias {order:.2}");
    assert!((-0.5..-0.28).contains(&fall), "the error falls as passes^{fall:.3}");
    assert!(order > 0.8, "the bias falls as radius^{order:.2}");
}
