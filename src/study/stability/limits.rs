//! Paths of one interaction and of ten thousand, pixels of one sample and of 65,536, pictures of one pixel and of one row.

use glam::DVec3;

use super::pieces::{WHITE_SKY, camera, camera_along_z, dielectric, diffuse, emitter, medium, render};
use super::shapes::{cuboid, parallelogram, sphere};
use super::{Case, Group, Loss, Measurement, Picture, Reference, Scene};
use crate::study::StudyError;

/// The group of the limit of depth.
pub(super) const DEPTH: Group = Group {
    name: "depth",
    parameter: "max_depth",
    about: "Paths that are ended by `max_depth`: what is lost is what is counted.",
    cases: depths,
};

/// The group of the number of samples.
pub(super) const SAMPLES: Group = Group {
    name: "samples",
    parameter: "samples",
    about: "Pixels of one sample to 65,536: means within their errors, errors as they should be.",
    cases: samples,
};

/// The group of the picture's size.
pub(super) const RESOLUTION: Group = Group {
    name: "resolution",
    parameter: "columns over rows",
    about: "Pictures of one pixel, one row and one column.",
    cases: resolutions,
};

fn depths() -> Vec<Case> {
    [1, 2, 10, 100, 1000, 10_000]
        .map(|depth| {
            let name = "white furnace of 300 free paths: what is seen and what is counted as lost";
            Case::new(&DEPTH, name, f64::from(depth), move || limited(depth)).quick_if(depth <= 100)
        })
        .into()
}

/// No path has a weight but 1 and no roulette is played, so each sample is either light or counted.
fn limited(depth: u32) -> Result<Measurement, StudyError> {
    let text = medium("milk", "scattering = 300")
        + &dielectric("cube.ply", "air", "milk")
        + &camera([1.2, -3.5, 0.8], [0.0; 3], 16.0, [16, 16])
        + &render(16, &format!("max_depth = {depth}\n"))
        + WHITE_SKY;
    let cube = cuboid(DVec3::splat(-0.5), DVec3::splat(0.5));
    let picture = Scene::new().mesh("cube.ply", &cube).render(&text)?;
    let (mean, _) = picture.mean();
    let lost = picture.counters.depth_limited as f64 / picture.samples as f64;
    // Several hundred products of 1 and its neighbours; means are f32.
    Ok(Measurement::new(Reference::Invariance, 1.0, mean.x + lost)
        .of(&picture)
        .tolerance(1e-5)
        .losing(Loss::DepthLimited)
        .note(format!("seen {:.4}", mean.x)))
}

fn samples() -> Vec<Case> {
    let counts = [1, 2, 16, 256, 4096, 65_536];
    let means = counts.map(|count| {
        Case::new(&SAMPLES, "a floor under a lamp: Lambert's form factor", f64::from(count), move || {
            floor(count)
        })
        .quick_if(count <= 4096)
    });
    let one = Case::new(&SAMPLES, "variance of a pixel of one sample: none is known", 1.0, single).quick();
    means.into_iter().chain([one]).collect()
}

/// A lamp of 1 x 1 m one metre above the middle of a floor.
fn lamp(count: u32, side: u32) -> Result<Picture, StudyError> {
    let text = diffuse("floor.ply", 0.5)
        + &emitter("lamp.ply", 1)
        + &camera_along_z([3.0, 0.0, 3.0], [0.0; 3], 1e-4, [side, side])
        + &render(count, "");
    let floor = parallelogram(DVec3::new(-9.0, -9.0, 0.0), DVec3::X * 18.0, DVec3::Y * 18.0);
    let lamp = parallelogram(DVec3::new(-0.5, -0.5, 1.0), DVec3::Y, DVec3::X);
    Scene::new().mesh("floor.ply", &floor).mesh("lamp.ply", &lamp).render(&text)
}

