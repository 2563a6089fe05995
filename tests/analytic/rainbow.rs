//! Where wavelengths go, against ray optics in f64: Snell's window, a prism and the rainbow.
//!
//! Pictures are compared row by row, or ring by ring, with the quadrature over pixels and wavelengths.

use std::f64::consts::PI;
use std::io::Cursor;

use exr::prelude::*;
use floe::optics::RefractiveIndex;
use floe::spectrum::cie;
use glam::DVec3;

use crate::common::mesh::{TestMesh, parallelogram, sphere};
use crate::common::render::{Prepared, Rendered};
use crate::common::scene::SceneFolder;

const WATER: RefractiveIndex = RefractiveIndex::Water { temperature: 20.0, salinity: 0.0 };
const WATER_TEXT: &str = "ior = { table = \"water\", temperature = 20, salinity = 0 }\nabsorption = 0\n";

/// Reflectance of unpolarised light at an angle of incidence (Fresnel); 1 where all is reflected.
fn reflectance(sin_i: f64, eta_t_over_i: f64) -> f64 {
    let sin_t = sin_i / eta_t_over_i;
    if sin_t >= 1.0 {
        return 1.0;
    }
    let (cos_i, cos_t) = ((1.0 - sin_i * sin_i).sqrt(), (1.0 - sin_t * sin_t).sqrt());
    let s = (cos_i - eta_t_over_i * cos_t) / (cos_i + eta_t_over_i * cos_t);
    let p = (eta_t_over_i * cos_i - cos_t) / (eta_t_over_i * cos_i + cos_t);
    0.5 * (s * s + p * p)
}

/// Linear RGB of white light times a function of the wavelength that is asked for at every 2 nm.
fn of_white(value: impl Fn(f64) -> f64) -> DVec3 {
    let known: Vec<f64> = (0..=200).map(|i| value(380.0 + 2.0 * f64::from(i))).collect();
    cie::rgb(|lambda| {
        let (at, step) = (0.5 * (lambda - 380.0), (0.5 * (lambda - 380.0)) as usize);
        let (below, above) = (known[step.min(200)], known[(step + 1).min(200)]);
        cie::d65(lambda) * (below + (above - below) * (at - step as f64))
    })
}

/// Standard scores of numbers from a picture against expected ones, each allowed an own deviation beside the noise: the
/// greatest must stay below 5, which 100 normal numbers exceed with a chance of 6e-5.
fn assert_scores(
    name: &str,
    found: &[(DVec3, DVec3)],
    expected: &[DVec3],
    deviation: impl Fn(usize) -> DVec3,
) {
    let (mut worst, mut squares) = (0.0_f64, 0.0);
    for (i, ((mean, se), expected)) in found.iter().zip(expected).enumerate() {
        let allowed = deviation(i);
        let z = ((*mean - *expected).abs() - allowed).max(DVec3::ZERO) / (*se + 1e-9);
        println!("{name} {i}: {mean:.5} +- {se:.5}, expected {expected:.5}, z {z:.2}");
        worst = worst.max(z.abs().max_element());
        squares += z.length_squared() / 3.0;
    }
    let rms = (squares / found.len() as f64).sqrt();
    println!("{name}: rms z {rms:.2}, worst {worst:.2}");
    assert!(worst < 5.0 && rms < 1.5, "{name}: rms z {rms:.2}, worst {worst:.2}");
}

fn rows(picture: &Rendered, height: u32) -> Vec<(DVec3, DVec3)> {
    (0..picture.image.height / height)
        .map(|row| picture.block_mean([0, row * height], [picture.image.width, height]))
        .collect()
}

/// The mean over a block of rows of a function of the slope, the tangent of the angle from the axis; the camera is level
/// with it, so narrow that columns are alike.
fn over_row(row: usize, rows: usize, half: f64, value: impl Fn(f64) -> f64) -> f64 {
    const POINTS: usize = 256;
    let at = |k: usize| {
        let y = (row as f64 + (k as f64 + 0.5) / POINTS as f64) / rows as f64;
        value(half * (1.0 - 2.0 * y))
    };
    (0..POINTS).map(at).sum::<f64>() / POINTS as f64
}

