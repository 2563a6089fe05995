//! How far half spaces that reflect by themselves are from walks, and what they spare: the tables of `src/optics/half_space/half_space.md`.
//!
//! `cargo test --release --test analytic reflected_measured -- --ignored --nocapture --test-threads 1`

use floe::driver::tiles::{Sampling, render_pixels};
use floe::study::stability::h_function::HFunction;
use glam::DVec3;

use super::half_space::{COSINES, SLAB, camera, slab};
use crate::common::files::sky_picture;
use crate::common::mesh::sphere;
use crate::common::render::Rendered;
use crate::common::scene::SceneFolder;

const EVEN: &str = "radiance = 1";
const PATCH: &str = "radiance = { image = \"sky.exr\" }";

fn samples(default: u32) -> u32 {
    std::env::var("SAMPLES").ok().and_then(|n| n.parse().ok()).unwrap_or(default)
}

/// A medium whose reduced extinction is `sigma` per metre, of these reduced albedos.
fn medium(n: f64, g: f64, sigma: f64, albedos: [f64; 3]) -> String {
    let scattering = albedos.map(|albedo| albedo * sigma / (1.0 - g));
    let absorption = albedos.map(|albedo| (1.0 - albedo) * sigma);
    let phase = if g == 0.0 { "\"isotropic\"".into() } else { format!("\"henyey-greenstein\", g = {g}") };
    format!(
        "[media.cloud]\nior = {n}\nscattering = {scattering:?}\nabsorption = {absorption:?}\nphase = {{ kind = {phase} }}\n"
    )
}

/// Walks in slabs of 200 reduced free paths, from which light comes back as exp(-2 kappa 200), 3e-10 for an albedo of 0.999,
/// and the half spaces that are similar to them.
#[test]
#[ignore = "half an hour"]
fn what_half_spaces_are_off_by() {
    // Light from within some 20 degrees of a direction 53 degrees from the normal, at 127 degrees from the eye's azimuth.
    let towards = DVec3::new(-0.6 * 0.8, 0.8 * 0.8, 0.6);
    let patch = sky_picture(|d| DVec3::splat(if d.dot(towards) > 0.94 { 10.0 } else { 0.0 }));
    let folder = slab(60.0, 200.0).file("sky.exr", &patch);
    let cases = [1.0, 1.33].into_iter().flat_map(|n| [0.0, 0.86, -0.5].map(|g| (n, g)));
    for ((n, g), (name, sky)) in
        cases.flat_map(|case| [("even", EVEN), ("patch", PATCH)].map(|sky| (case, sky)))
    {
        for mu in COSINES {
            let mut line = format!("| {name} | {n} | {g} | {mu} |");
            for (albedos, lanes) in [([0.5, 0.9, 0.99], 3), ([0.999; 3], 1)] {
                let kind = if n == 1.0 { SLAB.into() } else { SLAB.replace("null", "dielectric") };
                let render = |sigma: f64, samples, seed| {
                    let text = format!("{}{kind}[sky]\n{sky}\n{}", medium(n, g, sigma, albedos), camera(mu));
                    let scene = folder.scene(&text);
                    assert_eq!(scene.frame.half_spaces.is_empty(), sigma < 1e4);
                    scene.render(samples, seed)
                };
                let walked: Rendered = render(200.0 / 60.0, samples(1024), 0);
                let reflected = render(1e6, samples(1024), 1);
                let ((exact, exact_se), (mean, se)) = (walked.mean(), reflected.mean());
                for lane in 0..lanes {
                    let off = 100.0 * (mean[lane] / exact[lane] - 1.0);
                    let se = 100.0 * (se[lane] / mean[lane]).hypot(exact_se[lane] / exact[lane]);
                    line += &format!(" {off:+.2} ({se:.2}) |");
                }
            }
            println!("{line}");
        }
    }
}

