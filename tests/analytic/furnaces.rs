//! White furnaces: where nothing absorbs, everything looks like the surroundings.

use glam::DVec3;

use super::estimates::{assert_every_pixel, assert_mean};
use crate::common::mesh::{TestMesh, cuboid, parallelogram, sphere};
use crate::common::scene::SceneFolder;

const CAMERA: &str = "[camera]\neye = [1.2, -3.5, 0.8]\ntarget = [0, 0, 0]\nvertical_fov = 40\n\
                      resolution = [12, 12]\n[sky]\nradiance = 1\n";

#[test]
fn white_diffuse_surfaces_vanish_in_white_surroundings() {
    let fin = parallelogram(DVec3::new(-1.0, -1.0, -0.5), DVec3::X * 2.0, DVec3::Z);
    let folder = SceneFolder::new().mesh("ball.ply", &sphere(DVec3::ZERO, 0.8, 2)).mesh("fin.ply", &fin);
    for normals in ["flat", "smooth"] {
        let scene = folder.scene(&format!(
            "[[surfaces]]\nmesh = \"ball.ply\"\nnormals = \"{normals}\"\n\
             material = {{ kind = \"diffuse\", reflectance = 1 }}\n\
             [[surfaces]]\nmesh = \"fin.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 1 }}\n{CAMERA}"
        ));
        let picture = scene.render(64, 0);
        assert_every_pixel(&format!("white diffuse, {normals}"), &picture, DVec3::ONE, 2e-6);
    }
}

/// No event about a shading normal loses anything, but a path may be caught: inside, where normals turn against their
/// planes, total reflection can follow itself for ever. The coarser the mesh the more: 3 in 1000 of the paths on 128
/// triangles, whose normals are up to 15 degrees off, and next to none on 8192.
///
/// The limit of depth ends paths that total reflection about shading normals keeps inside, before the late roulette gives
/// those that come out a weight: so no pixel may be brighter than one.
#[test]
fn a_smooth_glass_sphere_vanishes_in_white_surroundings() {
    for (levels, least) in [(2, 0.99), (5, 0.9995)] {
        let folder = SceneFolder::new().mesh("ball.ply", &sphere(DVec3::ZERO, 1.0, levels));
        for (ior, split) in [(1.5, 1), (1.5, 3), (0.8, 0)] {
            let scene = folder.scene(&format!(
                "[media.glass]\nior = {ior}\n[[surfaces]]\nmesh = \"ball.ply\"\nnormals = \"smooth\"\n\
                 front = \"air\"\nback = \"glass\"\nmaterial = {{ kind = \"dielectric\" }}\n\
                 [render]\nsplit = {split}\nmax_depth = 1000\n{CAMERA}"
            ));
            let picture = scene.render(64, 0);
            let (mean, _) = picture.mean();
            println!("smooth glass {ior}, {levels} levels, split {split}: {mean:.6}");
            assert!(mean.x > least && mean.x < 1.0 + 1e-6, "ior {ior}, {levels} levels: {mean}");
            let brightest = picture.image.pixels.iter().map(|p| p.rgb.x).fold(0.0, f32::max);
            assert!(brightest < 1.0 + 2e-6, "ior {ior}, {levels} levels: a pixel of {brightest}");
        }
    }
}

/// In a dense medium most flights are not traced, since they end within a ball that holds no surface. A flight that left
/// the fluid unseen would show: it would meet the next surface from the wrong side, or none.
#[test]
fn walks_through_a_dense_medium_trace_little_and_lose_nothing() {
    let folder = SceneFolder::new().mesh("ball.ply", &sphere(DVec3::ZERO, 0.8, 4));
    let scene = folder.scene(&format!(
        "[media.snow]\nior = 1\nscattering = 40\n[[surfaces]]\nmesh = \"ball.ply\"\nnormals = \"flat\"\n\
         front = \"air\"\nback = \"snow\"\nmaterial = {{ kind = \"dielectric\" }}\n{CAMERA}"
    ));
    let picture = scene.render(64, 0);
    let counters = picture.counters;
    assert!(counters.untraced > counters.rays, "{counters:?}");
    assert_eq!((counters.label_mismatches, counters.escaped_inside), (0, 0));
    assert_mean("dense", &picture, DVec3::ONE, 1e-3);
}

