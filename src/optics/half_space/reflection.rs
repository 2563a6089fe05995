//! What a half space of particles reflects of the light that comes in under a cosine along another one.
//!
//! ```text
//! f_r(mu, mu0) = a / (4 pi) H(mu) H(mu0) / (mu + mu0),     L(mu) = integral of f_r L0 mu0     [CHANDRASEKHAR60 ch. III]
//! integral of f_r mu0 = 1 - s H(mu) = R(mu)                                                  [CHANDRASEKHAR60 ch. V]
//! a = sigma_s* / (sigma_s* + sigma_a),   sigma_s* = sigma_s (1 - g),   s = sqrt(1 - a)             [WYMAN89]
//! ```
//! for isotropic scattering, to which other phase functions of mean cosine g are reduced. mu and mu0 are cosines with the
//! normal within the medium, on the side that the light comes from.
//!
//! Lanes of different albedo reflect differently. One lane is chosen in proportion to P R, P being the path's throughput,
//! mu0 is drawn from its f_r mu0, and all lanes are weighted by the balance heuristic:
//!
//! ```text
//! pdf = sum of P f_r mu0 / sum of P R,      weight = f_r mu0 / pdf
//! ```
//! So the weight of lanes that are alike is R, whatever is drawn.

use std::f32::consts::FRAC_1_PI;

use super::incidence::Incidence;
use super::table::HTable;
use crate::optics::medium::{Medium, pick};
use crate::sampling::SampleStream;
use crate::spectrum::{LaneCurve, Lanes, Wavelengths};

/// A medium of which nothing but a half space is to be seen.
#[derive(Clone, Debug, PartialEq)]
pub struct HalfSpace {
    /// s = sqrt(1 - a).
    rest: LaneCurve,
}

/// The same at the wavelengths of a path.
#[derive(Clone, Copy, Debug)]
pub struct HalfSpaceLanes {
    rest: Lanes,
}

/// What it reflects along one cosine.
#[derive(Clone, Copy, Debug)]
pub struct Reflection {
    table: &'static HTable,
    rest: Lanes,
    mu: f32,
    /// a / (4 pi) H(mu).
    scale: Lanes,
    /// R: what it reflects of even light.
    pub reflectance: Lanes,
}

impl HalfSpace {
    /// What is similar to a medium and scatters isotropically.
    pub fn of(medium: &Medium) -> Self {
        let rest = |s: f32, a: f32| if s > 0.0 { (a / (a + s)).sqrt() } else { 1.0 };
        Self { rest: medium.reduced_scattering().combined(&medium.sigma_a, rest) }
    }

    /// At the wavelengths of a path.
    pub fn lanes(&self, wavelengths: &Wavelengths) -> HalfSpaceLanes {
        HalfSpaceLanes { rest: self.rest.lanes(wavelengths) }
    }
}

impl HalfSpaceLanes {
    /// What is reflected along the cosine `mu`.
    pub fn along(&self, mu: f32) -> Reflection {
        let table = HTable::get();
        let h = table.at(self.rest, mu);
        let albedo = (Lanes::ONE - self.rest) * (Lanes::ONE + self.rest);
        let reflectance = (Lanes::ONE - self.rest * h).max(Lanes::ZERO);
        Reflection { table, rest: self.rest, mu, scale: albedo * h * (0.25 * FRAC_1_PI), reflectance }
    }
}

impl Reflection {
    /// f_r mu0 in 1/sr.
    pub fn value(&self, mu0: f32) -> Lanes {
        let share = mu0 / (self.mu + mu0).max(f32::MIN_POSITIVE);
        self.scale * self.table.at(self.rest, mu0) * share
    }

    /// Density per solid angle with which a path of this throughput draws a direction of this cosine.
    pub fn pdf_w(&self, mu0: f32, throughput: Lanes) -> f32 {
        let whole = throughput.dot(self.reflectance);
        if whole > 0.0 { throughput.dot(self.value(mu0)) / whole } else { 0.0 }
    }

