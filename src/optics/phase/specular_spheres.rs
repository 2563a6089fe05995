//! Spheres much larger than the wavelength whose surface is a mirror.
//!
//! ```text
//! p = rho((pi - theta) / 2) / (4 pi rho_h),   rho_h = 2 integral over [0, 1] of rho(mu) mu dmu
//! ```
//! rho is Fresnel's reflectivity of unpolarised light; light that meets the sphere at the angle of incidence i is turned
//! by theta = pi - 2 i, and cos i = sin(theta / 2) = sqrt((1 - cos) / 2). What is refracted into the sphere is taken as
//! lost; the scattering coefficient says how much is reflected. Samples come from a table through the values; their
//! weights are within 0.1 % of 1, but for 0.88 to 1.41 in the cell of bubbles' critical angle, where rho has a kink.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::DVec4;

use super::Lobe;
use super::angle_table::{AngleTable, integral};
use super::deflection::Deflection;
use crate::optics::fresnel;

/// The phase function of large mirroring spheres.
#[derive(Clone, Debug, PartialEq)]
pub struct SpecularSpheres {
    eta: f32,
    k: f32,
    /// 1 / (4 pi rho_h).
    scale: f32,
    mean_cosine: f32,
    table: Arc<AngleTable>,
}

impl SpecularSpheres {
    /// Spheres of the index `eta + i k` relative to the medium; `None` when they reflect nothing or the index is not
    /// one.
    pub fn new(eta: f32, k: f32) -> Option<Self> {
        if !(eta > 0.0 && k >= 0.0 && eta.is_finite() && k.is_finite()) {
            return None;
        }
        let table = AngleTable::of(|d| reflectance(eta, k, cos_i(d)))?;
        let (rho_h, mean) = moments(eta, k);
        Some(Self {
            eta,
            k,
            scale: (0.25 / (PI * rho_h)) as f32,
            mean_cosine: mean as f32,
            table: Arc::new(table),
        })
    }
}

impl Lobe for SpecularSpheres {
    fn value(&self, deflection: Deflection) -> f32 {
        self.scale * reflectance(self.eta, self.k, cos_i(deflection)) as f32
    }

    fn table(&self) -> Option<&AngleTable> {
        Some(&self.table)
    }

    fn sample(&self, u: f32) -> Deflection {
        self.table.sample(u)
    }

    fn mean_cosine(&self) -> f32 {
        self.mean_cosine
    }
}

/// rho_h and the mean cosine.
///
/// Over x = mu^2 - c, c = cos^2 of the critical angle (0 where there is none): below it all is reflected, above it the
/// reflectance is a smooth function of the root of x.
fn moments(eta: f32, k: f32) -> (f64, f64) {
    let eta_squared = f64::from(eta) * f64::from(eta);
    let critical = if k == 0.0 { (1.0 - eta_squared).max(0.0) } else { 0.0 };
    let rest = 1.0 - critical;
    let reflectance = |x: f64| reflectance(eta, k, (critical + rest * x).sqrt());
    let rho_h = critical + rest * integral(reflectance);
    let mean = critical - critical * critical
        + rest * integral(|x| (1.0 - 2.0 * (critical + rest * x)) * reflectance(x));
    (rho_h, mean / rho_h)
}

/// Cosine of the angle of incidence.
fn cos_i(deflection: Deflection) -> f64 {
    (0.5 * f64::from(deflection.one_minus_cos())).sqrt()
}

fn reflectance(eta: f32, k: f32, cos_i: f64) -> f64 {
    if k == 0.0 {
        return fresnel::dielectric_amplitudes(cos_i, f64::from(eta))
            .map_or(1.0, |a| 0.5 * (a.r_s * a.r_s + a.r_p * a.r_p));
    }
    let (s, p) =
        fresnel::conductor_polarised(cos_i, DVec4::splat(f64::from(eta)), DVec4::splat(f64::from(k)));
    0.5 * (s.x + p.x)
}