/// An eye under water sees the sky within asin(1 / n), which is 48.0 degrees at 400 nm and 48.7 at 700, as n^2 T(theta).
/// Eight blocks of rows over 1.6 degrees; columns change the zenith angle by 1e-4 degrees at most. What is reflected is
/// black.
#[test]
fn snells_window_ends_at_the_critical_angle_of_each_wavelength() {
    let (angle, half, count) = (48.4_f64.to_radians(), 0.8_f64.to_radians().tan(), 8);
    let surface = parallelogram(DVec3::new(-50.0, -50.0, 0.0), DVec3::X * 100.0, DVec3::Y * 100.0);
    let target = DVec3::new(angle.sin(), 0.0, angle.cos() - 1.0).to_array();
    let floor = parallelogram(DVec3::new(-50.0, -50.0, -2.0), DVec3::X * 100.0, DVec3::Y * 100.0);
    let scene = SceneFolder::new().mesh("surface.ply", &surface).mesh("floor.ply", &floor).scene(&format!(
        "[media.water]\n{WATER_TEXT}\
         [[surfaces]]\nmesh = \"surface.ply\"\nfront = \"air\"\nback = \"water\"\nmaterial = {{ kind = \"dielectric\" }}\n\
         [[surfaces]]\nmesh = \"floor.ply\"\nmaterial = {{ kind = \"diffuse\", reflectance = 0 }}\n\
         [sky]\nradiance = 1\n\
         [camera]\neye = [0, 0, -1]\ntarget = {target:?}\nup = [0, 0, 1]\nvertical_fov = 1.6\nresolution = [8, 64]\n\
         [render]\nmax_depth = 1\ndispersion = true\n"
    ));
    let expected: Vec<DVec3> = (0..count)
        .map(|row| {
            of_white(|lambda| {
                let n = WATER.n(lambda);
                over_row(row, count, half, |slope| {
                    let theta = angle - slope.atan();
                    n * n * (1.0 - reflectance(theta.sin(), 1.0 / n))
                })
            })
        })
        .collect();
    let picture = scene.render(256, 0);
    assert_scores("window", &rows(&picture, 8), &expected, |_| DVec3::splat(2e-4));
}

/// Of glass with an apex angle of 60 degrees, its edge along y through (0, 0, 1).
fn prism() -> TestMesh {
    let w = 1.0 / 3.0_f64.sqrt();
    let corners = [(-w, 0.0), (w, 0.0), (0.0, 1.0)];
    let positions = [-5.0, 5.0].iter().flat_map(|y| corners.map(|(x, z)| DVec3::new(x, *y, z))).collect();
    let (left, right) = ([[0, 2, 3], [2, 5, 3]], [[1, 4, 2], [4, 5, 2]]);
    let (base, ends) = ([[0, 3, 1], [3, 4, 1]], [[0, 1, 2], [3, 5, 4]]);
    TestMesh { positions, triangles: [left, right, base, ends].concat() }
}

/// A direction beyond a face of this normal, on the side that it comes from (Snell).
fn refracted(direction: DVec3, normal: DVec3, eta_t_over_i: f64) -> DVec3 {
    let cos_i = -direction.dot(normal);
    let cos_t = (1.0 - (1.0 - cos_i * cos_i) / (eta_t_over_i * eta_t_over_i)).sqrt();
    (direction + cos_i * normal) / eta_t_over_i - cos_t * normal
}

/// What is seen through the prism of a white wall behind it that ends at a height: T_1 T_2, or nothing above.
fn through_prism(eye: DVec3, direction: DVec3, n: f64, (wall, height): (f64, f64)) -> f64 {
    let half = (3.0_f64.sqrt() / 2.0, 0.5);
    let (left, right) = (DVec3::new(-half.0, 0.0, half.1), DVec3::new(half.0, 0.0, half.1));
    let apex = DVec3::Z;
    let to_face = |from: DVec3, along: DVec3, normal: DVec3| (apex - from).dot(normal) / along.dot(normal);
    let passes = |along: DVec3, normal: DVec3, eta: f64| {
        let cos = along.dot(normal).abs();
        1.0 - reflectance((1.0 - cos * cos).sqrt(), eta)
    };
    let entry = eye + direction * to_face(eye, direction, left);
    let inside = refracted(direction, left, n);
    let exit = entry + inside * to_face(entry, inside, right);
    let beyond = refracted(inside, -right, 1.0 / n);
    let z = exit.z + beyond.z * (wall - exit.x) / beyond.x;
    let passed = passes(direction, left, n) * passes(inside, right, 1.0 / n);
    if z < height { passed } else { 0.0 }
}

