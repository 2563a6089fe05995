//! Lorenz-Mie coefficients by other ways than the renderer's: slow, and for real hosts and x from 0.1 only.
//!
//! ```text
//! D_n(z) by Lentz' continued fraction, for each n anew          (W. J. Lentz, Applied Optics 15, 1976)
//! chi_n upward,   psi_n (chi_n' - D_n chi_n) = -1               (the Wronskian)
//! a_n, b_n as in C. F. Bohren and D. R. Huffman, eq. 4.88, with nothing rearranged
//! ```

use num_complex::Complex64;

/// D_n(z) = psi_n'(z) / psi_n(z) = -n/z + J_(n-1/2)(z) / J_(n+1/2)(z).
fn logarithmic_derivative(n: usize, z: Complex64) -> Complex64 {
    let term = |k: usize| {
        let sign = if k % 2 == 1 { 1.0 } else { -1.0 };
        sign * (2.0 * (n as f64 + k as f64) - 1.0) / z
    };
    let mut numerator = term(2) + term(1).inv();
    let mut denominator = term(2);
    let mut value = term(1) * numerator / denominator;
    for k in 3.. {
        numerator = term(k) + numerator.inv();
        denominator = term(k) + denominator.inv();
        let factor = numerator / denominator;
        value *= factor;
        if (factor - 1.0).norm_sqr() < 1e-31 {
            break;
        }
    }
    value - n as f64 / z
}

/// Q_ext, Q_sca, Q_back and g of a sphere of relative index `m` and size `x`.
pub fn slow_sphere(m: Complex64, x: f64) -> [f64; 4] {
    let last = (x + 7.0 * x.cbrt() + 6.0) as usize;
    let mut chi = [-x.sin(), x.cos()];
    let mut psi_before = x.sin();
    let mut terms = Vec::new();
    for index in 1..=last {
        let n = index as f64;
        chi = [chi[1], (2.0 * n - 1.0) / x * chi[1] - chi[0]];
        let slope = chi[0] - n / x * chi[1];
        let d_x = logarithmic_derivative(index, x.into()).re;
        let psi = -1.0 / (slope - d_x * chi[1]);
        let xi = Complex64::new(psi, -chi[1]);
        let xi_before = Complex64::new(psi_before, -chi[0]);
        let d_y = logarithmic_derivative(index, m * x);
        let coefficient = |f: Complex64| (f * psi - psi_before) / (f * xi - xi_before);
        terms.push((n, coefficient(d_y / m + n / x), coefficient(m * d_y + n / x)));
        psi_before = psi;
    }
    let sum = |f: &dyn Fn(&(f64, Complex64, Complex64)) -> f64| terms.iter().map(f).sum::<f64>();
    let squares = sum(&|(n, a, b)| (2.0 * n + 1.0) * (a.norm_sqr() + b.norm_sqr()));
    let across = terms.windows(2).map(|pair| {
        let ((n, a, b), (_, a1, b1)) = (pair[0], pair[1]);
        n * (n + 2.0) / (n + 1.0) * (a * a1.conj() + b * b1.conj()).re
    });
    let within = sum(&|(n, a, b)| (2.0 * n + 1.0) / (n * (n + 1.0)) * (a * b.conj()).re);
    let back: Complex64 =
        terms.iter().map(|(n, a, b)| (2.0 * n + 1.0) * if n % 2.0 == 1.0 { b - a } else { a - b }).sum();
    [
        2.0 / (x * x) * sum(&|(n, a, b)| (2.0 * n + 1.0) * (a + b).re),
        2.0 / (x * x) * squares,
        back.norm_sqr() / (x * x),
        2.0 * (across.sum::<f64>() + within) / squares,
    ]
}
