//! Twenty small scenes of all kinds, and three full of fireflies.

use glam::DVec3;

use crate::common::files::{npy, sky_picture};
use crate::common::mesh::{Moving, TestMesh, cuboid, parallelogram, sphere};
use crate::common::render::Prepared;
use crate::common::scene::SceneFolder;

/// A scene: its name, and what it adds to the floor, the camera and the air.
pub struct Scene {
    pub name: &'static str,
    text: String,
}

impl Scene {
    /// Ready for rays; so many times 24 pixels wide and 16 high.
    pub fn prepare(&self, times: u32) -> Prepared {
        folder().scene(&self.text.replace(AT, &format!("resolution = [{}, {}]\n", 24 * times, 16 * times)))
    }
}

const AT: &str = "resolution = [24, 16]\n";
const VIEW: &str = "[camera]\neye = [0.5, -3.4, 1.7]\ntarget = [0, 0, 0.3]\nvertical_fov = 32\n";
const FLOOR: &str = "[[surfaces]]\nmesh = \"floor.ply\"\n\
                     material = { kind = \"diffuse\", reflectance = [0.7, 0.5, 0.3] }\n";
const LAMP: &str =
    "[[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = { kind = \"emitter\", radiance = [4, 5, 6] }\n";
const SKY: &str = "[sky]\nradiance = [0.5, 0.6, 0.8]\n";
const PICTURE: &str = "[sky]\nradiance = { image = \"sky.exr\" }\n";
const SUN: &str = "[sun]\ndirection = [0.4, -0.3, 0.8]\nangular_diameter = 20\nirradiance = [3, 2.8, 2.5]\n";
const PHOTON: &str = "[render]\nintegrator = \"photon\"\nphotons = { count = 2000 }\n";

fn body(mesh: &str, medium: &str) -> String {
    format!(
        "[media.body]\n{medium}\n[[surfaces]]\nmesh = \"{mesh}.ply\"\nnormals = \"smooth\"\nfront = \"air\"\n\
         back = \"body\"\nmaterial = {{ kind = \"dielectric\" }}\n"
    )
}

fn folder() -> SceneFolder {
    let v = DVec3::new;
    let floor = parallelogram(v(-4.0, -4.0, -0.4), DVec3::X * 8.0, DVec3::Y * 8.0);
    let lamp = parallelogram(v(-0.6, -0.6, 2.6), DVec3::Y * 1.2, DVec3::X * 1.2);
    let spark = parallelogram(v(-0.05, 0.3, 2.6), DVec3::Y * 0.06, DVec3::X * 0.06);
    let mirror = parallelogram(v(-1.3, 1.0, -0.3), v(2.4, 0.3, 0.0), v(0.0, 0.2, 1.4));
    let ball = sphere(v(0.0, 0.0, 0.3), 0.6, 3);
    SceneFolder::new()
        .mesh("floor.ply", &floor)
        .mesh("lamp.ply", &lamp)
        .mesh("spark.ply", &spark)
        .mesh("mirror.ply", &mirror)
        .mesh("ball.ply", &ball)
        .mesh("ball_0001.ply", &ball)
        .mesh("inner.ply", &sphere(v(0.25, -0.1, 0.4), 0.5, 3))
        .mesh("cube.ply", &cuboid(v(-0.5, -0.6, -0.3), v(0.6, 0.4, 0.7)))
        .mesh("waves.ply", &waves())
        .file("moving_0001.ply", ball.moving_ply(|p| v(9.0, 2.0, 6.0) + 4.0 * v(p.z, 0.0, -p.x)).as_bytes())
        .file(
            "sky.exr",
            &sky_picture(|d| {
                v(0.4, 0.6, 1.0) * (1.0 + 0.8 * d.z)
                    + 6.0 * v(1.0, 0.9, 0.7) * (d.x * 0.6 + d.z * 0.8).max(0.0).powi(24)
            }),
        )
        .file(
            "sharp.exr",
            &sky_picture(|d| {
                let is_sun = d.dot(v(0.3, -0.4, 0.85).normalize()) > 0.995;
                if is_sun { DVec3::splat(2000.0) } else { v(0.3, 0.4, 0.5) }
            }),
        )
        .file("plume.npy", &npy([7, 9, 5], |i| (i * 37 % 101) as f32 / 50.0))
}

/// A block of water whose top is a wave.
fn waves() -> TestMesh {
    let mut mesh = sphere(DVec3::ZERO, 1.0, 4);
    for p in &mut mesh.positions {
        let d = *p / p.abs().max_element();
        let wave = 0.08 * (6.0 * d.x + 1.0).sin() * (5.0 * d.y).cos();
        *p = DVec3::new(1.6 * d.x, 1.6 * d.y, 0.3 * d.z + if d.z > 0.0 { wave * d.z } else { 0.0 });
    }
    mesh
}

const CLEAR: &str = "ior = 1.33\nabsorption = [0.9, 0.3, 0.2]";
const TURBID: &str = "ior = 1.33\nabsorption = [0.6, 0.2, 0.1]\nscattering = [1, 2, 3]\n\
                      phase = { kind = \"henyey-greenstein\", g = 0.8 }";
