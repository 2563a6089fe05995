//! Blurred pictures against moments put together, closed forms, and pictures in which nothing moves.

use floe::sampling::SampleSeed;
use glam::DVec3;

use crate::common::mesh::{Moving, TestMesh, cuboid, parallelogram, sphere};
use crate::common::numbers::SplitMix;
use crate::common::render::{Prepared, Rendered};
use crate::common::scene::SceneFolder;

const VIEW: &str =
    "[camera]\neye = [0.4, -4, 1.6]\ntarget = [0, 0, 0]\nvertical_fov = 32\nresolution = [24, 16]\n";
/// Frames a second.
const FPS: f64 = 24.0;
/// Edge of a block in pixels.
const BLOCK: u32 = 8;
/// Pictures whose spread tells the error of their mean.
const REPEATS: u64 = 16;

/// Goes to the right and up, is stretched and shorn: by up to half its size in a frame.
fn velocity(p: DVec3) -> DVec3 {
    FPS * (DVec3::new(0.5, 0.0, 0.2) + DVec3::new(0.3 * p.z, -0.2 * p.y, 0.25 * p.x))
}

/// A body of some medium over a floor, lit by a lamp.
fn text(normals: &str, medium: &str, shutter: f64) -> String {
    format!(
        "[frames]\npath = \"body_####.ply\"\nnormals = \"{normals}\"\n[regions]\n1 = \"body\"\n[media.body]\n{medium}\n\
         [[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = [0.7, 0.5, 0.3] }}\n\
         [[surfaces]]\nmesh = \"lamp.ply\"\nmaterial = {{ kind = \"emitter\", radiance = 3 }}\n\
         [sky]\nradiance = [0.3, 0.4, 0.5]\n{VIEW}shutter = {shutter}\n"
    )
}

fn folder() -> SceneFolder {
    SceneFolder::new()
        .mesh("floor.ply", &parallelogram(DVec3::new(-6.0, -6.0, -0.9), DVec3::X * 12.0, DVec3::Y * 12.0))
        .mesh("lamp.ply", &parallelogram(DVec3::new(-1.0, -1.0, 3.0), DVec3::Y * 2.0, DVec3::X * 2.0))
}

/// Block means of each picture.
fn block_means(picture: &Rendered) -> Vec<DVec3> {
    let [across, down] = [picture.image.width / BLOCK, picture.image.height / BLOCK];
    let corners = (0..across * down).map(|i| [i % across * BLOCK, i / across * BLOCK]);
    corners.map(|corner| picture.block_mean(corner, [BLOCK; 2]).0).collect()
}

/// Mean and squared standard error of each block over pictures.
fn statistics(pictures: &[Vec<DVec3>]) -> Vec<(DVec3, DVec3)> {
    let n = pictures.len() as f64;
    (0..pictures[0].len())
        .map(|block| {
            let mean = pictures.iter().map(|p| p[block]).sum::<DVec3>() / n;
            let squares = pictures.iter().map(|p| (p[block] - mean) * (p[block] - mean)).sum::<DVec3>();
            (mean, squares / (n * (n - 1.0)))
        })
        .collect()
}

/// The mean of moments, one in each of 64 parts of the time, at a place in it drawn with `random`.
fn moments(body: &TestMesh, scene: &str, shutter: f64, samples: u32, random: &mut SplitMix) -> Vec<DVec3> {
    const MOMENTS: u32 = 64;
    let mut sum = Vec::new();
    for k in 0..MOMENTS {
        let seconds = shutter * (f64::from(k) + random.f64()) / f64::from(MOMENTS) / FPS;
        let body = body.clone().moved(velocity, seconds);
        let picture = folder().mesh("body_0001.ply", &body).scene(scene).render(samples, random.next());
        for (i, mean) in block_means(&picture).into_iter().enumerate() {
            if k == 0 {
                sum.push(DVec3::ZERO);
            }
            sum[i] += mean / f64::from(MOMENTS);
        }
    }
    sum
}

