//! The rays that are traced: from a camera, on from where those hit, and towards a light.

use floe::accel::{Accel, Ignored};
use floe::geometry::Ray;
use glam::Vec3;

use super::meshes::Mesh;
use super::random::Random;

/// What is asked of a ray.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Query {
    /// What it meets first.
    Closest,
    /// Whether it meets anything.
    Occluded,
}

/// Rays that are timed together.
pub struct RaySet {
    /// What `--rows` looks for.
    pub name: &'static str,
    /// What is asked of them.
    pub query: Query,
    /// The rays in the order they are traced in.
    pub rays: Vec<Ray>,
}

/// Where a camera ray met the mesh.
struct Landing {
    point: Vec3,
    /// Unit normal on the side that the ray came from.
    normal: Vec3,
}

/// Pixels of a square that is finished before the next begins.
const TILE: u32 = 8;

/// Half the camera's angle of view: almost every ray meets the mesh.
const TAN_HALF_FOV: f32 = 0.36;

/// Rays start this far off the surface, as a fraction of the mesh's extent.
const OFFSET: f32 = 1e-4;

/// All sets over a mesh, from a camera of `side` by `side` pixels.
pub fn all(mesh: &Mesh, accel: &Accel, side: u32) -> Vec<RaySet> {
    let primary = camera(mesh, side);
    let landings = land(mesh, accel, &primary);
    let secondary = scattered(mesh, &landings);
    let mut shuffled = secondary.clone();
    Random(4).shuffle(&mut shuffled);
    let shadow = to_light(mesh, &landings);
    vec![
        RaySet { name: "primary", query: Query::Closest, rays: primary },
        RaySet { name: "secondary, pixel order", query: Query::Closest, rays: secondary },
        RaySet { name: "secondary, shuffled", query: Query::Closest, rays: shuffled },
        RaySet { name: "shadow", query: Query::Occluded, rays: shadow },
    ]
}

/// One ray a pixel, tile by tile.
fn camera(mesh: &Mesh, side: u32) -> Vec<Ray> {
    let forward = -mesh.eye.normalize();
    let right = forward.cross(Vec3::Z).normalize();
    let up = right.cross(forward);
    let tiles = side.div_ceil(TILE);
    let pixel =
        |tile: u32, inside: u32| (tile % tiles * TILE + inside % TILE, tile / tiles * TILE + inside / TILE);
    let on_screen = |i: u32| TAN_HALF_FOV * (2.0 * (i as f32 + 0.5) / side as f32 - 1.0);
    (0..tiles * tiles)
        .flat_map(|tile| (0..TILE * TILE).map(move |inside| pixel(tile, inside)))
        .map(|(x, y)| Ray::new(mesh.eye, (forward + right * on_screen(x) - up * on_screen(y)).normalize()))
        .collect()
}

fn land(mesh: &Mesh, accel: &Accel, rays: &[Ray]) -> Vec<Landing> {
    let landing = |ray: &Ray| {
        let hit = accel.closest(ray, Ignored::NOTHING)?;
        let [a, b, c] = mesh.triangles[hit.triangle as usize].map(|i| mesh.positions[i as usize]);
        let normal = (b - a).cross(c - a).normalize();
        let normal = if normal.dot(ray.direction) < 0.0 { normal } else { -normal };
        Some(Landing { point: ray.at(hit.t), normal })
    };
    rays.iter().filter_map(landing).collect()
}

/// One ray from each landing, cosine-distributed: half of them back, as after a reflection, half of them on.
fn scattered(mesh: &Mesh, landings: &[Landing]) -> Vec<Ray> {
    let mut random = Random(3);
    let scatter = |landing: &Landing| {
        let side = if random.unit() < 0.5 { landing.normal } else { -landing.normal };
        let direction = (side * 1.0001 + random.direction()).normalize();
        Ray::new(landing.point + side * (OFFSET * mesh.extent), direction)
    };
    landings.iter().map(scatter).collect()
}

/// One ray from each landing to a point on a square above and to the side.
fn to_light(mesh: &Mesh, landings: &[Landing]) -> Vec<Ray> {
    let mut random = Random(5);
    let aim = |landing: &Landing| {
        let origin = landing.point + landing.normal * (OFFSET * mesh.extent);
        let light = Vec3::new(2.2, -2.0 + 0.3 * random.signed(), 1.5 + 0.3 * random.signed()) * mesh.extent;
        let way = light - origin;
        Ray { t_max: way.length(), ..Ray::new(origin, way.normalize()) }
    };
    landings.iter().map(aim).collect()
}