/// The radiance of the floor below the middle of a square of side 1 at a height of 1, times its reflectance of 1/2: four
/// times the form factor of a quarter, from its corner,
///
/// ```text
/// F = (1 / 2 pi) (a / A atan(b / A) + b / B atan(a / B)),   A^2 = 1 + a^2, B^2 = 1 + b^2,   a = b = 1/2
/// ```
/// The standard error is that of the spread of the pixels, which all see the same point to 1e-5; it needs no variance of
/// their own.
fn floor(count: u32) -> Result<Measurement, StudyError> {
    let side = if count > 4096 {
        2
    } else if count > 64 {
        4
    } else {
        32
    };
    let picture = lamp(count, side)?;
    let a = 0.5;
    let hypotenuse = libm::sqrt(1.0 + a * a);
    let quarter = 2.0 * a / hypotenuse * libm::atan(a / hypotenuse) / (2.0 * std::f64::consts::PI);
    let expected = 0.5 * 4.0 * quarter;
    let values: Vec<f64> = picture.image.pixels.iter().map(|p| f64::from(p.rgb.x)).collect();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let spread = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (n - 1.0);
    let own = picture.mean().1.x;
    Ok(Measurement::new(Reference::ClosedForm, expected, mean)
        .of(&picture)
        .standard_error((spread / n).sqrt())
        .tolerance(2e-6)
        .note(format!(
            "error of the mean by the pixels' own variances {own:.1e}, by their spread {:.1e}",
            (spread / n).sqrt()
        )))
}

/// 0 stands for a variance that is not known, and the pixel says so.
fn single() -> Result<Measurement, StudyError> {
    let picture = lamp(1, 8)?;
    let known =
        picture.image.pixels.iter().filter(|p| p.has_variance() || p.variance.max_element() != 0.0).count();
    Ok(Measurement::new(Reference::ClosedForm, 0.0, known as f64).of(&picture))
}

fn resolutions() -> Vec<Case> {
    let sizes = [[1, 1], [16_384, 1], [1, 16_384]];
    let furnaces = sizes.map(|size| {
        Case::new(
            &RESOLUTION,
            format!("white furnace, {} x {} pixels", size[0], size[1]),
            ratio(size),
            move || white(size),
        )
        .quick()
    });
    let edges = [[16_384, 1], [1, 16_384]].map(|size| {
        Case::new(
            &RESOLUTION,
            format!("where an edge is, {} x {} pixels", size[0], size[1]),
            ratio(size),
            move || edge(size),
        )
        .quick()
    });
    furnaces.into_iter().chain(edges).collect()
}

fn ratio([width, height]: [u32; 2]) -> f64 {
    f64::from(width) / f64::from(height)
}

fn white(size: [u32; 2]) -> Result<Measurement, StudyError> {
    let text =
        diffuse("ball.ply", 1) + &camera([0.0, -4.0, 0.0], [0.0; 3], 20.0, size) + &render(4, "") + WHITE_SKY;
    let picture = Scene::new().mesh("ball.ply", &sphere(DVec3::ZERO, 1.0, 3)).render(&text)?;
    Ok(Measurement::farthest_in(&picture, Reference::ClosedForm, 1.0).tolerance(2e-6))
}

/// A lamp covers what lies left of, or below, tan = 0.3 in a view of 90 degrees along the long side: (1 + 0.3) / 2 of the
/// picture, to one sample of one pixel.
fn edge(size: [u32; 2]) -> Result<Measurement, StudyError> {
    let field = if size[0] > size[1] { "horizontal_fov" } else { "vertical_fov" };
    let text = emitter("lamp.ply", 1)
        + &format!("[camera]\neye = [0, -1, 0]\ntarget = [0, 0, 0]\n{field} = 90\nresolution = {size:?}\n")
        + &render(4, "");
    let far = 9.0;
    let (x, z) = if size[0] > size[1] { (0.3 + far, 2.0 * far) } else { (2.0 * far, 0.3 + far) };
    let lamp = parallelogram(DVec3::new(-far, 0.0, -far), DVec3::X * x, DVec3::Z * z);
    let picture = Scene::new().mesh("lamp.ply", &lamp).render(&text)?;
    let (mean, _) = picture.mean();
    Ok(Measurement::new(Reference::ClosedForm, 0.65, mean.x).of(&picture).tolerance(1.0 / 16_384.0))
}
