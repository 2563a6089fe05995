//! Milk: water with riboflavin, globules of fat and micelles of casein.
//!
//! ```text
//! v_fat = (w_f / 0.915) / (100 / 1.03),   v_casein = 0.76 (w_p / 1.11) / (100 / 1.03)                   (1)
//! volume over r ~ exp(-((ln t - alpha) / beta)^2 / 2) / t                                              (2)
//! beta^2 = ln(c_s^2 / r_vs^2 + 1),   alpha = ln r_vs - beta^2 / 2                                      (3)
//! fat: t = r / um, r_vs = 0.475, c_s = 0.285
//! casein: t = r / (150 nm - r), r_vs = 43 / (150 - 43), c_s = 0.23
//! r_P0 = -0.2528 w_f^2 + 1.4186 w_f below 2 %, 1.456189 w_f^0.36 above                                 (4)
//! r_P50 = 7.4814e-4 w_f^2 + 3.20399e-2 w_f + 0.11622
//! r_43 = 10^(b - a log P),   b = log r_P0,   a = (b - log r_P50) / log 50                              (5)
//! r_vs = r_43 / (0.6^2 + 1),   c_s = 0.6 r_vs                                                          (6)
//! k_riboflavin = ln 10 (0.17 / 376.3682) / (100 / 1.03) (3.3e6 / 0.25654) A(lambda) lambda / (4 pi)     (7)
//! ```
//! `[FRISVAD07]`, w in per cent of the mass, P the pressure of homogenisation in MPa, r in um where no other unit
//! stands; read in the program that its authors published. At 1 MPa and below milk is as the cow gives it. The index of
//! water is that of Hale and Querry `[HALE73]` to three digits, with which the published figures were computed; n and k
//! of fat are those of `[MICHALSKI01]`, A is the absorbance of riboflavin of PhotochemCAD, both as that program has them. It
//! compares with the reduced scattering that `[NARASIMHAN06]` measured of regular milk: 8 to 16 % less at 20 MPa
//! (`tests/models/milk.rs`).

use std::f64::consts::PI;

use super::particles::{Host, Mixture, SizeDistribution, Species};
use super::{RefractiveIndex, water};
use crate::spectrum::Spectrum;
use crate::spectrum::cie::knots;
use crate::spectrum::curve::interpolate_even;

/// Milk of a composition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Milk {
    /// Fat in per cent of the mass.
    pub fat: f64,
    /// Protein in per cent of the mass.
    pub protein: f64,
    /// Pressure of homogenisation in MPa; `None` has globules as in (2).
    pub pressure: Option<f64>,
}

/// The pressures in MPa that (5) is for.
pub const PRESSURE_RANGE: [f64; 2] = [0.0, 50.0];

/// Milk by name; the first is what milk is unless it is told.
pub const PRESETS: [(&str, Milk); 3] =
    [("whole", Milk::of_fat(3.5)), ("semi", Milk::of_fat(1.5)), ("skimmed", Milk::of_fat(0.1))];

/// Greatest radius of a micelle in m.
const MICELLE: f64 = 150e-9;

/// (2) for fat: mean and spread of r, in um.
struct Globules {
    mean: f64,
    spread: f64,
}

impl Milk {
    const fn of_fat(fat: f64) -> Self {
        Self { fat, protein: 3.4, pressure: None }
    }

    /// Water, fat and casein; what has no volume is left out.
    pub fn mixture(&self) -> Mixture {
        let litre = 100.0 / 1.03;
        let fat = Species {
            name: "fat".to_owned(),
            index: RefractiveIndex::every_25_nm(FAT_N, FAT_K),
            sizes: self.globules().sizes(),
            volume_fraction: self.fat / 0.915 / litre, // (1)
        };
        let casein = Species {
            name: "casein".to_owned(),
            index: RefractiveIndex::Constant(1.503),
            sizes: micelles(),
            volume_fraction: 0.76 * (self.protein / 1.11) / litre, // (1)
        };
        let species = [fat, casein].into_iter().filter(|species| species.volume_fraction > 0.0).collect();
        Mixture { host: host(), species }
    }

    fn globules(&self) -> Globules {
        // The fits are of milk; what is skimmed further has the globules of what is skimmed so far.
        let (Some(pressure), w) = (self.pressure, self.fat.max(0.1)) else {
            return Globules { mean: 0.475, spread: 0.285 };
        };
        let untreated = if w < 2.0 { w * (1.4186 - 0.2528 * w) } else { 1.456189 * libm::pow(w, 0.36) }; // (4)
        let at_50 = 7.4814e-4 * w * w + 3.20399e-2 * w + 0.11622;
        let slope = libm::log10(untreated / at_50) / libm::log10(50.0);
        let radius = untreated * libm::pow(pressure.max(1.0), -slope); // (5)
        let mean = radius / (0.6 * 0.6 + 1.0); // (6)
        Globules { mean, spread: 0.6 * mean }
    }
}

impl Globules {
    /// The number is log-normal where the volume is.
    fn sizes(&self) -> SizeDistribution {
        let (alpha, beta_squared) = log_normal(self.mean, self.spread);
        SizeDistribution::LogNormal {
            median: 1e-6 * libm::exp(alpha - 3.0 * beta_squared),
            deviation: beta_squared.sqrt(),
        }
    }
}

