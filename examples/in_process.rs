//! Rings in a pool that no file holds: `cargo run --release --example in_process` writes their pictures into
//! `out/in_process`.

use std::path::{Path, PathBuf};

use floe::driver::{RenderError, RenderOptions, Renderer};
use floe::glam::{DVec2, DVec3};
use floe::mesh::RawMesh;

const SCENE: &str = r#"
[regions]
1 = "water"                        # within a closed mesh without labels

[media.water]
ior = 1.333
absorption = [0.3, 0.06, 0.02]

[sun]
direction = [0.3, -0.45, 0.85]
irradiance = [1.0, 0.95, 0.85]

[sky]
radiance = [0.08, 0.11, 0.16]

[camera]
eye = [0.5, -3.6, 3.2]
target = [0, -0.1, -0.5]
horizontal_fov = 46
resolution = [320, 200]

[render]
samples = 16

[output]
exposure = 1.2

[[surfaces]]
mesh = "sequences/pool/tiles.ply"
normals = "flat"
material = { kind = "diffuse", reflectance = [0.62, 0.74, 0.78] }

[[surfaces]]
mesh = "sequences/pool/deck.ply"
normals = "flat"
material = { kind = "diffuse", reflectance = [0.45, 0.40, 0.34] }
"#;

/// Squares along an edge of the surface.
const SQUARES: u32 = 48;

fn main() -> Result<(), RenderError> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut renderer = Renderer::parse(SCENE, &root.join("pool in memory"), RenderOptions::default())?;
    for frame in 1..=8_u32 {
        let rendered = renderer.render(frame, pool(f64::from(frame) / 8.0), &())?;
        rendered.write_png(&PathBuf::from(format!("out/in_process/frame_{frame:04}.png")))?;
    }
    Ok(())
}

/// The height of the water: ripples, and the rings of a drop that fell at time 0.
fn height(place: DVec2, time: f64) -> f64 {
    let DVec2 { x, y } = place;
    let ripples =
        0.012 * (5.0 * x + 3.0 * y + 4.0 * time).sin() + 0.01 * (6.0 * y - 4.0 * x + 5.0 * time).sin();
    let behind = place.distance(DVec2::new(0.3, -0.2)) - 1.1 * time;
    ripples + 0.03 * (-(behind / 0.25).powi(2)).exp() * (14.0 * behind).cos()
}

/// The water, closed behind the tiles: a surface over a bottom of as many vertices, and sides between their rims.
fn pool(time: f64) -> RawMesh {
    let row = SQUARES + 1;
    let place = |vertex: u32| {
        let step = 3.1 / f64::from(SQUARES);
        DVec2::new(f64::from(vertex % row), f64::from(vertex / row)) * step - 1.55
    };
    let surface = (0..row * row).map(|vertex| place(vertex).extend(height(place(vertex), time)));
    let bottom = (0..row * row).map(|vertex| place(vertex).extend(-1.3));
    let squares = (0..SQUARES * SQUARES).map(|square| square / SQUARES * row + square % SQUARES);
    let mut triangles: Vec<[u32; 3]> =
        squares.flat_map(|a| [[a, a + 1, a + row + 1], [a, a + row + 1, a + row]]).collect();
    let below = row * row;
    triangles.extend(triangles.clone().into_iter().map(|[a, b, c]| [a + below, c + below, b + below]));
    let south = (0..SQUARES).map(|i| [i, i + 1]);
    let north = south.clone().map(|[a, b]| [b + SQUARES * row, a + SQUARES * row]);
    let west = south.clone().map(|[a, b]| [b * row, a * row]);
    let east = south.clone().map(|[a, b]| [a * row + SQUARES, b * row + SQUARES]);
    for [a, b] in south.chain(north).chain(west).chain(east) {
        triangles.extend([[a, a + below, b + below], [a, b + below, b]]);
    }
    let positions: Vec<DVec3> = surface.chain(bottom).collect();
    RawMesh { positions, triangles, ..RawMesh::default() }
}
