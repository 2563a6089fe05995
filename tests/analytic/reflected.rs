//! Media that are too thick to walk through and reflect as half spaces do.

use std::f64::consts::PI;

use floe::study::stability::h_function::HFunction;
use glam::DVec3;

use super::estimates::{assert_every_pixel, assert_mean};
use super::half_space::{COSINES, SLAB, camera, slab, sun};
use super::thick_media::assert_same_mean;
use crate::common::files::sky_picture;
use crate::common::mesh::sphere;
use crate::common::render::Prepared;
use crate::common::scene::SceneFolder;

/// A slab of optical depth 6e7.
const DEPTH: f64 = 60.0;
const BREADTH: f64 = 200.0;
/// 1/m.
const EXTINCTION: f64 = 1e6;

/// A medium of these albedos.
fn cloud(albedos: [f64; 3], more: &str) -> String {
    let scattering = albedos.map(|albedo| albedo * EXTINCTION);
    let absorption = albedos.map(|albedo| (1.0 - albedo) * EXTINCTION);
    format!("[media.cloud]\nscattering = {scattering:?}\nabsorption = {absorption:?}\n{more}\n")
}

/// The scene, which has a half space.
fn reflected(folder: &SceneFolder, text: &str) -> Prepared {
    let scene = folder.scene(text);
    assert!(scene.frame.half_spaces.iter().flatten().count() > 0, "nothing is a half space in {text}");
    scene
}

fn refracting() -> String {
    SLAB.replace("null", "dielectric")
}

/// Of a grey half space without an interface nothing is left to chance but the roulette of what is dark: what it reflects of
/// even light is the weight of any direction, and the sun is looked for.
///
/// ```text
/// L(mu) = 1 - sqrt(1 - albedo) H(mu),   L(mu, mu0) = albedo E / (4 pi) mu0 / (mu + mu0) H(mu) H(mu0)
/// ```
///
/// H is within 2e-6 in the library and 1e-6 here; the sun's disc of 0.01 degrees spreads mu0 by 9e-5 sin / mu0 of it.
#[test]
fn a_grey_half_space_is_as_chandrasekhar_says_in_every_pixel() {
    let folder = slab(DEPTH, BREADTH);
    for albedo in [0.1, 0.5, 0.9, 0.99, 1.0 - 1e-7, 1.0] {
        let h = HFunction::new(albedo);
        for mu in COSINES {
            let text = format!("{}{SLAB}{}", cloud([albedo; 3], ""), camera(mu));
            let even = reflected(&folder, &format!("{text}[sky]\nradiance = 1\n"));
            let expected = 1.0 - (1.0 - albedo).sqrt() * h.at(mu);
            let name = format!("{albedo}, mu {mu}");
            match expected > 0.25 {
                true => assert_every_pixel(&name, &even.render(4, 0), DVec3::splat(expected), 5e-6),
                false => assert_mean(&name, &even.render(256, 0), DVec3::splat(expected), 2e-3),
            }
            for mu0 in [1.0, 0.2] {
                let picture = reflected(&folder, &format!("{}{text}", sun(mu0))).render(16, 0);
                let expected = 0.25 * albedo * mu0 / (mu + mu0) * h.at(mu) * h.at(mu0);
                let name = format!("{albedo}, mu {mu}, mu0 {mu0}");
                assert_every_pixel(&name, &picture, DVec3::splat(expected), 2e-4);
            }
        }
    }
}

/// Lanes of different albedo are weighted over all of them.
#[test]
fn a_coloured_half_space_is_as_chandrasekhar_says() {
    let albedos = [0.5, 0.9, 0.99];
    let h = albedos.map(HFunction::new);
    let folder = slab(DEPTH, BREADTH);
    for (seed, mu) in (0..).zip(COSINES) {
        let text = format!("{}{SLAB}[sky]\nradiance = 1\n{}", cloud(albedos, ""), camera(mu));
        let expected = [0, 1, 2].map(|i| 1.0 - (1.0 - albedos[i]).sqrt() * h[i].at(mu));
        let picture = reflected(&folder, &text).render(256, seed);
        assert_mean(&format!("colours, mu {mu}"), &picture, DVec3::from_array(expected), 2e-3);
    }
}

