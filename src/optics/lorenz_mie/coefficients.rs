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
//!
//! One sphere and many side by side go the same way; a sphere has the same bits in any company.

use num_complex::Complex64;

use super::bessel::{Waves, beginning, deviations};
use super::lanes::{Lanes, choose, minus, plus, scaled, square, times};
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
        let mut side_by_side = SideBySide::<1>::default();
        side_by_side.compute(&[sphere]);
        let terms = side_by_side.terms.iter().map(|[a, b]| [a.at(0), b.at(0)]).collect();
        Self { sphere, terms }
    }

    /// a_n and b_n, from n = 1 on.
    pub fn terms(&self) -> &[[Complex64; 2]] {
        &self.terms
    }
}

/// Coefficients of as many spheres as there are lanes, and the memory to compute them in.
#[derive(Debug, Default)]
pub(super) struct SideBySide<const N: usize> {
    of_host: Vec<Lanes<N>>,
    of_particle: Vec<Lanes<N>>,
    /// a_n and b_n, from n = 1 on as far as any of the spheres has some; 0 where a sphere has no more.
    pub terms: Vec<[Lanes<N>; 2]>,
}

impl<const N: usize> SideBySide<N> {
    /// Puts the coefficients of these spheres in place of others.
    #[inline(always)]
    pub fn compute(&mut self, spheres: &[Sphere; N]) {
        let (x, y) = (spheres.map(|s| s.x()), spheres.map(|s| s.y()));
        let lasts = spheres.map(|s| s.number_of_terms());
        let last = lasts.iter().copied().max().unwrap_or(0);
        let (mut from_x, mut from_y) = ([0; N], [0; N]);
        for i in 0..N {
            from_x[i] = beginning(x[i], lasts[i]);
            from_y[i] = beginning(y[i], lasts[i]);
        }
        resize(&mut self.of_host, last + 1, Lanes::ZERO);
        resize(&mut self.of_particle, last + 1, Lanes::ZERO);
        resize(&mut self.terms, last, [Lanes::ZERO; 2]);
        let constants = Constants::new(spheres, &lasts);
        let mut waves = Waves::new(&x);
        deviations(&Lanes::of(|i| x[i].inv()), &from_x, &mut self.of_host);
        deviations(&constants.over_y, &from_y, &mut self.of_particle);
        for (i, terms) in self.terms.iter_mut().enumerate() {
            let of_host = [&self.of_host[i], &self.of_host[i + 1]];
            constants.terms(i as f64 + 1.0, &mut waves, of_host, &self.of_particle[i + 1], terms);
        }
    }
}

fn resize<T: Clone>(memory: &mut Vec<T>, length: usize, with: T) {
    memory.clear();
    memory.resize(length, with);
}

/// What (1) and (2) need of the spheres for all n.
struct Constants<const N: usize> {
    m: Lanes<N>,
    over_m: Lanes<N>,
    over_y: Lanes<N>,
    /// (1/m^2 - 1) / x.
    bend: Lanes<N>,
    last: [f64; N],
}

impl<const N: usize> Constants<N> {
    fn new(spheres: &[Sphere; N], lasts: &[usize; N]) -> Self {
        let m = |i: usize| spheres[i].particle() / spheres[i].host();
        let bend = |i: usize| {
            let (host, particle) = (spheres[i].host(), spheres[i].particle());
            (host - particle) * (host + particle) / (particle * particle) / spheres[i].x()
        };
        Self {
            m: Lanes::of(m),
            over_m: Lanes::of(|i| m(i).inv()),
            over_y: Lanes::of(|i| spheres[i].y().inv()),
            bend: Lanes::of(bend),
            last: lasts.map(|last| last as f64),
        }
    }

    /// a_n and b_n, of E_(n-1)(x), E_n(x) and E_n(y).
    #[inline(always)]
    fn terms(
        &self,
        n: f64,
        waves: &mut Waves<N>,
        of_host: [&Lanes<N>; 2],
        of_particle: &Lanes<N>,
        terms: &mut [Lanes<N>; 2],
    ) {
        for i in 0..N {
            waves.step(i, n, of_host[0].at(i));
            let (e_x, e_y) = (of_host[1].at(i), of_particle.at(i));
            let (m, over_m) = (self.m.at(i), self.over_m.at(i));
            let d_y = plus(scaled(self.over_y.at(i), n + 1.0), e_y);
            let n_over_x = scaled(waves.inverse(i), n);
            let bend = scaled(self.bend.at(i), n + 1.0);
            let p_a = times(waves.psi(i), plus(minus(times(e_y, over_m), e_x), bend)); // (2)
            let p_b = times(waves.psi(i), minus(times(e_y, m), e_x)); // (2)
            let q_a = waves.outgoing(i, plus(times(d_y, over_m), n_over_x), p_a);
            let q_b = waves.outgoing(i, plus(times(d_y, m), n_over_x), p_b);
            let (square_a, square_b) = (square(q_a), square(q_b));
            // One division for both. Where the product runs over there is nothing left of either.
            let inverse = 1.0 / (square_a * square_b);
            let is_some = (n <= self.last[i]) & (inverse > 0.0);
            let a = scaled(times(p_a, Complex64::new(q_a.re, -q_a.im)), square_b * inverse); // (1)
            let b = scaled(times(p_b, Complex64::new(q_b.re, -q_b.im)), square_a * inverse); // (1)
            terms[0].set(i, choose(is_some, a, Complex64::ZERO));
            terms[1].set(i, choose(is_some, b, Complex64::ZERO));
        }
    }
}

impl Sphere {
    /// (3)
    pub(super) fn number_of_terms(&self) -> usize {
        let x = magnitude(self.x());
        (x + 6.0 * libm::cbrt(x) + 4.0).ceil() as usize
    }
}
