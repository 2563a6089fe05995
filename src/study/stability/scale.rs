//! Scenes of any size, and meshes of any number of triangles.
//!
//! Where all lengths grow by s and coefficients by 1 / s, radiance stays: what the picture shows has no unit.

use glam::DVec3;

use super::bodies::{LABELS, LOSSLESS, WHITE, alike, joined};
use super::shapes::{Shape, cuboid, parallelogram, sphere};
use super::{Case, Group, Measurement, Picture, Reference, Scene};
use crate::study::StudyError;

/// The group.
pub(super) const GROUP: Group = Group {
    name: "scale",
    parameter: "metres that a length of 1 becomes; triangles",
    about: "A scene of micrometres or of a million kilometres, with coefficients to match; fine meshes.",
    cases,
};

const SCALES: [f64; 10] = [1e-6, 1e-4, 1e-3, 1e-2, 1.0, 1e2, 1e4, 1e6, 1e7, 1e9];

/// How the scene is rendered, and what is in it.
const WAYS: [(&str, [f64; 2], &str); 4] = [
    ("clear", [0.0, 0.0], ""),
    ("turbid", [1.0, 6.0], ""),
    ("turbid, by photons", [1.0, 6.0], "integrator = \"photon\"\nphotons = { count = 2000 }\n"),
    ("turbid, forced scattering", [1.0, 6.0], "forced_scattering = 2\n"),
];

fn cases() -> Vec<Case> {
    let pictures = WAYS.iter().flat_map(|&(name, scattering, way)| {
        SCALES.iter().map(move |&scale| {
            let name = format!("the same picture, {name}");
            let case = Case::new(&GROUP, name, scale, move || {
                Ok(alike(&picture(1.0, scattering, way)?, &picture(scale, scattering, way)?))
            });
            if [1e-6, 1e7, 1e9].contains(&scale) { case.quick() } else { case }
        })
    });
    let fine = [2, 5, 8].map(|levels| {
        let triangles = 8.0 * f64::from(1 << (2 * levels));
        let case =
            Case::new(&GROUP, "a clear ball of many triangles in a white furnace", triangles, move || {
                ball(levels)
            });
        if levels < 8 { case.quick() } else { case }
    });
    pictures.chain(fine).collect()
}

/// A box of water and one of ice that touch, over a diffuse floor, below a lamp and the sun.
fn picture(scale: f64, scattering: [f64; 2], way: &str) -> Result<Picture, StudyError> {
    let scaled =
        |shape: Shape| Shape { positions: shape.positions.iter().map(|&p| p * scale).collect(), ..shape };
    let body = |min: DVec3, max: DVec3| scaled(cuboid(min, max).askew());
    let water = body(DVec3::new(-1.0, -0.8, -0.7), DVec3::new(0.0, 0.8, 0.6)).labelled(0, 1);
    let ice = body(DVec3::new(0.0, -0.8, -0.7), DVec3::new(1.1, 0.8, 0.6)).labelled(0, 2);
    let square = |half: f64, height: f64| {
        let corner = DVec3::new(-half, -half, height);
        scaled(parallelogram(corner, DVec3::X * 2.0 * half, DVec3::Y * 2.0 * half))
    };
    let [[in_water, in_ice], [water_a, ice_a]] = [scattering, [0.4, 0.1]].map(|of| of.map(|k| k / scale));
    let eye = [0.7, -4.0, 1.9].map(|x| x * scale);
    let text = format!(
        "{LABELS}[media.water]\nior = 1.33\nabsorption = {water_a:e}\nscattering = {in_water:e}\n\
         phase = {{ kind = \"henyey-greenstein\", g = 0.7 }}\n\
         [media.ice]\nior = 1.31\nabsorption = {ice_a:e}\nscattering = {in_ice:e}\n\
         [[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = [0.8, 0.6, 0.4] }}\n\
         [[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = {{ kind = \"emitter\", radiance = [3, 2.5, 2] }}\n\
         [sky]\nradiance = [0.5, 0.6, 0.7]\n[sun]\ndirection = [0.4, 0.2, 0.9]\nirradiance = 1\nangular_diameter = 10\n\
         [camera]\neye = {eye:?}\ntarget = [0, 0, 0]\nvertical_fov = 36\nresolution = [24, 18]\n\
         [render]\nsamples = 16\n{way}"
    );
    let scene = Scene::new()
        .mesh("floor.ply", &square(3.0, -0.9))
        .mesh("lamp.ply", &square(1.0, 3.0).turned())
        .frame(joined([water, ice]));
    scene.render(&text)
}

/// The mean over all pixels: the shallowest paths go round in the facets more than 1024 times, when roulette begins.
fn ball(levels: u32) -> Result<Measurement, StudyError> {
    let text = format!("{LABELS}{}{WHITE}", LOSSLESS[0].1);
    let picture = Scene::new().frame(sphere(DVec3::ZERO, 0.9, levels).labelled(0, 1)).render(&text)?;
    let (mean, error) = picture.mean();
    let measured = Measurement::new(Reference::ClosedForm, 1.0, mean.x).of(&picture);
    let note = "tests/scale.rs has one of ten million triangles";
    Ok(measured.standard_error(error.x).tolerance(1e-6).note(note))
}
