//! Sunlight that is bent twice or mirrored, by photons beside beams: against photons alone, and against paths that run into
//! a sun large enough for chance to find.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::common::mesh::{TestMesh, cuboid, parallelogram, sphere};
use crate::common::render::Prepared;
use crate::common::scene::SceneFolder;
use crate::seeds::{Means, Seeds, assert_agree, with_radius};

const GRID: [u32; 2] = [4, 3];
const VIEW: &str =
    "[camera]\neye = [0.4, -2.6, 1.9]\ntarget = [0, 0, 0.25]\nvertical_fov = 38\nresolution = [32, 24]\n";
const SUN: &str = "[sun]\ndirection = [0.5, 0.1, 0.8]\nangular_diameter = 0.53\nirradiance = [3, 2.5, 2]\n";

fn floor() -> TestMesh {
    parallelogram(DVec3::new(-3.0, -3.0, 0.0), DVec3::X * 6.0, DVec3::Y * 6.0)
}

fn on_floor() -> SceneFolder {
    SceneFolder::new().mesh("floor.ply", &floor())
}

fn dielectric(mesh: &str, [front, back]: [&str; 2], normals: &str) -> String {
    format!(
        "[[surfaces]]\nmesh = \"{mesh}.ply\"\nfront = \"{front}\"\nback = \"{back}\"\nnormals = \"{normals}\"\n\
         material = {{ kind = \"dielectric\" }}\n"
    )
}

fn scene(folder: &SceneFolder, text: &str, render: &str) -> Prepared {
    folder.scene(&format!(
        "[[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = [0.7, 0.5, 0.3] }}\n\
         {VIEW}{text}[render]\n{render}"
    ))
}

/// A scene at radius 0: means of radii r, 2 r and 4 r.
fn at_no_radius(folder: &SceneFolder, text: &str, render: &str, radius: f32, samples: u32) -> Means {
    let [near, middle, wide] = [1.0, 2.0, 4.0].map(|factor| {
        Seeds::render(&with_radius(scene(folder, text, render), factor * radius), samples, 4, GRID)
    });
    Seeds::extrapolated(&near, &middle, &wide).means()
}

/// Both sides are blurred by photons, and told at radius 0.
fn assert_is_as_by_photons(
    name: &str,
    folder: &SceneFolder,
    text: &str,
    sun: &str,
    radius: f32,
    samples: [u32; 2],
) {
    let beams = "integrator = \"beams\"\nphotons = { count = 20000 }\n";
    let photons = "integrator = \"photon\"\nphotons = { count = 40000, final_gather = false }\n";
    let text = format!("{sun}{text}");
    let counters = with_radius(scene(folder, &text, beams), radius).render(1, 0).counters;
    assert_eq!(counters.photons, 20_000, "{name}");
    let by_beams = at_no_radius(folder, &text, beams, radius, samples[0]);
    let by_photons = at_no_radius(folder, &text, photons, radius, samples[1]);
    assert_agree(name, &by_beams, &by_photons, 0.05);
}

/// Every way to the floor is bent twice, or mirrored; in the milky ball there are beams beside them.
#[test]
fn balls_of_glass() {
    let folder = on_floor().mesh("ball.ply", &sphere(DVec3::new(0.0, 0.0, 0.7), 0.6, 2));
    for (name, glass, normals) in [
        ("clear", "ior = 1.5", "smooth"),
        ("milky", "ior = 1.4\nscattering = [0.5, 1, 2]\nabsorption = 0.1", "flat"),
    ] {
        let ball = format!("[media.glass]\n{glass}\n{}", dielectric("ball", ["air", "glass"], normals));
        assert_is_as_by_photons(name, &folder, &ball, SUN, 0.02, [24, 24]);
    }
}

/// A block in water, all with faces of their own: beams reach the water, and photons what is beyond the block and in it, where
/// most of the light is scattered several times.
#[test]
fn a_slab_of_glass_in_water() {
    let water = cuboid(DVec3::new(-0.9, -0.9, 0.05), DVec3::new(0.9, 0.9, 0.6));
    let slab = cuboid(DVec3::new(-0.5, -0.4, 0.2), DVec3::new(0.4, 0.3, 0.4));
    let inner = parallelogram(DVec3::new(-0.89, -0.89, 0.07), DVec3::X * 1.78, DVec3::Y * 1.78);
    let folder = on_floor().mesh("water.ply", &water).mesh("slab.ply", &slab).mesh("inner.ply", &inner);
    let text = format!(
        "[media.water]\nior = 1.33\nabsorption = [0.4, 0.2, 0.1]\nscattering = 0.2\n\
         phase = {{ kind = \"henyey-greenstein\", g = 0.5 }}\n[media.glass]\nior = 1.6\nscattering = 2\n\
         [[surfaces]]\nmesh = \"inner.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 0.5 }}\n{}{}",
        dielectric("water", ["air", "water"], "flat"),
        dielectric("slab", ["water", "glass"], "flat"),
    );
    assert_is_as_by_photons("slab", &folder, &text, SUN, 0.02, [24, 32]);
}