/// A prism of index 1.55 to 1.45 from 380 to 780 nm before a white wall that ends at a height: over each row of the
/// picture the spectrum is cut at another wavelength. The columns are a quarter of a degree off the plane of the drawing at
/// most, which deviates by half the square of that more: 1e-5 of the spectrum's 0.15.
#[test]
fn a_prism_deviates_each_wavelength_by_its_index() {
    let n = |lambda: f64| 1.55 - 0.1 * (lambda - 380.0) / 400.0;
    let (wall, rise, count) = (5.0, (1.5_f64 / 2.0).asin() - PI / 6.0, 8);
    let face = DVec3::new(-0.5 / 3.0_f64.sqrt(), 0.0, 0.5);
    let axis = DVec3::new(rise.cos(), 0.0, rise.sin());
    let eye = face - 10.0 * axis;
    // Where the middle of the spectrum falls.
    let height = 0.5 - (wall - 0.5 / 3.0_f64.sqrt()) * rise.tan();
    let screen = parallelogram(DVec3::new(wall, -20.0, -30.0), DVec3::Y * 40.0, DVec3::Z * (30.0 + height));
    let (at, target) = (eye.to_array(), face.to_array());
    let scene = SceneFolder::new().mesh("prism.ply", &prism()).mesh("screen.ply", &screen.turned()).scene(&format!(
        "[media.glass]\nior = {{ wavelength = [380, 780], n = [1.55, 1.45] }}\n\
         [[surfaces]]\nmesh = \"prism.ply\"\nnormals = \"flat\"\nfront = \"air\"\nback = \"glass\"\n\
         material = {{ kind = \"dielectric\" }}\n\
         [[surfaces]]\nmesh = \"screen.ply\"\nmaterial = {{ kind = \"emitter\", radiance = 1 }}\n\
         [camera]\neye = {at:?}\ntarget = {target:?}\nup = [0, 0, 1]\nvertical_fov = 4\nresolution = [8, 64]\n\
         [render]\nmax_depth = 2\nsplit = 2\ndispersion = true\n"
    ));
    let half = 2.0_f64.to_radians().tan();
    let upward = DVec3::Y.cross(axis) * -1.0;
    let expected: Vec<DVec3> = (0..count)
        .map(|row| {
            of_white(|lambda| {
                over_row(row, count, half, |slope| {
                    through_prism(eye, (axis + slope * upward).normalize(), n(lambda), (wall, height))
                })
            })
        })
        .collect();
    assert_scores("prism", &rows(&scene.render(256, 0), 8), &expected, |_| DVec3::splat(1e-3));
}

/// Rows of the sky's picture: a ring of one row falls to nothing over a quarter of a degree on either side.
const SKY_ROWS: usize = 720;
const RING: f64 = PI / SKY_ROWS as f64;
/// From the centre of the drop, whose radius is 1, to the eye above it.
const DISTANCE: f64 = 500.0;
/// Half the edge of the picture at the drop.
const HALF: f64 = 1.02;
/// Reflections within the drop, and what else, that paths may have.
const DEPTH: usize = 6;

/// Light from a ring at an angle from the zenith.
fn ring(row: usize) -> Vec<u8> {
    let texel = |p: Vec2<usize>| if p.y() == row { (1.0_f32, 1.0_f32, 1.0_f32) } else { (0.0, 0.0, 0.0) };
    let image = Image::from_channels((8, SKY_ROWS), SpecificChannels::rgb(texel));
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).unwrap_or_else(|e| panic!("no picture: {e}"));
    bytes.into_inner()
}

