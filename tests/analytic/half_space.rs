//! Half spaces and thick slabs that scatter isotropically, against Chandrasekhar's closed forms.

use std::f64::consts::PI;

use floe::study::stability::h_function::HFunction;
use glam::DVec3;

use super::estimates::{assert_every_pixel, assert_mean};
use crate::common::files::sky_picture;
use crate::common::mesh::{TestMesh, parallelogram, sphere};
use crate::common::scene::SceneFolder;

/// Cosines with the normal under which a half space is lit and seen.
pub const COSINES: [f64; 5] = [1.0, 0.8, 0.6, 0.4, 0.2];
/// The lanes of one picture.
const ALBEDOS: [f64; 3] = [0.5, 0.9, 0.99];
const TURBID: &str = "[media.cloud]\nextinction = 1\nalbedo = [0.5, 0.9, 0.99]\n";

/// A slab between z = -depth and 0, without sides. Triangles are as large as their distance from the middle: what a ray
/// meets on a large one is off by the rounding of its far corners, and paths are near the middle.
pub fn slab(depth: f64, breadth: f64) -> SceneFolder {
    let steps = [-1.0, -0.1, -0.01, 0.01, 0.1, 1.0].map(|x| x * breadth);
    let mut slab = TestMesh::default();
    for (z, up) in [(0.0, true), (-depth, false)] {
        let first = slab.positions.len() as u32;
        slab.positions.extend(steps.iter().flat_map(|x| steps.map(|y| DVec3::new(*x, y, z))));
        for [i, j] in (0..5).flat_map(|i| (0..5).map(move |j| [i, j])) {
            let [a, b] = [first + 6 * i + j, first + 6 * (i + 1) + j];
            slab.triangles.extend(match up {
                true => [[a, b, b + 1], [a, b + 1, a + 1]],
                false => [[a, b + 1, b], [a, a + 1, b + 1]],
            });
        }
    }
    SceneFolder::new().mesh("slab.ply", &slab)
}

pub const SLAB: &str = "[[surfaces]]\nmesh = \"slab.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"cloud\"\n\
                    material = { kind = \"null\" }\n";

/// A view of the point at this height whose rays are all parallel to 1e-6.
fn view(eye: [f64; 3], z: f64) -> String {
    format!(
        "[camera]\neye = {eye:?}\ntarget = [0, 0, {z}]\nup = [0, 1, 0]\nvertical_fov = 0.0001\nresolution = [8, 8]\n"
    )
}

/// A view of the origin along this cosine with z.
pub fn camera(mu: f64) -> String {
    view([9.0 * (1.0 - mu * mu).sqrt(), 0.0, 9.0 * mu], 0.0)
}

/// A narrow sun at another azimuth that makes an irradiance of pi on a plane that faces it.
pub fn sun(mu: f64) -> String {
    let sine = (1.0 - mu * mu).sqrt();
    let direction = [-0.6 * sine, 0.8 * sine, mu];
    format!("[sun]\ndirection = {direction:?}\nangular_diameter = 0.01\nirradiance = {PI}\n")
}

fn h_functions() -> [HFunction; 3] {
    ALBEDOS.map(HFunction::new)
}

/// Its moments have closed forms: int H = 2 / albedo (1 - sqrt(1 - albedo)), and int mu H = 2 / sqrt(3) for albedo 1.
#[test]
fn the_h_function_has_its_moments() {
    for albedo in [0.5, 0.9, 0.99, 1.0] {
        let moment = HFunction::new(albedo).moment(0);
        let exact = 2.0 / albedo * (1.0 - (1.0 - albedo).sqrt());
        assert!((moment - exact).abs() < 1e-6, "albedo {albedo}: {moment} is not {exact}");
    }
    let conservative = HFunction::new(1.0);
    assert!((conservative.moment(1) - 2.0 / 3.0_f64.sqrt()).abs() < 1e-6);
    // As tabulated by Chandrasekhar.
    assert!((conservative.at(1.0) - 2.9078).abs() < 5e-5, "H(1) is {}", conservative.at(1.0));
}

