//! Where a sphere scatters light to.
//!
//! ```text
//! S_1 = sum (2n+1)/(n(n+1)) (a_n pi_n + b_n tau_n)     S_2 = sum (2n+1)/(n(n+1)) (a_n tau_n + b_n pi_n)    (1)
//! pi_(n+1) = ((2n+1) mu pi_n - (n+1) pi_(n-1)) / n     tau_n = n mu pi_n - (n+1) pi_(n-1)                  (2)
//! p = (|S_1|^2 + |S_2|^2) / (4 pi sum (2n+1) (|a_n|^2 + |b_n|^2))                                          (3)
//! ```
//!
//! mu is the cosine of the angle of scattering. (1) is `[BOHREN83 eq. 4.74]`, (2) `[BOHREN83 eq. 4.47]`.

use num_complex::Complex64;

use super::Coefficients;

impl Coefficients {
    /// S_1 and S_2 of (1): light polarised at right angles to the plane of scattering, and in it.
    pub fn amplitudes(&self, cos: f64) -> [Complex64; 2] {
        let mut amplitudes = [Complex64::ZERO; 2];
        let [mut before, mut pi] = [0.0, 1.0];
        for (i, &[a, b]) in self.terms.iter().enumerate() {
            let n = i as f64 + 1.0;
            let tau = n * cos * pi - (n + 1.0) * before; // (2)
            let weight = (2.0 * n + 1.0) / (n * (n + 1.0));
            amplitudes[0] += weight * (a * pi + b * tau); // (1)
            amplitudes[1] += weight * (a * tau + b * pi); // (1)
            (before, pi) = (pi, ((2.0 * n + 1.0) * cos * pi - (n + 1.0) * before) / n); // (2)
        }
        amplitudes
    }

    /// Phase function per steradian of unpolarised light, (3), at some cosines.
    pub fn phase_function(&self, cosines: &[f64]) -> Vec<f64> {
        let scale = 1.0 / (4.0 * std::f64::consts::PI * self.squares());
        let at = |&cos: &f64| self.amplitudes(cos).iter().map(Complex64::norm_sqr).sum::<f64>() * scale; // (3)
        cosines.iter().map(at).collect()
    }
}
