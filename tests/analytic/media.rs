//! Media that glow, and media whose density changes from place to place.

use floe::driver::error::Blame;
use glam::DVec3;

use super::estimates::{assert_every_pixel, assert_mean};
use crate::common::files::npy;
use crate::common::mesh::{cuboid, parallelogram};
use crate::common::scene::SceneFolder;

pub const CUBE: &str = "[[surfaces]]\nmesh = \"cube.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"fluid\"\n\
                    material = { kind = \"dielectric\" }\n";
/// A view of the cube from outside.
pub const OBLIQUE: &str =
    "[camera]\neye = [1.2, -3.5, 0.8]\ntarget = [0, 0, 0]\nvertical_fov = 40\nresolution = [12, 12]\n";
/// A view along y of which all rays are parallel to 1e-5.
pub const STRAIGHT: &str = "[camera]\neye = [0.05, -3.5, 0.03]\ntarget = [0.05, 0, 0.03]\nvertical_fov = 0.001\nresolution = [4, 4]\n";

/// Every kind of density.
pub const DENSITIES: [&str; 4] = [
    "",
    "density = { stratified = 0.4, surface = 0.7 }\n",
    "density = { stratified = -0.3 }\n",
    "density = { grid = \"plume.npy\", box = [[-0.6, -0.8, -0.7], [0.7, 0.5, 0.9]] }\n",
];

/// Values from 0 to 2 that repeat nowhere.
fn plume_value(cell: usize) -> f32 {
    (cell * 37 % 101) as f32 / 50.0
}

/// The cube from -0.7 to 0.7 and a plume.
pub fn folder() -> SceneFolder {
    let plume = npy([7, 9, 5], plume_value);
    SceneFolder::new()
        .mesh("cube.ply", &cuboid(DVec3::splat(-0.7), DVec3::splat(0.7)))
        .file("plume.npy", &plume)
}

#[test]
fn a_glowing_medium_that_only_absorbs_is_exact() {
    let scene = folder().scene(&format!(
        "[media.fluid]\nabsorption = [0.5, 2, 1e-4]\nemission = [3, 1, 2000]\n{CUBE}{STRAIGHT}"
    ));
    let seen = |radiance: f64, sigma_a: f64| -radiance * libm::expm1(-1.4 * sigma_a);
    let expected = DVec3::new(seen(3.0, 0.5), seen(1.0, 2.0), seen(2000.0, 1e-4));
    assert_every_pixel("glowing slab", &scene.render(4, 0), expected, 2e-6);
}

/// Kirchhoff: what is as hot as its surroundings cannot be seen, whatever it does to light. Where nothing scatters or
/// bends, that holds for each sample; n^2 is what lets it hold in the mean within a refracting body.
#[test]
fn a_medium_as_bright_as_its_surroundings_vanishes() {
    let folder = folder();
    for density in DENSITIES {
        for ior in [1.0, 1.33] {
            let scene = folder.scene(&format!(
                "[media.fluid]\nior = {ior}\nabsorption = [0.5, 2, 8]\nemission = 1\n{density}{CUBE}{OBLIQUE}\
                 [sky]\nradiance = 1\n"
            ));
            let name = format!("equilibrium, ior {ior}, {density}");
            if ior == 1.0 {
                assert_every_pixel(&name, &scene.render(16, 0), DVec3::ONE, 2e-6);
            } else {
                assert_mean(&name, &scene.render(256, 0), DVec3::ONE, 2e-3);
            }
        }
    }
}

#[test]
fn a_turbid_medium_as_bright_as_its_surroundings_vanishes_on_average() {
    let folder = folder();
    for density in DENSITIES {
        let scene = folder.scene(&format!(
            "[media.fluid]\nior = 1.33\nabsorption = [0.5, 2, 0.1]\nscattering = [3, 1, 6]\nemission = 1\n\
             phase = {{ kind = \"henyey-greenstein\", g = 0.5 }}\n{density}{CUBE}{OBLIQUE}[sky]\nradiance = 1\n"
        ));
        assert_mean(&format!("turbid equilibrium, {density}"), &scene.render(1024, 0), DVec3::ONE, 2e-3);
    }
}

