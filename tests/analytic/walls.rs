//! What an eye in a simulated box of water sees through each kind of wall.

use glam::DVec3;

use super::estimates::{assert_every_pixel, assert_mean};
use crate::common::files::sky_picture;
use crate::common::mesh::cuboid;
use crate::common::render::Prepared;
use crate::common::scene::SceneFolder;

/// Refractive index of the water.
const N: f64 = 1.33;
/// Reflectance of its surface at normal incidence.
const R: f64 = (0.33 / 2.33) * (0.33 / 2.33);

/// A box of water that fills x and y from -1 to 1 up to z = 0.3, with the eye in its middle.
fn water(walls: &str, sky: &str, picture: &[u8], target: [f64; 3]) -> Prepared {
    let mesh = cuboid(DVec3::splat(-1.0), DVec3::new(1.0, 1.0, 0.3));
    SceneFolder::new().mesh("box_0001.ply", &mesh).file("sky.exr", picture).scene(&format!(
        "[frames]\npath = \"box_####.ply\"\nnormals = \"smooth\"\n[regions]\n0 = \"air\"\n1 = \"water\"\n\
         [media.water]\nior = {N}\n[domain]\nbox = [[-1, -1, -1], [1, 1, 1]]\nwalls = {walls}\nreflectance = 0.4\n\
         [sky]\nradiance = {sky}\n\
         [camera]\neye = [0, 0, 0]\ntarget = {target:?}\nup = [0.3, 0.2, 0.7]\nvertical_fov = 0.1\nresolution = [4, 4]\n"
    ))
}

const IMAGE: &str = "{ image = \"sky.exr\" }";

/// Straight through a wall and back from the other, with the reflections between them:
/// n^2 (1 - R) (front + R back) / (1 - R^2).
#[test]
fn a_kept_wall_refracts() {
    let sky = sky_picture(|d| if d.x > 0.0 { DVec3::splat(3.0) } else { DVec3::ONE });
    let scene = water("{}", IMAGE, &sky, [1.0, 0.0, 0.0]);
    assert_mean("kept", &scene.render(4096, 0), DVec3::splat(N * N * (3.0 + R) / (1.0 + R)), 1e-2);
    // 37 degrees off the normal becomes 53: beyond the edge of the light at 45.
    let sky = sky_picture(|d| DVec3::splat(if d.z.abs() > d.x { 1.0 } else { 0.0 }));
    let picture = water("{}", IMAGE, &sky, [0.8, 0.0, 0.6]).render(64, 0);
    assert!(picture.mean().0.x > 0.9 * N * N, "not bent away from the normal: {}", picture.mean().0);
}

/// No bend and no reflection, but L / n^2 stays.
#[test]
fn an_open_wall_is_seen_straight_through() {
    let sky = sky_picture(|d| DVec3::splat(if d.z.abs() > d.x { 0.0 } else { 2.0 }));
    for target in [[1.0, 0.0, 0.0], [0.8, 0.0, -0.6], [0.8, -0.3, -0.5]] {
        let scene = water("{ sides = \"open\", bottom = \"open\" }", IMAGE, &sky, target);
        let name = format!("open towards {target:?}");
        assert_every_pixel(&name, &scene.render(16, 0), DVec3::splat(2.0 * N * N), 2e-6);
    }
}

/// Under an open top and between open sides the bottom receives pi n^2 L. What comes back up is not seen again.
#[test]
fn an_opaque_wall_reflects_its_irradiance() {
    let walls = "{ sides = \"open\", bottom = \"opaque\", top = \"open\" }";
    let mesh = cuboid(DVec3::splat(-1.0), DVec3::ONE);
    let folder = SceneFolder::new()
        .mesh("box_0001.ply", &mesh)
        .file("sky.exr", &sky_picture(|_| DVec3::new(1.0, 2.0, 3.0)));
    for sky in ["[1, 2, 3]", IMAGE] {
        let scene = folder.scene(&format!(
            "[frames]\npath = \"box_####.ply\"\n[regions]\n1 = \"water\"\n[media.water]\nior = {N}\n\
             [domain]\nbox = [[-1, -1, -1], [1, 1, 1]]\nwalls = {walls}\nreflectance = 0.4\n[sky]\nradiance = {sky}\n\
             [camera]\neye = [0, 0, 0]\ntarget = [0.1, 0.1, -1]\nvertical_fov = 20\nresolution = [4, 4]\n"
        ));
        let expected = 0.4 * N * N * DVec3::new(1.0, 2.0, 3.0);
        assert_mean(&format!("opaque under {sky}"), &scene.render(1024, 0), expected, 2e-2);
    }
    let furnace = water("{ sides = \"opaque\", bottom = \"opaque\" }", "1", b"", [0.0, 0.0, 1.0]);
    // Straight up: the sky through the surface, and a part of what the walls of reflectance 0.4 send up.
    let radiance = furnace.render(1024, 0).mean().0.x;
    assert!(radiance > (1.0 - R) * N * N && radiance < N * N, "{radiance}");
}

