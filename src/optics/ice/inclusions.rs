//! Air bubbles and pockets of brine in ice.
//!
//! ```text
//! air:    N(r) ~ r^-1.24,  r from 4 to 70 um
//! brine:  N(l) ~ l^-1.96,  l from 0.01 to 8 mm, cylinders with l / d = 1 up to 0.03 mm, 10.3 l^0.67 above     (1)
//! n_brine = 1.341 at -2 to 1.397 at -32 degrees, linear in between                                           (2)
//! ```
//! (1), l in mm there, and the bubbles are the sizes that `[LIGHT03]` found in sea ice off Alaska, (2) is `[MAYKUT95]`.
//! **All of this is from memory and unverified**: no source was opened. The cylinders are stood in for by spheres of
//! the same volume to area `[GRENFELL99]`. Over wavelength the index of brine falls as that of sea water does, and it
//! absorbs as pure water does.

use std::f64::consts::PI;

use super::super::particles::{Cylinder, SizeDistribution, SizesError, Species};
use super::super::refractive_index::REFERENCE_WAVELENGTH;
use super::super::{RefractiveIndex, water};

/// Lengths of cylinders that stand for all.
const LENGTHS: usize = 64;

/// Bubbles of air that take this share of the volume.
pub fn air(volume_fraction: f64) -> Species {
    Species {
        name: "air".to_owned(),
        index: RefractiveIndex::Constant(1.0),
        sizes: SizeDistribution::PowerLaw { exponent: 1.24, least: 4e-6, greatest: 70e-6 },
        volume_fraction,
    }
}

/// Pockets of brine at a temperature in degrees Celsius that take this share of the volume.
///
/// # Errors
/// Sizes that cannot be.
pub fn brine(volume_fraction: f64, temperature: f64) -> Result<Species, SizesError> {
    let (least, greatest) = (0.01_f64, 8.0_f64);
    let length = |i: usize| least * libm::pow(greatest / least, i as f64 / (LENGTHS - 1) as f64);
    let cylinder = |i: usize| {
        let mm = length(i);
        Cylinder { radius: 0.5e-3 * mm / aspect(mm), length: 1e-3 * mm }
    };
    let cylinders: Vec<Cylinder> = (0..LENGTHS).map(cylinder).collect();
    let number: Vec<f64> = (0..LENGTHS).map(|i| libm::pow(length(i), -1.96)).collect();
    Ok(Species {
        name: "brine".to_owned(),
        index: brine_index(temperature),
        sizes: SizeDistribution::equal_volume_to_area(&cylinders, &number)?,
        volume_fraction,
    })
}

/// Length over diameter of a pocket of a length in mm, (1).
fn aspect(length: f64) -> f64 {
    if length <= 0.03 { 1.0 } else { 10.3 * libm::pow(length, 0.67) }
}

/// (2) at sodium light, with the dispersion of sea water.
fn brine_index(temperature: f64) -> RefractiveIndex {
    let colder = ((-2.0 - temperature) / 30.0).clamp(0.0, 1.0);
    let at_sodium = 1.341 + (1.397 - 1.341) * colder;
    let sea = |lambda: f64| water::refractive_index(lambda, 0.0, 35.0);
    let wavelengths: Vec<f64> = (0..=40).map(|i| 380.0 + 10.0 * f64::from(i)).collect();
    let k = |lambda: &f64| water::absorption(*lambda) * lambda * 1e-9 / (4.0 * PI);
    RefractiveIndex::Table {
        n: wavelengths.iter().map(|l| (at_sodium + sea(*l) - sea(REFERENCE_WAVELENGTH)) as f32).collect(),
        k: wavelengths.iter().map(|l| k(l) as f32).collect(),
        wavelengths: wavelengths.iter().map(|l| *l as f32).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cube-like pocket of 0.02 mm (l = d) is a sphere of r = l / 2; the longest, 8 mm long and
    /// 8 / (10.3 x 8^0.67) = 0.1928 mm wide, has r = 1.5 x 0.0964 x 8 / 8.0964 = 0.1429 mm.
    #[test]
    fn pockets_are_spheres_of_the_same_volume_to_area() {
        let SizeDistribution::Table { radii, .. } = brine(0.01, -5.0).unwrap().sizes else { panic!() };
        assert!((radii[0] / 5e-6 - 1.0).abs() < 1e-12, "{}", radii[0]);
        let last = radii[radii.len() - 1];
        assert!((last / 142.9e-6 - 1.0).abs() < 1e-3, "{last}");
    }

    #[test]
    fn brine_has_the_index_of_its_ends_and_the_dispersion_of_water() {
        for (temperature, n) in [(-2.0, 1.341), (0.0, 1.341), (-17.0, 1.369), (-32.0, 1.397)] {
            // Linear over 10 nm of a curve: off by less than 1e-6 there.
            assert!((brine_index(temperature).n(REFERENCE_WAVELENGTH) - n).abs() < 2e-6, "{temperature}");
        }
        let index = brine_index(-5.0);
        let of_sea = |lambda: f64| water::refractive_index(lambda, 0.0, 35.0);
        assert!((index.n(400.0) - index.n(700.0) - of_sea(400.0) + of_sea(700.0)).abs() < 1e-6);
    }
}
