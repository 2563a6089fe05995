//! Wavelengths that bend at indices of their own.
//!
//! An index that is constant over each of three bands of wavelengths makes the sum of three pictures, each of one band of
//! light and of a constant index. Light that is dark where the index changes makes that exact: block by block both are
//! estimates of the same number.

use floe::spectrum::{LaneMode, cie};
use glam::DVec3;

use super::estimates::assert_mean;
use crate::common::mesh::{cuboid, parallelogram, sphere};
use crate::common::render::{Prepared, Rendered};
use crate::common::scene::SceneFolder;

/// In blocks of this many pixels.
const GRID: [u32; 2] = [4, 3];
const RESOLUTION: &str = "resolution = [24, 18]\n";

/// The index over wavelength, and that of each band alone.
const STAIRS: &str = "{ wavelength = [500, 501, 600, 601], n = [1.30, 1.42, 1.42, 1.55] }";
const STEPS: [&str; 3] = ["1.30", "1.42", "1.55"];

/// Light of all bands, and of each.
const ALL: &str =
    "{ wavelength = [499, 500, 501, 502, 599, 600, 601, 602], value = [1, 0, 0, 1, 1, 0, 0, 1] }";
const BANDS: [&str; 3] = [
    "{ wavelength = [499, 500], value = [1, 0] }",
    "{ wavelength = [501, 502, 599, 600], value = [0, 1, 1, 0] }",
    "{ wavelength = [601, 602], value = [0, 1] }",
];

fn with(text: &str, index: &str, light: &str, render: &str) -> String {
    format!("{}[render]\n{render}", text.replace("INDEX", index).replace("LIGHT", light))
}

/// Compares the picture of all wavelengths with the sum of those of the bands, `is_meant` having seen that the scene is what
/// it is meant to be.
///
/// 36 scores in each of seven comparisons: one normal score beyond 5 has a chance of 1.5e-4, a root mean square beyond 1.5 of
/// 1e-4 with a third of the scores independent of each other.
fn assert_is_the_sum_of_bands(
    name: &str,
    folder: &SceneFolder,
    text: &str,
    render: &str,
    (samples, is_meant): (u32, Check),
) {
    let dispersion = format!("dispersion = true\n{render}");
    let scene = folder.scene(&with(text, STAIRS, ALL, &dispersion));
    assert!(scene.frame.mode == LaneMode::Spectral && scene.frame.needs.dispersive, "{name}");
    assert!(is_meant(&scene), "{name}: the scene is another");
    let all = blocks(&scene.render(samples, 1));
    let bands: Vec<_> = STEPS
        .iter()
        .zip(BANDS)
        .zip(2..)
        .map(|((n, light), seed)| {
            let scene = folder.scene(&with(text, n, light, &dispersion));
            assert!(!scene.frame.needs.dispersive);
            blocks(&scene.render(samples, seed))
        })
        .collect();
    let (mut squares, mut worst, mut error) = (0.0, 0.0_f64, 0.0);
    for (i, (mean, se)) in all.iter().enumerate() {
        let expected: DVec3 = bands.iter().map(|band| band[i].0).sum();
        let variance = *se * *se + bands.iter().map(|band| band[i].1 * band[i].1).sum::<DVec3>();
        let rounding = 1e-5 * expected.abs().max_element();
        let z = (*mean - expected) / (variance + rounding * rounding).powf(0.5);
        squares += z.length_squared();
        worst = worst.max(z.abs().max_element());
        error += variance.element_sum().sqrt() / expected.abs().element_sum();
    }
    let rms = (squares / (3.0 * all.len() as f64)).sqrt();
    let error = error / all.len() as f64;
    println!("{name}: rms z {rms:.2}, worst {worst:.2}, relative error {error:.4}");
    assert!(rms < 1.5 && worst < 5.0, "{name}: rms z {rms:.2}, worst {worst:.2}");
    assert!(error < 0.08, "{name}: a relative error of {error} shows too little");
}

type Check = fn(&Prepared) -> bool;

fn blocks(picture: &Rendered) -> Vec<(DVec3, DVec3)> {
    let size = [picture.image.width / GRID[0], picture.image.height / GRID[1]];
    let corners = (0..GRID[1]).flat_map(|j| (0..GRID[0]).map(move |i| [i * size[0], j * size[1]]));
    corners.map(|corner| picture.block_mean(corner, size)).collect()
}

