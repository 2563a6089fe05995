//! Media whose phase functions differ from wavelength to wavelength, through the whole renderer: lane by lane on given
//! wavelengths, and as pictures.

use std::f64::consts::PI;

use floe::geometry::Ray;
use floe::integrator::{PreparedLight, Scratch};
use floe::sampling::{SampleSeed, SampleStream};
use floe::spectrum::{LaneMode, Lanes, Wavelengths};
use glam::{DVec3, DVec4};

use super::media::{CUBE, OBLIQUE, folder};
use super::thick_media::assert_same_mean;
use crate::common::files::sky_picture;
use crate::common::mesh::{cuboid, parallelogram};
use crate::common::render::Prepared;
use crate::common::scene::SceneFolder;

/// Wavelengths on either side of each of the curves below, and between.
const WAVELENGTHS: Wavelengths = Wavelengths { lambda: [420.0, 530.0, 560.0, 650.0], pdf: [1.0; 4] };
/// 1 at every wavelength, not white.
const EVEN: &str = "{ wavelength = [500], value = [1] }";

/// Lobes that differ little and much; tables that differ in where they vanish; the last is not narrow anywhere.
const PHASES: [&str; 4] = [
    "kind = \"henyey-greenstein\", g = { wavelength = [400, 700], value = [0.92, 0.9] }",
    "kind = \"henyey-greenstein\", g = { wavelength = [540, 550], value = [-0.5, 0.95] }",
    "kind = \"tabulated\", wavelength = [420, 540, 650], angle = [0, 3, 90, 180], value = [[1e4, 1, 0, 2], [0, 0, 1, 1], [1, 1, 1, 1]]",
    TABLES,
];
/// Linear in the cosine on either side of 90 degrees: p = (b + (a - b) cos) / (pi (a + 2 b + c)) ahead.
const TABLES: &str = "kind = \"tabulated\", wavelength = [420, 530, 560, 650], angle = [0, 90, 180], \
                      value = [[3, 1, 1], [0, 1, 0], [1, 1, 5], [4, 0, 1]]";
const ENDS: [[f64; 3]; 4] = [[3.0, 1.0, 1.0], [0.0, 1.0, 0.0], [1.0, 1.0, 5.0], [4.0, 0.0, 1.0]];

/// Radiance of each lane along a ray through points of the scene file, of one sample after the other; without those, one in a
/// million flights, that rounding has put on the wrong side of a surface.
fn samples(scene: &Prepared, [eye, target]: [DVec3; 2], count: u32) -> Vec<DVec4> {
    assert_eq!(scene.frame.mode, LaneMode::Spectral);
    let from = (eye - scene.frame.origin).as_vec3();
    let ray = Ray::new(from, (target - eye).normalize().as_vec3());
    let mut scratch = Scratch::default();
    let mut astray = 0;
    let sample = |i: u32| {
        // A pixel of its own for each, so that they are independent.
        let stream = SampleStream::new(SampleSeed::new(7), i & 1023, i >> 10, 0);
        let integrator = &scene.sampling.integrator;
        let found = integrator.sample(
            &scene.frame,
            &mut scratch,
            &ray,
            &WAVELENGTHS,
            stream,
            PreparedLight::default(),
        );
        let is_right = scratch.counters.label_mismatches == astray;
        astray = scratch.counters.label_mismatches;
        is_right.then(|| found.radiance.as_dvec4())
    };
    let all: Vec<DVec4> = (0..count).filter_map(sample).collect();
    let flights = scratch.counters.rays + scratch.counters.untraced;
    assert!(astray as f64 <= (flights as f64 * 2e-6).max(3.0), "{:?}", scratch.counters);
    all
}

/// Mean and standard error.
fn mean(samples: &[DVec4]) -> (DVec4, DVec4) {
    let n = samples.len() as f64;
    let mean = samples.iter().sum::<DVec4>() / n;
    let squares = samples.iter().map(|s| (*s - mean) * (*s - mean)).sum::<DVec4>();
    (mean, DVec4::from_array((squares / (n * (n - 1.0))).to_array().map(f64::sqrt)))
}

