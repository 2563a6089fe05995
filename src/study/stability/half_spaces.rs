//! Media too thick to walk through, which reflect as half spaces do ([`crate::optics::half_space`]).
//!
//! Nothing about them depends on their size any more: coordinates are those of their surface, and a path has as many turns as
//! its interface turns it back. So numbers are the same from the smallest size to the greatest.

use std::f64::consts::PI;

use glam::DVec3;

use super::shapes::{cuboid, sphere};
use super::{Case, Group, Measurement, Reference, Scene};
use crate::optics::half_space::h_function::HFunction;
use crate::study::StudyError;

/// The group.
pub(super) const GROUP: Group = Group {
    name: "half-spaces",
    parameter: "extinction times size",
    about: "Media too thick to walk through, as half spaces.",
    cases,
};

/// The least size of a half space, but for its rounding.
const LEAST: f64 = 1.1e5;
/// Of the medium that is compared with closed forms.
const ALBEDO: f64 = 0.9;
/// Cosines with the normal of the eye and of the sun.
const COSINES: [f64; 2] = [0.6, 0.8];

fn cases() -> Vec<Case> {
    let sizes = [LEAST, 1e6, 1e7, 1e8, 1e9];
    let each = |name: &'static str, measure: fn(f64) -> Result<Measurement, StudyError>| {
        sizes.map(|size| Case::new(&GROUP, name, size, move || measure(size)).quick())
    };
    let furnaces = each("white furnace of a cube of index 1.33, albedo 1", furnace);
    let even = each("albedo 0.9 under an even sky", under_even_sky);
    let sunlit = each("albedo 0.9 under a sun", under_sun);
    let coloured = each("a coloured ball of index 1.33: as at the least size", ball);
    [furnaces, even, sunlit, coloured].into_iter().flatten().collect()
}

/// Nothing may be seen of it: weights are 1 but for the rounding of some ten turns.
fn furnace(size: f64) -> Result<Measurement, StudyError> {
    let text = format!(
        "[media.milk]\nior = 1.33\nscattering = {size:e}\n\
         [[surfaces]]\nmesh = \"cube.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"milk\"\n\
         material = {{ kind = \"dielectric\" }}\n[sky]\nradiance = 1\n[camera]\neye = [1.2, -3.5, 0.8]\n\
         target = [0, 0, 0]\nvertical_fov = 16\nresolution = [8, 8]\n[render]\nsamples = 16\n"
    );
    let cube = cuboid(DVec3::splat(-0.5), DVec3::splat(0.5));
    let picture = Scene::new().mesh("cube.ply", &cube).render(&text)?;
    let got = picture.farthest(1.0);
    Ok(Measurement::new(Reference::ClosedForm, 1.0, got).of(&picture).tolerance(1e-6))
}

/// ```text
/// L = 1 - sqrt(1 - albedo) H(mu)                                                             [CHANDRASEKHAR60 ch. V]
/// ```
fn under_even_sky(size: f64) -> Result<Measurement, StudyError> {
    let rest = (1.0 - ALBEDO).sqrt();
    block(size, "[sky]\nradiance = 1\n", 1.0 - rest * HFunction::default().at(rest, COSINES[0]), 5e-6)
}

/// ```text
/// L = albedo E / (4 pi) mu0 / (mu + mu0) H(mu) H(mu0)                                        [CHANDRASEKHAR60 ch. III]
/// ```
/// The sun's disc of 0.01 degrees spreads mu0 by 7e-5 of it.
fn under_sun(size: f64) -> Result<Measurement, StudyError> {
    let [mu, mu0] = COSINES;
    let h = HFunction::default();
    let [a, b] = COSINES.map(|mu| h.at((1.0 - ALBEDO).sqrt(), mu));
    let sine = (1.0 - mu0 * mu0).sqrt();
    let sun = format!(
        "[sun]\ndirection = {:?}\nangular_diameter = 0.01\nirradiance = {PI}\n",
        [-0.6 * sine, 0.8 * sine, mu0]
    );
    block(size, &sun, 0.25 * ALBEDO * mu0 / (mu + mu0) * a * b, 1e-4)
}

/// The middle of the top of a block of 4 x 4 x 1 m, of which every pixel is the closed form.
fn block(size: f64, light: &str, expected: f64, tolerance: f64) -> Result<Measurement, StudyError> {
    let mu = COSINES[0];
    let eye = [3.0 * (1.0 - mu * mu).sqrt(), 0.0, 3.0 * mu];
    let text = format!(
        "[media.milk]\nscattering = {:e}\nabsorption = {:e}\n\
         [[surfaces]]\nmesh = \"block.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"milk\"\n\
         material = {{ kind = \"null\" }}\n{light}[camera]\neye = {eye:?}\ntarget = [0, 0, 0]\n\
         vertical_fov = 0.001\nresolution = [4, 4]\n[render]\nsamples = 16\n",
        ALBEDO * size,
        (1.0 - ALBEDO) * size
    );
    let block = cuboid(DVec3::new(-2.0, -2.0, -1.0), DVec3::new(2.0, 2.0, 0.0));
    let picture = Scene::new().mesh("block.ply", &block).render(&text)?;
    let got = picture.farthest(expected);
    Ok(Measurement::new(Reference::ClosedForm, expected, got).of(&picture).tolerance(tolerance * expected))
}

/// The same random numbers and, but for the rounding of its albedo, the same medium.
fn ball(size: f64) -> Result<Measurement, StudyError> {
    let render = |size: f64| {
        let [scattering, absorption] =
            [[0.5, 0.9, 0.99], [0.5, 0.1, 0.01]].map(|share| share.map(|s| s * size));
        let text = format!(
            "[media.milk]\nior = 1.33\nscattering = {scattering:?}\nabsorption = {absorption:?}\n\
             [[surfaces]]\nmesh = \"ball.ply\"\nfront = \"air\"\nback = \"milk\"\n\
             material = {{ kind = \"dielectric\" }}\n[sky]\nradiance = 1\n[sun]\ndirection = [0.5, -0.6, 0.7]\n\
             irradiance = 2\n[camera]\neye = [0, -4, 0.5]\ntarget = [0, 0, 0]\nvertical_fov = 16\n\
             resolution = [16, 16]\n[render]\nsamples = 64\n"
        );
        Scene::new().mesh("ball.ply", &sphere(DVec3::ZERO, 0.5, 3)).render(&text)
    };
    let (picture, least) = (render(size)?, render(LEAST)?);
    let (got, expected) = (picture.mean().0, least.mean().0);
    let channels = [0, 1, 2].map(|i| {
        Measurement::new(Reference::Invariance, expected[i], got[i])
            .of(&picture)
            .tolerance(1e-4 * expected[i])
    });
    Ok(Measurement::worst(channels))
}
