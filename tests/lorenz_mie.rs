//! Spheres against arbitrary precision, against another algorithm, and against what must hold for any of them.
//!
//! `tests/data/lorenz_mie` was computed with 400 to 4000 bits; it holds the published cases of Wiscombe and of Bohren and
//! Huffman, a grid from x = 1e-6 to 1e5 with relative indices from 0.75 to 10 + 10i, and spheres in water and ice.

// Measured numbers, for `--nocapture`.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

#[path = "common/mie.rs"]
mod slow;

use std::f64::consts::PI;

use floe::optics::lorenz_mie::{Coefficients, Complex64, Efficiencies, Sphere};

/// The numbers of a table of `tests/data/lorenz_mie`, without its head.
fn table(text: &str) -> Vec<Vec<f64>> {
    let numbers = |line: &str| line.split(',').map(|field| field.parse().unwrap()).collect();
    text.lines().skip(1).map(numbers).collect()
}

fn coefficients(m: Complex64, x: f64) -> Coefficients {
    Coefficients::new(Sphere::new(m, Complex64::ONE, x).unwrap())
}

fn numbers(e: &Efficiencies) -> [f64; 4] {
    [e.extinction, e.scattering, e.backward, e.asymmetry]
}

/// The greatest relative deviation of each number seen so far.
fn keep_worst<const N: usize>(worst: &mut [f64; N], got: [f64; N], expected: &[f64]) {
    for ((worst, got), expected) in worst.iter_mut().zip(got).zip(expected) {
        let deviation = (got / expected - 1.0).abs();
        // Not a number is worst of all.
        *worst = if deviation <= *worst { *worst } else { deviation };
    }
}

/// The bounds are three times what was measured: the bits do not depend on the machine.
#[test]
fn spheres_are_those_of_arbitrary_precision() {
    let mut worst = [0.0; 4];
    let rows = table(include_str!("data/lorenz_mie/spheres.csv"));
    assert_eq!(rows.len(), 168);
    for row in rows {
        let [m_re, m_im, x, expected @ ..] = &row[..] else { panic!("{row:?}") };
        let got = numbers(&coefficients(Complex64::new(*m_re, *m_im), *x).efficiencies());
        keep_worst(&mut worst, got, expected);
    }
    println!("Qext, Qsca, Qback, g: {worst:?}");
    for (worst, bound) in worst.iter().zip([1.2e-11, 1.2e-11, 1.1e-9, 2.1e-12]) {
        assert!(*worst < bound, "{worst:e}");
    }
}

/// Relative to the whole amplitude at that angle.
#[test]
fn amplitudes_are_those_of_arbitrary_precision() {
    let mut worst = 0.0_f64;
    for row in table(include_str!("data/lorenz_mie/amplitudes.csv")) {
        let [m_re, m_im, x, mu, s @ ..] = &row[..] else { panic!("{row:?}") };
        let got = coefficients(Complex64::new(*m_re, *m_im), *x).amplitudes(*mu);
        let expected = [Complex64::new(s[0], s[1]), Complex64::new(s[2], s[3])];
        let size = (expected[0].norm_sqr() + expected[1].norm_sqr()).sqrt();
        let deviation = got.iter().zip(expected).map(|(got, s)| (got - s).norm_sqr().sqrt() / size);
        worst = deviation.fold(worst, f64::max);
    }
    println!("amplitudes within {worst:e}");
    assert!(worst < 2e-10, "{worst:e}");
}

#[test]
fn hosts_that_absorb_are_those_of_arbitrary_precision() {
    let mut worst = [0.0; 3];
    for row in table(include_str!("data/lorenz_mie/absorbing_hosts.csv")) {
        let [r, lambda, n_h, k_h, n_p, k_p, expected @ ..] = &row[..] else { panic!("{row:?}") };
        let sphere =
            Sphere::new(Complex64::new(*n_p, *k_p), Complex64::new(*n_h, *k_h), 2.0 * PI * r / lambda);
        let found = Coefficients::new(sphere.unwrap()).efficiencies();
        let area = PI * r * r;
        keep_worst(&mut worst, [found.extinction * area, found.scattering * area, found.asymmetry], expected);
    }
    println!("Cext {:e} Csca {:e} g {:e}", worst[0], worst[1], worst[2]);
    assert!(worst.iter().all(|w| *w < 5e-13), "{worst:?}");
}

/// The other algorithm loses digits where terms cancel, some 1e-16 x^-2 of them for small spheres.
#[test]
fn another_algorithm_gives_the_same() {
    for (m, largest) in [((1.33, 0.0), 300.0), ((0.75, 0.0), 300.0), ((1.5, 0.1), 300.0), ((5.0, 2.0), 50.0)]
    {
        let mut worst = [0.0; 4];
        let m = Complex64::new(m.0, m.1);
        let mut x = 0.1;
        while x < largest {
            keep_worst(&mut worst, numbers(&coefficients(m, x).efficiencies()), &slow::slow_sphere(m, x));
            x *= 1.37;
        }
        println!("m {m}: {worst:?}");
        assert!(worst.iter().all(|w| *w < 1e-9), "m {m}: {worst:?}");
    }
}

