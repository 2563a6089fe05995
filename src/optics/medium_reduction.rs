//! The similarity relations of a medium, at every wavelength where its phase function differs.
//!
//! ```text
//! sigma_s*(lambda) = alpha(lambda) sigma_s(lambda)
//! ```
//! At each wavelength of the phase function's tables, and every 10 nm of a g that is a curve, alpha and p* are those of
//! [`super::similarity`]; in between both are linear. At order 1 that is the similarity relation at every wavelength. At
//! higher orders the moments in between are those of the blend, which is part of the bias. A medium is reduced at all
//! wavelengths or at none: not where one of them has no reduction.

use super::phase::{Deflection, Isotropic, MediumPhase, PhaseFunction, SpectralPhase};
use super::similarity::{Reduction, cosines};
use crate::spectrum::LaneCurve;
use crate::spectrum::curve::interpolate;

/// What takes the place of a medium's scattering.
#[derive(Clone, Debug, PartialEq)]
pub struct MediumReduction {
    /// sigma_s* / sigma_s.
    pub alpha: LaneCurve,
    /// The wider phase function.
    pub phase: MediumPhase,
}

impl MediumReduction {
    /// The reduction of an order from 1 on, as [`Reduction::of`].
    pub fn of(phase: &MediumPhase, order: usize) -> Option<Self> {
        match phase {
            MediumPhase::One(phase) => Reduction::of(phase, order)
                .map(|r| Self { alpha: LaneCurve::Constant(r.alpha as f32), phase: r.phase.into() }),
            MediumPhase::Spectral(phase) => Self::over_wavelength(phase, order),
        }
    }

    fn over_wavelength(phase: &SpectralPhase, order: usize) -> Option<Self> {
        let (wavelengths, phases): (Vec<f64>, Vec<PhaseFunction>) = phase.nodes().into_iter().unzip();
        let reductions: Vec<Reduction> =
            phases.iter().map(|phase| Reduction::of(phase, order)).collect::<Option<_>>()?;
        let places: Vec<f32> = wavelengths.iter().map(|&nm| nm as f32).collect();
        let alphas: Vec<f32> = reductions.iter().map(|r| r.alpha as f32).collect();
        let alpha = LaneCurve::sampled(|lambda| interpolate(&places, &alphas, lambda));
        let isotropic = PhaseFunction::Isotropic(Isotropic);
        let phase = match reductions.iter().all(|r| r.phase == isotropic) {
            true => isotropic.into(),
            false => {
                let angles: Vec<f64> = cosines().map(libm::acos).collect();
                let values = reductions.iter().map(|r| cosines().map(|cos| value(&r.phase, cos)).collect());
                SpectralPhase::tabulated(&wavelengths, &angles, &values.collect::<Vec<_>>())?.into()
            }
        };
        Some(Self { alpha, phase })
    }
}

fn value(phase: &PhaseFunction, cos: f64) -> f64 {
    let turned = match cos >= 0.0 {
        true => Deflection::from_one_minus_cos((1.0 - cos) as f32),
        false => Deflection::from_one_plus_cos((1.0 + cos) as f32),
    };
    f64::from(phase.value(turned))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::{Spectrum, Wavelengths};

    fn curve(values: [f32; 3]) -> MediumPhase {
        let g = Spectrum::Table { wavelengths: vec![400.0, 500.0, 600.0], values: values.to_vec() };
        MediumPhase::Spectral(SpectralPhase::henyey_greenstein(g).unwrap())
    }

    /// alpha (1 - g*) = 1 - g, between the nodes too where alpha is linear.
    #[test]
    fn the_first_moment_is_kept_at_every_wavelength() {
        let phase = curve([0.8, 0.9, 0.85]);
        let at = Wavelengths { lambda: [400.0, 450.0, 500.0, 605.0], pdf: [1.0; 4] };
        let lack = |phase: &MediumPhase| phase.mean_cosine().lanes(&at).to_array().map(|g| 1.0 - g);
        for order in 1..=3 {
            let reduction = MediumReduction::of(&phase, order).unwrap();
            assert_eq!(reduction.phase.one().is_some(), order == 1);
            let alpha = reduction.alpha.lanes(&at).to_array();
            let kept: [f32; 4] = std::array::from_fn(|i| alpha[i] * lack(&reduction.phase)[i]);
            for (kept, lack) in kept.into_iter().zip(lack(&phase)) {
                // Rounding and quadrature of 1024 cells.
                assert!((kept / lack - 1.0).abs() < 2e-3, "order {order}: {kept} {lack}");
            }
        }
    }

    #[test]
    fn all_wavelengths_are_reduced_or_none() {
        assert_eq!(MediumReduction::of(&curve([0.0, 0.9, 0.9]), 1), None);
        assert_eq!(MediumReduction::of(&curve([0.9, 0.9, -0.5]), 2), None);
    }
}