/// Panics unless the mean of each lane is as expected within five standard errors, none above `most` of it.
fn assert_lanes(name: &str, samples: &[DVec4], expected: DVec4, most: f64) {
    let (mean, se) = mean(samples);
    println!("{name}: {mean:.5} +- {se:.5}, expected {expected:.5}");
    assert!((se / expected).max_element() < most, "{name}: {se} shows too little");
    assert!(
        (mean - expected).abs().cmple(5.0 * se + 2e-6 * expected).all(),
        "{name}: {mean} +- {se}, not {expected}"
    );
}

/// Under an even sky nothing is lost. Each lane is 1 in the mean, and all four are 4 in every sample: whatever weighs more
/// in one lane weighs as much less in the others. Rounding of a few collisions with four products each costs 1e-7 of
/// them, that of the thousands in walks of the thick cubes (measured: 9e-6) more. One path in a million flights leaves through
/// an edge unnoticed, and is lost in the dark.
#[test]
fn a_turbid_cube_is_white_in_every_lane_and_in_every_sample_as_a_whole() {
    let folder = SceneFolder::new().mesh("cube.ply", &cuboid(DVec3::splat(-0.7), DVec3::splat(0.7)));
    for phase in PHASES {
        for (scattering, count, tolerance) in [
            ("3", 20_000, 5e-6),
            ("{ wavelength = [400, 700], value = [1, 9] }", 20_000, 1e-5),
            ("100", 3000, 5e-5),
        ] {
            let scene = folder.scene(&format!(
                "[media.fluid]\nior = 1.33\nscattering = {scattering}\nphase = {{ {phase} }}\n{CUBE}{OBLIQUE}\
                 [sky]\nradiance = {EVEN}\n[render]\nsplit = 0\n"
            ));
            let mut all = samples(&scene, [DVec3::new(1.2, -3.5, 0.8), DVec3::new(0.1, 0.2, 0.0)], count);
            all.retain(|lanes| *lanes != DVec4::ZERO);
            assert!(all.len() as u32 >= count - 3, "{} of {count} paths see the sky", all.len());
            let name = format!("{phase}, {scattering}/m");
            let worst = all.iter().map(|lanes| (lanes.element_sum() / 4.0 - 1.0).abs()).fold(0.0, f64::max);
            println!("{name}: all four lanes are off by at most {worst:.1e}");
            assert!(worst < tolerance, "{name}: all four lanes are off by {worst}");
            assert_lanes(&name, &all, DVec4::ONE, 0.1);
        }
    }
}

/// Splits and forced scattering draw anew, so the sum holds in the mean only.
#[test]
fn forced_scattering_is_white_in_every_lane() {
    let folder = SceneFolder::new().mesh("cube.ply", &cuboid(DVec3::splat(-0.7), DVec3::splat(0.7)));
    for phase in PHASES {
        let scene = folder.scene(&format!(
            "[media.fluid]\nior = 1.33\nscattering = {{ wavelength = [400, 700], value = [0.3, 2] }}\nphase = {{ {phase} }}\n\
             {CUBE}{OBLIQUE}[sky]\nradiance = {EVEN}\n[render]\nforced_scattering = 2\n"
        ));
        let all = samples(&scene, [DVec3::new(1.2, -3.5, 0.8), DVec3::new(0.1, 0.2, 0.0)], 20_000);
        assert_lanes(&format!("{phase}, forced"), &all, DVec4::ONE, 0.1);
    }
}

