use super::*;

/// A volume of this many cells with a value for each.
fn volume(size: [usize; 3], value: impl Fn(usize, usize, usize) -> f32) -> Volume {
    let mut values = Vec::new();
    for z in 0..size[2] {
        for y in 0..size[1] {
            for x in 0..size[0] {
                values.push(value(x, y, z));
            }
        }
    }
    Volume { size, values }
}

fn noise(x: usize, y: usize, z: usize) -> f32 {
    let bits = crate::sampling::seed::hash_pair(x as u32 + 1000 * y as u32, z as u32);
    crate::sampling::seed::unit_float(bits)
}

/// Noise with holes of whole blocks.
fn grid() -> GridDensity {
    let hollow = |x: usize, y, z| if (9..30).contains(&x) { 0.0 } else { noise(x, y, z) };
    let volume = volume([37, 11, 20], hollow);
    GridDensity::new(&volume, DVec3::new(-1.0, -0.5, 0.0), DVec3::new(1.0, 0.5, 2.0))
}

/// Trilinear interpolation in double precision, from the definition.
fn density(grid: &GridDensity, p: DVec3) -> f64 {
    let q = (p - grid.min.as_dvec3()) * grid.per_metre.as_dvec3();
    let cells = (grid.size - 2).as_dvec3();
    if q.min_element() < 0.0 || (cells - q).min_element() < 0.0 {
        return 0.0;
    }
    let q = (q - 0.5).clamp(DVec3::ZERO, cells - 1.0);
    let least = q.floor();
    let f = q - least;
    let mut sum = 0.0;
    for corner in 0..8 {
        let bit = |axis: i32| f64::from(corner >> axis & 1);
        let offset = DVec3::new(bit(0), bit(1), bit(2));
        let weight: f64 = (0..3).map(|i| if offset[i] == 1.0 { f[i] } else { 1.0 - f[i] }).product();
        let at = (least + offset).min(cells - 1.0).as_ivec3() + 1;
        sum += weight * f64::from(grid.values[index(at, grid.size)]);
    }
    sum
}

fn rays() -> Vec<Ray> {
    let number = |i: usize, k: usize| noise(i, k, 77) * 2.0 - 1.0;
    let mut rays: Vec<Ray> = (0..200)
        .map(|i| {
            let origin = Vec3::new(number(i, 0), number(i, 1), number(i, 2) + 1.0) * 1.3;
            let direction = Vec3::new(number(i, 3), number(i, 4), number(i, 5)).normalize();
            Ray { t_max: if i % 2 == 0 { f32::INFINITY } else { 0.7 }, ..Ray::new(origin, direction) }
        })
        .collect();
    for direction in [Vec3::X, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_X] {
        rays.push(Ray::new(Vec3::new(0.01, 0.02, 1.0) - 3.0 * direction, direction));
        // Along a plane through centres, and along one face of the box.
        rays.push(Ray::new(Vec3::new(0.0, 0.0, 1.0) - 3.0 * direction, direction));
    }
    rays
}

#[test]
fn the_length_is_the_integral_of_the_density() {
    let grid = grid();
    for ray in rays() {
        // The midpoint rule over 20,000 steps of at most 0.3 mm: the error is that of the kinks, about 1e-7, and of the
        // ends of the box, half a step of the greatest density.
        let end = f64::from(ray.t_max).min(6.0);
        let step = end / 20_000.0;
        let at = |i: i32| ray.origin.as_dvec3() + (f64::from(i) + 0.5) * step * ray.direction.as_dvec3();
        let expected: f64 = (0..20_000).map(|i| density(&grid, at(i)) * step).sum();
        let got = f64::from(grid.length(&ray));
        assert!((got - expected).abs() < step + 1e-5, "{ray:?}: {got} is not {expected}");
    }
}

#[test]
fn distance_and_length_are_each_others_inverse() {
    let grid = grid();
    let mut reached = 0;
    for ray in rays() {
        let whole = grid.length(&Ray { t_max: f32::INFINITY, ..ray });
        assert_eq!(grid.distance(&ray, whole * 1.001 + 1e-6), f32::INFINITY);
        for share in [1e-4, 0.1, 0.5, 0.77, 0.999] {
            let distance = grid.distance(&ray, share * whole);
            if whole < 1e-3 {
                continue;
            }
            let back = grid.length(&Ray { t_max: distance, ..ray });
            // Sums over up to eighty cells, each with a relative error of 1e-7 or so, and the rounding of the distance.
            let tolerance = 4e-6 * whole + f32::EPSILON * distance;
            assert!((back - share * whole).abs() < tolerance, "{ray:?} {share}: {back} of {whole}");
            reached += 1;
        }
    }
    assert!(reached > 300, "{reached}");
}

#[test]
fn a_constant_grid_is_its_box() {
    let grid = GridDensity::new(&volume([3, 1, 5], |_, _, _| 2.0), DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0));
    let through = grid.length(&Ray::new(Vec3::new(-1.0, 1.0, 1.5), Vec3::X));
    assert!((through - 2.0).abs() < 1e-6, "{through}");
    assert_eq!(grid.length(&Ray::new(Vec3::new(-1.0, 2.1, 1.5), Vec3::X)), 0.0);
    assert_eq!(grid.length(&Ray::new(Vec3::new(2.0, 1.0, 1.5), Vec3::X)), 0.0);
    assert_eq!((grid.maximum(), grid.cells()), (2.0, [3, 1, 5]));
}

#[test]
fn what_is_empty_is_stepped_over() {
    let grid = GridDensity::new(&volume([64, 64, 64], |_, _, _| 0.0), DVec3::ZERO, DVec3::ONE);
    assert_eq!(grid.length(&Ray::new(Vec3::splat(-1.0), Vec3::splat(1.0).normalize())), 0.0);
    let mut spans = 0;
    grid.each_span(&Ray::new(Vec3::splat(-1.0), Vec3::splat(1.0).normalize()), |_, _| {
        spans += 1;
        true
    });
    assert_eq!(spans, 0);
}

/// Delta tracking, which knows nothing of integrals, agrees with the closed form in the mean.
#[test]
fn delta_tracking_finds_the_same_transmittance() {
    let grid = grid();
    let sigma_t = 3.0_f64;
    let majorant = sigma_t * f64::from(grid.maximum());
    let mut state = 1_u32;
    let mut number = || {
        state = crate::sampling::seed::hash_pair(state, 12345);
        f64::from(crate::sampling::seed::unit_float(state))
    };
    for ray in rays().iter().take(4).chain(rays().iter().rev().take(2)) {
        let expected = libm::exp(-sigma_t * f64::from(grid.length(ray)));
        let trials = 20_000;
        let mut passed = 0;
        for _ in 0..trials {
            let mut t = 0.0;
            loop {
                t -= libm::log(1.0 - number()) / majorant;
                if t >= f64::from(ray.t_max).min(6.0) {
                    passed += 1;
                    break;
                }
                let p = ray.origin.as_dvec3() + t * ray.direction.as_dvec3();
                if number() * majorant < sigma_t * density(&grid, p) {
                    break;
                }
            }
        }
        let mean = f64::from(passed) / f64::from(trials);
        let deviation = (expected * (1.0 - expected) / f64::from(trials)).sqrt();
        // Six rays at four standard deviations: a chance of 4e-4, of a fixed seed.
        assert!((mean - expected).abs() <= 4.0 * deviation + 1e-9, "{mean} is not {expected} +- {deviation}");
    }
}
