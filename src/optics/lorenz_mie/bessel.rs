//! The Riccati-Bessel functions of Lorenz-Mie theory, in the forms in which they keep their digits.
//!
//! ```text
//! psi_n(z) = z j_n(z)     chi_n(z) = -z y_n(z)     xi_n(z) = z h_n(z) = psi_n - i chi_n              (1)
//! D_n = psi_n' / psi_n = (n+1)/z + E_n,   E_n = -1 / ((n+1)/z + D_(n+1))                             (2)
//! psi_n / psi_(n-1) = 1 / (n/z + D_n)                                                                (3)
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

use super::sphere::magnitude;

const I: Complex64 = Complex64::new(0.0, 1.0);

/// Im z up to which xi is made of psi and chi. The difference loses exp(2 Im z); but only psi and chi apart tell the small
/// real part of a coefficient from its large imaginary part where particles are small.
const NEARLY_REAL: f64 = 1.0;

/// Square of the ratio of one psi to the one before it below which the next does not come from it alone.
const NEXT_TO_NONE: f64 = 0.01;

/// E_n(z) of (2) for n = 0 to `last`.
pub(super) fn deviations(z: Complex64, last: usize) -> Vec<Complex64> {
    let size = magnitude(z);
    // From 8 |z|^(1/3) + 16 terms above |z| nothing of the beginning is left; half of that would leave 1e-10.
    let first = last.max((size + 8.0 * libm::cbrt(size)) as usize) + 16;
    let inverse = z.inv();
    let mut kept = vec![Complex64::ZERO; last + 1];
    let mut next = Complex64::ZERO;
    for n in (0..first).rev() {
        let ratio = (n as f64 + 1.0) * inverse;
        let deviation = -(ratio + next).inv(); // (2)
        next = ratio + deviation;
        if let Some(place) = kept.get_mut(n) {
            *place = deviation;
        }
    }
    kept
}

/// psi_n, and chi_n or xi_n, one n after the other from 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Waves {
    inverse: Complex64,
    size: f64,
    is_nearly_real: bool,
    n: f64,
    psi: [Complex64; 2],
    other: [Complex64; 2],
}

impl Waves {
    pub fn new(z: Complex64) -> Self {
        let (sin, cos) = sin_cos(z);
        let is_nearly_real = z.im.abs() <= NEARLY_REAL;
        let outward = exp_i(z);
        // The functions of n = -1 and of n = 0.
        let other = if is_nearly_real { [-sin, cos] } else { [outward, -I * outward] };
        Self { inverse: z.inv(), size: magnitude(z), is_nearly_real, n: 0.0, psi: [cos, sin], other }
    }

    /// Goes on to the next n, of which E_n is given.
    pub fn step(&mut self, deviation: Complex64) {
        let factor = (2.0 * self.n + 1.0) * self.inverse;
        self.n += 1.0;
        let upward = |f: [Complex64; 2]| [f[1], factor * f[1] - f[0]]; // (4)
        let is_next_to_none = self.psi[1].norm_sqr() < NEXT_TO_NONE * self.psi[0].norm_sqr();
        self.psi = if is_next_to_none && self.is_nearly_real && self.n < self.size {
            upward(self.psi)
        } else {
            [self.psi[1], self.psi[1] / ((2.0 * self.n + 1.0) * self.inverse + deviation)] // (3)
        };
        self.other = upward(self.other);
    }
}

impl Waves {
    /// psi_n.
    pub fn psi(&self) -> Complex64 {
        self.psi[1]
    }

    /// f xi_n - xi_(n-1), where p = f psi_n - psi_(n-1) is known without its cancellation.
    pub fn outgoing(&self, f: Complex64, p: Complex64) -> Complex64 {
        let other = f * self.other[1] - self.other[0];
        if self.is_nearly_real { p - I * other } else { other }
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
