//! Beams and photons find the same light.

use glam::DVec3;

use crate::common::mesh::{TestMesh, parallelogram, sphere};
use crate::common::render::Prepared;
use crate::common::scene::SceneFolder;
use crate::seeds::{self, with_radius};
use crate::walled;

/// Photons that are spread over a radius which does not shrink.
fn by_photons(folder: &SceneFolder, text: &str, radius: f32) -> Prepared {
    let settings = "[render]\nintegrator = \"photon\"\nphotons = { count = 100000, final_gather = false }\n";
    with_radius(folder.scene(&format!("{text}{settings}")), radius)
}

/// Means of 4 x 3 parts of a picture, one for each of four seeds.
fn parts(scene: &Prepared, samples: u32) -> Vec<Vec<f64>> {
    let of_seed =
        |seed| seeds::parts(&scene.render(samples, seed), [4, 3]).iter().map(|mean| mean.x).collect();
    (1..=4).map(of_seed).collect()
}

/// Beams against photons of a radius r, or of r, 2 r and 4 r extrapolated to 0. Each part is told by four seeds on both sides; with
/// the errors of all parts joined, twelve scores exceed 4.2 with probability 3e-4, and their root of the mean square 1.6 with 1e-3.
fn compare(name: &str, folder: &SceneFolder, text: &str, radius: f32, extrapolates: bool, samples: [u32; 2]) {
    let beams = format!("{text}[render]\nintegrator = \"beams\"\nphotons = {{ count = 20000 }}\n");
    let own = parts(&with_radius(folder.scene(&beams), radius), samples[0]);
    let at = |factor: f32| parts(&by_photons(folder, text, factor * radius), samples[1]);
    let near = at(1.0);
    let other = if extrapolates {
        let (middle, wide) = (at(2.0), at(4.0));
        let to_zero = |s: usize, p: usize| (8.0 * near[s][p] - 6.0 * middle[s][p] + wide[s][p]) / 3.0;
        (0..4).map(|s| (0..12).map(|p| to_zero(s, p)).collect()).collect()
    } else {
        near
    };
    let mean = |all: &[Vec<f64>], p: usize| all.iter().map(|seed| seed[p]).sum::<f64>() / 4.0;
    let relative = |all: &[Vec<f64>]| {
        let square =
            |p: usize| all.iter().map(|seed| (seed[p] / mean(all, p) - 1.0).powi(2)).sum::<f64>() / 12.0;
        (0..12).map(square).sum::<f64>() / 12.0
    };
    let (a, b) = (relative(&own), relative(&other));
    let scores = (0..12).map(|p| (mean(&own, p) / mean(&other, p) - 1.0) / (a + b).sqrt());
    let scores: Vec<f64> = scores.collect();
    let rms = (scores.iter().map(|z| z * z).sum::<f64>() / 12.0).sqrt();
    let worst = scores.iter().fold(0.0_f64, |w, z| w.max(z.abs()));
    println!("{name}: relative errors {:.4} {:.4}, rms {rms:.2}, worst {worst:.2}", a.sqrt(), b.sqrt());
    assert!((a + b).sqrt() < 0.04, "{name}: errors of {} and {} show too little", a.sqrt(), b.sqrt());
    assert!(rms < 1.6 && worst < 4.2, "{name}: rms {rms}, worst {worst}: {scores:.2?}");
}

