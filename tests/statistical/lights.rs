//! Directions drawn towards pictures of the sky, clear skies and emitting triangles.

use std::f64::consts::PI;
use std::io::Cursor;

use exr::prelude::*;
use floe::light::area::EmitterTriangle;
use floe::light::{AreaLights, ClearAir, ClearSky, Environment, LightSample, Picture};
use floe::sampling::warp;
use floe::spectrum::{LaneMode, Role, Spectrum, Wavelengths};
use glam::Vec3;

use super::tests_of_fit::{assert_fits, cell_of};
use crate::common::numbers::SplitMix;

const WIDTH: usize = 12;
const HEIGHT: usize = 6;

fn wavelengths() -> Wavelengths {
    Wavelengths::for_mode(LaneMode::Rgb, 0.5)
}

/// Uneven, with black texels and one that is 500 times as bright as the others.
fn sky(up: Vec3) -> Environment {
    let texels = (0..WIDTH * HEIGHT)
        .map(|i| match i % 7 {
            0 | 1 => Vec3::ZERO,
            2 => Vec3::new(0.5, 0.2, 1.0),
            _ => Vec3::splat(if i == 20 { 500.0 } else { 0.1 * (i % 5) as f32 }),
        })
        .collect();
    Environment::image(Picture { width: WIDTH, height: HEIGHT, texels }, up, LaneMode::Rgb)
}

/// Cells in cos(theta) and azimuth around z; their probabilities by the midpoint rule over `pdf_w`.
const ROWS: usize = 24;
const COLUMNS: usize = 24;

fn direction(cos: f64, turn: f64) -> Vec3 {
    let (sin, phi) = ((1.0 - cos * cos).max(0.0).sqrt(), 2.0 * PI * turn);
    Vec3::new((sin * phi.cos()) as f32, (sin * phi.sin()) as f32, cos as f32).normalize()
}

fn cell(d: Vec3) -> usize {
    let turn = (f64::from(d.y).atan2(f64::from(d.x)) / (2.0 * PI)).rem_euclid(1.0);
    cell_of(0.5 + 0.5 * f64::from(d.z), ROWS) * COLUMNS + cell_of(turn, COLUMNS)
}

fn probabilities(pdf_w: impl Fn(Vec3) -> f64) -> Vec<f64> {
    // Odd and unlike the picture's own divisions, so that the errors at the texels' edges cancel.
    let fine = 61;
    let weight = 4.0 * PI / (ROWS * COLUMNS * fine * fine) as f64;
    let mut cells = vec![0.0; ROWS * COLUMNS];
    for (i, probability) in cells.iter_mut().enumerate() {
        for j in 0..fine * fine {
            let row = (i / COLUMNS) as f64 + ((j / fine) as f64 + 0.5) / fine as f64;
            let column = (i % COLUMNS) as f64 + ((j % fine) as f64 + 0.5) / fine as f64;
            *probability += pdf_w(direction(2.0 * row / ROWS as f64 - 1.0, column / COLUMNS as f64)) * weight;
        }
    }
    cells
}

/// Scales probabilities whose sum is 1 to the accuracy of the quadrature.
fn normalised(name: &str, cells: Vec<f64>, tolerance: f64) -> Vec<f64> {
    let total: f64 = cells.iter().sum();
    println!("{name}: pdf_w integrates to {total:.6}");
    assert!((total - 1.0).abs() < tolerance, "{name}: pdf_w integrates to {total}");
    cells.into_iter().map(|p| p / total).collect()
}

#[test]
fn directions_towards_a_picture_follow_its_density() {
    for (seed, up) in (200..).zip([Vec3::Z, Vec3::Y, Vec3::NEG_X]) {
        let sky = sky(up);
        let name = format!("sky, {up} up");
        // The density is constant over a texel apart from the sine, so cells whose edges lie across texels are what the
        // quadrature misses.
        let cells = normalised(&name, probabilities(|d| f64::from(sky.pdf_w(d))), 3e-3);
        if up == Vec3::Z {
            // Rows of the cells do not coincide with rows of texels; the bright one decides. Coarse cells do not see it.
            let coarse = coarse(&cells);
            assert_fits(&name, seed, &coarse, |u| {
                let wi = sky.sample(u, &wavelengths()).map_or(Vec3::Z, |s| s.wi);
                cell(wi) / COLUMNS / 8 * 4 + cell(wi) % COLUMNS / 6
            });
        }
    }
}

/// 3 x 4 cells of 8 x 6.
fn coarse(cells: &[f64]) -> Vec<f64> {
    let mut joined = vec![0.0; 12];
    for (i, p) in cells.iter().enumerate() {
        joined[i / COLUMNS / 8 * 4 + i % COLUMNS / 6] += p;
    }
    joined
}

