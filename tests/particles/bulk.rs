//! Coefficients: against sums that are written out here, in limits, and how they converge.

use std::f64::consts::PI;

use floe::optics::lorenz_mie::{Complex64, Sphere, efficiencies};
use floe::optics::particles::{Host, Mixture, SizeDistribution};
use floe::spectrum::Spectrum;

use crate::mixtures::{host, index, mist, power_law, sea, sea_ice, species};
use crate::slow::slow_sphere;

/// n + ik as single precision has it.
fn rounded(n: f64, k: f64) -> Complex64 {
    Complex64::new(f64::from(n as f32), f64::from(k as f32))
}

/// Extinction and scattering in 1/m, and g, of all species of a mixture by another count of radii.
fn summed(mixture: &Mixture, lambda: f64, steps: u32) -> [f64; 3] {
    let mut sums = [0.0; 3];
    let at = |i: &floe::optics::RefractiveIndex| Complex64::new(i.n(lambda), i.k(lambda));
    for particles in &mixture.species {
        let (least, greatest, number): (f64, f64, Box<dyn Fn(f64) -> f64>) = match particles.sizes {
            SizeDistribution::PowerLaw { exponent, least, greatest } => {
                (least, greatest, Box::new(move |r: f64| (r / greatest).powf(-exponent)))
            }
            SizeDistribution::LogNormal { median, deviation } => {
                let middle = median * (3.0 * deviation * deviation).exp();
                let number = move |r: f64| (-0.5 * ((r / median).ln() / deviation).powi(2)).exp() / r;
                let side = (6.0 * deviation).exp();
                (middle / side, middle * side, Box::new(number))
            }
            SizeDistribution::Table { .. } => panic!("not summed here"),
        };
        let radius = |i: u32| least * (greatest / least).powf((f64::from(i) + 0.5) / f64::from(steps));
        let radii: Vec<f64> = (0..steps).map(radius).collect();
        let sphere =
            |r: &f64| Sphere::new(at(&particles.index), at(&mixture.host.index), 2e9 * PI * r / lambda);
        let spheres: Vec<Sphere> = radii.iter().map(|r| sphere(r).unwrap()).collect();
        let found = efficiencies(&spheres);
        let weights = || radii.iter().map(|r| number(*r) * r);
        let volume: f64 = radii.iter().zip(weights()).map(|(r, w)| 4.0 / 3.0 * PI * r.powi(3) * w).sum();
        for ((r, w), e) in radii.iter().zip(weights()).zip(&found) {
            let shadow = PI * r * r * w / volume * particles.volume_fraction;
            sums[0] += shadow * e.extinction;
            sums[1] += shadow * e.scattering;
            sums[2] += shadow * e.scattering * e.asymmetry;
        }
    }
    [sums[0], sums[1], sums[2] / sums[1]]
}

/// What is stated about the error holds, and says something: it is no more than a hundred times too much.
#[test]
fn the_stated_error_bounds_that_against_twenty_times_as_many_radii() {
    for (name, mixture) in [("sea", sea()), ("ice", sea_ice()), ("mist", mist())] {
        let host = Host { absorption: Spectrum::Constant(0.0), molecular: None, ..mixture.host };
        let mixture = Mixture { host, ..mixture };
        let found = mixture.bulk(&[550.0]).unwrap();
        let [sigma_t, sigma_s, g] = summed(&mixture, 550.0, 20_000);
        let extinction = found.sigma_a[0] + found.sigma_s[0];
        let errors =
            [extinction / sigma_t - 1.0, found.sigma_s[0] / sigma_s - 1.0, found.g[0] - g].map(f64::abs);
        println!("{name}: stated {:e}, found {errors:?}", found.relative_error);
        let worst = errors.into_iter().fold(0.0, f64::max);
        assert!(worst < found.relative_error && found.relative_error < 100.0 * worst, "{name}");
        assert!(found.relative_error < 2e-3, "{name}");
    }
}

/// One radius is one sphere, and another algorithm's.
#[test]
fn spheres_of_one_size_are_those_of_another_algorithm() {
    let (r, volume_fraction) = (1.7e-6, 1e-6);
    let sizes = SizeDistribution::Table { radii: vec![r], number: vec![5.0] };
    let mixture = Mixture {
        host: host(1.33, 0.0, 550.0),
        species: vec![species("spheres", index(1.5, 0.01), sizes, volume_fraction)],
    };
    let found = mixture.bulk(&[450.0, 650.0]).unwrap();
    let n_host = f64::from(1.33_f32);
    for (i, lambda) in [450e-9, 650e-9].into_iter().enumerate() {
        let [q_t, q_s, _, g] = slow_sphere(rounded(1.5, 0.01) / n_host, 2.0 * PI * r * n_host / lambda);
        let per_volume = 0.75 / r * volume_fraction;
        let species = &found.species[0];
        let pairs = [
            (species.sigma_t[i], q_t * per_volume),
            (species.sigma_s[i], q_s * per_volume),
            (species.g[i], g),
        ];
        for (got, expected) in pairs {
            // That algorithm is within 1e-9 (tests/lorenz_mie.rs); mostly four digits better.
            assert!((got / expected - 1.0).abs() < 1e-9, "{got} {expected}");
        }
    }
    assert_eq!(found.relative_error, 0.0);
}

