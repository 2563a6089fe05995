//! The Riccati-Bessel functions of Lorenz-Mie theory, in the forms in which they keep their digits.
//!
//! ```text
//! psi_n(z) = z j_n(z)     chi_n(z) = -z y_n(z)     xi_n(z) = z h_n(z) = psi_n - i chi_n              (1)
//! D_n = psi_n' / psi_n = (n+1)/z + E_n,   E_n = -1 / ((n+1)/z + D_(n+1))                             (2)
//! psi_n / psi_(n-1) = 1 / (n/z + D_n) = -E_(n-1)                                                     (3)
//! f_(n+1) = (2n+1)/z f_n - f_(n-1)        of all of (1)                                              (4)
//! ```
//!
//! (2) is `[BOHREN83 eq. 4.89]` and goes down in n: upward it loses all digits where z absorbs or n > |z|. Downward it
//! forgets how it began, but not before n has come to |z|, so it begins well above |z| whatever number of terms is asked
//! for. E_n is what is kept: where |z| is small D_n has lost it, and differences of two D_n are made of it.
//!
//! psi goes by (3): its errors are small relative to it and add up like a random walk, while those of (4) grow with every
//! step where n > |z|. Only a psi_(n-1) that is next to 0 says little of the one after it: that one comes by (4), in which
//! psi_(n-2) has all the weight. This makes x = 1e5 as exact as x = 10. chi and xi grow with n, so (4) is stable for them.

use num_complex::Complex64;

use super::lanes::{Lanes, choose, minus, plus, scaled, square, times};
use super::sphere::magnitude;

const I: Complex64 = Complex64::new(0.0, 1.0);

/// Im z up to which xi is made of psi and chi. The difference loses exp(2 Im z); but only psi and chi apart tell the small
/// real part of a coefficient from its large imaginary part where particles are small.
const NEARLY_REAL: f64 = 1.0;

/// Square of the ratio of one psi to the one before it below which the next does not come from it alone.
const NEXT_TO_NONE: f64 = 0.01;

/// Where the way down begins that is to have come to E_n for all n up to `last`.
pub(super) fn beginning(z: Complex64, last: usize) -> usize {
    let size = magnitude(z);
    // From 8 |z|^(1/3) + 16 terms above |z| nothing of the beginning is left; half of that would leave 1e-10.
    last.max((size + 8.0 * libm::cbrt(size)) as usize) + 16
}

/// E_n(z) of (2) for each n of `kept`, of 1/z in every lane. A lane begins at its own place, whatever the others do.
#[inline(always)]
pub(super) fn deviations<const N: usize>(inverse: &Lanes<N>, beginnings: &[usize; N], kept: &mut [Lanes<N>]) {
    let from = beginnings.iter().copied().max().unwrap_or(0);
    let begin = beginnings.map(|n| n as f64);
    let (mut next, mut unused) = (Lanes::ZERO, Lanes::ZERO);
    for n in (kept.len()..from).rev() {
        descend(n as f64 + 1.0, inverse, &begin, &mut next, &mut unused);
    }
    for (n, place) in kept.iter_mut().enumerate().rev() {
        descend(n as f64 + 1.0, inverse, &begin, &mut next, place);
    }
}

/// From D_n in `next` to E_(n-1), and D_(n-1) in its place.
#[inline(always)]
fn descend<const N: usize>(
    n: f64,
    inverse: &Lanes<N>,
    begin: &[f64; N],
    next: &mut Lanes<N>,
    place: &mut Lanes<N>,
) {
    for (i, begin) in begin.iter().enumerate() {
        let ratio = scaled(inverse.at(i), n);
        let sum = plus(ratio, next.at(i));
        let scale = 1.0 / square(sum);
        let deviation = Complex64::new(-sum.re * scale, sum.im * scale); // (2)
        place.set(i, deviation);
        next.set(i, choose(n <= *begin, plus(ratio, deviation), Complex64::ZERO));
    }
}

/// psi_n, and chi_n or xi_n, one n after the other from 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Waves<const N: usize> {
    inverse: Lanes<N>,
    /// |z| where z is nearly real, else 0.
    turn: [f64; N],
    psi: [Lanes<N>; 2],
    other: [Lanes<N>; 2],
}

impl<const N: usize> Waves<N> {
    pub fn new(z: &[Complex64; N]) -> Self {
        let is_nearly_real = |i: usize| z[i].im.abs() <= NEARLY_REAL;
        let mut turn = [0.0; N];
        let (mut psi, mut other) = ([Lanes::ZERO; 2], [Lanes::ZERO; 2]);
        for i in 0..N {
            let (sin, cos) = sin_cos(z[i]);
            let outward = exp_i(z[i]);
            // The functions of n = -1 and of n = 0.
            let [before, now] = if is_nearly_real(i) { [-sin, cos] } else { [outward, -I * outward] };
            psi[0].set(i, cos);
            psi[1].set(i, sin);
            other[0].set(i, before);
            other[1].set(i, now);
            turn[i] = if is_nearly_real(i) { magnitude(z[i]) } else { 0.0 };
        }
        Self { inverse: Lanes::of(|i| z[i].inv()), turn, psi, other }
    }

    /// 1/z.
    #[inline(always)]
    pub fn inverse(&self, lane: usize) -> Complex64 {
        self.inverse.at(lane)
    }

    /// Goes on to n, of which E_(n-1) is given.
    #[inline(always)]
    pub fn step(&mut self, lane: usize, n: f64, deviation: Complex64) {
        let factor = scaled(self.inverse.at(lane), 2.0 * n - 1.0);
        let [before, psi] = [self.psi[0].at(lane), self.psi[1].at(lane)];
        let is_next_to_none = square(psi) < NEXT_TO_NONE * square(before);
        let upward = minus(times(factor, psi), before); // (4)
        let onward = times(psi, Complex64::new(-deviation.re, -deviation.im)); // (3)
        self.psi[0].set(lane, psi);
        self.psi[1].set(lane, choose(is_next_to_none & (n < self.turn[lane]), upward, onward));
        let [before, other] = [self.other[0].at(lane), self.other[1].at(lane)];
        self.other[0].set(lane, other);
        self.other[1].set(lane, minus(times(factor, other), before)); // (4)
    }

    /// psi_n.
    #[inline(always)]
    pub fn psi(&self, lane: usize) -> Complex64 {
        self.psi[1].at(lane)
    }

    /// f xi_n - xi_(n-1), where p = f psi_n - psi_(n-1) is known without its cancellation.
    #[inline(always)]
    pub fn outgoing(&self, lane: usize, f: Complex64, p: Complex64) -> Complex64 {
        let other = minus(times(f, self.other[1].at(lane)), self.other[0].at(lane));
        // p - i other.
        let apart = Complex64::new(p.re + other.im, p.im - other.re);
        choose(self.turn[lane] > 0.0, apart, other)
    }
}

fn exp_i(z: Complex64) -> Complex64 {
    let (sin, cos) = libm::sincos(z.re);
    Complex64::new(cos, sin) * libm::exp(-z.im)
}

fn sin_cos(z: Complex64) -> (Complex64, Complex64) {
    let (sin, cos) = libm::sincos(z.re);
    let (sinh, cosh) = (libm::sinh(z.im), libm::cosh(z.im));
    (Complex64::new(sin * cosh, cos * sinh), Complex64::new(cos * cosh, -sin * sinh))
}
