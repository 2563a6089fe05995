//! Lights from 1e-20 to 1e20: transport is linear, so the picture is the same times a number.

use glam::{DVec3, Mat4};

use super::pieces::{camera, dielectric, diffuse, emitter, medium, render};
use super::shapes::{parallelogram, sphere};
use super::{Case, Group, Measurement, Picture, Reference, Scene};
use crate::film::exr::encode_exr;
use crate::film::exr_read::read_colours;
use crate::film::{FrameImage, ImageMetadata};
use crate::scene::description::Aov;
use crate::study::StudyError;

/// The group.
pub(super) const GROUP: Group = Group {
    name: "radiance",
    parameter: "radiance",
    about: "Lights of any strength, and strong ones next to weak ones: the same picture times a number.",
    cases,
};

fn cases() -> Vec<Case> {
    let scales = [1e-20, 1e-10, 1e-3, 1e3, 1e10, 1e20];
    let pictures = scales.map(|scale| {
        Case::new(&GROUP, "a pixel over that of radiance 1", scale, move || scaled(scale)).quick()
    });
    let variances = [1e-20, 1e-10, 1e-3, 1e3, 1e10, 1e17, 1e20].map(|scale| {
        Case::new(&GROUP, "relative error of a pixel", scale, move || variance(scale))
            .quick()
            .explained(LARGEST_VARIANCE, 0.5)
    });
    let files = scales.map(|scale| {
        Case::new(&GROUP, "pixels read back from OpenEXR", scale, move || stored(scale)).quick()
    });
    let ranges = [1.0, 1e3, 1e6, 1e9].into_iter().flat_map(|range| {
        [
            Case::new(&GROUP, "a lamp of this radiance beside 1", range, move || bright(range)).quick(),
            Case::new(&GROUP, "1 beside a lamp of this radiance", range, move || dark(range)).quick(),
        ]
    });
    pictures.into_iter().chain(variances).chain(files).chain(ranges).collect()
}

/// The end of the range of variances.
const LARGEST_VARIANCE: &str =
    "a variance is an f32 and ends at 3.4e38: deviations of a pixel above 1.8e19 are understated";

/// A ball of turbid glass on a floor under a lamp, sun and sky, everything times `scale`.
fn still_life(scale: f64) -> Result<Picture, StudyError> {
    let text = medium("glass", "ior = 1.5\nscattering = [1, 2, 3]\nabsorption = 0.1")
        + &dielectric("ball.ply", "air", "glass")
        + &diffuse("floor.ply", "[0.6, 0.5, 0.4]")
        + &emitter("lamp.ply", format!("{:e}", 20.0 * scale))
        + &format!(
            "[sun]\ndirection = [1, -2, 3]\nirradiance = {:e}\n[sky]\nradiance = {scale:e}\n",
            2.0 * scale
        )
        + &camera([0.0, -4.0, 2.0], [0.0, 0.0, 0.5], 40.0, [16, 16])
        + &render(16, "");
    let floor = parallelogram(DVec3::new(-3.0, -3.0, -0.01), DVec3::X * 6.0, DVec3::Y * 6.0);
    let lamp = parallelogram(DVec3::new(-2.0, 0.0, 3.0), DVec3::Y, DVec3::X);
    Scene::new()
        .mesh("ball.ply", &sphere(DVec3::Z, 1.0, 3))
        .mesh("floor.ply", &floor)
        .mesh("lamp.ply", &lamp)
        .render(&text)
}

/// All decisions of paths are the same, and each product and sum is rounded anew: some ten roundings of 2^-24 a vertex.
fn scaled(scale: f64) -> Result<Measurement, StudyError> {
    let (one, other) = (still_life(1.0)?, still_life(scale)?);
    let ratios = one
        .image
        .pixels
        .iter()
        .zip(&other.image.pixels)
        .flat_map(|(a, b)| (0..3).map(move |i| f64::from(b.rgb[i]) / (f64::from(a.rgb[i]) * scale)));
    let ratios = ratios.map(|ratio| Measurement::new(Reference::Invariance, 1.0, ratio).tolerance(1e-5));
    Ok(Measurement::worst(ratios).of(&one).of(&other))
}

/// The deviation of a pixel over the pixel. A variance is an f32: where it would leave its range, it has to stay at its end
/// rather than be infinite, or 0, which says that it is not known.
fn variance(scale: f64) -> Result<Measurement, StudyError> {
    let (one, other) = (still_life(1.0)?, still_life(scale)?);
    let relative = |picture: &Picture| {
        let (mean, error) = picture.mean();
        error.x / mean.x
    };
    let expected = relative(&one);
    let got = relative(&other);
    Ok(Measurement::new(Reference::Invariance, expected, got).of(&one).of(&other).tolerance(1e-4 * expected))
}

/// OpenEXR files have 32 bits a channel here.
fn stored(scale: f64) -> Result<Measurement, StudyError> {
    let picture = still_life(scale)?;
    let worst = off_when_stored(&picture.image);
    Ok(Measurement::new(Reference::Invariance, 0.0, worst).of(&picture))
}

/// The greatest difference of a channel after a file was written and read; what cannot be read is infinitely far off.
fn off_when_stored(image: &FrameImage) -> f64 {
    let (world_to_camera, world_to_ndc) = (Mat4::IDENTITY, Mat4::IDENTITY);
    let metadata =
        ImageMetadata { frame_number: 1, fps: 24.0, world_to_camera, world_to_ndc, attributes: Vec::new() };
    let written = encode_exr(image, &metadata, &[Aov::Variance], std::path::Path::new("stability.exr"));
    let read = written.ok().and_then(|bytes| read_colours(&bytes).ok());
    let Some(read) = read else { return f64::INFINITY };
    let pairs = image.pixels.iter().zip(&read.pixels);
    let off = pairs.map(|(a, b)| f64::from((a.rgb - b.rgb).abs().max_element()));
    off.fold(0.0, |most, off| if off <= most { most } else { off })
}

/// A lamp that fills the left half of the picture, beside a wall of radiance 1 that fills the right one.
fn halves(range: f64) -> Result<Picture, StudyError> {
    let text = emitter("lamp.ply", format!("{range:e}"))
        + &emitter("wall.ply", 1)
        + &camera([0.0, -4.0, 0.0], [0.0; 3], 40.0, [16, 16])
        + &render(16, "");
    let half = |x: f64| parallelogram(DVec3::new(x, 0.0, -9.0), DVec3::X * 9.0, DVec3::Z * 18.0);
    Scene::new().mesh("lamp.ply", &half(-9.0)).mesh("wall.ply", &half(0.0)).render(&text)
}

fn bright(range: f64) -> Result<Measurement, StudyError> {
    let picture = halves(range)?;
    let (mean, _) = picture.block_mean([0, 0], [8, 16]);
    Ok(Measurement::new(Reference::ClosedForm, range, mean.x).of(&picture).tolerance(1e-7 * range))
}

/// No pixel on the dark side has anything of the bright one.
fn dark(range: f64) -> Result<Measurement, StudyError> {
    let picture = halves(range)?;
    let (mean, _) = picture.block_mean([8, 0], [8, 16]);
    Ok(Measurement::new(Reference::ClosedForm, 1.0, mean.x).of(&picture).tolerance(1e-7))
}
