//! A frame that stops at its target has the error that it says: against the same frame with many more samples.
#![allow(clippy::unwrap_used)]

mod small;

use floe::driver::job::Job;
use floe::driver::tiles::{Sampling, render_pixels};
use floe::film::estimate::LUMINANCE_FLOOR;
use floe::film::{FrameImage, estimate_error};
use floe::spectrum::luminance::luminance_f64;
use small::{Folder, shipped_frame, shipped_scene};

fn luminance(image: &FrameImage, pixel: usize) -> f64 {
    luminance_f64(image.pixels[pixel].rgb.as_dvec3())
}

/// The squared relative error against a reference, less that of the reference, and the standard error of this mean over
/// the pixels.
fn squared_error(image: &FrameImage, reference: &FrameImage) -> (f64, f64) {
    let relative = |pixel| {
        let (found, expected) = (luminance(image, pixel), luminance(reference, pixel));
        let own = f64::from(reference.pixels[pixel].luminance_variance);
        ((found - expected).powi(2) - own) / (expected * expected + LUMINANCE_FLOOR * LUMINANCE_FLOOR)
    };
    let all: Vec<f64> = (0..image.pixels.len()).map(relative).collect();
    let n = all.len() as f64;
    let mean = all.iter().sum::<f64>() / n;
    let spread = all.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean, (spread / n).sqrt())
}

/// Two scenes with a picture of 64 x 36 pixels: the iceberg, and the same with a clear sea and a dark sky.
fn scenes() -> [String; 2] {
    let iceberg = shipped_scene(4096).replace("[32, 18]", "[64, 36]");
    let sky = iceberg.lines().find(|line| line.starts_with("radiance = ")).unwrap().to_owned();
    let clear =
        iceberg.replace(&sky, "radiance = [0.05, 0.2, 0.6]").replace("scattering = 7 ", "scattering = 0 ");
    assert_ne!(clear, iceberg);
    [iceberg, clear]
}

/// The true error is known to a few per cent over 2304 pixels, and the estimate likewise: within four standard errors of
/// both (6e-5 where they are normal). Where few pixels have most of the error intervals are wide, and it ends well below the
/// target; it may end a little above.
#[test]
fn the_error_of_a_frame_that_stopped_is_what_it_says() {
    for (name, scene) in ["iceberg", "clear"].into_iter().zip(scenes()) {
        let folder = Folder::with_scene(&scene);
        folder.write("frames/frame_0006.ply", std::fs::read(shipped_frame(6)).unwrap());
        let job = Job::open(&folder.path("scene.toml")).unwrap();
        let task = &job.tasks()[0];
        let meshes = task.read(&job.world).unwrap().meshes;
        let frame = job.world.assemble(task.number, meshes, None).unwrap().frame;
        let target = 0.06;
        let mut settings = job.world.description.render.clone();
        settings.target_error = Some(target);
        let sampling = Sampling::new(&settings);
        let (image, _) = render_pixels(&frame, &sampling, &|_, _| ());
        let mut plain = Sampling { samples: 512, target: None, ..sampling };
        plain.seed.seed += 1;
        let (reference, _) = render_pixels(&frame, &plain, &|_, _| ());
        let estimate = estimate_error(&image, 0.95).unwrap();
        let (squared, error) = squared_error(&image, &reference);
        assert!(estimate.high.is_finite(), "{name}: {estimate:?}");
        // The interval is 1.96 standard errors of the squared estimate to each side.
        let own = (estimate.high.powi(2) - estimate.low.powi(2)) / 2.0 / 1.96;
        let apart = (squared - estimate.relative.powi(2)) / error.hypot(own);
        println!("{name}: {estimate:?}, true {}, {apart:.2} apart", squared.sqrt());
        assert!(apart.abs() < 4.0, "{name}: {apart} standard errors");
        assert!(estimate.relative < 1.05 * target, "{name}: {estimate:?}");
    }
}