/// A glass ball whose interpolated normals lean far from the facets, on a floor under a lamp. The first interfaces are
/// split, or none is.
#[test]
fn a_ball_shows_each_wavelength_as_it_would_be_alone() {
    let folder = SceneFolder::new()
        .mesh("floor.ply", &parallelogram(DVec3::new(-3.0, -3.0, 0.0), DVec3::X * 6.0, DVec3::Y * 6.0))
        .mesh("lamp.ply", &parallelogram(DVec3::new(-1.0, -1.0, 3.0), DVec3::Y * 2.0, DVec3::X * 2.0))
        .mesh("ball.ply", &sphere(DVec3::new(0.0, 0.0, 0.7), 0.6, 1));
    let text = format!(
        "[media.glass]\nior = INDEX\n\
         [[surfaces]]\nmesh = \"ball.ply\"\nnormals = \"smooth\"\nfront = \"air\"\nback = \"glass\"\n\
         material = {{ kind = \"dielectric\" }}\n\
         [[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 0.6 }}\n\
         [[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = {{ kind = \"emitter\", radiance = LIGHT }}\n\
         [camera]\neye = [0.4, -2.6, 1.9]\ntarget = [0, 0, 0.5]\nvertical_fov = 24\n{RESOLUTION}"
    );
    for split in [0, 3] {
        let name = format!("ball, split {split}");
        assert_is_the_sum_of_bands(&name, &folder, &text, &format!("split = {split}\n"), (256, |_| true));
    }
}

/// From within turbid water: lamps are looked for through its surface, one lane is reflected totally where another is not,
/// a mirror stands in the water, and a glass ball in it has the water's index on one band only.
#[test]
fn turbid_water_shows_each_wavelength_as_it_would_be_alone() {
    let v = DVec3::new;
    let folder = SceneFolder::new()
        .mesh("lamp.ply", &parallelogram(v(-0.6, -0.6, 4.0), DVec3::Y * 1.2, DVec3::X * 1.2))
        .mesh("water.ply", &cuboid(v(-1.0, -1.0, -1.0), v(1.0, 1.0, 0.0)))
        .mesh("floor.ply", &parallelogram(v(-0.9, -0.9, -0.9), DVec3::X * 1.8, DVec3::Y * 1.8))
        .mesh("ball.ply", &sphere(v(0.3, 0.3, -0.5), 0.3, 2))
        .mesh("mirror.ply", &parallelogram(v(-0.8, 0.8, -0.8), v(1.0, 0.05, 0.0), v(0.0, 0.1, 0.7)));
    let text = format!(
        "[media.water]\nior = INDEX\nabsorption = 0.3\nscattering = 0.4\n[media.glass]\nior = 1.42\n\
         [[surfaces]]\nmesh = \"water.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"water\"\n\
         material = {{ kind = \"dielectric\" }}\n\
         [[surfaces]]\nmesh = \"ball.ply\"\nfront = \"water\"\nback = \"glass\"\nmaterial = {{ kind = \"dielectric\" }}\n\
         [[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 0.6 }}\n\
         [[surfaces]]\nmesh = \"mirror.ply\"\nmaterial = {{ kind = \"conductor\", eta = 1.2, k = 6 }}\n\
         [[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = {{ kind = \"emitter\", radiance = LIGHT }}\n\
         [camera]\neye = [-0.2, -0.8, -0.5]\ntarget = [0.1, 0.5, -0.45]\nvertical_fov = 60\n{RESOLUTION}"
    );
    let is_beneath: Check = |scene| scene.frame.beneath.iter().any(Option::is_some);
    for (name, render) in
        [("turbid", "split = 1\n"), ("turbid, forced", "split = 2\nforced_scattering = 1\n")]
    {
        assert_is_the_sum_of_bands(name, &folder, &text, render, (512, is_beneath));
    }
}

/// Of a medium too thick to walk through, reflection is closed but for its interface.
#[test]
fn a_half_space_shows_each_wavelength_as_it_would_be_alone() {
    let folder = SceneFolder::new()
        .mesh("cloud.ply", &cuboid(DVec3::splat(-100.0), DVec3::new(100.0, 100.0, 0.0)))
        .mesh("lamp.ply", &parallelogram(DVec3::new(-1.0, -1.0, 2.0), DVec3::Y * 2.0, DVec3::X * 2.0));
    let text = format!(
        "[media.cloud]\nior = INDEX\nabsorption = 1e4\nscattering = 1e6\n\
         [[surfaces]]\nmesh = \"cloud.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"cloud\"\n\
         material = {{ kind = \"dielectric\" }}\n\
         [[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = {{ kind = \"emitter\", radiance = LIGHT }}\n\
         [camera]\neye = [0, -3, 1.5]\ntarget = [0, 0, 0]\nvertical_fov = 40\n{RESOLUTION}"
    );
    let check: Check = |scene| scene.frame.half_spaces.iter().any(Option::is_some);
    assert_is_the_sum_of_bands("half space", &folder, &text, "", (256, check));
}

