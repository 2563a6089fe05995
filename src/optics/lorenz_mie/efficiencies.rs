//! What a sphere takes out of a beam, in units of its own shadow.
//!
//! ```text
//! Q_ext  = 2/(kr)^2 Re sum (2n+1) (a_n + b_n) / n_h^2                                                 (1)
//! Q_sca  = 2/|x|^2 exp(-alpha)/gamma sum (2n+1) (|a_n|^2 + |b_n|^2)                                   (2)
//! alpha  = 2 Im x,   gamma = 2 (1 + (alpha - 1) exp(alpha)) / alpha^2                                 (3)
//! Q_back = |sum (2n+1) (-1)^n (a_n - b_n)|^2 / |x|^2                                                  (4)
//! g      = 2 sum (n(n+2)/(n+1) Re(a_n a*_(n+1) + b_n b*_(n+1)) + (2n+1)/(n(n+1)) Re(a_n b*_n))
//!          / sum (2n+1) (|a_n|^2 + |b_n|^2)                                                           (5)
//! ```
//!
//! (1), (2) without its factor, (4) and (5) are `[BOHREN83 eq. 4.61, 4.62, 4.82 and section 4.5]`; the factor accounts for a
//! host that absorbs `[FRISVAD07]`. There Q_ext may be negative: the sphere takes the place of what absorbs more, and
//! what a medium absorbs altogether has to count its host.

use super::lanes::{Lanes, dot, minus, plus, scaled, square};
use super::{Coefficients, Sphere};

/// Cross sections over pi r^2, and how far scattering goes on forwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Efficiencies {
    /// Q_ext, (1).
    pub extinction: f64,
    /// Q_sca, (2).
    pub scattering: f64,
    /// Q_back, (4): 4 pi times the light scattered straight back per solid angle, for incident light of 1.
    pub backward: f64,
    /// g, (5): mean cosine of the angle of scattering.
    pub asymmetry: f64,
}

impl Coefficients {
    /// (1) to (5).
    pub fn efficiencies(&self) -> Efficiencies {
        let efficiencies = self.sums().efficiencies(0, &self.sphere);
        debug_assert!(self.is_balanced(&efficiencies), "{:?}: {efficiencies:?}", self.sphere);
        efficiencies
    }

    /// Sum of (2n+1) (|a_n|^2 + |b_n|^2).
    pub(super) fn squares(&self) -> f64 {
        self.sums().squares[0]
    }

    fn sums(&self) -> Sums<1> {
        let mut sums = Sums::new();
        for (i, terms) in self.terms.iter().enumerate() {
            sums.add(i as f64 + 1.0, &terms.map(|term| Lanes::of(|_| term)));
        }
        sums
    }

    /// Energy is neither made nor lost, and extinction is what the forward amplitude says (the optical theorem).
    fn is_balanced(&self, found: &Efficiencies) -> bool {
        let (size, host) = (self.sphere.size(), self.sphere.host());
        let [forward, _] = self.amplitudes(1.0);
        let by_amplitude = 4.0 / (size * size) * (forward / (host * host)).re;
        // Sums of so many numbers, of which each may be off by its last bit.
        let rounding =
            1e-15 * self.terms.len() as f64 * found.extinction.abs().max(found.scattering) + 1e-300;
        let theorem = (by_amplitude - found.extinction).abs() <= 100.0 * rounding;
        let energy =
            host.im > 0.0 || found.scattering <= found.extinction + 1e-10 * found.extinction + rounding;
        theorem && energy
    }
}

/// The sums of (1) to (5) for spheres side by side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sums<const N: usize> {
    forward: Lanes<N>,
    backward: Lanes<N>,
    /// Sum of (2n+1) (|a_n|^2 + |b_n|^2).
    pub squares: [f64; N],
    products: [f64; N],
    before: [Lanes<N>; 2],
    sign: f64,
}

impl<const N: usize> Sums<N> {
    pub fn new() -> Self {
        let zero = Lanes::ZERO;
        let (squares, products) = ([0.0; N], [0.0; N]);
        Self { forward: zero, backward: zero, squares, products, before: [zero; 2], sign: 1.0 }
    }

    /// Adds the terms of n; n rises from 1.
    #[inline(always)]
    pub fn add(&mut self, n: f64, terms: &[Lanes<N>; 2]) {
        let weight = 2.0 * n + 1.0;
        self.sign = -self.sign;
        let signed = self.sign * weight;
        let within = weight / (n * (n + 1.0));
        // That of the pair of n - 1 and n.
        let across = (n - 1.0) * (n + 1.0) / n;
        for i in 0..N {
            let (a, b) = (terms[0].at(i), terms[1].at(i));
            let (a_before, b_before) = (self.before[0].at(i), self.before[1].at(i));
            self.forward.set(i, plus(self.forward.at(i), scaled(plus(a, b), weight)));
            self.backward.set(i, plus(self.backward.at(i), scaled(minus(a, b), signed)));
            self.squares[i] += weight * (square(a) + square(b));
            self.products[i] += within * dot(a, b) + across * (dot(a_before, a) + dot(b_before, b));
            self.before[0].set(i, a);
            self.before[1].set(i, b);
        }
    }

    /// (1) to (5) of the sphere in a lane.
    pub fn efficiencies(&self, lane: usize, sphere: &Sphere) -> Efficiencies {
        let (size, host) = (sphere.size(), sphere.host());
        let area = size * size;
        let (forward, backward, squares) =
            (self.forward.at(lane), self.backward.at(lane), self.squares[lane]);
        Efficiencies {
            extinction: 2.0 / area * (forward / (host * host)).re, // (1)
            scattering: 2.0 / area * squares * host_factor(2.0 * sphere.x().im) / host.norm_sqr(), // (2)
            backward: backward.norm_sqr() / (area * host.norm_sqr()), // (4)
            asymmetry: 2.0 * self.products[lane] / squares,        // (5)
        }
    }
}

/// exp(-alpha) / gamma of (3), which cancels where alpha is small and runs over where it is large.
fn host_factor(alpha: f64) -> f64 {
    if alpha < 0.5 {
        // gamma = 2 sum over j of alpha^j / (j! (j + 2)); the 16th term is below 1e-18.
        let (mut power, mut gamma) = (2.0, 0.0);
        for j in 0..16 {
            gamma += power / (f64::from(j) + 2.0);
            power *= alpha / (f64::from(j) + 1.0);
        }
        libm::exp(-alpha) / gamma
    } else {
        alpha * alpha * libm::exp(-2.0 * alpha) / (2.0 * (libm::exp(-alpha) + alpha - 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factor_of_the_host_is_smooth() {
        assert_eq!(host_factor(0.0), 1.0);
        let direct = |alpha: f64| {
            let gamma = 2.0 * (1.0 + (alpha - 1.0) * alpha.exp()) / (alpha * alpha);
            (-alpha).exp() / gamma
        };
        // At 0.1 the direct form has lost two digits.
        for alpha in [0.1, 0.3, 0.49999, 0.50001, 1.0, 20.0] {
            assert!((host_factor(alpha) / direct(alpha) - 1.0).abs() < 1e-13, "{alpha}");
        }
        assert!(host_factor(300.0) > 0.0);
    }
}