/// The sea goes on to the horizon: dark below and, since all is reflected there, outside of Snell's window; within it the
/// sky, bent, whether the surface is met inside the box or far outside.
#[test]
fn an_extended_sea_is_dark_below_and_shows_the_sky_in_snells_window() {
    let walls = "{ sides = \"extend\" }";
    // The critical angle is 48.75 degrees from the vertical.
    for (target, expected) in [
        ([1.0, 0.2, -1e-4], 0.0),
        ([0.3, -1.0, -2.0], 0.0),
        ([0.0, 0.0, -1.0], 0.0),
        ([1.0, 0.1, 0.01], 0.0),
        ([1.0, 0.0, 0.8], 0.0),
        ([0.0, 0.0, 1.0], N * N * (1.0 - R)),
    ] {
        for sky in ["1", IMAGE] {
            let scene = water(walls, sky, &sky_picture(|_| DVec3::ONE), target);
            let picture = scene.render(256, 0);
            assert_mean(
                &format!("extended towards {target:?}, {sky}"),
                &picture,
                DVec3::splat(expected),
                1e-3,
            );
        }
    }
    // A band of the sky 55 to 65 degrees from the vertical, seen at the refracted 41 degrees.
    let sky = sky_picture(|d| DVec3::splat(if (0.42..0.58).contains(&d.z) { 1.0 } else { 0.0 }));
    let sine = 60_f64.to_radians().sin() / N;
    let cos_i = (1.0 - sine * sine).sqrt();
    let (rs, rp) = ((N * cos_i - 0.5) / (N * cos_i + 0.5), (N * 0.5 - cos_i) / (N * 0.5 + cos_i));
    let expected = N * N * (1.0 - 0.5 * (rs * rs + rp * rp));
    let scene = water(walls, IMAGE, &sky, [sine, 0.0, cos_i]);
    assert_mean("extended, 60 degrees", &scene.render(256, 0), DVec3::splat(expected), 1e-3);
}

/// From outside the box, where only the extension is: still dark below, and lit through the far surface.
#[test]
fn the_extension_is_water_too() {
    let mesh = cuboid(DVec3::splat(-1.0), DVec3::new(1.0, 1.0, 0.3));
    let folder = SceneFolder::new().mesh("box_0001.ply", &mesh);
    for (eye, target, expected) in [
        ("[20, 5, -1]", "[20, 5, 1]", N * N * (1.0 - R)),
        ("[20, 5, -1]", "[20, 6, -1.001]", 0.0),
        ("[20, 5, 1]", "[20, 5, -1]", R),
        ("[0, 0, 1]", "[0, 0, -1]", R),
    ] {
        let scene = folder.scene(&format!(
            "[frames]\npath = \"box_####.ply\"\n[regions]\n1 = \"water\"\n[media.water]\nior = {N}\n\
             [domain]\nbox = [[-1, -1, -1], [1, 1, 1]]\nwalls = {{ sides = \"extend\" }}\n[sky]\nradiance = 1\n\
             [camera]\neye = {eye}\ntarget = {target}\nup = [1, 0.5, 0]\nvertical_fov = 0.1\nresolution = [4, 4]\n"
        ));
        assert_mean(&format!("eye {eye} to {target}"), &scene.render(256, 0), DVec3::splat(expected), 1e-3);
    }
}

/// A fluid whose label is given the outside's medium is not there, and neither is its darkness.
#[test]
fn an_extended_region_of_the_outside_is_the_sky() {
    let mesh = cuboid(DVec3::splat(-1.0), DVec3::new(1.0, 1.0, 0.3));
    let scene = SceneFolder::new().mesh("box_0001.ply", &mesh).scene(
        "[frames]\npath = \"box_####.ply\"\n[regions]\n0 = \"air\"\n1 = \"air\"\n\
         [domain]\nbox = [[-1, -1, -1], [1, 1, 1]]\nwalls = { sides = \"extend\" }\n[sky]\nradiance = 1\n\
         [camera]\neye = [0, 0, 2]\ntarget = [1, 0, 2]\nvertical_fov = 60\nresolution = [4, 4]\n",
    );
    assert_every_pixel("no sea", &scene.render(4, 0), DVec3::ONE, 0.0);
}
