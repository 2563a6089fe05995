//! Media from nothing to opaque, by random walks.

use glam::DVec3;

use super::h_function::HFunction;
use super::pieces::{WHITE_SKY, camera, camera_along_z, dielectric, diffuse, medium, null, render};
use super::shapes::{Shape, cuboid, parallelogram};
use super::{Case, Group, Loss, Measurement, Reference, Scene};
use crate::study::StudyError;

/// The group.
pub(super) const GROUP: Group = Group {
    name: "extinction",
    parameter: "extinction times size",
    about: "A medium from nothing to opaque, by random walks.",
    cases,
};

fn cases() -> Vec<Case> {
    let depths = [0.0, 1e-12, 1e-6, 1e-3, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5];
    let each =
        |name: &'static str, least: f64, quick: f64, measure: fn(f64) -> Result<Measurement, StudyError>| {
            let asked = depths.into_iter().filter(move |depth| *depth >= least);
            asked.map(move |depth| {
                Case::new(&GROUP, name, depth, move || measure(depth)).quick_if(depth <= quick)
            })
        };
    let half_spaces = each("a half space of albedo 0.9, from 3 m", 100.0, 1e3, half_space);
    each("a slab that absorbs: exp(-tau)", 0.0, 1e5, absorbing_slab)
        .chain(each("white furnace of a cube, albedo 1", 0.0, 1e3, furnace))
        .chain(each("white furnace of a cube of index 1.33", 1e-12, 100.0, refracting_furnace))
        .chain(each("a slab of albedo 1: R + T", 1e-6, 100.0, reflected_and_transmitted))
        .chain(half_spaces.map(|case| case.explained(CLOSE_TO_ROUNDING, 0.01)))
        .collect()
}

/// What limits the extinction that walks can be traced through.
const CLOSE_TO_ROUNDING: &str = "collisions within 3e-6 m of the surface, 8 roundings of a coordinate of 3 m in f32 and \
                                 a third of a free path, count as beyond it";

/// A slab of 1 m between the eye and white surroundings, in all three channels.
///
/// The way through it is the difference of two distances of at most 3 m in f32, each rounded by a few units of 2^-24 of
/// it: the optical depth is off by 1e-6 of itself, and the transmittance by as much of that. What is below the least
/// normal f32 may be 0.
fn absorbing_slab(depth: f64) -> Result<Measurement, StudyError> {
    let face = |y: f64| parallelogram(DVec3::new(-1.0, y, -1.0), DVec3::X * 2.0, DVec3::Z * 2.0);
    let text = medium("ink", &format!("absorption = {depth:e}"))
        + &null("near.ply", "air", "ink")
        + &null("far.ply", "ink", "air")
        + &camera([0.3, -2.0, 0.2], [0.3, 0.0, 0.2], 0.001, [4, 4])
        + &render(4, "")
        + WHITE_SKY;
    let picture = Scene::new().mesh("near.ply", &face(0.0)).mesh("far.ply", &face(1.0)).render(&text)?;
    let expected = libm::exp(-depth);
    let tolerance = expected * (1e-6 * depth + 1e-6) + f64::from(f32::MIN_POSITIVE);
    Ok(Measurement::farthest_in(&picture, Reference::ClosedForm, expected).tolerance(tolerance))
}

fn furnace(depth: f64) -> Result<Measurement, StudyError> {
    furnace_of(depth, 1.0)
}

fn refracting_furnace(depth: f64) -> Result<Measurement, StudyError> {
    furnace_of(depth, 1.33)
}

/// A cube of 1 m in white surroundings, of which nothing may be seen: weights are 1 but for the roundings of two index
/// ratios, up to 2^-23 each, and for the roulette of walks of more than 65,536 collisions.
fn furnace_of(depth: f64, ior: f64) -> Result<Measurement, StudyError> {
    let samples = if depth > 1e4 { 4 } else { 16 };
    let text = medium("milk", &format!("ior = {ior}\nscattering = {depth:e}"))
        + &dielectric("cube.ply", "air", "milk")
        + &camera([1.2, -3.5, 0.8], [0.0; 3], 16.0, [8, 8])
        + &render(samples, "")
        + WHITE_SKY;
    let cube = cuboid(DVec3::splat(-0.5), DVec3::splat(0.5));
    let picture = Scene::new().mesh("cube.ply", &cube).render(&text)?;
    Ok(Measurement::mean_of(&picture, Reference::ClosedForm, 1.0).tolerance(1e-6))
}

