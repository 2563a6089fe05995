//! What thick media cost, and what their reduction is worth and does: the tables of `src/integrator/thick_media.md`.
//!
//! `cargo test --release --test analytic thick_media_measured -- --ignored --nocapture --test-threads 1`

use floe::film::estimate_error;
use floe::optics::medium_reduction::MediumReduction;
use glam::DVec3;

use super::led_walks::{EVEN, Layer, PICTURE, folder, lead};
use super::thick_media::{ABOVE, BELOW, LAYER, TRAY, assert_same_mean, trace_every_flight, tray};
use crate::common::files::sky_picture;
use crate::common::mesh::{TestMesh, sphere};
use crate::common::render::{Prepared, Rendered};
use crate::common::scene::SceneFolder;

/// Seconds that this process has computed for, over all threads, in steps of 10 ms.
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or("").split_whitespace().collect();
    fields.get(11).and_then(|ticks| ticks.parse::<f64>().ok()).unwrap_or(f64::NAN) / 100.0
}

fn timed(scene: &Prepared, samples: u32, seed: u64) -> (Rendered, f64) {
    let start = cpu_seconds();
    let picture = scene.render(samples, seed);
    (picture, cpu_seconds() - start)
}

/// Replaces the scattering of a medium by what is similar of an order, however thin it is.
fn reduce(scene: &mut Prepared, name: &str, order: usize) -> f64 {
    let Some(medium) = scene.frame.media.iter_mut().find(|m| m.name == name) else { panic!("no {name}") };
    let Some(MediumReduction { alpha, phase }) = MediumReduction::of(&medium.phase, order) else {
        return 1.0;
    };
    medium.phase = phase;
    medium.sigma_s = medium.sigma_s.combined(&alpha, |s, a| s * a);
    f64::from(alpha.maximum())
}

/// Mean over the directions of a view along the normal of so many degrees, weighted with their cosine, and its standard
/// error.
fn cosine_mean(picture: &Rendered, degrees: f64) -> (f64, f64) {
    let n = picture.image.width;
    let tangent = (0.5 * degrees).to_radians().tan();
    let mut sums = (0.0, 0.0, 0.0);
    for (pixel, i) in picture.image.pixels.iter().zip(0..) {
        let [x, y] = [i % n, i / n].map(|k| ((2.0 * f64::from(k) + 1.0) / f64::from(n) - 1.0) * tangent);
        // The solid angle of a pixel goes like the cube of the cosine.
        let weight = (1.0 + x * x + y * y).powi(-2);
        sums.0 += weight * f64::from(pixel.rgb.x);
        sums.1 += weight * weight * f64::from(pixel.variance.x);
        sums.2 += weight;
    }
    (sums.0 / sums.2, f64::sqrt(sums.1) / sums.2)
}

/// Prints how far off the reduced media are: transmittance of layers that absorb nothing and reflectance of layers that
/// do, under even light.
#[test]
#[ignore = "minutes"]
fn what_similarity_does_to_layers() {
    let folder = tray();
    let layers = [("T", -2, 0.0), ("R", 2, 0.01)]
        .into_iter()
        .flat_map(|view| [0.25, 0.5, 1.0, 2.0, 4.0, 8.0].map(|tau| (view, tau)));
    let views = [1.0, 1.31].into_iter().flat_map(|ior| [140.0, 10.0].map(|degrees| (ior, degrees)));
    for ((ior, degrees), ((view, z, lost), tau)) in views.flat_map(|v| layers.clone().map(move |l| (v, l))) {
        let mean = |order: usize| {
            let mut scene = folder.scene(&format!(
                "[media.milk]\nior = {ior}\nscattering = {}\nabsorption = {}\n\
                 phase = {{ kind = \"henyey-greenstein\", g = 0.86 }}\n{LAYER}{TRAY}\
                 [camera]\neye = [0.3, 0.2, {z}]\ntarget = [0.3, 0.2, 0]\nup = [0, 1, 0]\n\
                 vertical_fov = {degrees}\nresolution = [64, 64]\n",
                tau / 0.14,
                tau * lost
            ));
            reduce(&mut scene, "milk", order);
            cosine_mean(&scene.render(128, order as u64), degrees)
        };
        let exact = mean(0);
        let mut line = format!("ior {ior}, {degrees} degrees, {view}, tau* {tau}: {:.4}", exact.0);
        for (value, se) in (1..=3).map(mean) {
            let off = 100.0 * (value / exact.0 - 1.0);
            line += &format!(" | {off:+.2} ({:.2})", 100.0 * (se / exact.0).hypot(exact.1 / exact.0));
        }
        println!("{line}");
    }
}

