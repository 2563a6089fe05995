//! Light that is scattered once, against closed forms and quadrature in index-matched media.
//!
//! ```text
//! L = T(d) L0 + integral from 0 to d of T(t) sigma_s J1(t) dt
//! ```
//! J1(t) being what reaches the point t of the ray straight from the lights, times the phase function.

use std::f64::consts::PI;

use floe::integrator::{Integrator, Scattered};
use glam::DVec3;

use super::estimates::assert_mean;
use super::media::{CUBE, DENSITIES, OBLIQUE, folder};
use crate::common::files::sky_picture;
use crate::common::mesh::{TestMesh, cuboid, parallelogram};
use crate::common::render::Prepared;
use crate::common::scene::SceneFolder;

const ONCE: &str = "[render]\nintegrator = \"single-scattering\"\n";

/// Coefficients of a slab's medium on the three channels.
#[derive(Clone, Copy)]
struct Slab {
    depth: f64,
    sigma_a: [f64; 3],
    sigma_s: [f64; 3],
    g: f64,
}

/// Grey and chromatic, thin to thick, scattering forward, backward and evenly.
const SLABS: [Slab; 4] = [
    Slab { depth: 0.1, sigma_a: [0.0; 3], sigma_s: [0.5; 3], g: 0.6 },
    Slab { depth: 1.0, sigma_a: [0.3; 3], sigma_s: [0.7; 3], g: -0.4 },
    Slab { depth: 1.0, sigma_a: [1.0, 0.2, 0.0], sigma_s: [0.3, 1.0, 3.0], g: 0.0 },
    Slab { depth: 2.0, sigma_a: [0.1, 1.0, 0.5], sigma_s: [2.0, 1.0, 0.1], g: 0.6 },
];

/// Henyey and Greenstein's phase function.
fn phase(g: f64, cos: f64) -> f64 {
    (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * cos).powf(1.5))
}

impl Slab {
    /// From z = -depth to 0, so wide that light through its sides is dimmed by exp(-100).
    fn mesh(&self) -> TestMesh {
        cuboid(DVec3::new(-1e3, -1e3, -self.depth), DVec3::new(1e3, 1e3, 0.0))
    }

    fn scene(&self) -> String {
        format!(
            "[media.fluid]\nabsorption = {:?}\nscattering = {:?}\n\
             phase = {{ kind = \"henyey-greenstein\", g = {} }}\n{CUBE}",
            self.sigma_a, self.sigma_s, self.g
        )
    }

    /// A function of sigma_s and sigma_t on all channels.
    fn on_channels(&self, value: impl Fn(f64, f64) -> f64) -> DVec3 {
        DVec3::from_array([0, 1, 2].map(|i| value(self.sigma_s[i], self.sigma_a[i] + self.sigma_s[i])))
    }
}

/// Straight down from above, or straight up from below: `side` is 1 or -1.
fn vertical(side: f64) -> String {
    format!(
        "[camera]\neye = [0, 0, {}]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nvertical_fov = 0.001\nresolution = [4, 4]\n",
        4.0 * side
    )
}

/// The midpoint rule.
fn integral(from: f64, to: f64, steps: u32, value: impl Fn(f64) -> f64) -> f64 {
    let step = (to - from) / f64::from(steps);
    (0..steps).map(|i| value(from + (f64::from(i) + 0.5) * step)).sum::<f64>() * step
}

/// The sun at a zenith angle of cosine mu lights depth z by E exp(-sigma_t z / mu). Up and down again:
///
/// ```text
/// from above:  E p(-mu) sigma_s / (sigma_t (1 + 1 / mu)) (1 - exp(-sigma_t D (1 + 1 / mu)))
/// from below:  E p(mu) sigma_s (exp(-sigma_t D) - exp(-sigma_t D / mu)) / (sigma_t (1 / mu - 1))
/// ```
/// A disc of 0.05 degrees changes mu by 3e-4 at its rim and results by 1e-7 on average.
#[test]
fn a_slab_in_the_sun_scatters_once_what_the_closed_form_says() {
    let (mu, irradiance) = (0.8, 10.0);
    for slab in SLABS {
        let folder = SceneFolder::new().mesh("cube.ply", &slab.mesh());
        for (side, forced) in [(1.0, 0), (-1.0, 0), (1.0, 1), (-1.0, 1)] {
            let scene = folder.scene(&format!(
                "{}{ONCE}forced_scattering = {forced}\n{}[sun]\ndirection = [0, 0.6, 0.8]\nirradiance = {irradiance}\nangular_diameter = 0.05\n",
                slab.scene(),
                vertical(side)
            ));
            let expected = slab.on_channels(|sigma_s, sigma_t| {
                let scattered = irradiance * phase(slab.g, -side * mu) * sigma_s / sigma_t;
                if side > 0.0 {
                    let rate = 1.0 + 1.0 / mu;
                    -scattered / rate * libm::expm1(-sigma_t * slab.depth * rate)
                } else {
                    let depth = sigma_t * slab.depth;
                    scattered / (1.0 / mu - 1.0) * (libm::exp(-depth) - libm::exp(-depth / mu))
                }
            });
            let name = format!("sun on a slab of {} m, side {side}, forced {forced}", slab.depth);
            assert_mean(&name, &scene.render(1024, 0), expected, 3e-2 * expected.max_element());
        }
    }
}