/// A layer of 1 m in the mouth of a black tray, so that it is lit from above only: what is seen of it from above is what
/// it reflects of even light, R, and from below what it transmits, T. Without sides it would be R + T = 1; light that
/// goes 20 m to the side of a layer of 1 m falls off as exp(-20 pi), and where the layer is thinner than a free path,
/// what is scattered within 1 in 20 of the horizontal meets the tray, which is 1 in 15 of it for all angles of arrival.
fn reflected_and_transmitted(depth: f64) -> Result<Measurement, StudyError> {
    let layer = graded_slab(1.0, 25.0);
    let mut tray = cuboid(DVec3::new(-20.0, -20.0, -3.0), DVec3::new(20.0, 20.0, 0.0));
    // Without its top.
    tray.triangles.retain(|t| t.iter().any(|&v| tray.positions[v as usize].z < -1.0));
    let scene = Scene::new().mesh("layer.ply", &layer).mesh("tray.ply", &tray);
    let samples = if depth > 1e4 { 16 } else { 256 };
    let text = medium("milk", &format!("scattering = {depth:e}"))
        + &dielectric("layer.ply", "air", "milk")
        + &diffuse("tray.ply", 0)
        + &render(samples, "")
        + WHITE_SKY;
    let seen_from = |z: f64| {
        let camera = camera_along_z([0.01, 0.004, z], [0.01, 0.004, 0.0], 0.001, [8, 8]);
        scene.render(&(text.clone() + &camera))
    };
    let (above, below) = (seen_from(2.0)?, seen_from(-2.0)?);
    let ((reflected, r), (transmitted, t)) = (above.mean(), below.mean());
    Ok(Measurement::new(Reference::ClosedForm, 1.0, reflected.x + transmitted.x)
        .of(&above)
        .of(&below)
        .standard_error((r.x * r.x + t.x * t.x).sqrt())
        .tolerance(if depth < 1.0 { depth / 15.0 } else { 0.0 } + 1e-6)
        .note(format!("R {:.5}, T {:.2e}", reflected.x, transmitted.x)))
}

/// Under an even sky a half space shows, at the cosine mu with its normal,
///
/// ```text
/// L = 1 - sqrt(1 - albedo) H(mu)                                                             [CHANDRASEKHAR60 ch. V]
/// ```
/// It is the middle of a slab of 4 x 4 x 1 m. Light from the bottom comes back as exp(-2 kappa tau) and that from beside
/// as exp(-2 kappa tau), kappa being 0.525 for this albedo: below 1e-22.
///
/// The eye looks at where triangles are small: what a ray meets on a large one is off by the rounding of its far corners.
fn half_space(depth: f64) -> Result<Measurement, StudyError> {
    const ALBEDO: f64 = 0.9;
    const COSINE: f64 = 0.6;
    let text = medium(
        "milk",
        &format!("absorption = {:e}\nscattering = {:e}", (1.0 - ALBEDO) * depth, ALBEDO * depth),
    ) + &null("slab.ply", "air", "milk")
        + &camera([6e-4 + 3.0 * 0.8, 2e-4, 3.0 * COSINE], [6e-4, 2e-4, 0.0], 0.001, [8, 8])
        + &render(if depth > 1e3 { 2048 } else { 256 }, "")
        + WHITE_SKY;
    let picture = Scene::new().mesh("slab.ply", &graded_slab(1.0, 2.0)).render(&text)?;
    let expected = 1.0 - (1.0 - ALBEDO).sqrt() * HFunction::new(ALBEDO).at(COSINE);
    // The quadrature of H is good to 1e-6.
    let measured = Measurement::mean_of(&picture, Reference::ClosedForm, expected).tolerance(2e-6);
    // Where a path enters, rounding decides on which side of the surface its first collision is if it is so near.
    Ok(if depth > 1e3 { measured.losing(Loss::Astray) } else { measured })
}

/// A slab without sides between z = -depth and 0, whose triangles are as large as their distance from the middle.
fn graded_slab(depth: f64, half: f64) -> Shape {
    let steps = [-1.0, -0.1, -0.01, -1e-3, 1e-3, 0.01, 0.1, 1.0].map(|x| x * half);
    let count = steps.len() as u32;
    let mut slab = Shape::default();
    for (z, up) in [(0.0, true), (-depth, false)] {
        let first = slab.positions.len() as u32;
        slab.positions.extend(steps.iter().flat_map(|x| steps.map(|y| DVec3::new(*x, y, z))));
        for [i, j] in (0..count - 1).flat_map(|i| (0..count - 1).map(move |j| [i, j])) {
            let [a, b] = [first + count * i + j, first + count * (i + 1) + j];
            slab.triangles.extend(match up {
                true => [[a, b, b + 1], [a, b + 1, a + 1]],
                false => [[a, b + 1, b], [a, a + 1, b + 1]],
            });
        }
    }
    slab
}