/// The closed forms of a slab in the sun ([`super::single_scattering`]), each lane with its own phase function:
///
/// ```text
/// from above:  E p(-mu) sigma_s / (sigma_t (1 + 1 / mu)) (1 - exp(-sigma_t D (1 + 1 / mu)))
/// from below:  E p(mu) sigma_s (exp(-sigma_t D) - exp(-sigma_t D / mu)) / (sigma_t (1 / mu - 1))
/// ```
#[test]
fn a_slab_in_the_sun_scatters_in_every_lane_what_the_closed_form_says() {
    let (mu, depth, irradiance) = (0.8, 1.0, 10.0);
    let (sigma_a, sigma_s) = ([0.3, 0.2, 0.1, 0.0], [0.5, 1.0, 0.7, 2.0]);
    let curve = |v: [f64; 4]| format!("{{ wavelength = [420, 530, 560, 650], value = {v:?} }}");
    let lobe = |g: f64, cos: f64| (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * cos).powf(1.5));
    let table = |[a, b, c]: [f64; 3], cos: f64| {
        let end = if cos > 0.0 { a } else { c };
        (b + (end - b) * cos.abs()) / (PI * (a + 2.0 * b + c))
    };
    let g = [-0.5, 0.0, 0.6, 0.9];
    let slab = cuboid(DVec3::new(-1e3, -1e3, -depth), DVec3::new(1e3, 1e3, 0.0));
    let folder = SceneFolder::new().mesh("cube.ply", &slab);
    let lobes = format!("kind = \"henyey-greenstein\", g = {}", curve(g));
    for (phase, is_table) in [(lobes.as_str(), false), (TABLES, true)] {
        let scene = folder.scene(&format!(
            "[media.fluid]\nabsorption = {}\nscattering = {}\nphase = {{ {phase} }}\n{CUBE}{OBLIQUE}\
             [sun]\ndirection = [0, 0.6, 0.8]\nangular_diameter = 0.05\nirradiance = {{ wavelength = [500], value = [{irradiance}] }}\n\
             [render]\nintegrator = \"single-scattering\"\n",
            curve(sigma_a),
            curve(sigma_s)
        ));
        for side in [1.0, -1.0] {
            let expected = DVec4::from_array([0, 1, 2, 3].map(|i| {
                let p = if is_table { table(ENDS[i], -side * mu) } else { lobe(g[i], -side * mu) };
                let (sigma_t, rate) = (sigma_a[i] + sigma_s[i], 1.0 / mu + side);
                let scattered = irradiance * p * sigma_s[i] / sigma_t / rate;
                match side > 0.0 {
                    true => -scattered * libm::expm1(-sigma_t * depth * rate),
                    false => scattered * (libm::exp(-sigma_t * depth) - libm::exp(-sigma_t * depth / mu)),
                }
            }));
            let eye = DVec3::new(0.1, 0.2, 4.0 * side);
            let all = samples(&scene, [eye, DVec3::new(0.1, 0.2, 0.0)], 40_000);
            assert_lanes(
                &format!("{phase}, side {side}"),
                &all,
                expected + DVec4::splat(1e-9),
                f64::INFINITY,
            );
        }
    }
}

const SUNNY: &str = "[camera]\neye = [1.2, -3.5, 0.8]\ntarget = [0, 0, 0]\nvertical_fov = 22\nresolution = [12, 12]\n\
                     [sun]\ndirection = [0.2, -0.6, 0.8]\nangular_diameter = 3\nirradiance = ";

/// A cube in a sun of one band of wavelengths, in which the phase function is one lobe, against a cube that scatters by
/// that lobe at every wavelength. The other half of the lanes scatters by another lobe, as little like it as it can be,
/// and draws half of the directions.
#[test]
fn a_band_of_wavelengths_sees_its_own_phase_function_only() {
    let bands = "{ wavelength = [540, 541], value = [0, 0.9] }";
    for (g, band) in [
        ("0", "{ wavelength = [538, 539], value = [9, 0] }"),
        ("0.9", "{ wavelength = [542, 543], value = [0, 9] }"),
    ] {
        let picture = |g: &str, seed: u64| {
            folder()
                .scene(&format!(
                    "[media.fluid]\nabsorption = 0.2\nscattering = 4\nphase = {{ kind = \"henyey-greenstein\", g = {g} }}\n\
                     {CUBE}{SUNNY}{band}\n"
                ))
                .render(1024, seed)
        };
        let (both, one) = (picture(bands, 1), picture(g, 2));
        assert_same_mean(&format!("g of {g} in {band}"), &both, &one, 0.1);
        // It can tell: the other lobe looks different by more than is allowed.
        let other = picture(if g == "0" { "0.9" } else { "0" }, 3);
        let (is, is_not) = (one.mean(), other.mean());
        let difference = (is.0 - is_not.0).abs().max_element();
        assert!(difference > 10.0 * (is.1 + is_not.1).max_element(), "{is:?} {is_not:?}");
    }
}