const ICE: &str = "ior = 1.31\nabsorption = [0.7, 0.15, 0.03]\nscattering = 60";
const MILK: &str = "ior = 1.2\nabsorption = 0.2\nscattering = [5, 4, 3]";
const SPECTRAL: &str = "ior = 1.33\nabsorption = { wavelength = [400, 550, 700], value = [0.1, 0.3, 3] }\n\
                        scattering = { wavelength = [400, 700], value = [4, 1] }";

/// The scenes.
pub fn scenes() -> Vec<Scene> {
    let all = |text: String| format!("{text}{VIEW}{AT}");
    let path = |parts: &[&str]| format!("{FLOOR}{}", parts.concat());
    let by_photons = |parts: &[&str]| format!("{FLOOR}{}{PHOTON}", parts.concat());
    let walls =
        "[[surfaces]]\nmesh = \"mirror.ply\"\nmaterial = { kind = \"conductor\", eta = 0.2, k = 3 }\n";
    let outer = "[media.glass]\nior = 1.5\nabsorption = [0.2, 0.4, 0.1]\n[media.water]\nior = 1.33\n\
                 absorption = [0.9, 0.3, 0.1]\nscattering = [0.5, 1, 2]\n\
                 [[meshes]]\npath = \"ball.ply\"\ninside = \"glass\"\npriority = 1\n\
                 [[meshes]]\npath = \"inner.ply\"\ninside = \"water\"\n";
    let moving = |medium: &str| {
        format!("[frames]\npath = \"moving_####.ply\"\n[regions]\n1 = \"body\"\n[media.body]\n{medium}\n")
    };
    let sea = "[frames]\npath = \"ball_####.ply\"\n[regions]\n1 = \"body\"\n[media.body]\nior = 1.34\n\
               absorption = [1.1, 0.3, 0.2]\nscattering = 3\n\
               density = { stratified = 2.0, surface = 0.9 }\n";
    let plume = "ior = 1.0\nabsorption = 0.3\nscattering = [3, 4, 5]\n\
                 density = { grid = \"plume.npy\", box = [[-0.7, -0.7, -0.4], [0.7, 0.7, 1.0]] }";
    let lava = "ior = 1.4\nabsorption = 8\nscattering = 20\nemission = [3, 1, 0.2]";
    let list = [
        ("clear ball, lamp", all(path(&[&body("ball", CLEAR), LAMP]))),
        ("clear waves, sky", all(path(&[&body("waves", CLEAR), SKY]))),
        ("turbid cube, lamp and sky", all(path(&[&body("cube", TURBID), LAMP, SKY]))),
        ("turbid waves, sky picture", all(path(&[&body("waves", TURBID), PICTURE]))),
        ("thick ice, sky picture", all(path(&[&body("ball", ICE), PICTURE]))),
        ("milk in the dark, lamp", all([&body("cube", MILK), LAMP].concat())),
        ("sun on a mirror and a floor", all(path(&[walls, SUN, SKY]))),
        ("sky picture on a floor", all(path(&[PICTURE]))),
        ("layers, lamp and sky", all(path(&[outer, LAMP, SKY]))),
        ("four wavelengths, sky", all(path(&[&body("cube", SPECTRAL), SKY]))),
        ("moving ball, lamp", format!("{}shutter = 0.6\n{AT}", path(&[&moving(CLEAR), LAMP, SKY]) + VIEW)),
        (
            "lens, milk, lamp",
            format!("{}aperture = 0.3\nfocus_distance = 3\n{AT}", path(&[&body("cube", MILK), LAMP]) + VIEW),
        ),
        ("plume of a grid, lamp", all(path(&[&body("cube", plume), LAMP]))),
        ("stratified sea ball, sun", all(path(&[sea, &SUN.replace("= 20", "= 6"), SKY]))),
        ("glowing lava", all(path(&[&body("ball", lava)]))),
        (
            "both branches, clear ball, lamp",
            all(path(&[&body("ball", CLEAR), LAMP])) + "[render]\nsplit = 2\n",
        ),
        ("photons: ball, sun", all(by_photons(&[&body("ball", CLEAR), SUN, SKY]))),
        ("photons: turbid waves, sun", all(by_photons(&[&body("waves", TURBID), SUN, SKY]))),
        ("photons: four wavelengths, lamp", all(by_photons(&[&body("cube", SPECTRAL), LAMP]))),
        (
            "photons: moving ball, sun",
            format!("{}shutter = 0.6\n{AT}", by_photons(&[&moving(MILK), SUN, SKY]) + VIEW),
        ),
    ];
    list.into_iter().map(|(name, text)| Scene { name, text }).collect()
}

/// Scenes whose light is rarely found.
pub fn firefly_scenes() -> Vec<Scene> {
    let all = |text: String| format!("{text}{VIEW}{AT}");
    let spark = "[[surfaces]]\nmesh = \"spark.ply\"\nmaterial = { kind = \"emitter\", radiance = 1500 }\n";
    let sharp = "[sky]\nradiance = { image = \"sharp.exr\" }\n";
    let list = [
        ("spark through a ball, dark", all(format!("{FLOOR}{}{spark}", body("ball", CLEAR)))),
        ("spark through waves, sky", all(format!("{FLOOR}{}{spark}{SKY}", body("waves", CLEAR)))),
        ("sun of a sky picture through waves", all(format!("{FLOOR}{}{sharp}", body("waves", TURBID)))),
    ];
    list.into_iter().map(|(name, text)| Scene { name, text }).collect()
}