/// Light that comes out of a glowing turbid medium, and light of the surroundings that gets through it without the glow,
/// are two estimates that know nothing of each other: by Kirchhoff's law they sum to 1.
#[test]
fn emission_is_what_transport_leaves_out() {
    let folder = folder();
    for density in DENSITIES {
        let mean = |emission: u32, sky: u32| {
            let scene = folder.scene(&format!(
                "[media.fluid]\nior = 1.1\nabsorption = [1, 2, 0.5]\nscattering = [0.1, 1, 4]\nemission = {emission}\n\
                 {density}{CUBE}{OBLIQUE}[sky]\nradiance = {sky}\n"
            ));
            scene.render(1024, u64::from(emission)).mean()
        };
        let ((glow, glow_se), (passed, passed_se)) = (mean(1, 0), mean(0, 1));
        let deviation =
            DVec3::from_array((glow_se * glow_se + passed_se * passed_se).to_array().map(f64::sqrt));
        println!("{density}: {glow:.5} + {passed:.5} +- {deviation:.5}");
        assert!(glow.min_element() > 0.01 && deviation.max_element() < 2e-3);
        assert!(
            (glow + passed - DVec3::ONE).abs().cmple(5.0 * deviation + 1e-5).all(),
            "{density}: {glow} {passed}"
        );
    }
}

#[test]
fn a_heterogeneous_medium_that_absorbs_nothing_vanishes_in_white_surroundings() {
    let folder = folder();
    for density in DENSITIES {
        for (scattering, samples) in [("12", 64), ("[0.5, 4, 20]", 1024)] {
            let scene = folder.scene(&format!(
                "[media.fluid]\nior = 1.33\nscattering = {scattering}\n\
                 phase = {{ kind = \"henyey-greenstein\", g = 0.8 }}\n{density}{CUBE}{OBLIQUE}[sky]\nradiance = 1\n"
            ));
            let name = format!("albedo 1, scattering {scattering}, {density}");
            let picture = scene.render(samples, 0);
            if scattering == "12" {
                assert_every_pixel(&name, &picture, DVec3::ONE, 2e-5);
            } else {
                assert_mean(&name, &picture, DVec3::ONE, 1e-2);
            }
        }
    }
}

/// Along the cells of a column the integral of the linear interpolation, flat in the outer halves, is the mean of the
/// cells times their length.
#[test]
fn light_through_a_grid_follows_bouguers_law() {
    let column = npy([1, 3, 1], |i| [0.5, 2.0, 0.25][i]);
    let scene = folder().file("plume.npy", &column).scene(&format!(
        "[media.fluid]\nabsorption = [0.5, 2, 0]\n\
         density = {{ grid = \"plume.npy\", box = [[-0.7, -0.5, -0.7], [0.7, 0.4, 0.7]] }}\n{CUBE}{STRAIGHT}[sky]\nradiance = 1\n"
    ));
    let length = 0.9_f64 * (0.5 + 2.0 + 0.25) / 3.0;
    let expected = DVec3::new((-0.5 * length).exp(), (-2.0 * length).exp(), 1.0);
    assert_every_pixel("column of a grid", &scene.render(4, 0), expected, 2e-6);
}

/// Optical depth of the plume along a ray, by the midpoint rule over the cube and the grid's box: values belong to cell
/// centres, are linear in between, and flat in the outer halves of the outer cells.
fn plume_depth(eye: DVec3, direction: DVec3) -> f64 {
    let (min, max) = (DVec3::new(-0.6, -0.8, -0.7), DVec3::new(0.7, 0.5, 0.9));
    let (low, high) = (min.max(DVec3::splat(-0.7)), max.min(DVec3::splat(0.7)));
    let ([a, b], count) = ([low, high].map(|corner| (corner - eye) / direction), [7_usize, 9, 5]);
    let (near, far) = (a.min(b).max_element(), a.max(b).min_element());
    let step = (far - near).max(0.0) / 20_000.0;
    let density = |t: f64| {
        let cell = (eye + t * direction - min) / (max - min) * DVec3::new(7.0, 9.0, 5.0) - 0.5;
        let mut sum = 0.0;
        for corner in 0..8 {
            let (mut weight, mut index) = (1.0, [0; 3]);
            for axis in 0..3 {
                let (upper, floor) = (corner >> axis & 1, cell[axis].floor());
                let share = cell[axis] - floor;
                weight *= if upper == 1 { share } else { 1.0 - share };
                index[axis] = (floor as i64 + upper).clamp(0, count[axis] as i64 - 1) as usize;
            }
            sum += weight * f64::from(plume_value(index[0] + 7 * (index[1] + 9 * index[2])));
        }
        sum
    };
    (0..20_000).map(|i| density(near + (f64::from(i) + 0.5) * step)).sum::<f64>() * step
}

