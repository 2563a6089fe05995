//! The sun through one refracting interface, found by looking for every way of it, against closed forms, a quadrature and
//! photons; and what is bent otherwise, by photons beside it.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

#[path = "../common/mod.rs"]
mod common;

use common::mesh::parallelogram;
use common::scene::SceneFolder;
use glam::DVec3;

mod agreement;
mod ball;
mod closed_forms;
mod dispersion;
mod hero;
mod motion;
#[path = "../photons/seeds.rs"]
mod seeds;
mod strays;
mod suns;
mod wave;

/// Adds four black walls at a distance from the middle, which keep paths from leaving between the surface and the floor.
fn walled(folder: SceneFolder, half: f64, top: f64) -> (SceneFolder, String) {
    let mut walls = folder;
    let mut text = String::new();
    for (i, (x, y)) in [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)].into_iter().enumerate() {
        let out = DVec3::new(x, y, 0.0) * half;
        let along = DVec3::new(-y, x, 0.0) * (half + 0.05);
        let wall = parallelogram(out - along - 0.1 * DVec3::Z, 2.0 * along, (top + 0.1) * DVec3::Z);
        walls = walls.mesh(&format!("wall_{i}.ply"), &wall);
        text += &format!(
            "[[surfaces]]\nmesh = \"wall_{i}.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 0 }}\n"
        );
    }
    (walls, text)
}
