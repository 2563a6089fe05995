//! Open Image Denoise, where it is installed.
//!
//! ```sh
//! pip download --no-deps pyoidn && unzip pyoidn*.whl -d oidn
//! FLOE_OIDN=oidn/pyoidn/oidn/lib cargo test --release --features denoise --test denoise -- --ignored
//! ```
#![cfg(feature = "denoise")]
#![allow(clippy::unwrap_used)]

mod small;

use floe::driver::RenderOptions;
use floe::film::{Denoiser, FrameImage, Pixel};
use floe::sampling::{SampleSeed, SampleStream};
use glam::Vec3;
use small::{Folder, cube, labelled, scene};

/// Two grey halves, 0.2 and 0.8, with uniform noise of `noise` around them.
fn halves(noise: f32) -> FrameImage {
    let mut image = FrameImage::new(64, 48);
    for (pixel, i) in image.pixels.iter_mut().zip(0_u32..) {
        let grey = if i % 64 < 32 { 0.2 } else { 0.8 };
        let u = SampleStream::new(SampleSeed::new(3), i, 0, 0).next4();
        let rgb = Vec3::splat(grey) + noise * (Vec3::new(u[0], u[1], u[2]) - 0.5);
        *pixel = Pixel { rgb, albedo: Vec3::splat(grey), normal: Vec3::Z, ..Pixel::EMPTY };
    }
    image
}

fn error(image: &FrameImage, truth: &FrameImage) -> f32 {
    let square = |(a, b): (&Pixel, &Pixel)| (a.rgb - b.rgb).length_squared();
    (image.pixels.iter().zip(&truth.pixels).map(square).sum::<f32>() / image.pixels.len() as f32).sqrt()
}

/// A denoiser that takes away less than three quarters of white noise on flat halves would not be worth its name; a
/// picture that is handed over with wrong strides comes back far from the truth.
#[test]
#[ignore = "needs Open Image Denoise: FLOE_OIDN"]
fn noise_goes_and_edges_stay() {
    let denoiser = Denoiser::load().unwrap();
    let (noisy, truth) = (halves(0.3), halves(0.0));
    let denoised = denoiser.denoised(&noisy).unwrap();
    let [before, after] = [error(&noisy, &truth), error(&denoised, &truth)];
    println!("root mean square error {before} before, {after} after");
    assert!(after < 0.25 * before, "{after} after {before}");
    assert_eq!(denoised.pixels[7].albedo, noisy.pixels[7].albedo);
    assert!(!denoised.pixels[7].has_variance());
}

#[test]
#[ignore = "needs Open Image Denoise: FLOE_OIDN"]
fn the_picture_with_its_noise_is_kept_as_it_is() {
    let folder = Folder::with_scene(&scene("[output]\naovs = [\"N\"]\n"));
    folder.frame(1, &labelled(cube(), 0, 1));
    folder.render(RenderOptions::default());
    let noisy = [folder.read("out/frame_0001.exr"), folder.read("out/frame_0001.png")];
    let report = folder.render(RenderOptions { denoise: true, ..RenderOptions::default() });
    assert!(report.failures.is_empty(), "{:?}", report.failures);
    assert_eq!(noisy, [folder.read("out/frame_0001.exr"), folder.read("out/frame_0001.png")]);
    assert_ne!(folder.read("out/frame_0001.denoised.png"), noisy[1]);
    assert!(folder.read("out/frame_0001.denoised.exr").windows(13).any(|w| w == b"floe:denoised"));
}