/// A mirror and a dark ball, whose interpolated normals lean far from those of its facets, throw light at a wall.
#[test]
fn light_that_is_mirrored_onto_a_wall() {
    let wall = parallelogram(DVec3::new(-1.2, 0.9, 0.0), DVec3::X * 2.4, DVec3::Z * 1.5);
    let mirror = parallelogram(DVec3::new(-0.9, -0.6, 0.3), DVec3::X * 0.6, DVec3::new(0.0, 0.6, -0.1));
    let folder = on_floor()
        .mesh("wall.ply", &wall)
        .mesh("mirror.ply", &mirror)
        .mesh("ball.ply", &sphere(DVec3::new(0.5, 0.2, 0.5), 0.4, 1));
    let text = format!(
        "[media.water]\nior = 1.33\nabsorption = 30\n{}\
         [[surfaces]]\nmesh = \"wall.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 0.8 }}\n\
         [[surfaces]]\nmesh = \"mirror.ply\"\nmaterial = {{ kind = \"conductor\", eta = 0.2, k = 3 }}\n",
        dielectric("ball", ["air", "water"], "smooth"),
    );
    let sun = SUN.replace("[0.5, 0.1, 0.8]", "[0.1, -0.6, 0.6]");
    assert_is_as_by_photons("mirrored", &folder, &text, &sun, 0.02, [24, 24]);
}

/// Water with thick ice in it under a sun 20 degrees wide, and under a lamp as wide and far away, which paths find by chance.
///
/// The lamp is a polygon of 256 sides, 1e4 m away: of the disc's area it has all but 1e-4, and over the scene its direction
/// varies by 1e-4.
#[test]
#[ignore = "half a minute"]
fn a_wide_sun_as_chance_finds_it() {
    const FAR: f64 = 1e4;
    const SIDES: u32 = 256;
    let to_sun = DVec3::new(0.5, 0.1, 0.8).normalize();
    let radius = FAR * 10.0_f64.to_radians().tan();
    let (side, other) = (to_sun.any_orthonormal_vector(), to_sun.cross(to_sun.any_orthonormal_vector()));
    let rim = (0..SIDES).map(|i| {
        let (sin, cos) = (TAU * f64::from(i) / f64::from(SIDES)).sin_cos();
        to_sun * FAR + (side * cos + other * sin) * radius
    });
    let lamp = TestMesh {
        positions: std::iter::once(to_sun * FAR).chain(rim).collect(),
        triangles: (0..SIDES).map(|i| [0, 1 + (i + 1) % SIDES, 1 + i]).collect(),
    };
    let water = cuboid(DVec3::new(-0.9, -0.9, 0.05), DVec3::new(0.9, 0.9, 0.6));
    let ice = sphere(DVec3::new(0.0, 0.0, 0.35), 0.2, 2);
    let inner = parallelogram(DVec3::new(-0.89, -0.89, 0.07), DVec3::X * 1.78, DVec3::Y * 1.78);
    let folder = on_floor()
        .mesh("water.ply", &water)
        .mesh("ice.ply", &ice)
        .mesh("inner.ply", &inner)
        .mesh("lamp.ply", &lamp);
    let text = format!(
        "[media.water]\nior = 1.33\nabsorption = [0.4, 0.2, 0.1]\nscattering = 0.3\n[media.ice]\nior = 1.5\nscattering = 30\n\
         [[surfaces]]\nmesh = \"inner.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 0.5 }}\n{}{}",
        dielectric("water", ["air", "water"], "flat"),
        dielectric("ice", ["water", "ice"], "smooth"),
    );
    let sine = 10.0_f64.to_radians().sin();
    let sun = "[sun]\ndirection = [0.5, 0.1, 0.8]\nangular_diameter = 20\nirradiance = 3\n";
    let lamp = format!(
        "[[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = {{ kind = \"emitter\", radiance = {} }}\n",
        3.0 / (PI * sine * sine)
    );
    let beams = "integrator = \"beams\"\nphotons = { count = 20000 }\n";
    let by_beams = at_no_radius(&folder, &format!("{text}{sun}"), beams, 0.005, 96);
    let by_chance = Seeds::render(&scene(&folder, &format!("{text}{lamp}"), ""), 2048, 4, GRID).means();
    assert_agree("wide sun", &by_beams, &by_chance, 0.05);
}