/// Light that turns next to the surface that it came in through, nearer than the rounding of coordinates: 1 flight of 10,000 ends
/// there. On the plane or beyond it a path turned outwards would walk on without a medium around it, unseen until it came
/// back through a surface from the wrong side, or was far from all there is. Of the 8 million flights 3 still end as near to a
/// surface that they did not come through, and 224 did before those were moved inwards that had come through it.
#[test]
fn what_turns_next_to_a_surface_turns_within() {
    let folder = SceneFolder::new().mesh("cube.ply", &cuboid(DVec3::splat(-0.7), DVec3::splat(0.7)));
    for (ior, kind) in [(1.33, "dielectric"), (1.0, "null")] {
        let scene = folder.scene(&format!(
            "[media.snow]\nior = {ior}\nscattering = 10000\n[[surfaces]]\nmesh = \"cube.ply\"\nnormals = \"flat\"\n\
             front = \"air\"\nback = \"snow\"\nmaterial = {{ kind = \"{kind}\" }}\n[camera]\neye = [1.2, -3.5, 0.8]\n\
             target = [0.1, 0.2, 0]\nvertical_fov = 8\nresolution = [32, 32]\n[sky]\nradiance = 1\n\
             [render]\nsplit = 0\nmax_depth = 64\n"
        ));
        let counters = scene.render(256, 0).counters;
        let astray = counters.label_mismatches + counters.escaped_inside;
        println!("{kind}: {astray} astray of {} flights", counters.rays + counters.untraced);
        assert!(astray <= 12, "{kind}: {counters:?}");
    }
}

/// Each of some hundred scatterings multiplies the throughput by a weight of relative error 2^-24 or so, of either sign:
/// 1e-5 leaves an order of magnitude.
#[test]
fn a_medium_that_absorbs_nothing_vanishes_in_white_surroundings() {
    let slab = cuboid(DVec3::new(-1.0, -0.2, -1.0), DVec3::new(1.0, 0.2, 1.0));
    let folder = SceneFolder::new().mesh("slab.ply", &slab);
    for ior in [0.75, 1.0, 1.000_001, 1.33, 2.4] {
        for (scattering, g) in [(0, 0.0), (20, 0.0), (20, 0.5), (20, -0.9), (20, 0.9999)] {
            let scene = folder.scene(&format!(
                "[media.milk]\nior = {ior}\nscattering = {scattering}\n\
                 phase = {{ kind = \"henyey-greenstein\", g = {g} }}\n\
                 [[surfaces]]\nmesh = \"slab.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"milk\"\n\
                 material = {{ kind = \"dielectric\" }}\n{CAMERA}"
            ));
            let picture = scene.render(32, 0);
            let (rays, events) = (picture.counters.rays, picture.counters.label_mismatches);
            println!("{events} label mismatches in {rays} rays");
            assert_every_pixel(
                &format!("albedo 1, ior {ior}, {scattering}/m, g {g}"),
                &picture,
                DVec3::ONE,
                1e-5,
            );
        }
    }
}

/// Where samples are drawn through a table, their weights differ from 1 and still average to it.
#[test]
fn every_phase_function_is_white_on_average() {
    let slab = cuboid(DVec3::new(-1.0, -0.2, -1.0), DVec3::new(1.0, 0.2, 1.0));
    let folder = SceneFolder::new().mesh("slab.ply", &slab);
    for phase in [
        "kind = \"rayleigh\"",
        "kind = \"murky\"",
        "kind = \"two-term-henyey-greenstein\", share = 0.9, g1 = 0.9, g2 = -0.9",
        "kind = \"cornette-shanks\", g = -0.9",
        "kind = \"diffuse-spheres\"",
        "kind = \"specular-spheres\", ior = 0.75",
        "kind = \"gaussian\", gamma = 1e6",
        "kind = \"fournier-forand\", backscatter = 0.0183",
        "kind = \"tabulated\", angle = [0, 0.1, 10, 90, 180], value = [1e6, 1e4, 3, 0, 2]",
    ] {
        let scene = folder.scene(&format!(
            "[media.milk]\nior = 1.33\nscattering = 20\nphase = {{ {phase} }}\n\
             [[surfaces]]\nmesh = \"slab.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"milk\"\n\
             material = {{ kind = \"dielectric\" }}\n{CAMERA}"
        ));
        assert_mean(phase, &scene.render(256, 0), DVec3::ONE, 2e-3);
    }
}

