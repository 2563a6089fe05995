//! Media that are computed from what is in them: their coefficients and phase functions as paths look them up.
//!
//! Lorenz-Mie theory is worked out every few nanometres, where spheres of many sizes are smooth over wavelength. What the
//! host absorbs is not, and is taken at every nanometre.

use super::description::{Model, ModelPhase};
use crate::optics::particles::{Bulk, Cache, MixtureError, Scattering};
use crate::optics::phase::{Isotropic, MediumPhase, PhaseFunction, SpectralPhase};
use crate::spectrum::cie::{NANOMETRES, nanometre};
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
    let (lambda, particles) = (single(&bulk.wavelengths), single(&particles));
    let host = model.mixture.host.absorption.prepare(Role::Coefficient, LaneMode::Spectral);
    let at = |i: usize| {
        let path = Wavelengths { lambda: [nanometre(i) as f32; 4], pdf: [1.0; 4] };
        // Particles in a host that absorbs may take away from what it would absorb in their place.
        (host.lanes(&path).x + interpolate(&lambda, &particles, nanometre(i)) as f32).max(0.0)
    };
    Spectrum::Table {
        wavelengths: (0..NANOMETRES).map(|i| nanometre(i) as f32).collect(),
        values: (0..NANOMETRES).map(at).collect(),
    }
}

fn table(wavelengths: &[f64], values: &[f64]) -> Spectrum {
    Spectrum::Table { wavelengths: single(wavelengths), values: single(values) }
}

fn single(values: &[f64]) -> Vec<f32> {
    values.iter().map(|value| *value as f32).collect()
}