/// Waves of few triangles across each other.
pub fn waves() -> TestMesh {
    let cells = 40;
    let mut mesh = TestMesh { positions: Vec::new(), triangles: Vec::new() };
    for i in 0..=cells {
        for j in 0..=cells {
            let [x, y] = [i, j].map(|i| 4.0 * f64::from(i) / f64::from(cells) - 2.0);
            let z = 1.0 + 0.05 * (5.0 * x + y).sin() + 0.04 * (6.0 * y - 2.0 * x).cos();
            mesh.positions.push(DVec3::new(x, y, z));
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

fn tank(water: &str, normals: &str, walls: &str) -> String {
    format!(
        "[media.water]\nior = 1.33\n{water}\n\
         [[surfaces]]\nmesh = \"surface.ply\"\nfront = \"air\"\nback = \"water\"\nnormals = \"{normals}\"\n\
         material = {{ kind = \"dielectric\" }}\n\
         [[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 0.5 }}\n\
         [sun]\ndirection = [0.3, 0.1, 0.9]\nangular_diameter = 0.53\nirradiance = 3\n\
         [camera]\neye = [0, -0.6, 0.7]\ntarget = [0, 0.1, 0]\nvertical_fov = 60\nresolution = [32, 24]\n{walls}"
    )
}

/// A floor under waves: its parts are 0.3 m wide, and what photons blur over 0.01 m changes their means by less than their
/// errors.
#[test]
fn a_wavy_tank() {
    in_a_tank("smooth");
}

/// From within a ball of turbid water, up to a black screen in it, so that no eye path turns at the ball.
#[test]
fn a_ball_of_water() {
    in_a_ball("smooth");
}

/// The same by the triangles' own normals.
#[test]
#[ignore = "takes a minute"]
fn flat_faces() {
    in_a_tank("flat");
    in_a_ball("flat");
}

fn in_a_tank(normals: &str) {
    let floor = parallelogram(DVec3::new(-2.0, -2.0, 0.0), DVec3::X * 4.0, DVec3::Y * 4.0);
    let folder = SceneFolder::new().mesh("surface.ply", &waves()).mesh("floor.ply", &floor);
    let (folder, walls) = walled(folder, 1.9, 1.2);
    let text = tank("absorption = 0.2", normals, &walls);
    compare(normals, &folder, &text, 0.01, false, [32, 16]);
}

/// The waves over water that shows a glow around the sun: floor and particles send paths towards it.
#[test]
fn a_turbid_tank() {
    let floor = parallelogram(DVec3::new(-2.0, -2.0, 0.0), DVec3::X * 4.0, DVec3::Y * 4.0);
    let folder = SceneFolder::new().mesh("surface.ply", &waves()).mesh("floor.ply", &floor);
    // They stand where the surface ends: photons would leave the turbid water beyond them at its open sides.
    let (folder, walls) = walled(folder, 2.0, 1.2);
    let water = "absorption = 0.1\nscattering = 1.5\nphase = { kind = \"henyey-greenstein\", g = 0.9 }";
    compare("turbid", &folder, &tank(water, "smooth", &walls), 0.02, true, [32, 16]);
}

fn in_a_ball(normals: &str) {
    let screen = parallelogram(DVec3::new(-0.77, 0.1, -0.58), DVec3::X * 1.54, DVec3::Z * 1.16);
    let folder =
        SceneFolder::new().mesh("ball.ply", &sphere(DVec3::ZERO, 1.0, 3)).mesh("screen.ply", &screen);
    let text = format!(
        "[media.water]\nior = 1.33\nabsorption = 0.1\nscattering = 0.4\n\
         [[surfaces]]\nmesh = \"ball.ply\"\nfront = \"air\"\nback = \"water\"\nnormals = \"{normals}\"\n\
         material = {{ kind = \"dielectric\" }}\n\
         [[surfaces]]\nmesh = \"screen.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 0 }}\n\
         [sun]\ndirection = [0.3, -0.2, 0.9]\nangular_diameter = 0.53\nirradiance = 3\n\
         [camera]\neye = [0, -0.85, 0]\ntarget = [0, 0, 0]\nvertical_fov = 60\nresolution = [32, 24]\n"
    );
    compare(normals, &folder, &text, 0.03, true, [32, 8]);
}

/// A screen in a bubble under water, whose normals let light in where its coarse faces reflect all of it.
#[test]
fn a_bubble_in_a_sea() {
    let screen = parallelogram(DVec3::new(-0.6, -0.6, -0.1), DVec3::X * 1.2, DVec3::Y * 1.2);
    let folder =
        SceneFolder::new().mesh("ball.ply", &sphere(DVec3::ZERO, 1.0, 1)).mesh("screen.ply", &screen);
    let text = "[media.air]\nior = 1.33\n[media.bubble]\nior = 1.0\n\
                [[surfaces]]\nmesh = \"ball.ply\"\nfront = \"air\"\nback = \"bubble\"\nnormals = \"smooth\"\n\
                material = { kind = \"dielectric\" }\n\
                [[surfaces]]\nmesh = \"screen.ply\"\nmaterial = { kind = \"diffuse\", reflectance = 0.5 }\n\
                [sun]\ndirection = [0.3, -0.2, 0.9]\nangular_diameter = 0.53\nirradiance = 3\n\
                [camera]\neye = [0, -0.45, 0.5]\ntarget = [0, 0, -0.1]\nvertical_fov = 60\nresolution = [32, 24]\n";
    compare("bubble", &folder, text, 0.02, true, [8, 4]);
}