/// Under a sky of radiance 1 the light at depth z is that of both half spaces, 1/2 (E2(tau) + E2(tau')), where E2 is the
/// integral of exp(-tau / mu) over mu from 0 to 1; there is 1 behind the slab as well. Without a direction to prefer,
/// the phase function has to be even.
#[test]
fn a_slab_under_an_even_sky_scatters_once_what_quadrature_says() {
    let e2 = |tau: f64| integral(0.0, 1.0, 400, |mu| libm::exp(-tau / mu));
    for slab in SLABS.map(|slab| Slab { g: 0.0, ..slab }) {
        let folder = SceneFolder::new().mesh("cube.ply", &slab.mesh());
        let scene = folder.scene(&format!("{}{ONCE}{}[sky]\nradiance = 1\n", slab.scene(), vertical(1.0)));
        let expected = slab.on_channels(|sigma_s, sigma_t| {
            let scattered = integral(0.0, slab.depth, 400, |z| {
                let both = e2(sigma_t * z) + e2(sigma_t * (slab.depth - z));
                libm::exp(-sigma_t * z) * 0.5 * both
            });
            libm::exp(-sigma_t * slab.depth) + sigma_s * scattered
        });
        let name = format!("sky over a slab of {} m", slab.depth);
        assert_mean(&name, &scene.render(1024, 0), expected, 1e-2);
    }
}

/// A lamp of radiance 4, turned towards the slab, and how much of the way to it lies within the medium.
fn lamp_in(slab: &Slab, lamp: &TestMesh) -> DVec3 {
    let [corner, edge1, edge2] =
        [lamp.positions[0], lamp.positions[1] - lamp.positions[0], lamp.positions[3] - lamp.positions[0]];
    let facing = edge1.cross(edge2);
    let steps = 24_u32;
    let points: Vec<DVec3> = (0..steps * steps)
        .map(|i| {
            let share = |j: u32| (f64::from(j) + 0.5) / f64::from(steps);
            corner + edge1 * share(i % steps) + edge2 * share(i / steps)
        })
        .collect();
    slab.on_channels(|sigma_s, sigma_t| {
        let lit = |z: f64| {
            let from_point = |light: &DVec3| {
                let way = *light - DVec3::new(0.0, 0.0, -z);
                let distance = way.length();
                let within = if light.z > 0.0 { distance * z / way.z } else { distance };
                let area = facing.dot(-way / distance).max(0.0) / f64::from(steps * steps);
                // Travel: from the lamp along -way, then up to the eye.
                let turned = phase(slab.g, -way.z / distance);
                4.0 * turned * libm::exp(-sigma_t * within) * area / (distance * distance)
            };
            points.iter().map(from_point).sum::<f64>()
        };
        sigma_s * integral(0.0, slab.depth, 1000, |z| libm::exp(-sigma_t * z) * lit(z))
    })
}

fn lit_slab(slab: &Slab, lamp: &TestMesh) -> Prepared {
    SceneFolder::new().mesh("cube.ply", &slab.mesh()).mesh("lamp.ply", lamp).scene(&format!(
        "{}{ONCE}{}[[surfaces]]\nmesh = \"lamp.ply\"\nnormals = \"flat\"\n\
         material = {{ kind = \"emitter\", radiance = 4 }}\n",
        slab.scene(),
        vertical(1.0)
    ))
}

/// Lamps over the slab and within it, looked for and, where enough is scattered, found by chance: the balance heuristic
/// changes nothing but the noise.
/// 24 x 24 points on a lamp half a metre away from the ray are off by some (1/24)^2 / 24 of its light: 1e-4.
#[test]
fn a_lamp_in_and_over_a_slab_lights_it_as_quadrature_says() {
    let v = DVec3::new;
    let over = parallelogram(v(0.2, -0.5, 0.4), v(0.1, 1.0, 0.0), v(0.7, 0.0, 0.1));
    let within = parallelogram(v(0.5, -0.4, -0.8), v(0.1, 0.8, 0.0), v(-0.1, 0.0, 0.6)).turned();
    for slab in SLABS {
        for (name, lamp) in [("over", &over), ("within", &within)] {
            if name == "within" && slab.depth < 1.0 {
                continue;
            }
            // A lamp that is turned has its edges in the other order.
            let edges = if name == "within" {
                let p = &lamp.positions;
                TestMesh { positions: vec![p[0], p[3], p[2], p[1]], triangles: lamp.triangles.clone() }
            } else {
                lamp.clone()
            };
            let expected = lamp_in(&slab, &edges);
            let mut scene = lit_slab(&slab, lamp);
            let name = format!("lamp {name} a slab of {} m", slab.depth);
            let most = 1e-2 * expected.max_element();
            let with = scene.render(8192, 0);
            assert_mean(&name, &with, expected, most);
            if slab.depth < 1.0 {
                continue;
            }
            scene.frame.needs.direct_light = false;
            let without = scene.render(4096, 1);
            assert_mean(&format!("{name}, by chance"), &without, expected, 10.0 * most);
            assert!(with.mean().1.max_element() < without.mean().1.max_element());
        }
    }
}