/// A lumpy body of some 5 m.
fn iceberg() -> TestMesh {
    let mut mesh = sphere(DVec3::ZERO, 1.0, 5);
    for p in &mut mesh.positions {
        let d = *p;
        let lumps = 0.18 * (3.0 * d.x + 1.0).sin() * (2.0 * d.y - 0.5).cos()
            + 0.1 * (5.0 * d.y + 2.0 * d.z).sin()
            + 0.06 * (9.0 * d.z - 4.0 * d.x).cos() * (7.0 * d.y).sin();
        *p = d * DVec3::new(2.4, 2.2, 1.9) * (1.0 + lumps);
    }
    mesh
}

fn iceberg_scene() -> Prepared {
    let sky =
        |d: DVec3| DVec3::new(0.4, 0.6, 1.0) * (1.0 + 0.8 * d.z) + DVec3::splat(0.3 * (1.0 + d.x).powi(2));
    SceneFolder::new().mesh("ice.ply", &iceberg()).file("sky.exr", &sky_picture(sky)).scene(
        "[media.ice]\nior = 1.31\nscattering = 870\nabsorption = [0.12, 0.02, 0.002]\n\
         phase = { kind = \"henyey-greenstein\", g = 0.86 }\n\
         [[surfaces]]\nmesh = \"ice.ply\"\nfront = \"air\"\nback = \"ice\"\nmaterial = { kind = \"dielectric\" }\n\
         [sky]\nradiance = { image = \"sky.exr\" }\n\
         [camera]\neye = [3, -10, 2.5]\ntarget = [0, 0, 0]\nvertical_fov = 34\nresolution = [320, 180]\n",
    )
}

/// Prints seconds and error of the iceberg, and the seconds to an estimated relative error of 5 % that follow.
#[test]
#[ignore = "ten minutes"]
fn an_iceberg_of_five_metres() {
    let samples =
        |name: &str, default: u32| std::env::var(name).ok().and_then(|n| n.parse().ok()).unwrap_or(default);
    let walks = [("plain", samples("PLAIN", 4)), ("balls", samples("BALLS", 16))];
    let reduced = ["similarity 1", "similarity 2", "similarity 3"].map(|name| (name, samples("REDUCED", 64)));
    let mut exact: Option<Rendered> = None;
    for ((name, samples), i) in walks.into_iter().chain(reduced).zip(0_usize..) {
        let mut scene = iceberg_scene();
        let alpha = reduce(&mut scene, "ice", i.saturating_sub(1));
        if i == 0 {
            trace_every_flight(&mut scene);
        }
        let (picture, seconds) = timed(&scene, samples, i as u64);
        let error = estimate_error(&picture.image, 0.95).map_or(f64::NAN, |e| e.relative);
        let (mean, se) = picture.mean();
        println!(
            "{name}: {alpha:.3}, {samples} samples, {seconds:.2} s, error {error:.4}, to 5 %: {:.1} s, mean {mean:.5} +- {se:.5}",
            seconds * (error / 0.05).powi(2)
        );
        println!("    {:?}", picture.counters);
        match &exact {
            Some(plain) if i == 1 => assert_same_mean(name, &picture, plain, 0.02),
            Some(balls) if i > 1 => compare_blocks(balls, &picture),
            _ => {}
        }
        if i < 2 {
            exact = Some(picture);
        }
    }
}

/// Prints how far the means of blocks of 20 x 20 pixels are off, and the part of that which is noise.
fn compare_blocks(exact: &Rendered, other: &Rendered) {
    let ((a, a_se), (b, b_se)) = (other.mean(), exact.mean());
    println!(
        "    mean {:+.3} % +- {:.3}",
        100.0 * (a / b - 1.0),
        100.0 * (a_se * a_se + b_se * b_se).powf(0.5) / b
    );
    let (mut square, mut noise, mut worst, mut count) = (0.0, 0.0, 0.0_f64, 0.0);
    for y in (0..180).step_by(20) {
        for x in (0..320).step_by(20) {
            let ((a, a_se), (b, b_se)) =
                (other.block_mean([x, y], [20, 20]), exact.block_mean([x, y], [20, 20]));
            let off = (a / b - 1.0).y;
            square += off * off;
            noise += ((a_se * a_se + b_se * b_se) / (b * b)).y;
            worst = worst.max(off.abs());
            count += 1.0;
        }
    }
    let [rms, noise, worst] =
        [(square / count).sqrt(), f64::sqrt(noise / count), worst].map(|part: f64| 100.0 * part);
    println!("    blocks of 20 x 20, green: rms {rms:.2} % of which noise {noise:.2} %, worst {worst:.2} %");
}