/// Prints what walks reflect of even light where free paths get as short as the rounding of coordinates 9 m from the eye, relative to
/// the closed form, in a slab of 1 m.
#[test]
#[ignore = "minutes"]
fn what_rounding_does_to_walks() {
    let folder = slab(1.0, 20.0);
    let albedos = [0.5, 0.9, 0.99];
    for (size, mu) in [1e4, 1e5, 1e6, 1e7].into_iter().flat_map(|size| [1.0, 0.4].map(|mu| (size, mu))) {
        let text = format!("{}{SLAB}[sky]\n{EVEN}\n{}", medium(1.0, 0.0, size, albedos), camera(mu));
        let mut scene = folder.scene(&text);
        scene.frame.half_spaces.clear();
        // Not by the scene's own `render`, which does not stand for so many labels that disagree.
        let sampling = Sampling { samples: samples(512), ..scene.sampling.clone() };
        let (image, counters) = render_pixels(&scene.frame, &sampling, &|_, _| ());
        let (mean, se) = Rendered { image, counters }.mean();
        let mismatches = 1e6 * counters.label_mismatches as f64 / (counters.rays + counters.untraced) as f64;
        let exact = albedos.map(|albedo| 1.0 - (1.0 - albedo).sqrt() * HFunction::new(albedo).at(mu));
        let off = [0, 1, 2]
            .map(|i| format!("{:+.2} ({:.2})", 100.0 * (mean[i] / exact[i] - 1.0), 100.0 * se[i] / exact[i]));
        println!("| {size:e} | {mu} | {} | {mismatches:.1} |", off.join(" | "));
    }
}

/// Seconds that this process has computed for, over all threads, in steps of 10 ms.
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or("").split_whitespace().collect();
    fields.get(11).and_then(|ticks| ticks.parse::<f64>().ok()).unwrap_or(f64::NAN) / 100.0
}

/// Prints what a ball of milk of 1 m takes by walks and as a half space, in turns.
#[test]
#[ignore = "minutes"]
fn a_ball_of_milk() {
    let sky = sky_picture(|d| DVec3::new(0.4, 0.6, 1.0) * (1.0 + 0.8 * d.z) + 0.3 * (1.0 + d.x).powi(2));
    let folder = SceneFolder::new().mesh("ball.ply", &sphere(DVec3::ZERO, 0.5, 4)).file("sky.exr", &sky);
    for (size, absorption) in [(1e4, 0.0), (1e5, 0.0), (1e6, 0.0), (1e6, 1.0), (1e6, 100.0)] {
        let mut scene = folder.scene(&format!(
            "[media.milk]\nior = 1.35\nscattering = {}\nabsorption = {absorption}\n\
             phase = {{ kind = \"henyey-greenstein\", g = 0.9 }}\n[[surfaces]]\nmesh = \"ball.ply\"\nfront = \"air\"\n\
             back = \"milk\"\nmaterial = {{ kind = \"dielectric\" }}\n[sky]\nradiance = {{ image = \"sky.exr\" }}\n\
             [camera]\neye = [0, -3, 0.4]\ntarget = [0, 0, 0]\nvertical_fov = 22\nresolution = [64, 64]\n",
            size * 1.01
        ));
        let is_half_space = !scene.frame.half_spaces.is_empty();
        let mut line = format!("size {size:e}, absorption {absorption}:");
        for way in ["half space", "walk"] {
            if way == "walk" {
                scene.frame.half_spaces.clear();
            } else if !is_half_space {
                continue;
            }
            let start = cpu_seconds();
            let count = if way == "walk" { samples(2) } else { 256 };
            let picture = scene.render(count, 1);
            let seconds = (cpu_seconds() - start) / f64::from(count);
            let (mean, se) = picture.mean();
            line += &format!(
                " {way}: {seconds:.4} s a sample, {:.5} +- {:.5}, cut {};",
                mean.y, se.y, picture.counters.cut
            );
        }
        println!("{line}");
    }
}
