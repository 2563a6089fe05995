//! Media that are computed from what is in them: their coefficients and phase functions as paths look them up.
//!
//! Lorenz-Mie theory is worked out every few nanometres, where spheres of many sizes are smooth over wavelength. What the
//! host absorbs is not, and is taken at every nanometre.

use super::description::{Model, ModelPhase};
use crate::optics::particles::{Bulk, Cache, MixtureError, Scattering};
use crate::optics::phase::{Isotropic, MediumPhase, PhaseFunction, SpectralPhase};
use crate::spectrum::cie::nanometres;
use crate::spectrum::curve::interpolate;
use crate::spectrum::{LaneCurve, LaneMode, Role, Spectrum, Wavelengths};

/// Absorption and scattering in 1/m, and whereto is scattered.
pub(super) fn light_in(model: &Model, mode: LaneMode) -> Result<([LaneCurve; 2], MediumPhase), MixtureError> {
    let Scattering { bulk, phase } = model.mixture.scattering(&Cache::of_user())?;
    let phase = match &model.phase {
        ModelPhase::LorenzMie => {
            SpectralPhase::tabulated(&phase.wavelengths, &phase.angles, &phase.values).map(MediumPhase::from)
        }
        ModelPhase::HenyeyGreenstein => {
            SpectralPhase::henyey_greenstein(table(&bulk.wavelengths, &bulk.g)).map(MediumPhase::from)
        }
        ModelPhase::Given(phase) => Some(phase.clone()),
    };
    // Where nothing scatters there is no phase function, and none is needed.
    let phase = phase.unwrap_or_else(|| PhaseFunction::Isotropic(Isotropic).into());
    let curves = [absorbed(model, &bulk), table(&bulk.wavelengths, &bulk.sigma_s)];
    Ok((curves.map(|curve| curve.prepare(Role::Coefficient, mode)), phase))
}

/// The host's absorption at every nanometre with that of the particles in between the wavelengths of `bulk`.
fn absorbed(model: &Model, bulk: &Bulk) -> Spectrum {
    let of_species = |i: usize| bulk.species.iter().map(|s| s.sigma_t[i] - s.sigma_s[i]).sum::<f64>();
    let particles: Vec<f64> = (0..bulk.wavelengths.len()).map(of_species).collect();
    let host = model.mixture.host.absorption.prepare(Role::Coefficient, LaneMode::Spectral);
    Spectrum::tabulated(nanometres(), |lambda| {
        let of_host = f64::from(host.lanes(&Wavelengths::single(lambda as f32)).x);
        // Particles in a host that absorbs may take away from what it would absorb in their place.
        (of_host + interpolate(&bulk.wavelengths, &particles, lambda)).max(0.0)
    })
}

fn table(wavelengths: &[f64], values: &[f64]) -> Spectrum {
    Spectrum::tabulated(wavelengths.iter().copied(), |lambda| interpolate(wavelengths, values, lambda))
}