/// The drop, seen from above, under a ring.
fn sky_ring(drop: &[u8], row: usize) -> Prepared {
    let fov = 2.0 * (HALF / DISTANCE).atan().to_degrees();
    let folder = SceneFolder::new().file("drop.ply", drop).file("sky.exr", &ring(row));
    folder.scene(&format!(
        "[media.water]\n{WATER_TEXT}\
         [[surfaces]]\nmesh = \"drop.ply\"\nfront = \"air\"\nback = \"water\"\nmaterial = {{ kind = \"dielectric\" }}\n\
         [sky]\nradiance = {{ image = \"sky.exr\" }}\n\
         [camera]\neye = [0, 0, {DISTANCE}]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nvertical_fov = {fov}\nresolution = [24, 24]\n\
         [render]\nmax_depth = {DEPTH}\nsplit = 4\ndispersion = true\n"
    ))
}

/// What the drop sends to the eye of light from a ring at `angle` from the eye's zenith, over all of the picture: sum over
/// the reflections within of T^2 R^(p - 1) for rays of each impact parameter b = sin i, n sin r = sin i, which leave turned
/// by 2 (i - r) + (p - 1) (pi - 2 r).
fn drop(angle: f64, n: f64, impacts: usize) -> f64 {
    let ring = |direction: f64| (1.0 - ((-direction.cos()).acos() - angle).abs() / RING).max(0.0);
    let seen = |slope: f64| {
        let tilt = slope.atan();
        let b = DISTANCE * tilt.sin();
        if b >= 1.0 {
            return 0.0;
        }
        let (i, r, share) = (b.asin(), (b / n).asin(), reflectance(b, n));
        let within = |p: usize| {
            let turned = 2.0 * (i - r) + (p - 1) as f64 * (PI - 2.0 * r);
            (1.0 - share) * (1.0 - share) * share.powi(p as i32 - 1) * ring(tilt - turned)
        };
        share * ring(tilt + PI - 2.0 * i) + (1..DEPTH).map(within).sum::<f64>()
    };
    let step = HALF / DISTANCE / impacts as f64;
    let sum: f64 = (0..impacts)
        .map(|k| (k as f64 + 0.5) * step)
        .map(|slope| 2.0 * PI * slope * step * seen(slope))
        .sum();
    // The corners of the picture are beyond the drop.
    sum / (2.0 * HALF / DISTANCE).powi(2)
}

/// The angle of a bow of k reflections from the point opposite to the sun: sin i = sqrt(((k + 1)^2 - n^2) / (k (k + 2))) is
/// turned least (Descartes).
fn bow(n: f64, reflections: i32) -> f64 {
    let k = f64::from(reflections);
    let sine = (((k + 1.0).powi(2) - n * n) / (k * (k + 2.0))).sqrt();
    let (i, r) = (sine.asin(), (sine / n).asin());
    let turned = 2.0 * (i - r) + k * (PI - 2.0 * r);
    (-turned.cos()).acos().to_degrees()
}