/// Compares 16 blurred pictures with as many means of 64 moments.
///
/// With 16 pictures on either side a score beyond 5 has a chance of 2e-5 (Student's distribution with 30 degrees of
/// freedom), 4e-4 for 6 blocks of 3 channels; seeds are fixed.
fn assert_is_the_mean_of_its_moments(normals: &str, medium: &str, render: &str, samples: u32) {
    let body = sphere(DVec3::new(-0.3, 0.0, 0.0), 0.7, 3);
    let shutter = 0.6;
    let [open, closed] = [shutter, 0.0].map(|shutter| text(normals, medium, shutter) + render);
    let scene = folder().file("body_0001.ply", body.moving_ply(velocity).as_bytes()).scene(&open);
    let blurred: Vec<_> = (0..REPEATS).map(|seed| block_means(&scene.render(64, seed))).collect();
    let mut random = SplitMix(7);
    let by_hand: Vec<_> =
        (0..REPEATS).map(|_| moments(&body, &closed, shutter, samples, &mut random)).collect();
    let (blurred, by_hand) = (statistics(&blurred), statistics(&by_hand));
    let still = folder().mesh("body_0001.ply", &body).scene(&closed).render(64, 0);
    let (mut worst, mut moved) = (0.0_f64, 0.0_f64);
    for (((a, a2), (b, b2)), still) in blurred.iter().zip(&by_hand).zip(block_means(&still)) {
        let error = DVec3::from_array((*a2 + *b2).to_array().map(f64::sqrt)).max(DVec3::splat(1e-9));
        worst = worst.max(((*a - *b) / error).abs().max_element());
        moved = moved.max(((*a - still) / error).abs().max_element());
    }
    println!("{normals}, {medium:?}{render}: worst score {worst:.2}, {moved:.0} from the still picture");
    assert!(worst < 5.0, "{normals}, {medium:?}{render}: {worst}");
    assert!(moved > 20.0, "the motion shows too little: {moved}");
}

#[test]
fn a_blurred_picture_is_the_mean_of_its_moments() {
    let clear = "ior = 1.33\nabsorption = [0.9, 0.3, 0.2]";
    let turbid = "ior = 1.1\nabsorption = 0.2\nscattering = [20, 10, 5]";
    for (normals, medium) in [("flat", clear), ("smooth", clear), ("flat", turbid)] {
        assert_is_the_mean_of_its_moments(normals, medium, "", 4);
    }
}

/// The photons of a pass meet the surface where the eye paths of the pass do; radii are the same in both pictures.
#[test]
fn a_blurred_picture_of_photons_is_the_mean_of_its_moments() {
    let render = "[render]\nintegrator = \"photon\"\n\
                  photons = { count = 3000, radius = 0.15, volume_radius = 0.2, shrink = 1.0 }\n";
    let turbid = "ior = 1.2\nabsorption = 0.2\nscattering = [3, 2, 1]";
    assert_is_the_mean_of_its_moments("flat", turbid, render, 1);
}

/// A square that moves across the picture covers each column for a part of the time that is known exactly. Estimates of
/// independent samples would have a standard error of sqrt(p (1 - p) / n); 5 of them and the rounding of the edges.
#[test]
fn a_moving_square_covers_each_column_for_its_part_of_the_time() {
    // The camera sees 16 x 4 m with a metre a pixel, from so far that perspective plays no part within 1e-4 of a pixel.
    let distance = 1e4;
    let fov = 2.0 * (2.0_f64 / distance).atan().to_degrees();
    let square = parallelogram(DVec3::new(-5.3, -9.0, 0.0), DVec3::X * 3.1, DVec3::Y * 18.0);
    let shutter = 0.75;
    let way = 6.4 / shutter;
    let moving = square.moving_ply(|_| DVec3::X * (way * FPS));
    let scene = SceneFolder::new().file("square_0001.ply", moving.as_bytes()).scene(&format!(
        "[[surfaces]]\nmesh = \"square_####.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 0 }}\n\
         [sky]\nradiance = 1\n[camera]\neye = [0, 0, {distance}]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\n\
         vertical_fov = {fov}\nresolution = [16, 4]\nshutter = {shutter}\n"
    ));
    let samples = 1024;
    let picture = scene.render(samples, 0);
    // Left of the leading edge, at first and at last: what lies before it on average over a time in which it goes on.
    let behind = |start: f64, x: f64| {
        let steps = 20_000;
        let at = |k: u32| start + 6.4 * (f64::from(k) + 0.5) / f64::from(steps);
        (0..steps).map(|k| (at(k) - x).clamp(0.0, 1.0)).sum::<f64>() / f64::from(steps)
    };
    for column in 0..16 {
        let x = f64::from(column) - 8.0;
        let expected = behind(-2.2, x) - behind(-5.3, x);
        let error = (expected * (1.0 - expected) / f64::from(samples)).max(0.0).sqrt();
        for row in 0..4 {
            let alpha = f64::from(picture.image.pixels[(row * 16 + column) as usize].alpha);
            assert!((alpha - expected).abs() < 5.0 * error + 2e-4, "column {column}: {alpha} and {expected}");
        }
    }
}