/// Light that is absorbed exactly, and the share of free flights that end at a particle: the picture's alpha.
#[test]
fn oblique_rays_through_a_grid_follow_its_quadrature() {
    let folder = folder();
    for (eye, target) in [
        (DVec3::new(1.2, -3.5, 0.8), DVec3::new(0.02, 0.01, 0.03)),
        (DVec3::new(-2.0, 2.5, -3.0), DVec3::new(0.1, -0.2, 0.15)),
        (DVec3::new(0.3, 0.2, 4.0), DVec3::new(0.1, -0.3, 0.0)),
        (DVec3::new(-3.0, -0.4, 0.5), DVec3::new(0.0, -0.6, 0.6)),
        (DVec3::new(2.5, 2.0, 1.0), DVec3::new(0.5, 0.3, -0.4)),
    ] {
        let render = |coefficients: &str, samples| {
            let scene = folder.scene(&format!(
                "[media.fluid]\n{coefficients}\n{}\n{CUBE}[sky]\nradiance = 1\n[camera]\neye = {:?}\ntarget = {:?}\n\
                 vertical_fov = 0.0001\nresolution = [8, 8]\n",
                DENSITIES[3],
                eye.to_array(),
                target.to_array()
            ));
            scene.render(samples, 0)
        };
        let depth = plume_depth(eye, (target - eye).normalize());
        let expected = DVec3::new((-0.5 * depth).exp(), (-2.0 * depth).exp(), 1.0);
        let name = format!("grid from {eye}");
        assert_every_pixel(&name, &render("absorption = [0.5, 2, 0]", 1), expected, 1e-5);
        let samples = 1024;
        let alphas = render("scattering = 1", samples).image.pixels;
        let alpha = alphas.iter().map(|p| f64::from(p.alpha)).sum::<f64>() / 64.0;
        let share = -libm::expm1(-depth);
        let se = (share * (1.0 - share) / f64::from(64 * samples)).sqrt();
        println!("{name}: depth {depth:.6}, {alpha:.5} of the flights end, expected {share:.5} +- {se:.5}");
        assert!((alpha - share).abs() < 5.0 * se, "{name}: {alpha} of the flights end and not {share}");
    }
}

/// A grid for each frame is that of the frame's number: a still is number 1.
#[test]
fn a_grid_for_each_frame_is_read_with_it() {
    let folder = folder().file("plume_0001.npy", &npy([1, 1, 1], |_| 2.0));
    let scene = folder.scene(&format!(
        "[media.fluid]\nabsorption = 0.5\n\
         density = {{ grid = \"plume_####.npy\", box = [[-1, -1, -1], [1, 1, 1]] }}\n{CUBE}{STRAIGHT}[sky]\nradiance = 1\n"
    ));
    assert_every_pixel("grid of a frame", &scene.render(4, 0), DVec3::splat(libm::exp(-1.4)), 2e-6);
}

#[test]
fn grids_that_cannot_be_read_are_named() {
    let folder = folder().file("short.npy", &npy([2, 2, 2], |_| 1.0)[..100]).file("text.npy", b"1 2 3");
    for (name, blame, problem) in [
        ("short.npy", Blame::Data, "bytes of data where 2 x 2 x 2 cells of 4 bytes take 32"),
        (
            "text.npy",
            Blame::Data,
            "the file starts neither as .npy nor as .nrrd; write the grid with numpy.save",
        ),
        ("none.npy", Blame::Missing, "check density.grid, which is relative to the scene file"),
    ] {
        let error = folder.refused(&format!(
            "[media.fluid]\nabsorption = 1\ndensity = {{ grid = \"{name}\", box = [[0, 0, 0], [1, 1, 1]] }}\n{CUBE}{OBLIQUE}"
        ));
        let message = error.to_string();
        assert!(message.contains(name) && message.contains(problem), "{message}");
        assert_eq!(error.blame(), blame, "{message}");
    }
}