/// A drop seen from above under a sky that is dark but for a ring: by ring the picture's mean is what the rainbow has
/// there, red and blue as wavelengths have it.
///
/// The mesh of a sphere of radius 1 has corners on it and edges of h = pi / 2 / 2^7; within a triangle it lies up to
/// h^2 / 6 = 2.5e-5 too deep, and the interpolated normal is that of the place. A ray that meets three such places leaves
/// by up to twice as much each beside, 1.5e-4 radians, 0.035 of a ring's width: of the difference to the neighbouring
/// rings as much is allowed.
#[test]
fn the_rainbow_stands_at_42_and_51_degrees() {
    // Descartes' angles at the ends of what is seen: red is outside of the first bow and inside of the second.
    let (red, violet) = (WATER.n(700.0), WATER.n(400.0));
    for (n, reflections, degrees) in
        [(1.331, 1, 42.37), (1.343, 1, 40.65), (1.331, 2, 50.37), (1.343, 2, 53.47)]
    {
        assert!((bow(n, reflections) - degrees).abs() < 0.01, "{n} {reflections}: {}", bow(n, reflections));
    }
    println!(
        "n {red:.4} to {violet:.4}: bows {:.2} to {:.2}, {:.2} to {:.2}",
        bow(red, 1),
        bow(violet, 1),
        bow(red, 2),
        bow(violet, 2)
    );
    let angles =
        [40.625, 41.125, 41.625, 42.125, 42.375, 44.125, 47.125, 50.125, 50.625, 51.625, 52.625, 53.125];
    let drop_mesh = sphere(DVec3::ZERO, 1.0, 7).ply().into_bytes();
    let expected_at = |angle: f64| of_white(|lambda| drop(angle.to_radians(), WATER.n(lambda), 4000));
    let (mut found, mut expected, mut slopes) = (Vec::new(), Vec::new(), Vec::new());
    for degrees in angles {
        let row = (degrees * 4.0) as usize;
        let scene = sky_ring(&drop_mesh, row);
        found.push(scene.render(64, row as u64).mean());
        expected.push(expected_at(degrees));
        slopes.push((expected_at(degrees + 0.25) - expected_at(degrees - 0.25)).abs() * 0.5);
    }
    assert_scores("rainbow", &found, &expected, |i| 0.035 * slopes[i]);
    let at = |degrees: f64| found[angles.iter().position(|a| *a == degrees).unwrap_or(0)].0;
    // Red outside of the first bow and inside of the second, blue on the other sides, dark in between (Alexander).
    assert!(at(42.375).x > 2.0 * at(42.375).z.abs() && at(50.625).x > 2.0 * at(50.625).z.abs());
    assert!(at(40.625).z > at(40.625).x && at(53.125).z > at(53.125).x);
    let dark = at(47.125).element_sum().max(at(44.125).element_sum());
    assert!(at(41.625).element_sum() > 5.0 * dark && at(51.625).element_sum() > 2.0 * dark);
}

/// Draws the sky over a lawn, the sun 12 degrees high behind the eye, as a wall of such drops sends it: each pixel as the ring
/// of its angle from the point opposite to the sun, over the ring's solid angle.
#[test]
#[ignore = "writes rainbow.png into the folder that FLOE_PICTURES names"]
fn the_rainbow_as_a_picture() {
    const FIRST: usize = 80;
    const RINGS: usize = 144;
    let Some(folder) = std::env::var_os("FLOE_PICTURES") else { return };
    let drop_mesh = sphere(DVec3::ZERO, 1.0, 7).ply().into_bytes();
    let rings: Vec<DVec3> = (FIRST..FIRST + RINGS)
        .map(|row| {
            sky_ring(&drop_mesh, row).render(64, row as u64).mean().0 / ((row as f64 + 0.5) * RING).sin()
        })
        .collect();
    let at = |degrees: f64| {
        let place = (4.0 * degrees - 0.5 - FIRST as f64).clamp(0.0, RINGS as f64 - 1.001);
        rings[place as usize].lerp(rings[place as usize + 1], place.fract())
    };
    // Within the bow, where nothing stands out, noise is smoothed over 4 degrees.
    let even = |degrees: f64| (-16..=16).map(|k| at(degrees + 0.125 * f64::from(k))).sum::<DVec3>() / 33.0;
    let seen = |degrees: f64| at(degrees).lerp(even(degrees), ((38.5 - degrees) * 0.5).clamp(0.0, 1.0));
    let brightest = rings.iter().map(|c| c.max_element()).fold(0.0, f64::max);
    let opposite = DVec3::new(1.0, 0.0, -(12.0_f64.to_radians().tan())).normalize();
    let picture = image::RgbImage::from_fn(640, 280, |x, y| {
        // A cylinder: 120 degrees wide, from the horizon up.
        let (phi, theta) = ((f64::from(x) - 319.5) * 0.1875, (270.0 - f64::from(y)) * 0.1875);
        let (phi, theta) = (phi.to_radians(), theta.to_radians());
        let direction = DVec3::new(theta.cos() * phi.cos(), theta.cos() * phi.sin(), theta.sin());
        let bow = seen(direction.angle_between(opposite).to_degrees()) * (0.6 / brightest);
        let sky = DVec3::new(0.07, 0.09, 0.12);
        let colour = if theta < 0.0 { DVec3::new(0.03, 0.05, 0.02) } else { sky + bow };
        let code = |v: f64| if v < 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
        image::Rgb(colour.to_array().map(|v| (255.0 * code(v.clamp(0.0, 1.0))).round() as u8))
    });
    let file = std::path::Path::new(&folder).join("rainbow.png");
    picture.save(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
}