/// Each lobe with a parameter of asymmetry, close to its ends. Those with an inverted distribution have weights of exactly 1.
#[test]
fn the_narrowest_lobes_are_white_on_average() {
    let slab = cuboid(DVec3::new(-1.0, -0.2, -1.0), DVec3::new(1.0, 0.2, 1.0));
    let folder = SceneFolder::new().mesh("slab.ply", &slab);
    for phase in [
        "kind = \"henyey-greenstein\", g = -0.9999",
        "kind = \"two-term-henyey-greenstein\", share = 0.5, g1 = 0.9999, g2 = -0.9999",
        "kind = \"cornette-shanks\", g = 0.9999",
        "kind = \"cornette-shanks\", g = -0.9999",
        "kind = \"draine\", g = 0.9999, alpha = 3",
        "kind = \"draine\", g = -0.9999, alpha = 3",
        "kind = \"schlick\", k = 0.9999",
        "kind = \"schlick\", k = -0.9999",
        "kind = \"two-term-schlick\", share = 0.5, k1 = 0.9999, k2 = -0.9999",
    ] {
        for ior in [1.0, 1.33] {
            let scene = folder.scene(&format!(
                "[media.milk]\nior = {ior}\nscattering = 20\nphase = {{ {phase} }}\n\
                 [[surfaces]]\nmesh = \"slab.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"milk\"\n\
                 material = {{ kind = \"dielectric\" }}\n{CAMERA}"
            ));
            assert_mean(&format!("{phase}, ior {ior}"), &scene.render(64, 0), DVec3::ONE, 2e-3);
        }
    }
}

/// Lanes that scatter differently are drawn from one of them; the weights of a white furnace still average to 1.
#[test]
fn a_coloured_medium_that_absorbs_nothing_is_white_on_average() {
    let folder = SceneFolder::new().mesh("cube.ply", &cuboid(DVec3::splat(-0.7), DVec3::splat(0.7)));
    let scene = folder.scene(&format!(
        "[media.milk]\nior = 1.33\nscattering = [0.5, 2, 4]\nphase = {{ kind = \"henyey-greenstein\", g = 0.5 }}\n\
         [[surfaces]]\nmesh = \"cube.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"milk\"\n\
         material = {{ kind = \"dielectric\" }}\n{CAMERA}"
    ));
    assert_mean("coloured albedo 1", &scene.render(4096, 0), DVec3::ONE, 2e-3);
}

/// The integrating sphere: a share f of the wall emits `radiance` and is black, the rest reflects r. Each point of a
/// sphere sees equal areas equally, so
///
/// ```text
/// L = r f radiance / (1 - r (1 - f))
/// ```
///
/// and without more than k interactions the terms r^j (1 - f)^(j - 1) of its series with j <= k. The ball of 2048
/// triangles has chords that are off by 2e-3 in the mean, which allows as much.
#[test]
fn an_integrating_sphere_has_the_radiance_of_its_geometric_series() {
    let ball = sphere(DVec3::ZERO, 1.0, 4).turned();
    let height = |t: &[u32; 3]| t.iter().map(|&v| ball.positions[v as usize].z).sum::<f64>() / 3.0;
    let part = |bright: bool| TestMesh {
        positions: ball.positions.clone(),
        triangles: ball.triangles.iter().copied().filter(|t| (height(t) > 0.6) == bright).collect(),
    };
    let area = |mesh: &TestMesh| -> f64 {
        let corners = |t: &[u32; 3]| t.map(|v| mesh.positions[v as usize]);
        mesh.triangles.iter().map(corners).map(|[a, b, c]| (b - a).cross(c - a).length() / 2.0).sum()
    };
    let (wall, lamp) = (part(false), part(true));
    let share = area(&lamp) / (area(&lamp) + area(&wall));
    let folder = SceneFolder::new().mesh("wall.ply", &wall).mesh("lamp.ply", &lamp);
    let reflectance = DVec3::new(0.9, 0.5, 0.2);
    for depth in [0, 1, 2, 3] {
        let scene = folder.scene(&format!(
            "[[surfaces]]\nmesh = \"wall.ply\"\nnormals = \"flat\"\n\
             material = {{ kind = \"diffuse\", reflectance = [0.9, 0.5, 0.2] }}\n\
             [[surfaces]]\nmesh = \"lamp.ply\"\nnormals = \"flat\"\nmaterial = {{ kind = \"emitter\", radiance = 2 }}\n\
             [camera]\neye = [0, 0.5, 0.3]\ntarget = [0, -0.5, -0.7]\nvertical_fov = 30\nresolution = [8, 8]\n\
             [render]\nmax_depth = {depth}\n"
        ));
        let ratio = reflectance * (1.0 - share);
        let series = match depth {
            0 => 1.0 / (1.0 - ratio),
            _ => (1.0 - ratio.powf(f64::from(depth))) / (1.0 - ratio),
        };
        let expected = 2.0 * share * reflectance * series;
        let (mean, se) = scene.render(1024, 0).mean();
        println!("integrating sphere, depth {depth}: {mean:.5} +- {se:.5}, expected {expected:.5}");
        let allowed = 5.0 * se + 2e-3 * expected;
        assert!((mean - expected).abs().cmple(allowed).all(), "depth {depth}: {mean} is not {expected}");
    }
}
