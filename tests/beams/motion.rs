//! A surface that moves while the shutter is open, against the mean of its moments.

use glam::DVec3;

use crate::common::mesh::{Moving, TestMesh, parallelogram};
use crate::common::numbers::SplitMix;
use crate::common::scene::SceneFolder;
use crate::seeds::{Seeds, assert_agree, parts};
use crate::walled;

const SHUTTER: f64 = 0.6;
/// Frames a second.
const FPS: f64 = 24.0;
/// Pictures whose spread tells the error of their mean.
const REPEATS: u64 = 8;
const MOMENTS: u32 = 32;
const HEIGHT: f64 = 0.05;

fn crest(p: DVec3) -> f64 {
    HEIGHT * (5.0 * p.x + 2.0 * p.y).cos()
}

fn surface(height: impl Fn(DVec3) -> f64) -> TestMesh {
    let cells = 26;
    let mut mesh = TestMesh { positions: Vec::new(), triangles: Vec::new() };
    for i in 0..=cells {
        for j in 0..=cells {
            let [x, y] = [i, j].map(|i| 4.4 * f64::from(i) / f64::from(cells) - 2.2);
            let flat = DVec3::new(x, y, 0.0);
            mesh.positions.push(flat + (1.0 + height(flat)) * DVec3::Z);
        }
    }
    let at = |i: u32, j: u32| i * (cells + 1) + j;
    for i in 0..cells {
        for j in 0..cells {
            mesh.triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            mesh.triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    mesh
}

fn text(walls: &str, normals: &str, shutter: f64) -> String {
    format!(
        "[media.water]\nior = 1.33\n\
         [[surfaces]]\nmesh = \"surface_####.ply\"\nfront = \"air\"\nback = \"water\"\nnormals = \"{normals}\"\n\
         material = {{ kind = \"dielectric\" }}\n\
         [[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = [0.7, 0.5, 0.3] }}\n\
         [sun]\ndirection = [0.3, 0.1, 0.9]\nangular_diameter = 0.53\nirradiance = 3\n\
         [camera]\neye = [0, 0, 0.6]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nvertical_fov = 70\nresolution = [24, 18]\n\
         shutter = {shutter}\n{walls}[render]\nintegrator = \"beams\"\nmax_depth = 2\n"
    )
}

fn folder() -> (SceneFolder, String) {
    let floor = parallelogram(DVec3::new(-2.0, -2.0, 0.0), DVec3::X * 4.0, DVec3::Y * 4.0);
    walled(SceneFolder::new().mesh("floor.ply", &floor), 1.9, 1.2)
}

/// The mean of moments, one in each of equal parts of the time, at a place in it drawn with `random`.
fn moments(
    water: &TestMesh,
    velocity: impl Fn(DVec3) -> DVec3 + Copy,
    normals: &str,
    random: &mut SplitMix,
) -> Vec<DVec3> {
    let mut sum = vec![DVec3::ZERO; 12];
    for k in 0..MOMENTS {
        let seconds = SHUTTER * (f64::from(k) + random.f64()) / f64::from(MOMENTS) / FPS;
        let (folder, walls) = folder();
        let folder = folder.mesh("surface_0001.ply", &water.clone().moved(velocity, seconds));
        let picture = folder.scene(&text(&walls, normals, 0.0)).render(2, random.next());
        for (sum, mean) in sum.iter_mut().zip(parts(&picture, [4, 3])) {
            *sum += mean / f64::from(MOMENTS);
        }
    }
    sum
}

/// Eight blurred pictures against as many means of 32 moments: scores of 36 block means, as [`assert_agree`] judges them, and
/// a still picture that differs.
fn assert_is_the_mean_of_its_moments(
    name: &str,
    water: &TestMesh,
    velocity: impl Fn(DVec3) -> DVec3 + Copy,
    normals: &str,
) {
    let (folder, walls) = folder();
    let folder = folder.file("surface_0001.ply", water.moving_ply(velocity).as_bytes());
    let render = |shutter: f64, samples: u32| {
        let scene = folder.scene(&text(&walls, normals, shutter));
        Seeds::render(&scene, samples, REPEATS, [4, 3]).means()
    };
    let (blurred, still) = (render(SHUTTER, 64), render(0.0, 64));
    let mut random = SplitMix(7);
    let by_hand: Vec<_> = (0..REPEATS).map(|_| moments(water, velocity, normals, &mut random)).collect();
    let apart = blurred.iter().zip(&still).map(|(a, b)| ((a.0 - b.0) / b.0).abs().max_element());
    let apart = apart.fold(0.0, f64::max);
    println!("{name}, {normals}: a block of the still picture is {apart:.2} off");
    assert!(apart > 0.1, "{name}: the motion shows too little: {apart}");
    assert_agree(&format!("{name}, {normals}"), &blurred, &Seeds(by_hand).means(), 0.02);
}

/// Waves that move on by a fifth of their length, and rise.
#[test]
#[ignore = "half a minute"]
fn waves_that_move_on() {
    for normals in ["smooth", "flat"] {
        let velocity = |_: DVec3| DVec3::new(0.25, 0.1, 0.1) / SHUTTER * FPS;
        assert_is_the_mean_of_its_moments("moving on", &surface(crest), velocity, normals);
    }
}

/// Crests become troughs: normals turn by up to 30 degrees, from one side of the vertical as far to the other, which is where
/// vertex normals that go straight from the first to the last have the slopes of the moved surface.
#[test]
#[ignore = "half a minute"]
fn crests_that_become_troughs() {
    for normals in ["smooth", "flat"] {
        let velocity = |p: DVec3| -2.0 * crest(p) / SHUTTER * FPS * DVec3::Z;
        assert_is_the_mean_of_its_moments("turning", &surface(crest), velocity, normals);
    }
}

/// A black plate over flat water that leaves while the shutter is open: what is in the shade when it opens is lit afterwards.
///
/// The edge of the plate goes 40 m, and 10 m of them until the sun comes to the water above the middle of the floor; where it
/// comes to the rest of what the camera sees of that is within a metre and a half of there, and within half a metre in the
/// mean. 6912 pixels' samples, of which three quarters are lit, tell the mean within 0.006 at one standard error, as they would
/// if they were independent; with 4 of these it is within 0.04.
#[test]
fn a_shadow_that_goes_away() {
    const WAY: f64 = 40.0;
    let mean = |y: f64| {
        let (folder, walls) = folder();
        let plate = parallelogram(DVec3::new(-10.0, y - 10.0, 2.0), DVec3::X * 20.0, DVec3::Y * 20.0);
        let plate = plate.moving_ply(|_| DVec3::X * WAY / SHUTTER * FPS);
        let folder = folder.mesh("surface.ply", &surface(|_| 0.0)).file("plate_0001.ply", plate.as_bytes());
        let text = text(&walls, "flat", SHUTTER).replace("surface_####", "surface");
        let plate =
            "[[surfaces]]\nmesh = \"plate_####.ply\"\nmaterial = { kind = \"diffuse\", reflectance = 0 }\n";
        folder.scene(&format!("{text}{plate}")).render(16, 1).mean().0.x
    };
    let share = mean(0.0) / mean(100.0);
    println!("{share:.4} of the time it is lit");
    assert!((share - (1.0 - 10.0 / WAY)).abs() < 0.04, "{share}");
}