/// Tables that are all equal, and a g that is the same everywhere, look as one phase function does.
#[test]
fn what_is_the_same_at_every_wavelength_is_one_phase_function() {
    let unused = "[media.unused]\nabsorption = { wavelength = [400, 700], value = [1, 1] }\n";
    let row = "[20, 3, 1, 2]";
    for (name, over_wavelength, one) in [
        (
            "lobe",
            "kind = \"henyey-greenstein\", g = { wavelength = [400, 700], value = [0.8, 0.8] }".to_owned(),
            "kind = \"henyey-greenstein\", g = 0.8".to_owned(),
        ),
        (
            "tables",
            format!(
                "kind = \"tabulated\", wavelength = [400, 600, 700], angle = [0, 3, 90, 180], value = [{row}, {row}, {row}]"
            ),
            format!("kind = \"tabulated\", angle = [0, 3, 90, 180], value = {row}"),
        ),
    ] {
        let picture = |phase: &str, seed: u64| {
            folder()
                .scene(&format!(
                    "[media.fluid]\nabsorption = 0.2\nscattering = 4\nphase = {{ {phase} }}\n{unused}{CUBE}{SUNNY}[3, 2, 1]\n"
                ))
                .render(2048, seed)
        };
        assert_same_mean(name, &picture(&over_wavelength, 1), &picture(&one, 2), 0.05);
    }
}

/// A lamp and a picture of a sky, looked for and found by chance: the balance heuristic changes nothing but the noise.
#[test]
fn lights_that_are_looked_for_are_those_that_chance_finds() {
    let lamp = parallelogram(DVec3::new(-0.5, -0.5, 1.0), DVec3::Y, DVec3::X);
    let sky = sky_picture(|d| DVec3::new(0.2, 0.3, 0.5) * (1.0 + d.z) + 3.0 * d.x.max(0.0).powi(8));
    let folder = folder().mesh("lamp.ply", &lamp).file("sky.exr", &sky);
    for phase in [PHASES[1], PHASES[2], TABLES] {
        let mut scene = folder.scene(&format!(
            "[media.fluid]\nabsorption = 0.2\nscattering = {{ wavelength = [400, 700], value = [1, 3] }}\nphase = {{ {phase} }}\n\
             {CUBE}{OBLIQUE}[[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = {{ kind = \"emitter\", radiance = 5 }}\n\
             [sky]\nradiance = {{ image = \"sky.exr\" }}\n"
        ));
        let with = scene.render(512, 1);
        scene.frame.needs.direct_light = false;
        let by_chance = scene.render(1024, 2);
        assert_same_mean(phase, &with, &by_chance, 0.05);
    }
}

/// Walks are not led and not drawn ahead by one of several phase functions.
#[test]
fn thick_media_are_walked_through_as_they_are() {
    let slab = cuboid(DVec3::new(-25.0, -25.0, -1.0), DVec3::new(25.0, 25.0, 0.0));
    let folder = SceneFolder::new().mesh("cube.ply", &slab);
    let scene = |phase: &str, similarity: u32| {
        folder.scene(&format!(
            "[media.fluid]\nscattering = 1000\nabsorption = 4\nphase = {{ kind = \"henyey-greenstein\", g = {phase} }}\n\
             {CUBE}{OBLIQUE}[sky]\nradiance = {EVEN}\n[render]\nsimilarity = {similarity}\n"
        ))
    };
    let bands = "{ wavelength = [400, 500, 700], value = [0.8, 0.9, 0.9] }";
    let is_led = |phase: &str| scene(phase, 0).frame.led.contains(&true);
    assert_eq!((is_led("0.9"), is_led(bands)), (true, false));
    // Similar at order 1, each wavelength by itself: sigma_s (1 - g), isotropic.
    let reduced = scene(bands, 1);
    let Some(medium) = reduced.frame.media.iter().find(|m| m.name == "fluid") else { panic!("no fluid") };
    let wavelengths = Wavelengths { lambda: [400.0, 450.0, 500.0, 600.0], pdf: [1.0; 4] };
    let found = medium.sigma_s.lanes(&wavelengths);
    let off = found / Lanes::new(200.0, 150.0, 100.0, 100.0) - Lanes::ONE;
    assert!(off.abs().max_element() < 1e-4, "{found}");
    assert!(medium.phase.one().is_some() && reduced.frame.led.contains(&true));
}

