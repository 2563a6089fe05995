//! Pictures of the sky.

use std::f64::consts::PI;

use glam::DVec3;

use super::estimates::{assert_every_pixel, assert_mean};
use crate::common::files::sky_picture;
use crate::common::mesh::{cuboid, parallelogram};
use crate::common::render::Prepared;
use crate::common::scene::SceneFolder;

fn directions(d: DVec3) -> DVec3 {
    // Linear in the direction: every component tells its axis and sign.
    DVec3::new(1.0 + 0.5 * d.x, 1.0 + 0.5 * d.y, 1.0 + 0.5 * d.z)
}

/// The top row is up, +x the middle, +y a quarter of the width to the right of it. The picture's texels are 5.6 degrees
/// wide, so interpolation between them is off by (5.6 degrees)^2 / 8 of the second derivative 0.5: 6e-4.
#[test]
fn the_picture_lies_around_the_scene_as_documented() {
    let folder = SceneFolder::new().file("sky.exr", &sky_picture(directions));
    for d in [
        DVec3::X,
        DVec3::NEG_X,
        DVec3::Y,
        DVec3::NEG_Y,
        DVec3::new(0.3, 0.1, 0.9),
        DVec3::new(0.5, -0.5, -0.7),
    ] {
        let target = (10.0 * d).to_array();
        let scene = folder.scene(&format!(
            "[sky]\nradiance = {{ image = \"sky.exr\" }}\n\
             [camera]\neye = [0, 0, 0]\ntarget = {target:?}\nvertical_fov = 0.01\nresolution = [2, 2]\n"
        ));
        assert_every_pixel(&format!("towards {d}"), &scene.render(4, 0), directions(d.normalize()), 2e-3);
    }
}

/// With another axis up, the picture turns with it and is not mirrored: what was (x, y, z) is now (y, z, x) for x up and
/// (z, x, y) for y up.
#[test]
fn the_picture_turns_with_the_axis_that_is_up() {
    let mesh = cuboid(DVec3::splat(50.0), DVec3::splat(51.0));
    let folder = SceneFolder::new().file("sky.exr", &sky_picture(directions)).mesh("box_0001.ply", &mesh);
    for (up, turned) in
        [("x", DVec3::new(3.0, 1.0, 2.0)), ("y", DVec3::new(2.0, 3.0, 1.0)), ("z", DVec3::new(1.0, 2.0, 3.0))]
    {
        // `turned` is where the picture's direction (1, 2, 3) lies in the scene.
        let target = turned.to_array();
        let scene = folder.scene(&format!(
            "[frames]\npath = \"box_####.ply\"\nup = \"{up}\"\n[regions]\n1 = \"air\"\n\
             [sky]\nradiance = {{ image = \"sky.exr\" }}\n\
             [camera]\neye = [0, 0, 0]\ntarget = {target:?}\nvertical_fov = 0.01\nresolution = [2, 2]\n"
        ));
        let expected = directions(DVec3::new(1.0, 2.0, 3.0).normalize());
        assert_every_pixel(&format!("{up} up"), &scene.render(4, 0), expected, 2e-3);
    }
}

/// Dim, with a sun of one texel's width.
fn uneven(d: DVec3) -> DVec3 {
    let sun = DVec3::new(0.6, 0.5, 0.6).normalize();
    let glow = if d.dot(sun) > 0.995 { 300.0 } else { 0.0 };
    DVec3::new(0.2 + glow, 0.3 + glow * 0.5 + 0.2 * d.x, 0.5 + 0.3 * d.z)
}

/// Irradiance of a floor that faces up, from the interpolated picture as it is documented, by quadrature in f64.
fn quadrature(radiance: impl Fn(DVec3) -> DVec3) -> DVec3 {
    let (width, height) = (64_i32, 32_i32);
    let texel = |column: i32, row: i32| {
        let (column, row) = (column.rem_euclid(width), row.clamp(0, height - 1));
        let phi = (2.0 * (f64::from(column) + 0.5) / f64::from(width) - 1.0) * PI;
        let theta = (f64::from(row) + 0.5) / f64::from(height) * PI;
        radiance(DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()))
    };
    // The midpoint rule over 16 x 16 points a texel.
    let (columns, rows) = (width * 16, height * 16);
    let mut sum = DVec3::ZERO;
    for j in 0..rows / 2 {
        let theta = (f64::from(j) + 0.5) / f64::from(rows) * PI;
        let y = (f64::from(j) + 0.5) / 16.0 - 0.5;
        for i in 0..columns {
            let x = (f64::from(i) + 0.5) / 16.0 - 0.5;
            let (left, top) = (x.floor(), y.floor());
            let mix = |row: i32| texel(left as i32, row).lerp(texel(left as i32 + 1, row), x - left);
            let value = mix(top as i32).lerp(mix(top as i32 + 1), y - top);
            sum += value * theta.sin() * theta.cos();
        }
    }
    sum * (2.0 * PI / f64::from(columns)) * (PI / f64::from(rows))
}

fn floor_under(radiance: impl Fn(DVec3) -> DVec3 + Sync) -> Prepared {
    let floor = parallelogram(DVec3::new(-9.0, -9.0, 0.0), DVec3::X * 18.0, DVec3::Y * 18.0);
    SceneFolder::new().file("sky.exr", &sky_picture(radiance)).mesh("floor.ply", &floor).scene(
        "[[surfaces]]\nmesh = \"floor.ply\"\nmaterial = { kind = \"diffuse\", reflectance = 0.5 }\n\
         [sky]\nradiance = { image = \"sky.exr\" }\n\
         [camera]\neye = [0, -1, 2]\ntarget = [0, 0, 0]\nvertical_fov = 20\nresolution = [8, 8]\n",
    )
}

#[test]
fn a_floor_reflects_the_irradiance_of_the_picture() {
    let mut scene = floor_under(uneven);
    let expected = 0.5 * quadrature(uneven) / PI;
    let with = scene.render(1024, 0);
    assert_mean("uneven sky", &with, expected, 5e-3 * expected.x);
    scene.frame.needs.direct_light = false;
    let without = scene.render(4096, 0);
    assert_mean("uneven sky by chance", &without, expected, 5e-2 * expected.x);
    let ratio = (with.mean().1 / without.mean().1).x * 0.5;
    println!("noise with over without, at as many samples: {ratio:.3}");
    // Measured: 0.26.
    assert!(ratio < 0.33, "importance sampling does not pay: {ratio}");
}

#[test]
fn a_white_picture_is_a_white_furnace() {
    let scene = floor_under(|_| DVec3::ONE);
    assert_mean("white picture", &scene.render(1024, 0), DVec3::splat(0.5), 1e-3);
}