/// In the picture's own cells the probabilities are exact: the texels'.
#[test]
fn texels_are_drawn_by_their_share_of_the_density() {
    let sky = sky(Vec3::Z);
    let edges = |row: usize| (PI * row as f64 / HEIGHT as f64).cos();
    let cells: Vec<f64> = (0..WIDTH * HEIGHT)
        .map(|i| {
            let (row, column) = (i / WIDTH, i % WIDTH);
            // pdf_w sin(theta) is constant over a texel.
            let theta = PI * (row as f64 + 0.5) / HEIGHT as f64;
            let turn = (column as f64 + 0.5) / WIDTH as f64 - 0.5;
            let constant = f64::from(sky.pdf_w(direction(theta.cos(), turn))) * theta.sin();
            constant * (PI / HEIGHT as f64) * (2.0 * PI / WIDTH as f64)
        })
        .collect();
    let cells = normalised("texels", cells, 1e-5);
    assert_fits("texels", 210, &cells, |u| {
        let wi = sky.sample(u, &wavelengths()).map_or(Vec3::Z, |s| s.wi);
        let row = (0..HEIGHT).rfind(|&row| f64::from(wi.z) <= edges(row)).unwrap_or(0);
        let turn = (f64::from(wi.y).atan2(f64::from(wi.x)) / (2.0 * PI) + 0.5).rem_euclid(1.0);
        row * WIDTH + cell_of(turn, WIDTH)
    });
}

/// `sample` and `pdf_w` agree but for directions at the very edge of a texel, and radiance over density is bounded: the
/// interpolated picture is nowhere more than 8 times its own mean over a texel, nor twice at the poles' sine.
#[test]
fn a_picture_states_the_density_of_its_samples() {
    for up in [Vec3::Z, Vec3::NEG_Y] {
        let sky = sky(up);
        let mut random = SplitMix(5);
        let mut off = 0;
        for _ in 0..20_000 {
            let Some(sample) = sky.sample(random.pair(), &wavelengths()) else { continue };
            let stated = sky.pdf_w(sample.wi);
            off += u32::from((stated / sample.pdf_w - 1.0).abs() > 1e-3);
            assert!(sample.pdf_w > 0.0 && sample.radiance.is_finite());
            assert_eq!(sample.radiance, sky.radiance(sample.wi, &wavelengths()));
        }
        assert!(off < 20, "{off} of 20000 samples state another density than pdf_w");
    }
}

fn clear_sky(degrees: f32, up: Vec3) -> ClearSky {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let ahead = Vec3::new(up.y, up.z, up.x);
    let air = ClearAir { turbidity: 2.5, ground_albedo: 0.3 };
    ClearSky::new(air, ahead * cos + up * sin, &Spectrum::Constant(1.0), up, LaneMode::Spectral)
}

/// Cells of the sky's own are 1.4 degrees: the quadrature of `probabilities` is finer.
#[test]
fn directions_towards_a_clear_sky_follow_its_density() {
    for (seed, (degrees, up)) in (230..).zip([(50.0, Vec3::Z), (4.0, Vec3::Y), (90.0, Vec3::NEG_X)]) {
        let sky = Environment::Clear(Box::new(clear_sky(degrees, up)));
        let name = format!("clear sky, sun at {degrees}, {up} up");
        let cells = normalised(&name, probabilities(|d| f64::from(sky.pdf_w(d))), 3e-3);
        assert_fits(&name, seed, &coarse(&cells), |u| {
            let wi = sky.sample(u, &wavelengths()).map_or(Vec3::Z, |s| s.wi);
            cell(wi) / COLUMNS / 8 * 4 + cell(wi) % COLUMNS / 6
        });
    }
}

/// Radiance over density has the mean that the sky states, 4 pi times, and next to no spread: cells are small and the four
/// wavelengths of sampling are not the one of the test. Significance 1e-4 (4.06 standard errors, three skies); the
/// quadrature of the mean adds 1e-4.
#[test]
fn the_clear_skys_samples_have_its_mean() {
    for (seed, degrees) in (7..).zip([60.0, 20.0, 1.0]) {
        let sky = Environment::Clear(Box::new(clear_sky(degrees, Vec3::Z)));
        let wavelengths = Wavelengths { lambda: [450.0, 500.0, 550.0, 650.0], pdf: [1.0; 4] };
        let mut random = SplitMix(seed);
        let (mut sum, mut square, count) = (0.0, 0.0, 100_000);
        for _ in 0..count {
            let Some(sample) = sky.sample(random.pair(), &wavelengths) else { panic!("a bright sky") };
            assert_eq!(sample.radiance, sky.radiance(sample.wi, &wavelengths));
            let weight = f64::from(sample.radiance.z / sample.pdf_w);
            (sum, square) = (sum + weight, square + weight * weight);
        }
        let mean = sum / f64::from(count);
        let spread = (square / f64::from(count) - mean * mean).sqrt();
        let stated = 4.0 * PI * f64::from(sky.mean_radiance(&wavelengths).z);
        println!("sun at {degrees}: {mean:.5} for {stated:.5}, spread {:.3}", spread / mean);
        let allowed = 4.06 * spread / f64::from(count).sqrt() + 1e-4 * stated;
        assert!((mean - stated).abs() < allowed, "{mean} {stated} +- {allowed}");
        assert!(spread < 0.5 * mean, "{spread}");
    }
}