/// Under a sun that makes the irradiance E on a plane that faces it,
///
/// ```text
/// L(mu, mu0) = albedo E / (4 pi) mu0 / (mu + mu0) H(mu) H(mu0)
/// ```
///
/// (Chandrasekhar, Radiative Transfer, chapter III). Light from a depth of 50 and more comes back as exp(-2 k 50),
/// k being 0.17 for an albedo of 0.99: 3e-8; from 200 aside as exp(-k 200). From 58 on walks are led to the surface.
#[test]
fn a_half_space_reflects_the_sun_as_chandrasekhar_says() {
    let h = h_functions();
    let folder = slab(60.0, 200.0);
    let (mut ratios, mut weights) = (DVec3::ZERO, DVec3::ZERO);
    let pairs = COSINES.iter().flat_map(|mu| COSINES.map(|mu0| (*mu, mu0)));
    for (seed, (mu, mu0)) in (0..).zip(pairs) {
        let scene = folder.scene(&format!("{TURBID}{SLAB}{}{}", sun(mu0), camera(mu)));
        let expected = [0, 1, 2].map(|i| 0.25 * ALBEDOS[i] * mu0 / (mu + mu0) * h[i].at(mu) * h[i].at(mu0));
        let expected = DVec3::from_array(expected);
        let picture = scene.render(256, seed);
        assert_mean(&format!("mu {mu}, mu0 {mu0}"), &picture, expected, 0.02);
        let (mean, se) = picture.mean();
        let weight = (expected / se) * (expected / se);
        ratios += weight * mean / expected;
        weights += weight;
        assert_eq!(picture.counters.cut, 0);
    }
    // All together: every pair has a seed of its own.
    let (ratio, se) = (ratios / weights, weights.map(|w| 1.0 / w.sqrt()));
    println!("half space: {ratio:.6} +- {se:.6} of what is expected");
    assert!(se.max_element() < 5e-3 && (ratio - 1.0).abs().cmple(5.0 * se).all(), "{ratio} +- {se}");
}

/// A half space as hot as a black body of radiance B shows
///
/// ```text
/// L(mu) = B sqrt(1 - albedo) H(mu)
/// ```
///
/// by Kirchhoff's law: what is left of 1 by the light that it reflects of surroundings of radiance 1,
/// 1 - sqrt(1 - albedo) H(mu) (Chandrasekhar, Radiative Transfer, chapter V).
#[test]
fn a_glowing_half_space_shows_what_it_does_not_reflect() {
    let h = h_functions();
    let folder = slab(50.0, 200.0);
    for (seed, mu) in (0..).zip(COSINES) {
        let scene = folder.scene(&format!("{TURBID}emission = 2\n{SLAB}{}", camera(mu)));
        let expected = [0, 1, 2].map(|i| 2.0 * (1.0 - ALBEDOS[i]).sqrt() * h[i].at(mu));
        assert_mean(&format!("glow, mu {mu}"), &scene.render(1024, seed), DVec3::from_array(expected), 5e-3);
    }
}

/// Isotropic scattering does not ask for the azimuth of light, so half a sky that shines 2 is reflected as a whole one that
/// shines 1:
///
/// ```text
/// L(mu) = 1 - sqrt(1 - albedo) H(mu)
/// ```
///
/// The half is a lamp of triangles or a picture of the sky, looked for from each particle through the matched boundary and
/// weighted against running into it, or found by chance alone.
#[test]
fn a_half_space_reflects_half_a_sky_however_it_is_found() {
    let h = h_functions();
    let dome = sphere(DVec3::ZERO, 400.0, 3).turned();
    let is_lamp = |t: &[u32; 3]| t.iter().map(|&v| dome.positions[v as usize].y).sum::<f64>() > 0.0;
    let lamp = TestMesh {
        triangles: dome.triangles.iter().copied().filter(is_lamp).collect(),
        positions: dome.positions.clone(),
    };
    let picture = sky_picture(|d| DVec3::splat(if d.y > 0.0 { 2.0 } else { 0.0 }));
    let folder = slab(60.0, 200.0).mesh("lamp.ply", &lamp).file("sky.exr", &picture);
    let lights = [
        ("lamp", "[[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = { kind = \"emitter\", radiance = 2 }\n"),
        ("picture", "[sky]\nradiance = { image = \"sky.exr\" }\n"),
    ];
    for (name, light) in lights {
        for (seed, mu) in (0..).zip(COSINES) {
            let mut scene = folder.scene(&format!("{TURBID}{SLAB}{light}{}", camera(mu)));
            let expected = [0, 1, 2].map(|i| 1.0 - (1.0 - ALBEDOS[i]).sqrt() * h[i].at(mu));
            let expected = DVec3::from_array(expected);
            assert_mean(&format!("{name}, mu {mu}"), &scene.render(256, seed), expected, 1e-2);
            scene.frame.needs.direct_light = false;
            let name = format!("{name} by chance, mu {mu}");
            assert_mean(&name, &scene.render(256, 10 + seed), expected, 1e-2);
        }
    }
}

/// An absorbing slab of depth d shows B (1 - exp(-sigma_a d / mu)). Distances are f32 of about 9 m beside 0.3 m: 4e-6.
#[test]
fn a_glowing_slab_that_scatters_nothing_is_exact() {
    let folder = slab(0.3, 200.0);
    for mu in COSINES {
        let scene = folder
            .scene(&format!("[media.cloud]\nabsorption = [0.2, 1, 5]\nemission = 2\n{SLAB}{}", camera(mu)));
        let expected = [0.2, 1.0, 5.0].map(|sigma_a| -2.0 * libm::expm1(-sigma_a * 0.3 / mu));
        let name = format!("glowing slab, mu {mu}");
        assert_every_pixel(&name, &scene.render(1, 0), DVec3::from_array(expected), 1e-5);
    }
}