/// Air that thins out upwards between the sun, a floor and the eye: rays to the light and to the eye have the lengths
///
/// ```text
/// H / cos(zenith angle of the sun),   H (1 - exp(-height / H))
/// ```
///
/// The points drawn on the sun's disc have cosines that are off by 0.003 of 0.8 each: 1e-4 in the mean of 64 stratified ones.
#[test]
fn a_floor_under_thinning_air_is_lit_through_its_layers() {
    let floor = parallelogram(DVec3::new(-5.0, -5.0, 0.0), DVec3::X * 10.0, DVec3::Y * 10.0);
    let scene = SceneFolder::new().mesh("floor.ply", &floor).scene(
        "[media.air]\nabsorption = [0.2, 1, 0]\ndensity = { stratified = -0.5 }\n\
         [[surfaces]]\nmesh = \"floor.ply\"\nmaterial = { kind = \"diffuse\", reflectance = 0.5 }\n\
         [sun]\ndirection = [0, 0.6, 0.8]\nirradiance = 10\n\
         [camera]\neye = [0.1, 0.2, 2]\ntarget = [0.1, 0.2, 0]\nup = [0, 1, 0]\nvertical_fov = 0.001\nresolution = [4, 4]\n\
         [render]\nmax_depth = 1\n",
    );
    let length = 0.5_f64 / 0.8 - 0.5 * libm::expm1(-2.0 / 0.5);
    let lit = 0.5 * 10.0 * 0.8 / std::f64::consts::PI;
    let expected = lit * DVec3::new((-0.2 * length).exp(), (-length).exp(), 1.0);
    assert_every_pixel("floor under thinning air", &scene.render(64, 0), expected, 2e-4);
}

/// One medium in three notations: these products are exact in single precision.
#[test]
fn every_way_to_give_coefficients_makes_the_same_picture() {
    let folder = folder();
    let picture = |coefficients: &str| {
        let scene = folder.scene(&format!(
            "[media.fluid]\nior = 1.2\n{coefficients}\n{CUBE}{OBLIQUE}[sky]\nradiance = [1, 2, 3]\n"
        ));
        let pixels = scene.render(8, 0).image.pixels;
        pixels.iter().map(|p| p.rgb.to_array().map(f32::to_bits)).collect::<Vec<_>>()
    };
    let plain = picture("absorption = [1, 2, 0]\nscattering = [3, 2, 1]");
    assert_eq!(picture("extinction = [4, 4, 1]\nalbedo = [0.75, 0.5, 1]"), plain);
    assert_eq!(
        picture("mass_absorption = [0.5, 1, 0]\nmass_scattering = [1.5, 1, 0.5]\nmass_concentration = 2"),
        plain
    );
    assert_eq!(
        picture("absorption = [1, 2, 0]\nmass_scattering = [12, 8, 4]\nmass_concentration = 0.25"),
        plain
    );
    assert_ne!(picture("absorption = [1, 2, 0]\nscattering = [3, 2, 2]"), plain);
}

/// Over wavelength: a body of 3000 K in surroundings of 3000 K.
#[test]
fn a_black_body_as_hot_as_its_surroundings_vanishes() {
    let folder = folder();
    let render = |fluid: &str| {
        let scene = folder.scene(&format!(
            "[media.fluid]\n{fluid}\n{CUBE}{OBLIQUE}[sky]\nradiance = {{ blackbody = 3000 }}\n"
        ));
        scene.render(16, 0).mean().0
    };
    let hot =
        render("absorption = { wavelength = [400, 700], value = [0.2, 5] }\nemission = { blackbody = 3000 }");
    let clear = render("");
    println!("{hot:.6} {clear:.6}");
    assert!(((hot - clear) / clear).abs().max_element() < 2e-5);
}
