//! What is wrong with a mixture is named, with the value and the cure.

use floe::optics::particles::{Cache, Cylinder, SizeDistribution};

use crate::mixtures::{host, index, sea};

#[test]
fn sizes_that_cannot_be() {
    let power = |exponent, least, greatest| SizeDistribution::PowerLaw { exponent, least, greatest };
    let table = |radii: &[f64], number: &[f64]| SizeDistribution::Table {
        radii: radii.to_vec(),
        number: number.to_vec(),
    };
    let log_normal = |median, deviation| SizeDistribution::LogNormal { median, deviation };
    for (sizes, message) in [
        (power(3.0, 0.0, 1e-6), "the least radius in m is 0"),
        (power(3.0, 1e-6, f64::NAN), "the greatest radius in m is NaN"),
        (power(f64::INFINITY, 1e-7, 1e-6), "the exponent is inf"),
        (power(3.0, 1e-6, 1e-7), "exchange them"),
        (log_normal(-1e-6, 0.3), "the median radius in m is -0.000001"),
        (log_normal(1e-6, 0.0), "the deviation of ln r is 0"),
        (table(&[], &[]), "the table of radii is empty"),
        (table(&[1e-6], &[1.0, 2.0]), "1 radii and 2 numbers"),
        (table(&[1e-6, 1e-6], &[1.0, 2.0]), "radius 1 of the table, 1e-6 m"),
        (table(&[1e-6, f64::NAN, 3e-6], &[1.0, 2.0, 3.0]), "radius 1 of the table, NaN m"),
        (table(&[-1e-6, 1e-6], &[1.0, 2.0]), "the least radius of the table in m is"),
        (table(&[1e-6, 2e-6], &[1.0, -2.0]), "number 1 of the table is -2"),
        (table(&[1e-6, 2e-6], &[0.0, 0.0]), "every number of the table is 0"),
        (table(&[1e-6, 1.001e-6, 9.999e-5, 1e-4], &[1.0, 0.0, 0.0, 1.0]), "too steep to be summed up"),
        (power(1e6, 1e-7, 1e-6), "too steep to be summed up"),
    ] {
        let mut mixture = sea();
        mixture.species[1].sizes = sizes;
        for error in [mixture.bulk(&[550.0]).unwrap_err(), mixture.scattering(&Cache::off()).unwrap_err()] {
            let text = error.to_string();
            assert!(text.starts_with("algae: ") && text.contains(message), "{text}");
        }
    }
    let cylinder = Cylinder { radius: 1e-6, length: 1e-5 };
    let stand_in = |cylinders: &[Cylinder], number: &[f64]| {
        SizeDistribution::equal_volume_to_area(cylinders, number).unwrap_err().to_string()
    };
    assert!(stand_in(&[cylinder], &[]).contains("1 radii and 0 numbers"));
    assert!(stand_in(&[Cylinder { radius: 0.0, ..cylinder }], &[1.0]).contains("radius of a cylinder is 0"));
    assert!(stand_in(&[cylinder, cylinder], &[1.0, 1.0]).contains("sort them"));
}

#[test]
fn mixtures_that_cannot_be() {
    let message = |change: &dyn Fn(&mut floe::optics::particles::Mixture), lambda: f64| {
        let mut mixture = sea();
        change(&mut mixture);
        mixture.bulk(&[lambda]).unwrap_err().to_string()
    };
    for value in [-0.1, f64::NAN, 1.5] {
        let text = message(&|m| m.species[0].volume_fraction = value, 550.0);
        assert!(text.contains(&format!("minerals: the volume fraction is {value}")), "{text}");
    }
    let crowded = |m: &mut floe::optics::particles::Mixture| {
        m.species.iter_mut().for_each(|s| s.volume_fraction = 0.75);
    };
    assert!(message(&crowded, 550.0).contains("minerals, algae are 1.5 altogether: there is room for 1"));
    let text = message(&|m| m.species[1].index = index(-1.5, 0.0), 550.0);
    assert!(text.contains("algae, radius") && text.contains("at 550 nm: the refractive index of the sphere"));
    let huge = |m: &mut floe::optics::particles::Mixture| {
        m.species[0].sizes = SizeDistribution::Table { radii: vec![1.0], number: vec![1.0] };
    };
    assert!(message(&huge, 550.0).contains("minerals, radius 1e0 m at 550 nm: the size parameter"));
    let text = message(&|m| m.host = host(1.33, -1e-3, 550.0), 550.0);
    assert!(text.contains("minerals") && text.contains("the refractive index of the host is"), "{text}");
    let dark = |m: &mut floe::optics::particles::Mixture| {
        m.host.absorption = floe::spectrum::Spectrum::Constant(f32::NAN);
    };
    assert!(message(&dark, 550.0).contains("the host's absorption is NaN 1/m at 550 nm"));
    for lambda in [0.0, -5.0, f64::INFINITY] {
        assert!(message(&|_| (), lambda).contains(&format!("a wavelength is {lambda} nm")));
    }
}
