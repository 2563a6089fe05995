//! Wavelengths that bend at indices of their own, against pictures of one index each.
//!
//! An index that is constant over each of three bands of wavelengths makes the sum of three pictures, each of one band of
//! light and of a constant index. Light that is dark where the index changes makes that exact.

use floe::spectrum::LaneMode;
use glam::DVec3;

use crate::common::mesh::{TestMesh, parallelogram};
use crate::common::scene::SceneFolder;
use crate::seeds::{Means, Seeds, assert_agree};
use crate::walled;

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

/// A wave of few triangles, on which light of the three indices goes through other triangles to the same point.
fn surface() -> TestMesh {
    let cells = 32;
    let mut mesh = TestMesh { positions: Vec::new(), triangles: Vec::new() };
    for i in 0..=cells {
        for y in [-2.0, 2.0] {
            let x = 4.0 * f64::from(i) / f64::from(cells) - 2.0;
            mesh.positions.push(DVec3::new(x, y, 1.0 + 0.06 * (4.0 * x).sin()));
        }
    }
    for i in 0..cells {
        let [a, b, c, d] = [2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1];
        mesh.triangles.extend([[a, b, c], [a, c, d]]);
    }
    mesh
}

/// The floor under the wave, with four seeds a picture; scores as [`assert_agree`] judges them.
#[test]
fn a_floor_shows_each_wavelength_as_it_would_be_alone() {
    let floor = parallelogram(DVec3::new(-2.0, -2.0, 0.0), DVec3::X * 4.0, DVec3::Y * 4.0);
    let folder = SceneFolder::new().mesh("surface.ply", &surface()).mesh("floor.ply", &floor);
    let (folder, walls) = walled(folder, 1.9, 1.2);
    for normals in ["smooth", "flat"] {
        let scene = |index: &str, light: &str| {
            folder.scene(&format!(
                "[media.water]\nior = {index}\n\
                 [[surfaces]]\nmesh = \"surface.ply\"\nfront = \"air\"\nback = \"water\"\nnormals = \"{normals}\"\n\
                 material = {{ kind = \"dielectric\" }}\n\
                 [[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 0.6 }}\n\
                 [sun]\ndirection = [0.6, 0.1, 0.8]\nangular_diameter = 0.53\nirradiance = {light}\n\
                 [camera]\neye = [0, 0, 0.6]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nvertical_fov = 70\n\
                 resolution = [24, 18]\n{walls}\
                 [render]\nintegrator = \"beams\"\nmax_depth = 2\ndispersion = true\n"
            ))
        };
        let whole = scene(STAIRS, ALL);
        assert!(whole.frame.mode == LaneMode::Spectral && whole.frame.needs.dispersive);
        let all = Seeds::render(&whole, 128, 4, [4, 3]).means();
        let mut sum: Means = vec![(DVec3::ZERO, DVec3::ZERO); all.len()];
        for (n, light) in STEPS.iter().zip(BANDS) {
            let band = scene(n, light);
            assert!(!band.frame.needs.dispersive);
            for (sum, (mean, se)) in sum.iter_mut().zip(Seeds::render(&band, 128, 4, [4, 3]).means()) {
                *sum = (sum.0 + mean, (sum.1 * sum.1 + se * se).map(f64::sqrt));
            }
        }
        assert_agree(&format!("{normals} wave"), &all, &sum, 0.05);
    }
}
