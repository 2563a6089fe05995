//! Kernels of density estimation: how a photon's flux is spread over a disc of radius r.
//!
//! ```text
//! K(d) = k(d / r) / (pi r^2):   constant k = 1,   cone k = 3 (1 - x),   Epanechnikov k = 2 (1 - x^2)
//! ```
//! Each integrates to 1 over the disc. Their biases are r^2 / 2 times the mean of x^2 under them (1/2, 3/10, 1/3) times
//! half the Laplacian of the density, their variances 1 / (pi r^2 n) times the integral of k^2 (1, 3/2, 4/3)
//! `[SILVERMAN86 section 4.2]`.

use crate::scene::description::KernelKind;

/// k at the square of the relative distance, which is in [0, 1].
#[inline]
pub(super) fn profile(kernel: KernelKind, squared: f32) -> f32 {
    match kernel {
        KernelKind::Constant => 1.0,
        KernelKind::Cone => 3.0 * (1.0 - squared.sqrt()),
        KernelKind::Epanechnikov => 2.0 * (1.0 - squared),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integrals over the disc in the variable q = x^2, in which the area is uniform.
    fn mean(f: impl Fn(f64) -> f64) -> f64 {
        let n = 200_000;
        (0..n).map(|i| f((f64::from(i) + 0.5) / f64::from(n))).sum::<f64>() / f64::from(n)
    }

    /// The moments that the module's head states; the midpoint rule on 2e5 cells is right to 1e-6.
    #[test]
    fn kernels_have_their_moments() {
        for (kernel, second, square) in [
            (KernelKind::Constant, 0.5, 1.0),
            (KernelKind::Cone, 0.3, 1.5),
            (KernelKind::Epanechnikov, 1.0 / 3.0, 4.0 / 3.0),
        ] {
            let k = |q: f64| f64::from(profile(kernel, q as f32));
            assert!((mean(k) - 1.0).abs() < 1e-5, "{kernel:?}");
            assert!((mean(|q| q * k(q)) - second).abs() < 1e-5, "{kernel:?}");
            assert!((mean(|q| k(q) * k(q)) - square).abs() < 1e-5, "{kernel:?}");
            assert!(profile(kernel, 1.0) >= 0.0);
        }
    }
}
