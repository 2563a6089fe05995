//! The coefficients of the scattered wave.
//!
//! ```text
//! a_n = p_a / ((D_n(y)/m + n/x) xi_n(x) - xi_(n-1)(x))     b_n likewise with m D_n(y)                  (1)
//! p_a = psi_n(x) (E_n(y)/m - E_n(x) + (n+1)/x (1/m^2 - 1))     p_b = psi_n(x) (m E_n(y) - E_n(x))      (2)
//! N = |x| + 6 |x|^(1/3) + 4                                                                            (3)
//! ```
//!
//! (1) is `[BOHREN83 eq. 4.88]`. Its numerators are differences of numbers that are nearly the same where the sphere is
//! small or nearly invisible; (2) are the same with what cancels taken out. (3) has more terms than `[WISCOMBE80]`
//! (4 |x|^(1/3) + 2 beyond |x|), whose 1e-6 in the light that goes straight back become 1e-10.

use num_complex::Complex64;

use super::bessel::{Waves, deviations};
use super::sphere::{Sphere, magnitude};

/// a_n and b_n of a sphere, for n from 1 on.
#[derive(Clone, Debug, PartialEq)]
pub struct Coefficients {
    pub(super) sphere: Sphere,
    pub(super) terms: Vec<[Complex64; 2]>,
}

impl Coefficients {
    /// Those of a sphere. Takes time and memory in proportion to its size: 10 ms at x = 1e5.
    pub fn new(sphere: Sphere) -> Self {
        let (x, y) = (sphere.x(), sphere.y());
        let (host, particle) = (sphere.host(), sphere.particle());
        let m = particle / host;
        let last = number_of_terms(magnitude(x));
        let (of_host, of_particle) = (deviations(x, last), deviations(y, last));
        let (over_m, over_x, over_y) = (m.inv(), x.inv(), y.inv());
        let contrast = (host - particle) * (host + particle) / (particle * particle); // 1/m^2 - 1
        let mut waves = Waves::new(x);
        let terms = (1..=last).map(|index| {
            let n = index as f64;
            let (e_x, e_y) = (of_host[index], of_particle[index]);
            waves.step(e_x);
            let d_y = (n + 1.0) * over_y + e_y;
            let p_a = waves.psi() * (e_y * over_m - e_x + (n + 1.0) * over_x * contrast); // (2)
            let p_b = waves.psi() * (e_y * m - e_x); // (2)
            let a = p_a / waves.outgoing(d_y * over_m + n * over_x, p_a); // (1)
            let b = p_b / waves.outgoing(d_y * m + n * over_x, p_b); // (1)
            [a, b]
        });
        let terms = terms.collect();
        Self { sphere, terms }
    }

    /// a_n and b_n, from n = 1 on.
    pub fn terms(&self) -> &[[Complex64; 2]] {
        &self.terms
    }
}

/// (3)
fn number_of_terms(x: f64) -> usize {
    (x + 6.0 * libm::cbrt(x) + 4.0).ceil() as usize
}