/// Prints how many times less time walks that are led take to equal error, and how many times less their variance is.
#[test]
#[ignore = "minutes"]
fn what_leading_walks_is_worth() {
    let folder = folder();
    for (sky, view, thickness) in [(PICTURE, ABOVE, 40.0), (EVEN, ABOVE, 40.0), (EVEN, BELOW, 4.0)] {
        for (n, g) in [(1.0, 0.0), (1.31, 0.0), (1.0, 0.86), (1.31, 0.86)] {
            let mut line = format!("{sky}, {thickness}, n {n}, g {g}:");
            for albedo in [0.5, 0.7, 0.9, 0.99, 0.998] {
                let mut scene = Layer { n, g, thickness, albedos: [albedo; 3] }.scene(&folder, sky, view);
                let (mut square, mut seconds) = ([0.0; 2], [0.0; 2]);
                for (seed, is_led) in (0..3).flat_map(|seed| [(seed, false), (seed, true)]) {
                    lead(&mut scene, is_led);
                    let (picture, time) = timed(&scene, 256, seed);
                    square[usize::from(is_led)] += picture.mean().1.y.powi(2);
                    seconds[usize::from(is_led)] += time;
                }
                let less = square[0] / square[1];
                line += &format!(" | {albedo}: {:.2} ({less:.2})", less * seconds[0] / seconds[1]);
            }
            println!("{line}");
        }
    }
}

/// The same of balls of 1 m, under the picture of the sky and lit from behind only.
#[test]
#[ignore = "minutes"]
fn what_leading_walks_is_worth_in_balls() {
    let behind = sky_picture(|d| DVec3::splat(if d.y > 0.3 { 1.0 } else { 0.0 }));
    let all = sky_picture(|d| DVec3::new(0.4, 0.6, 1.0) * (1.0 + 0.8 * d.x) + 0.5 * d.z.max(0.0));
    let ball = sphere(DVec3::ZERO, 0.5, 4);
    for (name, sky) in [("all around", all), ("behind", behind)] {
        let folder = SceneFolder::new().mesh("ball.ply", &ball).file("sky.exr", &sky);
        for (thickness, g) in [10.0, 20.0, 40.0].into_iter().flat_map(|t| [0.0, 0.86].map(|g| (t, g))) {
            let mut line = format!("ball, {name}, {thickness}, g {g}:");
            for albedo in [0.7, 0.9, 0.99, 0.998] {
                let mut scene = folder.scene(&format!(
                    "[media.milk]\nior = 1.31\nscattering = {}\nabsorption = {}\n\
                     phase = {{ kind = {} }}\n[[surfaces]]\nmesh = \"ball.ply\"\nfront = \"air\"\nback = \"milk\"\n\
                     material = {{ kind = \"dielectric\" }}\n[sky]\nradiance = {{ image = \"sky.exr\" }}\n\
                     [camera]\neye = [0, -10, 0]\ntarget = [0, 0, 0]\nvertical_fov = 5\nresolution = [32, 32]\n",
                    thickness / (1.0 - g),
                    thickness * (1.0 - albedo) / albedo,
                    if g == 0.0 { "\"isotropic\"" } else { "\"henyey-greenstein\", g = 0.86" }
                ));
                let (mut square, mut seconds) = ([0.0; 2], [0.0; 2]);
                for (seed, is_led) in (0..2).flat_map(|seed| [(seed, false), (seed, true)]) {
                    lead(&mut scene, is_led);
                    let (picture, time) = timed(&scene, 64, seed);
                    square[usize::from(is_led)] += picture.mean().1.y.powi(2);
                    seconds[usize::from(is_led)] += time;
                }
                let less = square[0] / square[1];
                line += &format!(" | {albedo}: {:.2} ({less:.2})", less * seconds[0] / seconds[1]);
            }
            println!("{line}");
        }
    }
}