/// Nothing is lost where nothing is absorbed, of whichever index and phase function, and with interpolated normals. Each
/// turn rounds the throughput by 1e-7, and of index 2.4 there are some ten.
#[test]
fn a_furnace_is_white_in_every_pixel() {
    let ball = SceneFolder::new().mesh("slab.ply", &sphere(DVec3::ZERO, 1.0, 2));
    let round = "[[surfaces]]\nmesh = \"slab.ply\"\nfront = \"air\"\nback = \"cloud\"\nmaterial = { kind = \"dielectric\" }\n";
    let view = "[camera]\neye = [0, -4, 0.5]\ntarget = [0, 0, 0]\nvertical_fov = 32\nresolution = [24, 24]\n";
    for (ior, g) in [(0.75, 0.0), (1.0, 0.0), (1.0, 0.86), (1.33, -0.5), (1.33, 0.86), (2.4, 0.3)] {
        let more = format!("ior = {ior}\nphase = {{ kind = \"henyey-greenstein\", g = {g} }}");
        let medium = cloud([1.0; 3], &more);
        let scene = reflected(&ball, &format!("{medium}{round}{view}[sky]\nradiance = 1\n"));
        let picture = scene.render(16, 0);
        assert_every_pixel(&format!("ball, n {ior}, g {g}"), &picture, DVec3::ONE, 3e-6);
        assert_eq!((picture.counters.cut, picture.counters.untraced), (0, 0), "nothing walks");
        let text = format!("{medium}{}{}[sky]\nradiance = 1\n", refracting(), camera(0.6));
        let picture = reflected(&slab(DEPTH, BREADTH), &text).render(16, 0);
        assert_every_pixel(&format!("slab, n {ior}, g {g}"), &picture, DVec3::ONE, 3e-6);
    }
}

/// Walls that are declared open, behind which the index is another, and meshes that overlap.
#[test]
fn a_furnace_is_white_behind_open_walls_and_among_layers() {
    let view = "[camera]\neye = [0, -4, 0.5]\ntarget = [0, 0, 0]\nvertical_fov = 32\nresolution = [24, 24]\n[sky]\nradiance = 1\n";
    let medium = cloud([1.0; 3], "ior = 1.33");
    let cube = crate::common::mesh::cuboid(DVec3::splat(-1.0), DVec3::new(1.0, 1.0, 0.3));
    let folder = SceneFolder::new()
        .mesh("box_0001.ply", &cube)
        .mesh("ball.ply", &sphere(DVec3::new(0.3, 0.0, 0.2), 0.8, 2));
    let walls = "[frames]\npath = \"box_####.ply\"\n[regions]\n0 = \"air\"\n1 = \"cloud\"\n[domain]\n\
                 box = [[-1, -1, -1], [1, 1, 1]]\nwalls = { sides = \"open\", bottom = \"open\" }\n";
    let layers = "[[meshes]]\npath = \"box_0001.ply\"\ninside = \"water\"\n[[meshes]]\npath = \"ball.ply\"\n\
                  inside = \"cloud\"\npriority = 1\n[media.water]\nior = 1.2\n";
    for scene in [walls, layers] {
        let picture = reflected(&folder, &format!("{medium}{scene}{view}")).render(64, 0);
        assert_every_pixel(scene, &picture, DVec3::ONE, 3e-6);
    }
}

