//! Complex numbers side by side, one of each of several spheres.
//!
//! Whatever is done with them is a loop over the lanes whose body is one lane's arithmetic: compilers make wide registers
//! of that where a processor has them. The operations of a lane are the same on one lane and on many, in the same order and
//! none of them fused, so its bits are the same as well.

use num_complex::Complex64;

/// One complex number a lane.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Lanes<const N: usize> {
    re: [f64; N],
    im: [f64; N],
}

impl<const N: usize> Lanes<N> {
    pub const ZERO: Self = Self { re: [0.0; N], im: [0.0; N] };

    pub fn of(value: impl Fn(usize) -> Complex64) -> Self {
        let mut lanes = Self::ZERO;
        for i in 0..N {
            lanes.set(i, value(i));
        }
        lanes
    }

    #[inline(always)]
    pub fn at(&self, lane: usize) -> Complex64 {
        Complex64::new(self.re[lane], self.im[lane])
    }

    #[inline(always)]
    pub fn set(&mut self, lane: usize, value: Complex64) {
        self.re[lane] = value.re;
        self.im[lane] = value.im;
    }
}

/// One of two numbers, without a branch.
#[inline(always)]
pub(super) fn choose(first: bool, one: Complex64, other: Complex64) -> Complex64 {
    Complex64::new(if first { one.re } else { other.re }, if first { one.im } else { other.im })
}

/// The product. That of [`Complex64`] is the same, but not sure to be compiled into the loop.
#[inline(always)]
pub(super) fn times(a: Complex64, b: Complex64) -> Complex64 {
    Complex64::new(a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re)
}

/// a plus b.
#[inline(always)]
pub(super) fn plus(a: Complex64, b: Complex64) -> Complex64 {
    Complex64::new(a.re + b.re, a.im + b.im)
}

/// a minus b.
#[inline(always)]
pub(super) fn minus(a: Complex64, b: Complex64) -> Complex64 {
    Complex64::new(a.re - b.re, a.im - b.im)
}

/// z times a real number.
#[inline(always)]
pub(super) fn scaled(z: Complex64, factor: f64) -> Complex64 {
    Complex64::new(z.re * factor, z.im * factor)
}

/// |z|^2.
#[inline(always)]
pub(super) fn square(z: Complex64) -> f64 {
    z.re * z.re + z.im * z.im
}

/// Re(a b*).
#[inline(always)]
pub(super) fn dot(a: Complex64, b: Complex64) -> f64 {
    a.re * b.re + a.im * b.im
}