/// Prints how the colours of a ball of ever more collisions part, and what its noise is in light that is not even.
///
/// ```sh
/// cargo test --release --test analytic colour_noise -- --ignored --nocapture
/// ```
#[test]
#[ignore = "minutes"]
fn colour_noise_of_a_ball_by_its_collisions() {
    let ball = crate::common::mesh::sphere(DVec3::ZERO, 0.5, 3);
    let folder = SceneFolder::new()
        .mesh("ball.ply", &ball)
        .file("sky.exr", &sky_picture(|d| DVec3::splat(if d.x > 0.0 { 2.0 } else { 0.0 })));
    let skies = [("even", "1"), ("half dark", "{ image = \"sky.exr\" }")];
    println!(
        "g | sky | scattering | collisions | rms r g b | rms luminance | rms of r - g and b - g | CPU us a sample"
    );
    for (name, sky) in skies {
        for g in ["0.85", "0.855, 0.85", "0.87, 0.83", "0.95, 0.75", "0.9, 0"] {
            for scattering in [4, 20, 100, 500, 2500] {
                let curve = format!(
                    "{{ wavelength = [400, 700], value = [{g}{}] }}",
                    if g.contains(',') { "" } else { ", 0.85" }
                );
                let phase = if g.contains(',') { curve } else { g.to_owned() };
                let scene = folder.scene(&format!(
                    "[media.milk]\nscattering = {scattering}\nphase = {{ kind = \"henyey-greenstein\", g = {phase} }}\n\
                     [media.unused]\nabsorption = {EVEN}\n\
                     [[surfaces]]\nmesh = \"ball.ply\"\nfront = \"air\"\nback = \"milk\"\nmaterial = {{ kind = \"null\" }}\n\
                     [camera]\neye = [0, -10, 0]\ntarget = [0, 0, 0]\nvertical_fov = 2\nresolution = [16, 16]\n\
                     [sky]\nradiance = {sky}\n"
                ));
                let [count, rms, luminance, chroma, seconds] = noise(&scene);
                println!(
                    "{g} | {name} | {scattering} | {count:.0} | {rms:.3} | {luminance:.3} | {chroma:.3} | {:.1}",
                    1e6 * seconds
                );
            }
        }
    }
}

/// Collisions a sample, the deviation of one sample's colours, luminance and differences of colours, and its CPU seconds.
fn noise(scene: &Prepared) -> [f64; 5] {
    let from = (DVec3::new(0.0, -10.0, 0.0) - scene.frame.origin).as_vec3();
    let (count, seed) = (4000, SampleSeed::new(3));
    let mut scratch = Scratch::default();
    let start = cpu_time::ProcessTime::now();
    let (mut sum, mut squares, mut chroma) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    let mut luminances = [0.0; 2];
    for i in 0..count {
        let mut stream = SampleStream::new(seed, i & 1023, i >> 10, 0);
        let u = stream.next4();
        let wavelengths = Wavelengths::for_mode(scene.frame.mode, u[0]);
        let target = glam::Vec3::new(0.3 * (u[1] - 0.5), 0.0, 0.3 * (u[2] - 0.5));
        let ray = Ray::new(from, (target - scene.frame.origin.as_vec3() - from).normalize());
        let found = scene.sampling.integrator.sample(
            &scene.frame,
            &mut scratch,
            &ray,
            &wavelengths,
            stream,
            PreparedLight::default(),
        );
        let rgb = wavelengths.to_rgb(found.radiance).as_dvec3();
        sum += rgb;
        squares += rgb * rgb;
        chroma += 0.5 * ((rgb.x - rgb.y).powi(2) + (rgb.z - rgb.y).powi(2));
        let luminance = floe::spectrum::cie::rgb_to_xyz(rgb).y;
        luminances[0] += luminance;
        luminances[1] += luminance * luminance;
    }
    let n = f64::from(count);
    let variance = squares / n - (sum / n) * (sum / n);
    let white = luminances[0] / n;
    [
        (scratch.counters.untraced + scratch.counters.rays) as f64 / n,
        (variance.element_sum() / 3.0).sqrt() / white,
        (luminances[1] / n - white * white).max(0.0).sqrt() / white,
        (chroma / n).sqrt() / white,
        start.elapsed().as_secs_f64() / n,
    ]
}
