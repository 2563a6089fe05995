//! Phase functions of mixtures: normalised, with the right mean, and fine enough in angle and wavelength.

use std::f64::consts::PI;

use floe::optics::particles::{Cache, EnsemblePhase, Mixture, SizeDistribution};
use floe::spectrum::Spectrum;

use crate::mixtures::{host, index, mist, sea, sea_ice, species};

/// 1 - cos of the cell between two angles is this much greater at the second.
fn width(a: f64, b: f64) -> f64 {
    2.0 * (0.5 * (b - a)).sin() * (0.5 * (a + b)).sin()
}

/// The integral over all directions and the mean cosine, where p is linear in the cosine between its angles.
fn moments(angles: &[f64], values: &[f64]) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for (a, p) in angles.windows(2).zip(values.windows(2)) {
        let width = width(a[0], a[1]);
        let (u, v) = (a[0].cos(), a[1].cos());
        sums[0] += PI * width * (p[0] + p[1]);
        sums[1] += PI / 3.0 * width * (u * p[0] + v * p[1] + (u + v) * (p[0] + p[1]));
    }
    sums
}

/// The integral over all directions of |p - q|: twice the share of light that goes elsewhere.
fn difference(angles: &[f64], p: &[f64], q: &[f64]) -> f64 {
    let gap = |i: usize| (p[i] - q[i]).abs();
    (1..angles.len()).map(|i| PI * width(angles[i - 1], angles[i]) * (gap(i - 1) + gap(i))).sum()
}

#[test]
fn they_are_normalised_and_their_mean_cosine_is_g() {
    for (name, mixture) in [("sea", sea()), ("ice", sea_ice()), ("mist", mist())] {
        let found = mixture.scattering(&Cache::off()).unwrap();
        let mut worst = 0.0_f64;
        for (lambda, values) in found.phase.wavelengths.iter().zip(&found.phase.values) {
            let place = found.bulk.wavelengths.iter().position(|w| w == lambda).unwrap();
            let [whole, mean] = moments(&found.phase.angles, values);
            assert!((whole - 1.0).abs() < 1e-12, "{name} at {lambda} nm: {whole}");
            worst = worst.max((mean - found.bulk.g[place]).abs());
        }
        println!("{name}: g within {worst:e}, {} angles", found.phase.angles.len());
        assert!(worst < 1e-3, "{name}: {worst:e}");
        assert!(found.bulk.relative_error < 2e-3);
    }
}

/// Halfway between the wavelengths, where a straight line is off most. Where spheres have many sizes most of it is not the
/// line but the radii, a third of those of the coefficients.
#[test]
fn the_wavelengths_suffice() {
    for (name, mixture, step, bound) in
        [("sea", sea(), 40.0, 3e-3), ("ice", sea_ice(), 40.0, 1e-2), ("mist", mist(), 20.0, 1e-2)]
    {
        for start in [380.0, 740.0] {
            let EnsemblePhase { angles, values, .. } =
                mixture.phase(&[start, start + 0.5 * step, start + step]).unwrap();
            let blended: Vec<f64> = values[0].iter().zip(&values[2]).map(|(p, q)| 0.5 * (p + q)).collect();
            let elsewhere = 0.5 * difference(&angles, &blended, &values[1]);
            println!("{name} from {start} nm: {elsewhere:e}");
            assert!(elsewhere < bound, "{name} from {start} nm: {elsewhere:e}");
        }
    }
}

/// Molecules alone, and as the part of all that they scatter.
#[test]
fn molecules_scatter_as_one_plus_0_835_cos_squared() {
    let mut mixture = sea();
    mixture.host.molecular = Some(Spectrum::Constant(1e6));
    let found = mixture.phase(&[500.0]).unwrap();
    for (angle, p) in found.angles.iter().zip(&found.values[0]) {
        let expected = 3.0 / (4.0 * PI * 3.835) * (1.0 + 0.835 * angle.cos().powi(2));
        // What the particles scatter is a millionth of it, but for their peak; straight lines between the angles are off by
        // 2e-5 (`src/optics/particles/angles.rs`).
        let rest = if *angle > 0.1 { 5e-5 } else { 0.02 };
        assert!((p / expected - 1.0).abs() < rest, "{angle}: {p}");
    }
    mixture.species.clear();
    mixture.host.molecular = None;
    let nothing = mixture.phase(&[500.0]).unwrap();
    assert!(nothing.values[0].iter().all(|p| *p == 0.25 / PI), "even where nothing scatters");
}

/// Drops of one size keep their rainbow, at 138 degrees, and their glory.
#[test]
fn drops_of_one_size_have_a_rainbow_and_a_glory() {
    let sizes = SizeDistribution::LogNormal { median: 4e-5, deviation: 0.03 };
    let mist = Mixture {
        host: host(1.0, 0.0, 550.0),
        species: vec![species("drops", index(1.334, 0.0), sizes, 1e-7)],
    };
    let EnsemblePhase { angles, values, .. } = mist.phase(&[550.0]).unwrap();
    let at = |degrees: f64| values[0][angles.partition_point(|a| *a < degrees.to_radians())];
    let greatest = |from: f64, to: f64| {
        let inside = angles.iter().zip(&values[0]).filter(|(a, _)| (from..to).contains(&a.to_degrees()));
        inside.fold((0.0, 0.0), |best, (a, p)| if *p > best.1 { (a.to_degrees(), *p) } else { best })
    };
    let (place, bow) = greatest(120.0, 160.0);
    println!("bow at {place}: {bow} against {} before it; back {}", at(125.0), at(180.0));
    // Airy's: a few degrees outside of Descartes' 137.9 for drops of this size.
    assert!((137.9..142.0).contains(&place) && bow > 5.0 * at(125.0));
    assert!(greatest(178.0, 180.1).1 > 3.0 * at(175.0));
}
