//! The refractive index of a medium over wavelength.
//!
//! ```text
//! sigma_a = 4 pi k / lambda
//! ```
//! Rays bend at the index of one wavelength, [`REFERENCE_WAVELENGTH`], unless the scene asks for dispersion; absorption
//! and particles use all of them.

use std::f64::consts::PI;

use super::{ice, water};
use crate::spectrum::Spectrum;
use crate::spectrum::cie::nanometres;
use crate::spectrum::curve::interpolate;

/// The wavelength in nm (sodium D) at whose index rays reflect and bend.
pub const REFERENCE_WAVELENGTH: f64 = 589.3;

/// A complex index n + i k over wavelength; k >= 0 absorbs.
#[derive(Clone, Debug, PartialEq)]
pub enum RefractiveIndex {
    /// The same at every wavelength; absorbs nothing.
    Constant(f32),
    /// Pure or sea water, see [`water`].
    Water {
        /// Degrees Celsius.
        temperature: f32,
        /// Parts per thousand.
        salinity: f32,
    },
    /// Pure ice, see [`ice`].
    Ice,
    /// Measured values, linear in between and constant beyond the ends.
    Table {
        /// Wavelengths in nm, strictly rising.
        wavelengths: Vec<f32>,
        /// Real part.
        n: Vec<f32>,
        /// Imaginary part; empty is zero.
        k: Vec<f32>,
    },
}

impl RefractiveIndex {
    /// Of n and k from 375 to 775 nm in steps of 25 nm.
    pub(super) fn every_25_nm(n: [f32; 17], k: [f32; 17]) -> Self {
        let wavelengths = (0..n.len()).map(|i| 375.0 + 25.0 * i as f32).collect();
        Self::Table { wavelengths, n: n.to_vec(), k: k.to_vec() }
    }

    /// Real part at `lambda_nm`.
    pub fn n(&self, lambda_nm: f64) -> f64 {
        match self {
            Self::Constant(n) => f64::from(*n),
            Self::Water { temperature, salinity } => {
                water::refractive_index(lambda_nm, f64::from(*temperature), f64::from(*salinity))
            }
            Self::Ice => ice::refractive_index(lambda_nm),
            Self::Table { wavelengths, n, .. } => interpolate(wavelengths, n, lambda_nm),
        }
    }

    /// Imaginary part at `lambda_nm`.
    pub fn k(&self, lambda_nm: f64) -> f64 {
        match self {
            Self::Constant(_) => 0.0,
            Self::Water { .. } => water::absorption(lambda_nm) * lambda_nm * 1e-9 / (4.0 * PI),
            Self::Ice => ice::extinction_index(lambda_nm),
            Self::Table { wavelengths, k, .. } => interpolate(wavelengths, k, lambda_nm),
        }
    }

    /// The real part at which rays reflect and bend.
    pub fn for_rays(&self) -> f32 {
        self.n(REFERENCE_WAVELENGTH) as f32
    }

    /// True when the real part is not the same at every wavelength.
    pub fn disperses(&self) -> bool {
        match self {
            Self::Constant(_) => false,
            Self::Water { .. } | Self::Ice => true,
            Self::Table { n, .. } => n.windows(2).any(|pair| pair[0] != pair[1]),
        }
    }

    /// What is to be known of it: that it is extrapolated.
    pub fn warning(&self) -> Option<String> {
        let Self::Water { temperature, .. } = self else { return None };
        let [least, greatest] = water::TEMPERATURE_RANGE;
        (!(least..=greatest).contains(temperature)).then(|| {
            format!(
                "temperature = {temperature}: the index of water is known from {least} to {greatest} degrees Celsius; \
                 beyond it is extrapolated"
            )
        })
    }

    /// The absorption in 1/m that the imaginary part implies, at whole nanometres; `None` where there is none.
    pub fn absorption(&self) -> Option<Spectrum> {
        let sigma_a = |lambda: f64| match self {
            Self::Water { .. } => water::absorption(lambda),
            _ => 4.0 * PI * self.k(lambda) / (lambda * 1e-9),
        };
        let absorption = Spectrum::tabulated(nanometres(), sigma_a);
        (!absorption.is_zero()).then_some(absorption)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::{LaneMode, Lanes, Role, Wavelengths};

    fn absorption_at(index: &RefractiveIndex, lambda: [f32; 4]) -> Lanes {
        let curve = index.absorption().unwrap().prepare(Role::Coefficient, LaneMode::Spectral);
        curve.lanes(&Wavelengths { lambda, pdf: [1.0; 4] })
    }

    #[test]
    fn a_constant_index_and_a_table_without_k_absorb_nothing() {
        assert_eq!(RefractiveIndex::Constant(1.33).absorption(), None);
        let glass = RefractiveIndex::Table { wavelengths: vec![500.0], n: vec![1.5], k: vec![] };
        assert_eq!(glass.absorption(), None);
        assert_eq!(glass.n(400.0), 1.5);
    }

    #[test]
    fn water_and_ice_absorb_as_measured() {
        let water = RefractiveIndex::Water { temperature: 10.0, salinity: 35.0 };
        assert_eq!(
            absorption_at(&water, [420.0, 550.0, 600.0, 700.0]),
            Lanes::new(0.00454, 0.0565, 0.2224, 0.624)
        );
        let at_550 = absorption_at(&RefractiveIndex::Ice, [550.0; 4]).x;
        assert!((at_550 - 0.0523).abs() < 1e-5, "{at_550}");
        // k of water at 550 nm: 0.0565 * 550e-9 / (4 pi).
        assert!((water.k(550.0) / 2.4729e-9 - 1.0).abs() < 1e-4);
    }

    #[test]
    fn a_table_gives_4_pi_k_over_lambda() {
        let index = RefractiveIndex::Table {
            wavelengths: vec![400.0, 700.0],
            n: vec![1.4, 1.3],
            k: vec![1e-8, 1e-8],
        };
        let at = absorption_at(&index, [400.0, 500.0, 600.0, 700.0]);
        for (lambda, got) in [400.0, 500.0, 600.0, 700.0].into_iter().zip(at.to_array()) {
            let want = 4.0 * PI * 1e-8 / (lambda * 1e-9);
            assert!((f64::from(got) / want - 1.0).abs() < 1e-6, "{lambda} nm: {got}");
        }
        assert!((index.n(550.0) - 1.35).abs() < 1e-6);
    }

    #[test]
    fn rays_bend_at_the_sodium_line() {
        let fresh = RefractiveIndex::Water { temperature: 20.0, salinity: 0.0 };
        assert!((fresh.for_rays() - 1.333).abs() < 1e-4);
        assert!((RefractiveIndex::Ice.for_rays() - 1.3097).abs() < 1e-4);
    }
}
