//! Media whose lanes differ by factors of a thousand: each lane is what it would be alone.

use glam::DVec3;

use super::pieces::{WHITE_SKY, camera, dielectric, medium, null, render};
use super::shapes::cuboid;
use super::{Case, Group, Measurement, Picture, Reference, Scene};
use crate::study::StudyError;

/// The group.
pub(super) const GROUP: Group = Group {
    name: "chromatic",
    parameter: "ratio of extinctions",
    about: "Media whose lanes have extinctions far apart: each is what it would be alone.",
    cases,
};

fn cases() -> Vec<Case> {
    let ratios = [1.0005, 1.002, 10.0, 1e3, 1e6];
    let passed = ratios.map(|ratio| {
        Case::new(&GROUP, "a cube that absorbs: exp(-tau)", ratio, move || absorbed(ratio)).quick()
    });
    let alone = [1.0005, 1.002, 10.0, 1e3].map(|ratio| {
        Case::new(&GROUP, "a turbid cube of albedo 0.8, each lane alone", ratio, move || alone(ratio))
            .quick_if(ratio < 1e3)
    });
    let furnaces = [1.0005, 10.0, 1e3].map(|ratio| {
        Case::new(&GROUP, "white furnace, albedo 1", ratio, move || furnace(ratio)).quick_if(ratio < 1e3)
    });
    let spectral = [10.0, 1e3].map(|ratio| {
        Case::new(&GROUP, "grey furnace on four wavelengths", ratio, move || spectral(ratio))
            .quick_if(ratio < 1e3)
    });
    passed.into_iter().chain(alone).chain(furnaces).chain(spectral).collect()
}

/// The extinctions of the three lanes, for a cube of 1 m.
fn extinctions(ratio: f64) -> [f64; 3] {
    [1.0 / ratio.sqrt(), 1.0, ratio.sqrt()]
}

fn cube(text: &str) -> Result<Picture, StudyError> {
    let text = text.to_owned() + &camera([0.2, -3.0, 0.1], [0.2, 0.0, 0.1], 0.001, [8, 8]) + WHITE_SKY;
    Scene::new().mesh("cube.ply", &cuboid(DVec3::splat(-0.5), DVec3::splat(0.5))).render(&text)
}

/// As the slab of `extinction.rs`.
fn absorbed(ratio: f64) -> Result<Measurement, StudyError> {
    let depths = extinctions(ratio);
    let text =
        medium("ink", &format!("absorption = {depths:?}")) + &null("cube.ply", "air", "ink") + &render(4, "");
    let picture = cube(&text)?;
    let expected = depths.map(|depth| libm::exp(-depth));
    let channels =
        Measurement::channels_of(&picture, Reference::ClosedForm, expected).into_iter().zip(depths);
    Ok(Measurement::worst(channels.map(|(channel, depth)| {
        let tolerance = channel.expected * 1e-6 * (1.0 + depth) + f64::from(f32::MIN_POSITIVE);
        channel.tolerance(tolerance)
    })))
}

/// Three lanes together, and each in all three lanes of a picture of its own.
fn alone(ratio: f64) -> Result<Measurement, StudyError> {
    let text = |extinction: &str, samples| {
        medium("milk", &format!("ior = 1.33\nextinction = {extinction}\nalbedo = 0.8"))
            + &dielectric("cube.ply", "air", "milk")
            + &render(samples, "")
    };
    let together = cube(&text(&format!("{:?}", extinctions(ratio)), 1024))?;
    let (mean, error) = together.mean();
    let mut lanes = Vec::new();
    for (i, extinction) in extinctions(ratio).into_iter().enumerate() {
        let own = cube(&(text(&format!("{extinction:e}"), 512) + "seed = 1\n"))?;
        let (own_mean, own_error) = own.mean();
        let lane = Measurement::new(Reference::Invariance, own_mean.x, mean[i]).of(&own);
        lanes.push(
            lane.standard_error(libm::hypot(error[i], own_error.x))
                .tolerance(1e-6)
                .note(format!("channel {i}")),
        );
    }
    Ok(Measurement::worst(lanes).of(&together))
}

fn furnace(ratio: f64) -> Result<Measurement, StudyError> {
    let text = medium("milk", &format!("ior = 1.33\nscattering = {:?}", extinctions(ratio)))
        + &dielectric("cube.ply", "air", "milk")
        + &render(1024, "");
    let picture = cube(&text)?;
    let channels = Measurement::channels_of(&picture, Reference::ClosedForm, [1.0; 3]);
    Ok(Measurement::worst(channels.map(|channel| channel.tolerance(1e-5))))
}

/// White light in white surroundings stays white: each of the three colours is a mean over four wavelengths, whose
/// table is of whole nanometres.
fn spectral(ratio: f64) -> Result<Measurement, StudyError> {
    let [low, middle, high] = extinctions(ratio);
    let curve = format!("{{ wavelength = [400, 550, 700], value = [{high:e}, {middle:e}, {low:e}] }}");
    let text = medium("milk", &format!("ior = 1.33\nscattering = {curve}"))
        + &dielectric("cube.ply", "air", "milk")
        + &render(1024, "");
    let picture = cube(&text)?;
    let channels = Measurement::channels_of(&picture, Reference::ClosedForm, [1.0; 3]);
    Ok(Measurement::worst(channels.map(|channel| channel.tolerance(1e-3))))
}
