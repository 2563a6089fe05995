//! Computes what a report says.

use super::{Colour, Column, MediumReport, MediumStudy, Subject, phase};
use crate::optics::RefractiveIndex;
use crate::optics::apparent::{backscattered_share, diffuse_attenuation, reflectance};
use crate::optics::half_space::h_function::HFunction;
use crate::optics::medium::Medium;
use crate::optics::particles::{Bulk, Cache, EnsemblePhase, MixtureError, Scattering};
use crate::scene::description::ModelPhase;
use crate::spectrum::curve::interpolate;
use crate::spectrum::{LaneCurve, Wavelengths};

/// Wavelengths in nm at which colours are computed where nothing else says them; what lies between is linear.
const STEP: usize = 5;

impl MediumStudy {
    /// Computes it, with the scattering of particles from the cache where that has it.
    ///
    /// # Errors
    /// What is wrong with a mixture.
    pub fn run(&self, cache: &Cache) -> Result<MediumReport, MixtureError> {
        let (fine, bulk, phase, was_kept) = match &self.subject {
            Subject::Mixture { mixture, phase } => {
                let (Scattering { bulk: mut fine, phase: computed }, was_kept) =
                    mixture.scattering_kept(cache)?;
                let mut bulk = match fine.at(&self.wavelengths) {
                    Some(bulk) => bulk,
                    None => mixture.bulk(&self.wavelengths)?,
                };
                let phase = match phase {
                    ModelPhase::LorenzMie => computed,
                    ModelPhase::HenyeyGreenstein => phase::one_lobe(&fine.wavelengths, &fine.g),
                    ModelPhase::Given(given) => {
                        for bulk in [&mut fine, &mut bulk] {
                            bulk.g = over(&given.mean_cosine(), &bulk.wavelengths);
                        }
                        phase::tabulated(given)
                    }
                };
                (fine, bulk, phase, was_kept)
            }
            Subject::Given { index, medium } => {
                let visible: Vec<f64> = (380..=780).step_by(STEP).map(f64::from).collect();
                let [fine, bulk] = [&visible, &self.wavelengths].map(|at| given(index, medium, at));
                (fine, bulk, phase::tabulated(&medium.phase), false)
            }
        };
        Ok(MediumReport { was_kept, ..self.report(&fine, bulk, phase) })
    }

    /// `fine` is what colours are of.
    fn report(&self, fine: &Bulk, bulk: Bulk, phase: EnsemblePhase) -> MediumReport {
        let [seen, told] = [fine, &bulk].map(|bulk| Apparent::of(bulk, &phase));
        let over = |values: Vec<f64>| move |lambda: f64| interpolate(&fine.wavelengths, &values, lambda);
        let extinction = over(sums(&fine.sigma_a, &fine.sigma_s));
        let attenuation = over(seen.attenuation);
        let column = Column {
            length: self.column,
            straight: Colour::dimmed(|lambda| extinction(lambda) * self.column),
            diffuse: Colour::dimmed(|lambda| attenuation(lambda) * self.column),
        };
        let sigma_t = sums(&bulk.sigma_a, &bulk.sigma_s);
        let pairs = bulk.sigma_s.iter().zip(&sigma_t);
        let albedo = pairs.map(|(s, t)| if *t > 0.0 { s / t } else { 0.0 }).collect();
        MediumReport {
            medium: self.name.clone(),
            reduced_sigma_s: bulk.sigma_s.iter().zip(&bulk.g).map(|(s, g)| s * (1.0 - g)).collect(),
            backscattering: told.backscattering,
            diffuse_attenuation: told.attenuation,
            reflectance: told.reflectance,
            wavelengths: bulk.wavelengths,
            n: bulk.n,
            sigma_a: bulk.sigma_a,
            sigma_s: bulk.sigma_s,
            g: bulk.g,
            sigma_t,
            albedo,
            species: bulk.species,
            quadrature_error: bulk.relative_error.max(fine.relative_error),
            column,
            depth: Colour::reflected(over(seen.reflectance)),
            warnings: self.warnings.clone(),
            phase,
            was_kept: false,
        }
    }
}

/// What follows from coefficients, at each wavelength.
struct Apparent {
    backscattering: Vec<f64>,
    attenuation: Vec<f64>,
    reflectance: Vec<f64>,
}

impl Apparent {
    fn of(bulk: &Bulk, phase: &EnsemblePhase) -> Self {
        let h = HFunction::default();
        let shares: Vec<f64> = phase.values.iter().map(|v| backscattered_share(&phase.angles, v)).collect();
        let mut found = Self { backscattering: Vec::new(), attenuation: Vec::new(), reflectance: Vec::new() };
        for (i, lambda) in bulk.wavelengths.iter().enumerate() {
            let share = interpolate(&phase.wavelengths, &shares, *lambda);
            let (a, s, g) = (bulk.sigma_a[i], bulk.sigma_s[i], bulk.g[i]);
            found.backscattering.push(share * s);
            found.attenuation.push(diffuse_attenuation(a, s, g));
            found.reflectance.push(reflectance(a, s, g, share, &h));
        }
        found
    }
}

/// A medium whose coefficients are given, as rays meet it.
fn given(index: &RefractiveIndex, medium: &Medium, wavelengths: &[f64]) -> Bulk {
    let over = |curve: &LaneCurve| over(curve, wavelengths);
    Bulk {
        wavelengths: wavelengths.to_vec(),
        n: wavelengths.iter().map(|lambda| index.n(*lambda)).collect(),
        sigma_a: over(&medium.sigma_a),
        sigma_s: over(&medium.sigma_s),
        g: over(&medium.phase.mean_cosine()),
        species: Vec::new(),
        relative_error: 0.0,
    }
}

fn over(curve: &LaneCurve, wavelengths: &[f64]) -> Vec<f64> {
    let at = |lambda: &f64| {
        let path = Wavelengths { lambda: [*lambda as f32; 4], pdf: [1.0; 4] };
        f64::from(curve.lanes(&path).x)
    };
    wavelengths.iter().map(at).collect()
}

fn sums(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}