/// Reflectance at a smooth dielectric, and the cosine beyond; all is reflected beyond the critical angle.
fn fresnel(cos: f64, eta: f64) -> (f64, f64) {
    let sine = (1.0 - cos * cos).max(0.0).sqrt() / eta;
    if sine >= 1.0 {
        return (1.0, 0.0);
    }
    let beyond = (1.0 - sine * sine).sqrt();
    let s = (cos - eta * beyond) / (cos + eta * beyond);
    let p = (eta * cos - beyond) / (eta * cos + beyond);
    (0.5 * (s * s + p * p), beyond)
}

/// A half space below an interface, by iteration on nodes of the cosine: what goes up in it is
///
/// ```text
/// u(mu) = u0(mu) + 2 pi integral of f_r(mu, mu0) mu0 F(mu0) u(mu0),       L = (1 - F) u / n^2
/// ```
///
/// u0 being what is reflected of the light that comes in through the interface. F has the form of a square root above the
/// critical angle, and f_r changes fast towards the horizon: nodes are even in the roots of the distances to both.
struct Layered {
    n: f64,
    albedo: f64,
    h: HFunction,
    /// Cosine, weight and u.
    nodes: Vec<[f64; 3]>,
}

impl Layered {
    fn new(n: f64, albedo: f64, source: impl Fn(&Self, f64) -> f64) -> Self {
        let critical = (1.0 - 1.0 / (n * n)).sqrt();
        let parts = [(0.0, critical), (critical, 1.0)];
        let count = 300;
        let node = |(from, to): (f64, f64), i: i32| {
            let root = (f64::from(i) + 0.5) / f64::from(count);
            [from + (to - from) * root * root, (to - from) * 2.0 * root / f64::from(count), 0.0]
        };
        let nodes = parts.iter().flat_map(|part| (0..count).map(move |i| node(*part, i))).collect();
        let mut layered = Self { n, albedo, h: HFunction::new(albedo), nodes };
        let (cosines, h): (Vec<f64>, Vec<f64>) =
            layered.nodes.iter().map(|node| (node[0], layered.h.at(node[0]))).unzip();
        let u0: Vec<f64> = cosines.iter().map(|mu| source(&layered, *mu)).collect();
        let back: Vec<f64> = (0..cosines.len())
            .map(|j| 0.5 * albedo * h[j] * cosines[j] * layered.nodes[j][1] * fresnel(cosines[j], 1.0 / n).0)
            .collect();
        loop {
            let next = |i: usize| {
                let sum =
                    (0..cosines.len()).map(|j| back[j] * layered.nodes[j][2] / (cosines[i] + cosines[j]));
                u0[i] + h[i] * sum.sum::<f64>()
            };
            let next: Vec<f64> = (0..cosines.len()).map(next).collect();
            let change = next.iter().zip(&layered.nodes).map(|(u, n)| (u - n[2]).abs()).fold(0.0, f64::max);
            next.iter().zip(&mut layered.nodes).for_each(|(u, node)| node[2] = *u);
            if change < 1e-9 {
                return layered;
            }
        }
    }

    fn reflection(&self, mu: f64, mu0: f64) -> f64 {
        self.albedo / (4.0 * PI) * self.h.at(mu) * self.h.at(mu0) / (mu + mu0)
    }

    /// Of even light of radiance 1: what has come in by `mu0` is n^2 (1 - F).
    fn even(&self, mu: f64) -> f64 {
        let entered = |mu0: f64| self.n * self.n * (1.0 - fresnel(mu0, 1.0 / self.n).0);
        self.nodes.iter().map(|n| 2.0 * PI * self.reflection(mu, n[0]) * n[0] * n[1] * entered(n[0])).sum()
    }

    /// Of a sun that makes an irradiance of pi on a plane that faces it.
    fn sun(&self, mu: f64, cos: f64) -> f64 {
        let (reflectance, mu0) = fresnel(cos, self.n);
        self.reflection(mu, mu0) * (1.0 - reflectance) * PI * cos
    }

