//! Many spheres at once are the same spheres, to the last bit, and their patterns those of the scalar series.

use floe::optics::lorenz_mie::{Coefficients, Complex64, Efficiencies, Pattern, Sphere, efficiencies};

/// Spheres over all that is computed: from next to nothing to beyond where they go alone, clear and black, in hosts that
/// absorb up to the darkest.
fn spheres() -> Vec<Sphere> {
    let mut spheres = Vec::new();
    let hosts = [(1.0, 0.0), (1.33, 2e-9), (1.33, 1e-3), (1.0, 0.5)];
    let particles = [(1.5, 0.0), (0.75, 0.0), (1.33, 2e-9), (10.0, 10.0), (1.0001, 1e-7), (2.0, 30.0)];
    for (n, k) in hosts {
        for (i, (re, im)) in particles.into_iter().enumerate() {
            for step in 0..34 {
                let size = 1e-12 * 3.16_f64.powi(step) * (1.0 + 0.1 * i as f64);
                if step % 2 == 0 || size > 0.01 {
                    spheres.extend(Sphere::new(Complex64::new(re, im), Complex64::new(n, k), size));
                }
            }
        }
    }
    spheres
}

fn bits(e: &Efficiencies) -> [u64; 4] {
    [e.extinction, e.scattering, e.backward, e.asymmetry].map(f64::to_bits)
}

#[test]
fn a_sphere_has_the_same_bits_in_any_company() {
    let spheres = spheres();
    assert!(spheres.len() > 400 && spheres.iter().any(|s| s.size() > 2.5e4));
    let together = efficiencies(&spheres);
    for (sphere, found) in spheres.iter().zip(&together) {
        let alone = Coefficients::new(*sphere).efficiencies();
        assert_eq!(bits(&alone), bits(found), "{sphere:?}: {alone:?} {found:?}");
    }
    assert_eq!(efficiencies(&spheres[..3]), together[..3]);
    assert!(efficiencies(&[]).is_empty());
}

/// Q_ext = 4 / x^2 Re S(0), each a sum in an order of its own.
#[test]
fn extinction_is_what_the_forward_amplitude_says() {
    let mut worst = 0.0_f64;
    for sphere in spheres().iter().filter(|s| s.size() < 1e4) {
        let coefficients = Coefficients::new(*sphere);
        let by_amplitude =
            4.0 / sphere.size().powi(2) * (coefficients.amplitudes(1.0)[0] / sphere.host().powi(2)).re;
        let found = coefficients.efficiencies();
        let size = found.extinction.abs().max(found.scattering);
        // Where a host absorbs the parts cancel: relative to all that is scattered or taken.
        let total: f64 = coefficients
            .terms()
            .iter()
            .enumerate()
            .map(|(i, [a, b])| (2.0 * i as f64 + 3.0) * (a + b).norm_sqr().sqrt())
            .sum::<f64>()
            * 2.0
            / (sphere.size().powi(2) * sphere.host().norm_sqr());
        worst = worst.max((by_amplitude - found.extinction).abs() / size.max(total));
    }
    println!("optical theorem within {worst:e}");
    assert!(worst < 1e-12, "{worst:e}");
}

/// The mean of the phase functions of some spheres, weighted as each scatters.
#[test]
fn patterns_are_those_of_the_series() {
    let host = Complex64::new(1.33, 1e-9);
    let sphere = |i: u32| {
        let index = if i.is_multiple_of(2) { Complex64::new(1.58, 1e-3) } else { Complex64::new(1.0, 0.0) };
        Sphere::new(index, host, 0.02 * 1.35_f64.powi(i as i32)).unwrap()
    };
    let spheres: Vec<Sphere> = (0..40).map(sphere).collect();
    let numbers: Vec<f64> = spheres.iter().map(|s| s.size().powf(-2.7)).collect();
    let cosines: Vec<f64> =
        (0..=100).map(|i| (std::f64::consts::FRAC_PI_2 * f64::from(i) / 100.0).cos()).collect();
    let mut expected = [vec![0.0; cosines.len()], vec![0.0; cosines.len()]];
    let mut total = 0.0;
    for (sphere, number) in spheres.iter().zip(&numbers) {
        let coefficients = Coefficients::new(*sphere);
        let weight = number * sphere.size().powi(2) * coefficients.efficiencies().scattering;
        total += weight;
        let opposite: Vec<f64> = cosines.iter().map(|c| -c).collect();
        for (sums, cosines) in expected.iter_mut().zip([&cosines, &opposite]) {
            let values = coefficients.phase_function(cosines);
            sums.iter_mut().zip(values).for_each(|(sum, p)| *sum += weight * p);
        }
    }
    let found = Pattern::new(&spheres, &numbers).both_ways(&cosines);
    let mut worst = 0.0_f64;
    for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
        worst = worst.max((found / (expected / total) - 1.0).abs());
    }
    println!("patterns within {worst:e}");
    // The largest is x = 3000: its terms add up some 1e-13 at any angle, of which the light straight back is a small part.
    assert!(worst < 1e-11, "{worst:e}");
}