/// alpha and beta^2 of (3).
fn log_normal(mean: f64, spread: f64) -> (f64, f64) {
    let beta_squared = libm::log(spread * spread / (mean * mean) + 1.0);
    (libm::log(mean) - 0.5 * beta_squared, beta_squared)
}

/// (2) for casein, at every nanometre.
fn micelles() -> SizeDistribution {
    let (alpha, beta_squared) = log_normal(43e-9 / (MICELLE - 43e-9), 0.23);
    let radii: Vec<f64> = (0..150).map(|i| (f64::from(i) + 0.5) * 1e-9).collect();
    let number = |r: &f64| {
        let t = r / (MICELLE - r);
        let from_middle = libm::log(t) - alpha;
        let volume = libm::exp(-0.5 * from_middle * from_middle / beta_squared) / t;
        volume * (1e-9 / r).powi(3)
    };
    SizeDistribution::Table { number: radii.iter().map(number).collect(), radii }
}

fn host() -> Host {
    // At the nodes of the absorption of water, 5 nm apart, and at those of the index.
    let absorbed = |lambda: f64| water::absorption_at(lambda, water::MEASURED_AT, 0.0) + riboflavin(lambda);
    let k = std::array::from_fn(|i| {
        let lambda = 375.0 + 25.0 * i as f64;
        (absorbed(lambda) * lambda * 1e-9 / (4.0 * PI)) as f32
    });
    Host {
        index: RefractiveIndex::every_25_nm(WATER_N, k),
        absorption: Spectrum::tabulated(knots(), absorbed),
        molecular: None,
    }
}

/// Absorption of the riboflavin in milk in 1/m: 4 pi k / lambda of (7), linear between its nodes.
fn riboflavin(lambda_nm: f64) -> f64 {
    let absorbance = interpolate_even(&ABSORBANCE, [375.0, 25.0], lambda_nm);
    std::f64::consts::LN_10 * (0.17 / 376.3682) / (100.0 / 1.03) * (3.3e6 / 0.25654) * absorbance
}

/// From 375 nm in steps of 25 nm, as in the tables below `[HALE73]`.
#[rustfmt::skip]
const WATER_N: [f32; 17] = [
    1.341, 1.339, 1.338, 1.337, 1.336, 1.335, 1.334, 1.333, 1.333,
    1.332, 1.332, 1.331, 1.331, 1.331, 1.330, 1.330, 1.330,
];

#[rustfmt::skip]
const FAT_N: [f32; 17] = [
    1.480, 1.476, 1.473, 1.470, 1.468, 1.466, 1.464, 1.463, 1.462,
    1.461, 1.460, 1.459, 1.458, 1.457, 1.457, 1.456, 1.456,
];

#[rustfmt::skip]
const FAT_K: [f32; 17] = [
    4.0e-6, 6.4e-6, 8.6e-6, 1.14e-5, 1.1e-5, 1.0e-5, 4.7e-6, 4.6e-6, 4.7e-6,
    4.9e-6, 5.0e-6, 5.0e-6, 5.1e-6, 5.2e-6, 5.2e-6, 5.2e-6, 5.2e-6,
];

/// Absorbance of riboflavin.
#[rustfmt::skip]
const ABSORBANCE: [f64; 17] = [
    0.07117, 0.05934, 0.07215, 0.08300, 0.06379, 0.01962, 0.00950, 0.00957, 0.01198,
    0.01047, 0.01046, 0.01061, 0.00671, 0.01034, 0.00589, 0.00886, 0.01015,
];

#[cfg(test)]
mod tests {
    use super::*;

    /// The same formulas, worked out elsewhere with constants that may have more digits: 20 MPa with 1.5 and 3.5 % of fat, and
    /// none. Half a unit of the last digit of 0.11622 is 3.0e-5 of r_P50 with 1.5 % of fat, and 0.77 times that of the mean.
    #[test]
    fn homogenised_globules_are_as_small_as_the_formulas_say() {
        for (fat, pressure, mean) in [
            (1.5, 20.0, 0.206_220_6),
            (3.5, 20.0, 0.296_820_0),
            (3.5, 1.0, 1.680_905_8),
            (3.5, 0.0, 1.680_905_8),
        ] {
            let found = Milk { fat, pressure: Some(pressure), ..Milk::of_fat(fat) }.globules();
            assert!((found.mean / mean - 1.0).abs() < 2.4e-5, "{fat} %, {pressure} MPa: {}", found.mean);
            assert!((found.spread / found.mean - 0.6).abs() < 1e-6);
        }
    }

    /// ln 10 x 0.17 / 376.3682 / 97.087 x 1.2863e7 = 137.8 times 0.00957 is 1.319 1/m at 550 nm.
    #[test]
    fn riboflavin_makes_milk_yellow() {
        assert!((riboflavin(550.0) - 1.319).abs() < 1e-3);
        assert!(riboflavin(450.0) > 8.0 * riboflavin(550.0));
        assert_eq!(riboflavin(300.0), riboflavin(375.0));
    }
}