fn pixels(scene: &Prepared) -> Vec<[u32; 3]> {
    let image = scene.render(16, 3).image;
    image.pixels.iter().map(|pixel| pixel.rgb.to_array().map(f32::to_bits)).collect()
}

/// Without a motion every bit is that of the still picture: where all velocities are zero, and where only one vertex that
/// no ray meets has one, so that everything goes through the tree of what moves.
#[test]
fn what_stands_still_is_the_same_picture_to_the_last_bit() {
    let mut body = sphere(DVec3::new(-0.3, 0.0, 0.0), 0.7, 3);
    let corner = body.positions.len() as u32;
    body.positions.extend([
        DVec3::new(0.0, 90.0, 1e3),
        DVec3::new(1.0, 90.0, 1e3),
        DVec3::new(0.0, 91.0, 1e3),
    ]);
    body.triangles.push([corner, corner + 1, corner + 2]);
    for medium in ["ior = 1.33\nabsorption = 0.5", "ior = 1.1\nscattering = [20, 10, 5]"] {
        let still = pixels(&folder().mesh("body_0001.ply", &body).scene(&text("smooth", medium, 0.0)));
        let open = |velocity: fn(DVec3) -> DVec3| {
            let folder = folder().file("body_0001.ply", body.moving_ply(velocity).as_bytes());
            folder.scene(&text("smooth", medium, 0.5))
        };
        let zero = open(|_| DVec3::ZERO);
        assert!(!zero.frame.accel.is_in_motion() && zero.frame.geometry.motions.is_empty());
        assert_eq!(pixels(&zero), still);
        let afar = open(|p| if p.z > 500.0 { DVec3::Z } else { DVec3::ZERO });
        assert!(afar.frame.accel.is_in_motion());
        assert_eq!(pixels(&afar), still);
    }
}

/// Nothing is lost or gained in what moves, however it does: wherever the eye looks, white surroundings are white.
#[test]
fn a_white_furnace_with_moving_bodies_is_white() {
    let body = sphere(DVec3::ZERO, 0.8, 4);
    for (name, medium, tolerance) in
        [("scattering", "ior = 1\nscattering = [0.5, 4, 40]", 2e-5), ("glass", "ior = 1.5", 2e-6)]
    {
        let folder = SceneFolder::new().file("body_0001.ply", body.moving_ply(velocity).as_bytes());
        let scene = folder.scene(&format!(
            "[frames]\npath = \"body_####.ply\"\nnormals = \"flat\"\n[regions]\n1 = \"body\"\n[media.body]\n{medium}\n\
             [sky]\nradiance = 1\n{VIEW}shutter = 1\n[render]\nmax_depth = 4000\n"
        ));
        let picture = scene.render(256, 0);
        let (worst, at) = picture.worst_deviation(DVec3::ONE);
        let (mean, se) = picture.mean();
        println!("{name}: mean {mean:.6} +- {se:.6}, worst {worst:.1e} at {at:?}, {:?}", picture.counters);
        assert!(((mean - DVec3::ONE).abs()).cmple(5.0 * se + tolerance).all(), "{name}: {mean}");
        assert_eq!(picture.counters.escaped_inside, 0);
    }
}

/// A wave of labelled water that moves: rays never find themselves in another medium than the surface says.
#[test]
fn moving_surfaces_are_watertight() {
    let body = cuboid(DVec3::new(-1.0, -1.0, -0.6), DVec3::new(1.0, 1.0, 0.4));
    let folder = folder().file("body_0001.ply", body.moving_ply(velocity).as_bytes());
    let scene = folder.scene(&text("flat", "ior = 1.33\nscattering = 3", 1.0));
    let seed = SampleSeed { seed: 5, ..scene.sampling.seed };
    let sampling = floe::driver::tiles::Sampling { samples: 128, seed, ..scene.sampling.clone() };
    let (_, counters) = floe::driver::tiles::render_pixels(&scene.frame, &sampling, &|_, _| ());
    println!("{counters:?}");
    assert!(counters.rays > 300_000);
    assert_eq!((counters.label_mismatches, counters.escaped_inside), (0, 0));
}