/// Sun, sky and lamps on the cube, in any density.
const LIGHTS: &str = "[sun]\ndirection = [0, 0.6, 0.8]\nirradiance = [3, 2, 1]\nangular_diameter = 3\n\
    [sky]\nradiance = { image = \"sky.exr\" }\n\
    [[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = { kind = \"emitter\", radiance = 5 }\n";

/// The path integrator with one interaction is a second estimator of the same light where nothing refracts: it draws
/// whether light gets through, where single scattering takes the transmittance.
#[test]
fn in_matched_media_one_scattering_is_one_interaction() {
    let lamp = parallelogram(DVec3::new(-0.4, -0.3, 1.2), DVec3::Y * 0.6, DVec3::X * 0.8);
    let dim = |d: DVec3| DVec3::new(0.5 + 0.4 * d.x, 0.5, 0.7 + 0.5 * d.z);
    let folder = folder().mesh("lamp.ply", &lamp).file("sky.exr", &sky_picture(dim));
    for density in DENSITIES {
        let mean = |render: &str, seed: u64| {
            let scene = folder.scene(&format!(
                "[media.fluid]\nabsorption = [0.5, 0.1, 0]\nscattering = [0.5, 1, 4]\n\
                 phase = {{ kind = \"henyey-greenstein\", g = 0.5 }}\n{density}{CUBE}{OBLIQUE}{LIGHTS}[render]\n{render}"
            ));
            scene.render(1024, seed).mean()
        };
        let (once, once_se) = mean("integrator = \"single-scattering\"\n", 1);
        let (depth, depth_se) = mean("max_depth = 1\n", 2);
        let (path, _) = mean("", 3);
        let se = DVec3::from_array((once_se * once_se + depth_se * depth_se).to_array().map(f64::sqrt));
        println!("{density}: {once:.5} {depth:.5} +- {se:.5}; all orders {path:.5}");
        assert!(se.max_element() < 5e-3, "{density}: {se}");
        assert!((once - depth).abs().cmple(5.0 * se).all(), "{density}: {once} {depth} {se}");
        assert!((path - once).cmpgt(5.0 * se).all(), "what is scattered again does not show: {path} {once}");
    }
}

/// In a white furnace all orders together are exactly 1, so what is scattered more than once is 1 - L, and proportional
/// to the square of a small optical depth. An index below that of the surroundings traps no light: in a body that does,
/// light that has once been scattered gets out by being scattered again, however rarely, and the difference is linear.
///
/// Of that the next order is a share of about the depth itself, so that the exponent between 0.1 and 0.2 is off by 0.2.
#[test]
fn what_is_scattered_again_falls_with_the_square_of_the_depth() {
    let folder = folder();
    for ior in [1.0, 0.8] {
        let missing = [0.2, 0.1].map(|depth: f64| {
            let scene = folder.scene(&format!(
                "[media.fluid]\nior = {ior}\nscattering = {}\n{CUBE}{OBLIQUE}{ONCE}[sky]\nradiance = 1\n",
                depth / 1.4
            ));
            let (mean, se) = scene.render(8192, 0).mean();
            (1.0 - mean.x, se.x)
        });
        let [(thick, thick_se), (thin, thin_se)] = missing;
        let exponent = (thick / thin).log2();
        let se = (thick_se / thick).hypot(thin_se / thin) / std::f64::consts::LN_2;
        println!("ior {ior}: {thick:.3e}, {thin:.3e}, exponent {exponent:.3} +- {se:.3}");
        assert!(se < 0.05 && (exponent - 2.0).abs() < 0.2 + 5.0 * se, "ior {ior}: {exponent} +- {se}");
    }
}

/// The scene file's names are those of the integrators.
#[test]
fn the_scene_file_chooses_the_integrator() {
    let folder = folder();
    for (name, scattered) in
        [("path", Scattered::Always), ("single-scattering", Scattered::Once), ("fog", Scattered::Ambient)]
    {
        let scene =
            folder.scene(&format!("{CUBE}{OBLIQUE}[media.fluid]\n[render]\nintegrator = \"{name}\"\n"));
        let Integrator::Path(tracer) = scene.sampling.integrator else { panic!("{name}") };
        assert_eq!((tracer.scattered, scene.sampling.integrator.name()), (scattered, name));
    }
}