/// Rayleigh's limit is left as x^2: a tenth of the size, a hundredth of the deviation.
#[test]
fn small_spheres_are_rayleighs_to_their_order() {
    for m in [Complex64::new(1.5, 0.0), Complex64::new(1.33, 0.2), Complex64::new(0.75, 0.0)] {
        let polarisability = (m * m - 1.0) / (m * m + 2.0);
        let deviation = |x: f64| {
            let found = coefficients(m, x).efficiencies();
            let absorbed =
                if m.im > 0.0 { found.extinction / (4.0 * x * polarisability.im) - 1.0 } else { 0.0 };
            let scattered = found.scattering / (8.0 / 3.0 * x.powi(4) * polarisability.norm_sqr()) - 1.0;
            [scattered, absorbed]
        };
        for (large, small) in deviation(1e-2).into_iter().zip(deviation(1e-3)) {
            // What comes after x^2 is x^3 where the sphere absorbs: a part of some 1e-2.
            assert!(large == 0.0 || (large / small - 100.0).abs() < 3.0, "m {m}: {large:e} {small:e}");
        }
        // At 1e-6 next to nothing is left of it.
        assert!(deviation(1e-6).iter().all(|d| d.abs() < 1e-10), "m {m}: {:?}", deviation(1e-6));
    }
}

/// Energy: what does not absorb scatters all that it takes. The phase function is normalised and has the mean cosine g,
/// by Simpson's rule in the angle; there are 2x + 4 or so lobes of a width of pi/x.
#[test]
fn energy_is_kept_and_the_phase_function_is_that_of_the_coefficients() {
    for (m, x) in [((1.33, 0.0), 0.5), ((1.5, 0.0), 7.3), ((0.75, 0.0), 60.0), ((1.4, 1e-3), 200.0)] {
        let coefficients = coefficients(Complex64::new(m.0, m.1), x);
        let found = coefficients.efficiencies();
        if m.1 == 0.0 {
            assert!((found.extinction / found.scattering - 1.0).abs() < 1e-12, "{m:?} {x}: {found:?}");
        }
        let intervals = 16_000;
        let step = PI / f64::from(intervals);
        let cosines: Vec<f64> = (0..=intervals).map(|i| (step * f64::from(i)).cos()).collect();
        let phase = coefficients.phase_function(&cosines);
        let simpson = |power: i32| {
            let terms = cosines.iter().zip(&phase).enumerate().map(|(i, (cos, p))| {
                let weight = if i == 0 || i == intervals as usize { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
                weight * p * cos.powi(power) * (1.0 - cos * cos).max(0.0).sqrt()
            });
            2.0 * PI * step / 3.0 * terms.sum::<f64>()
        };
        assert!((simpson(0) - 1.0).abs() < 1e-7, "{m:?} {x}: {}", simpson(0));
        assert!((simpson(1) - found.asymmetry).abs() < 1e-7, "{m:?} {x}: {} {found:?}", simpson(1));
    }
}

/// A sphere of the host's own matter does nothing, in any host, and a large one takes twice its shadow.
#[test]
fn limits() {
    for host in [Complex64::ONE, Complex64::new(1.33, 1e-3)] {
        let found = Coefficients::new(Sphere::new(host, host, 10.0).unwrap()).efficiencies();
        assert!(found.extinction.abs() < 1e-25 && found.scattering < 1e-25, "{found:?}");
    }
    let large = coefficients(Complex64::new(1.33, 0.1), 1e5).efficiencies();
    // The edge adds some 2 x^(-2/3).
    assert!((large.extinction - 2.0).abs() < 2.0 * 1e5_f64.powf(-2.0 / 3.0), "{large:?}");
}

/// Hosts that let less and less through: every number stays finite up to where spheres are refused.
#[test]
fn black_hosts_have_finite_numbers() {
    for depth in [0.1, 0.9, 1.1, 10.0, 100.0, 150.0] {
        for x in [1e-3, 1.0, 100.0] {
            let host = Complex64::new(1.0, depth / x);
            for particle in [Complex64::new(1.5, 0.0), Complex64::new(2.0, 3.0)] {
                let found = Coefficients::new(Sphere::new(particle, host, x).unwrap()).efficiencies();
                assert!(numbers(&found).iter().all(|q| q.is_finite()), "{depth} {x} {particle}: {found:?}");
                assert!(found.scattering >= 0.0 && found.asymmetry.abs() <= 1.0, "{depth} {x}: {found:?}");
            }
        }
    }
}