/// A slab of optical depth tau that absorbs nothing holds, deep inside, the light that a half space would, less a flux pi f
/// through it that falls evenly to zero where both faces are moved outwards by Hopf's constant q. Each face lets out, or
/// keeps back, f K(mu) (Milne's problem):
///
/// ```text
/// K(mu) = sqrt(3) / 4 H(mu)
/// f = 4 / 3 / (tau + 2 q)                         under a white sky on one side
/// f = 4 / 3 / (tau + 2 q) E mu0 / pi K(mu0)       under a sun
/// ```
///
/// What is left out falls as exp(-tau). So of a white sky each face shows R(mu) = 1 - f K(mu) and T(mu) = f K(mu), and under
/// a sun
///
/// ```text
/// L(mu, mu0) = E mu0 / (4 pi) H(mu) H(mu0) (1 / (mu + mu0) - 1 / (tau + 2 q))
/// ```
struct Milne(HFunction);

impl Milne {
    fn new() -> Self {
        Self(HFunction::new(1.0))
    }

    fn escape(&self, mu: f64) -> f64 {
        0.25 * 3.0_f64.sqrt() * self.0.at(mu)
    }

    /// Hopf's constant.
    fn extrapolation(&self) -> f64 {
        self.0.moment(2) / self.0.moment(1)
    }

    fn transmittance(&self, depth: f64, mu: f64) -> f64 {
        4.0 / 3.0 / (depth + 2.0 * self.extrapolation()) * self.escape(mu)
    }

    /// Under an irradiance of pi.
    fn reflected(&self, depth: f64, mu: f64, mu0: f64) -> f64 {
        let loss = 1.0 / (depth + 2.0 * self.extrapolation());
        0.25 * mu0 * self.0.at(mu) * self.0.at(mu0) * (1.0 / (mu + mu0) - loss)
    }
}

/// 0.710446 (Chandrasekhar, Radiative Transfer, chapter III).
#[test]
fn hopfs_constant_is_that_of_the_h_function() {
    let q = Milne::new().extrapolation();
    assert!((q - 0.710_446).abs() < 2e-6, "{q}");
}

/// White above and black below, seen from either side. A walk through an optical depth of 1000 takes half a million
/// collisions, and all walks take 2000 in the mean: none is lost.
#[test]
fn what_a_thick_slab_does_not_reflect_it_transmits() {
    let milne = Milne::new();
    for (depth, mu, samples, most) in
        [(10.0, 1.0_f64, 512, 3e-3), (100.0, 0.6, 512, 1e-3), (1000.0, 0.8, 256, 1e-3)]
    {
        let floor = parallelogram(DVec3::new(-1e5, -1e5, -depth - 20.0), DVec3::X * 2e5, DVec3::Y * 2e5);
        let folder = slab(depth, 10.0 * depth).mesh("floor.ply", &floor);
        let render = |camera: &str, seed| {
            let scene = folder.scene(&format!(
                "[media.cloud]\nscattering = 1\n{SLAB}[[surfaces]]\nmesh = \"floor.ply\"\n\
                 material = {{ kind = \"diffuse\", reflectance = 0 }}\n[sky]\nradiance = 1\n{camera}"
            ));
            scene.render(samples, seed)
        };
        let below = [9.0 * (1.0 - mu * mu).sqrt(), 0.0, -depth - 9.0 * mu];
        let reflected = render(&camera(mu), 0);
        let transmitted = render(&view(below, -depth), 1);
        let expected = milne.transmittance(depth, mu);
        assert_mean(&format!("R of {depth}"), &reflected, DVec3::splat(1.0 - expected), most);
        assert_mean(&format!("T of {depth}"), &transmitted, DVec3::splat(expected), most);
        let ((r, r_se), (t, t_se)) = (reflected.mean(), transmitted.mean());
        let (sum, se) = (r.x + t.x, r_se.x.hypot(t_se.x));
        println!("R + T of {depth}: {sum:.6} +- {se:.6}, {:?}", reflected.counters);
        assert!((sum - 1.0).abs() < 5.0 * se, "R + T of {depth}: {sum} +- {se}");
        assert_eq!(reflected.counters.cut + transmitted.counters.cut, 0);
    }
}

/// The flux through a slab of 30 takes up to a twentieth of what a half space reflects, through one of 1000 next to nothing.
#[test]
fn a_slab_that_absorbs_nothing_reflects_the_sun() {
    let milne = Milne::new();
    for (depth, samples, most) in [(30.0, 256, 0.02), (1000.0, 16, 0.1)] {
        let folder = slab(depth, 10.0 * depth);
        for (seed, (mu, mu0)) in (0..).zip(COSINES.into_iter().zip([0.6, 1.0, 0.2, 0.8, 0.4])) {
            let scene =
                folder.scene(&format!("[media.cloud]\nscattering = 1\n{SLAB}{}{}", sun(mu0), camera(mu)));
            let expected = DVec3::splat(milne.reflected(depth, mu, mu0));
            let picture = scene.render(samples, seed);
            assert_mean(&format!("{depth} under a sun, mu {mu}, mu0 {mu0}"), &picture, expected, most);
            assert_eq!(picture.counters.cut, 0);
        }
    }
}