/// Water that overlaps glass: what is between them is told on the way.
#[test]
fn layers_show_each_wavelength_as_it_would_be_alone() {
    let folder = SceneFolder::new()
        .mesh("water.ply", &cuboid(DVec3::splat(-0.6), DVec3::splat(0.6)))
        .mesh("glass.ply", &sphere(DVec3::new(0.3, -0.5, 0.2), 0.5, 2))
        .mesh("lamp.ply", &parallelogram(DVec3::new(-1.0, -1.0, 2.0), DVec3::Y * 2.0, DVec3::X * 2.0));
    let text = format!(
        "[media.water]\nior = INDEX\nscattering = 0.3\n[media.glass]\nior = 1.42\n\
         [[meshes]]\npath = \"water.ply\"\ninside = \"water\"\npriority = 1\nnormals = \"flat\"\n\
         [[meshes]]\npath = \"glass.ply\"\ninside = \"glass\"\npriority = 2\n\
         [[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = {{ kind = \"emitter\", radiance = LIGHT }}\n\
         [sky]\nradiance = LIGHT\n\
         [camera]\neye = [1.5, -3, 1.2]\ntarget = [0, 0, 0]\nvertical_fov = 26\n{RESOLUTION}"
    );
    assert_is_the_sum_of_bands("layers", &folder, &text, "", (256, |scene| scene.frame.needs.layers));
}

/// Linear RGB of white light times a function of the wavelength.
fn of_white(value: impl Fn(f64) -> f64) -> DVec3 {
    cie::rgb(|lambda| value(lambda) * cie::d65(lambda))
}

/// An index that falls from 1.7 to 1.3 over the visible range.
const STEEP: &str = "{ wavelength = [380, 780], n = [1.7, 1.3] }";

fn steep(lambda: f64) -> f64 {
    1.7 - 0.001 * (lambda - 380.0)
}

/// White surroundings stay white, however wavelengths go apart: clear and turbid.
#[test]
fn furnaces_stay_white() {
    let folder = SceneFolder::new().mesh("ball.ply", &sphere(DVec3::ZERO, 0.6, 2));
    for (name, medium) in [("clear furnace", ""), ("turbid furnace", "scattering = 2\n")] {
        for split in [0, 2] {
            let scene = folder.scene(&format!(
                "[media.fluid]\nior = {STEEP}\n{medium}\
                 [[surfaces]]\nmesh = \"ball.ply\"\nfront = \"air\"\nback = \"fluid\"\n\
                 material = {{ kind = \"dielectric\" }}\n[sky]\nradiance = 1\n\
                 [camera]\neye = [2, -3, 1]\ntarget = [0, 0, 0]\nvertical_fov = 12\nresolution = [16, 12]\n\
                 [render]\nsplit = {split}\ndispersion = true\n"
            ));
            assert_mean(name, &scene.render(256, 3), DVec3::ONE, 5e-3);
        }
    }
}

/// Radiance over the square of the index is the same on both sides, on each wavelength: through a boundary that nothing
/// bends at, and by emission.
#[test]
fn radiance_in_a_medium_grows_with_the_square_of_each_index() {
    let folder = SceneFolder::new().mesh("cube.ply", &cuboid(DVec3::splat(-1.0), DVec3::splat(1.0)));
    for medium in ["absorption = 0\n", "absorption = 2\nemission = 1\n"] {
        let scene = folder.scene(&format!(
            "[media.fluid]\nior = {STEEP}\n{medium}\
             [[surfaces]]\nmesh = \"cube.ply\"\nfront = \"air\"\nback = \"fluid\"\nmaterial = {{ kind = \"null\" }}\n\
             [sky]\nradiance = 1\n\
             [camera]\neye = [0, 0, 0]\ntarget = [0.2, 0.3, 1]\nvertical_fov = 50\nresolution = [8, 8]\n\
             [render]\ndispersion = true\n"
        ));
        let expected = of_white(|lambda| steep(lambda) * steep(lambda));
        assert_mean("square of the index", &scene.render(1024, 0), expected, 5e-3);
    }
}

/// Tables whose index is one number do not make a scene disperse, nor do others without `dispersion`.
#[test]
fn only_what_varies_is_needed() {
    let folder = SceneFolder::new().mesh("cube.ply", &cuboid(DVec3::splat(-1.0), DVec3::splat(1.0)));
    let needs = |ior: &str, render: &str| {
        let scene = folder.scene(&format!(
            "[media.fluid]\nior = {ior}\nabsorption = 0.1\n[[surfaces]]\nmesh = \"cube.ply\"\nfront = \"air\"\n\
             back = \"fluid\"\nmaterial = {{ kind = \"dielectric\" }}\n[sky]\nradiance = 1\n[render]\n{render}"
        ));
        (scene.frame.mode == LaneMode::Spectral, scene.frame.needs.dispersive)
    };
    let even = "{ wavelength = [400, 700], n = [1.3, 1.3] }";
    for (ior, render, expected) in [
        (STEEP, "dispersion = true\n", (true, true)),
        ("{ table = \"water\" }", "dispersion = true\n", (true, true)),
        (STEEP, "", (false, false)),
        (even, "dispersion = true\n", (false, false)),
        ("1.3", "dispersion = true\n", (false, false)),
        (STEEP, "dispersion = true\nintegrator = \"ambient-occlusion\"\n", (false, false)),
    ] {
        assert_eq!(needs(ior, render), expected, "{ior}, {render}");
    }
}