    /// What leaves along the cosine `mu` outside, besides what the interface reflects.
    fn leaving(&self, mu: f64, source: impl Fn(&Self, f64) -> f64) -> f64 {
        let (reflectance, inside) = fresnel(mu, self.n);
        let back = |n: &[f64; 3]| {
            2.0 * PI * self.reflection(inside, n[0]) * n[0] * n[1] * fresnel(n[0], 1.0 / self.n).0 * n[2]
        };
        let u = source(self, inside) + self.nodes.iter().map(back).sum::<f64>();
        (1.0 - reflectance) * u / (self.n * self.n)
    }
}

/// Under an interface of index 1.33, lit evenly and by the sun, which nothing but looking for finds.
#[test]
fn a_half_space_under_an_interface_is_as_quadrature_says() {
    let folder = slab(DEPTH, BREADTH);
    let n = 1.33;
    for albedo in [0.5, 0.9, 0.99, 0.9999] {
        let even = Layered::new(n, albedo, Layered::even);
        for (seed, mu) in (0..).zip(COSINES) {
            let text = format!("{}{}{}", cloud([albedo; 3], "ior = 1.33"), refracting(), camera(mu));
            let expected = fresnel(mu, n).0 + even.leaving(mu, Layered::even);
            let picture = reflected(&folder, &format!("{text}[sky]\nradiance = 1\n")).render(512, seed);
            assert_mean(&format!("even, {albedo}, mu {mu}"), &picture, DVec3::splat(expected), 3e-3);
            let mu0 = COSINES[(seed as usize + 2) % 5];
            let source = |layered: &Layered, mu: f64| layered.sun(mu, mu0);
            let expected = Layered::new(n, albedo, source).leaving(mu, source);
            let scene = reflected(&folder, &format!("{text}{}", sun(mu0)));
            assert!(!scene.frame.needs.sun_behind_interface, "no sun is left out");
            let picture = scene.render(512, seed);
            assert_mean(&format!("sun, {albedo}, mu {mu}"), &picture, DVec3::splat(expected), 3e-3);
        }
    }
}

/// Half a sky and a lamp, looked for at each turn and weighted against chance, or found by chance alone, on a ball whose normals are
/// interpolated over few triangles.
#[test]
fn light_is_the_same_however_it_is_found() {
    let picture = sky_picture(|d| DVec3::new(0.3, 0.6, 1.0) * if d.x + d.z > 0.0 { 2.0 } else { 0.1 });
    let folder = SceneFolder::new()
        .mesh("slab.ply", &sphere(DVec3::ZERO, 1.0, 1))
        .mesh("lamp.ply", &sphere(DVec3::new(1.5, -1.5, 1.5), 0.7, 2))
        .file("sky.exr", &picture);
    let lights = [
        ("picture", "[sky]\nradiance = { image = \"sky.exr\" }\n"),
        (
            "lamp",
            "[[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = { kind = \"emitter\", radiance = [2, 3, 4] }\n",
        ),
    ];
    let view = "[camera]\neye = [0, -4, 0.5]\ntarget = [0, 0, 0]\nvertical_fov = 32\nresolution = [24, 24]\n";
    for (ior, kind) in [(1.0, "null"), (1.33, "dielectric"), (0.75, "dielectric")] {
        for (name, light) in lights {
            let medium = cloud([0.6, 0.95, 1.0], &format!("ior = {ior}"));
            let mut scene = reflected(
                &folder,
                &format!(
                    "{medium}[[surfaces]]\nmesh = \"slab.ply\"\nfront = \"air\"\nback = \"cloud\"\n\
                     material = {{ kind = \"{kind}\" }}\n{light}{view}"
                ),
            );
            assert!(scene.frame.needs.direct_light);
            let looked = scene.render(256, 0);
            scene.frame.needs.direct_light = false;
            assert_same_mean(&format!("{name}, n {ior}"), &looked, &scene.render(1024, 1), 0.02);
        }
    }
}