    /// A cosine drawn with `u`, and the weight that the path takes; `None` where nothing is reflected.
    pub fn sample(&self, throughput: Lanes, u: f32, stream: &mut SampleStream) -> Option<(f32, Lanes)> {
        let shares = throughput * self.reflectance;
        let whole = shares.element_sum();
        if whole.is_nan() || whole <= 0.0 {
            return None;
        }
        let (lane, u) = pick(shares / whole, u);
        let rest = self.rest[lane];
        let h = |x: f32| self.table.in_lane(rest, x);
        let mu0 = Incidence::new(rest, self.mu).draw(u, stream, h);
        let value = self.value(mu0);
        // The table is 1 but for its rounding where nothing is scattered: what is reflected there is 0, and R may not be.
        let own = throughput.dot(value);
        (own > 0.0).then(|| (mu0, value * (whole / own)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::SampleSeed;
    use glam::Vec4;

    /// Lanes that absorb nothing, little, much and all.
    const REST: Vec4 = Vec4::new(0.0, 3.2e-4, 0.5, 1.0);
    const COSINES: [f32; 5] = [1.0, 0.6, 0.2, 0.01, 1e-6];

    fn along(mu: f32) -> Reflection {
        HalfSpaceLanes { rest: REST }.along(mu)
    }

    /// The integral of f_r mu0 over the cosine, by the midpoint rule in its square root: measured 2e-6 off.
    #[test]
    fn what_is_reflected_sums_to_the_reflectance() {
        for mu in COSINES {
            let n = 20_000;
            let mut sum = Vec4::ZERO.as_dvec4();
            for i in 0..n {
                let root = (i as f32 + 0.5) / n as f32;
                sum += (along(mu).value(root * root) * (2.0 * root)).as_dvec4();
            }
            let total = sum * 2.0 * std::f64::consts::PI / f64::from(n);
            let off = (total - along(mu).reflectance.as_dvec4()).abs().max_element();
            assert!(off < 1e-5, "mu {mu}: {total}, not {}", along(mu).reflectance);
        }
    }

    /// Helmholtz: f_r is the same both ways.
    #[test]
    fn reflection_is_reciprocal() {
        for (mu, mu0) in COSINES.into_iter().flat_map(|mu| COSINES.map(|mu0| (mu, mu0))) {
            let there = along(mu).value(mu0) / mu0;
            let back = along(mu0).value(mu) / mu;
            assert!((there - back).abs().cmple(1e-6 * there).all(), "{mu} {mu0}: {there} {back}");
        }
    }

    /// Drawn directions of every path weigh what is reflected over their density, and lanes alike the reflectance.
    #[test]
    fn weights_are_values_over_densities() {
        for (i, mu) in (0..).zip(COSINES) {
            for (j, throughput) in (0..).zip([Vec4::new(0.2, 1.0, 0.5, 0.1), Vec4::X, Vec4::Y, Vec4::Z]) {
                let mut stream = SampleStream::new(SampleSeed::new(1), i, j, 0);
                for _ in 0..100 {
                    let u = stream.next4()[0];
                    let Some((mu0, weight)) = along(mu).sample(throughput, u, &mut stream) else {
                        panic!("{mu} reflects nothing");
                    };
                    let expected = along(mu).value(mu0) / along(mu).pdf_w(mu0, throughput);
                    assert!((weight - expected).abs().cmple(1e-5 * expected).all(), "{weight} {expected}");
                    if throughput == Vec4::X {
                        let lost = 1.0 - weight.x;
                        assert!(lost.abs() <= f32::EPSILON, "{lost} is lost where nothing is absorbed");
                    }
                }
            }
        }
        let mut stream = SampleStream::new(SampleSeed::new(1), 0, 0, 0);
        for mu in (0..=1000).map(|i| i as f32 / 1000.0) {
            assert!(along(mu).sample(Vec4::W, 0.5, &mut stream).is_none(), "mu {mu}: nothing is reflected");
        }
    }
}
