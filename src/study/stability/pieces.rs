//! Pieces of scene files.

use std::fmt::Display;

use glam::DVec3;

use super::shapes::cuboid;
use super::{Picture, Scene};
use crate::study::StudyError;

/// A surface of this mesh and material, with flat normals and further keys of the surface.
fn surface(mesh: &str, keys: &str, material: &str) -> String {
    format!("[[surfaces]]\nmesh = \"{mesh}\"\nnormals = \"flat\"\n{keys}material = {{ {material} }}\n")
}

fn sides(front: &str, back: &str) -> String {
    format!("front = \"{front}\"\nback = \"{back}\"\n")
}

/// A smooth interface.
pub fn dielectric(mesh: &str, front: &str, back: &str) -> String {
    surface(mesh, &sides(front, back), "kind = \"dielectric\"")
}

/// A boundary that bends nothing.
pub fn null(mesh: &str, front: &str, back: &str) -> String {
    surface(mesh, &sides(front, back), "kind = \"null\"")
}

/// A Lambertian surface.
pub fn diffuse(mesh: &str, reflectance: impl Display) -> String {
    surface(mesh, "", &format!("kind = \"diffuse\", reflectance = {reflectance}"))
}

/// A light on the front.
pub fn emitter(mesh: &str, radiance: impl Display) -> String {
    surface(mesh, "", &format!("kind = \"emitter\", radiance = {radiance}"))
}

/// A medium with these keys.
pub fn medium(name: &str, keys: &str) -> String {
    format!("[media.{name}]\n{keys}\n")
}

/// A cube of 1 m of "milk" with these keys in white surroundings, rendered with so many samples.
pub(super) fn milk_in_white(keys: &str, samples: u32) -> Result<Picture, StudyError> {
    let text = medium("milk", keys)
        + &dielectric("cube.ply", "air", "milk")
        + &camera([1.2, -3.5, 0.8], [0.0; 3], 16.0, [8, 8])
        + &render(samples, "")
        + WHITE_SKY;
    Scene::new().mesh("cube.ply", &cuboid(DVec3::splat(-0.5), DVec3::splat(0.5))).render(&text)
}

/// White surroundings.
pub const WHITE_SKY: &str = "[sky]\nradiance = 1\n";

/// A camera with this field of view in degrees, down the picture.
pub fn camera(eye: [f64; 3], target: [f64; 3], fov: f64, resolution: [u32; 2]) -> String {
    format!(
        "[camera]\neye = {eye:?}\ntarget = {target:?}\nvertical_fov = {fov}\nresolution = {resolution:?}\n"
    )
}

/// The same with y up, for views along z.
pub fn camera_along_z(eye: [f64; 3], target: [f64; 3], fov: f64, resolution: [u32; 2]) -> String {
    camera(eye, target, fov, resolution) + "up = [0, 1, 0]\n"
}

/// Samples a pixel, and further keys of the rendering.
pub fn render(samples: u32, keys: &str) -> String {
    format!("[render]\nsamples = {samples}\n{keys}")
}