/// The pictures that tests write and the one in memory are the same.
#[test]
fn a_picture_comes_back_from_its_file() {
    let texel = |p: Vec2<usize>| (p.x() as f32, p.y() as f32, 0.5_f32);
    let image = Image::from_channels((4, 2), SpecificChannels::rgb(texel));
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).unwrap();
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), bytes.into_inner()).unwrap();
    let picture = Picture::read(file.path()).unwrap();
    assert_eq!((picture.width, picture.height), (4, 2));
    assert_eq!(picture.texels[6], Vec3::new(2.0, 1.0, 0.5));
}

/// Three triangles of unlike size and brightness around the origin; the third shows its back.
fn lamps() -> AreaLights {
    let triangles = [
        ([Vec3::new(1.0, -0.5, -0.5), Vec3::new(1.2, 0.4, 0.9), Vec3::new(1.0, 0.9, -0.4)], 1.0),
        ([Vec3::new(-0.6, 0.2, 0.5), Vec3::new(-0.2, -0.8, 0.7), Vec3::new(0.3, 0.4, 0.9)], 6.0),
        ([Vec3::new(0.0, 2.0, 0.0), Vec3::new(1.0, 2.0, 0.0), Vec3::new(0.0, 2.0, 1.0)], 2.0),
    ];
    let emitters = (7..).zip(triangles).map(|(id, (vertices, importance))| {
        // Towards the origin, apart from the last.
        let [a, b, c] = vertices;
        let faces = (b - a).cross(c - a).dot(a) < 0.0;
        let vertices = if faces == (id < 9) { [a, b, c] } else { [a, c, b] };
        let radiance = Spectrum::Constant(importance).prepare(Role::Illuminant, LaneMode::Rgb);
        EmitterTriangle { id, vertices, radiance, importance }
    });
    AreaLights::new(emitters.collect()).unwrap_or_else(|| panic!("lamps that emit nothing"))
}

/// Distance at which the ray from the origin meets a triangle.
fn met(d: Vec3, v: [Vec3; 3]) -> Option<f32> {
    let ray = floe::geometry::Ray::new(Vec3::ZERO, d);
    floe::geometry::triangle::RayCast::new(&ray).triangle(&v, f32::INFINITY).map(|hit| hit.t)
}

#[test]
fn directions_towards_lamps_follow_their_density() {
    let lamps = lamps();
    let triangles = [
        [Vec3::new(1.0, -0.5, -0.5), Vec3::new(1.2, 0.4, 0.9), Vec3::new(1.0, 0.9, -0.4)],
        [Vec3::new(-0.6, 0.2, 0.5), Vec3::new(-0.2, -0.8, 0.7), Vec3::new(0.3, 0.4, 0.9)],
    ];
    let pdf_w = |d: Vec3| -> f64 {
        let each = triangles.iter().zip(7..);
        each.filter_map(|(v, id)| met(d, *v).map(|t| f64::from(lamps.pdf_w(id, d, t)))).sum()
    };
    // The third lamp takes its share of the samples, and none of them counts.
    let areas: Vec<f64> =
        triangles.iter().map(|[a, b, c]| f64::from((*b - *a).cross(*c - *a).length()) * 0.5).collect();
    let dark = 0.5 * 2.0;
    let share = (areas[0] + areas[1] * 6.0) / (areas[0] + areas[1] * 6.0 + dark);
    let mut cells = probabilities(pdf_w);
    let total: f64 = cells.iter().sum();
    println!("lamps: pdf_w integrates to {total:.5}, the lit share is {share:.5}");
    assert!((total / share - 1.0).abs() < 2e-3, "pdf_w integrates to {total} and not {share}");
    for p in &mut cells {
        *p *= share / total;
    }
    let mut coarse = coarse(&cells);
    coarse.push(1.0 - share);
    let mut choice = SplitMix(221);
    assert_fits("lamps", 220, &coarse, |[u, v]| {
        match lamps.sample(Vec3::ZERO, [u, v, choice.pair()[0]], &wavelengths()) {
            Some(LightSample { wi, .. }) => cell(wi) / COLUMNS / 8 * 4 + cell(wi) % COLUMNS / 6,
            None => 12,
        }
    });
}

#[test]
fn lamps_state_the_density_of_their_samples() {
    let lamps = lamps();
    let mut random = SplitMix(6);
    for _ in 0..5000 {
        let from = warp::sphere(random.pair()) * 0.1;
        let ([u, v], [choice, _]) = (random.pair(), random.pair());
        let Some(sample) = lamps.sample(from, [u, v, choice], &wavelengths()) else { continue };
        let id = sample.triangle.unwrap_or(u32::MAX);
        assert_eq!(sample.pdf_w, lamps.pdf_w(id, sample.wi, sample.distance));
        assert!((sample.wi.length() - 1.0).abs() < 1e-6 && sample.distance > 0.0);
    }
    assert_eq!(lamps.pdf_w(3, Vec3::X, 1.0), 0.0, "a triangle that is no lamp");
}