/// sigma_s = 4 pi sum k^4 r^6 |(m^2-1)/(m^2+2)|^2 N is left as x^2: a tenth of the size, a hundredth of the deviation.
#[test]
fn small_particles_are_rayleighs_to_their_order() {
    let (lambda, volume_fraction) = (500.0_f64, 1e-6);
    let n_host = f64::from(1.33_f32);
    let m = rounded(1.5, 0.0) / n_host;
    let polarisability = (m * m - 1.0) / (m * m + 2.0);
    let k = 2.0 * PI * n_host / (lambda * 1e-9);
    let deviation = |r: f64| {
        let (a, b) = (r / 1.5, r * 1.5);
        let sizes = SizeDistribution::PowerLaw { exponent: 4.0, least: a, greatest: b };
        let mixture = Mixture {
            host: host(1.33, 0.0, lambda),
            species: vec![species("dust", index(1.5, 0.0), sizes, volume_fraction)],
        };
        let found = mixture.bulk(&[lambda]).unwrap().sigma_s[0];
        // Over the same radii, so that the quadrature is in both: integral of r^2 over that of 1/r.
        let steps = 999;
        let radius = |i: u32| a * (b / a).powf((f64::from(i) + 0.5) / f64::from(steps));
        let cubes: f64 = (0..steps).map(|i| radius(i).powi(3)).sum();
        let mean = cubes / f64::from(steps);
        let rayleigh = 2.0 * k.powi(4) * polarisability.norm_sqr() * mean * volume_fraction;
        found / rayleigh - 1.0
    };
    let (large, small) = (deviation(1e-9), deviation(1e-10));
    println!("{large:e} {small:e}");
    // x is 0.017 and 0.0017; what comes after x^2 is x^3 and more.
    assert!((large / small - 100.0).abs() < 1.0, "{large:e} {small:e}");
}

#[test]
fn what_does_not_absorb_loses_nothing_and_the_host_adds_what_it_does() {
    let clear = Mixture {
        host: host(1.33, 0.0, 550.0),
        species: vec![species("glass", index(1.5, 0.0), power_law(3.0, 0.1, 10.0), 1e-6)],
    };
    let found = clear.bulk(&[400.0, 700.0]).unwrap();
    for (sigma_a, sigma_s) in found.sigma_a.iter().zip(&found.sigma_s) {
        // Sums of a thousand spheres, each exact to 1e-13.
        assert!(*sigma_a <= 1e-12 * sigma_s, "{sigma_a:e}");
    }
    let mut tinted = clear.clone();
    tinted.host.absorption = Spectrum::Table { wavelengths: vec![400.0, 700.0], values: vec![0.25, 0.5] };
    tinted.host.molecular = Some(Spectrum::Table { wavelengths: vec![400.0], values: vec![0.125] });
    let with = tinted.bulk(&[400.0, 550.0, 700.0]).unwrap();
    for (got, expected) in with.sigma_a.iter().zip([0.25, 0.375, 0.5]) {
        assert!((got / expected - 1.0).abs() < 1e-6, "{got}");
    }
    assert!((with.sigma_s[0] / (found.sigma_s[0] + 0.125) - 1.0).abs() < 1e-12);
    // The molecules' own g is 0.
    assert!((with.g[0] * with.sigma_s[0] / (found.g[0] * found.sigma_s[0]) - 1.0).abs() < 1e-12);
    assert_eq!(with.n, vec![f64::from(1.33_f32); 3]);
}

/// Clear bubbles in a dark host take up less than the host in their place: their extinction is negative, and only the sum
/// with the host says what is absorbed. It is cut at 0 after that.
#[test]
fn particles_that_take_the_place_of_a_dark_host() {
    let bubbles = species("bubbles", index(1.0, 0.0), power_law(2.0, 0.005, 0.02), 0.1);
    let dark = Mixture { host: host(1.33, 0.05, 550.0), species: vec![bubbles] };
    let of_host = 4.0 * PI * f64::from(0.05_f32) / 550e-9;
    let found = dark.bulk(&[550.0]).unwrap();
    let taken = found.species[0].sigma_t[0] - found.species[0].sigma_s[0];
    assert!(found.species[0].sigma_t[0] < 0.0, "{found:?}");
    // The host's coefficient is in single precision.
    assert!((found.sigma_a[0] / (of_host + taken) - 1.0).abs() < 1e-6, "{found:?}");
    assert!(found.sigma_a[0] > 0.0 && found.sigma_a[0] < of_host, "{found:?}");
    // A host whose index says that it absorbs, and whose coefficient does not.
    let host = Host { absorption: Spectrum::Constant(0.0), ..dark.host };
    assert_eq!(Mixture { host, ..dark }.bulk(&[550.0]).unwrap().sigma_a, [0.0]);
}

#[test]
fn no_particles_are_no_scattering() {
    let mut mixture = sea();
    mixture.species.iter_mut().for_each(|s| s.volume_fraction = 0.0);
    let found = mixture.bulk(&[550.0]).unwrap();
    assert!((found.sigma_s[0] - 0.002).abs() < 1e-9 && found.g[0] == 0.0);
    assert_eq!(found.species.iter().map(|s| s.sigma_t[0]).sum::<f64>(), 0.0);
    // Spheres of the host's own matter are not there either.
    let mixture = Mixture {
        host: host(1.33, 0.0, 550.0),
        species: vec![species("host", index(1.33, 0.0), power_law(3.0, 0.1, 10.0), 0.1)],
    };
    let found = mixture.bulk(&[550.0]).unwrap();
    assert!(found.sigma_s[0] < 1e-20 && found.g[0].is_finite() && found.relative_error.is_finite());
}
