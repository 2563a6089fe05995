//! Elementary functions with the same bits on every machine.
//!
//! The platform's `exp`, `ln`, `sin`, ... differ between C libraries, and a path tracer turns one different bit
//! into a different picture. Whatever reaches a pixel takes these functions instead; `sqrt` is exact in IEEE 754
//! and needs no replacement.

use glam::Vec4;

/// e^x.
#[inline]
pub fn exp(x: f32) -> f32 {
    libm::expf(x)
}

/// Natural logarithm.
#[inline]
pub fn ln(x: f32) -> f32 {
    libm::logf(x)
}

/// -ln(1 - u) for u in [0, 1), a multiple of 2^-24 as random numbers are: relative error below 3e-7, no branch.
///
/// 1 - u is exact then. It is taken apart into 2^e m with m in [sqrt(1/2), sqrt(2)), and ln m = x - x^2 / 2 + x^3 P(x),
/// x = m - 1, with the polynomial of Cephes' `logf`.
#[inline]
pub fn minus_ln_of_rest(u: f32) -> f32 {
    const SQRT_HALF: u32 = std::f32::consts::FRAC_1_SQRT_2.to_bits();
    const LN2_HIGH: f32 = 0.693_359_4;
    const LN2_LOW: f32 = -2.121_944_4e-4;
    let bits = (1.0 - u).to_bits();
    let exponent = (bits as i32 - SQRT_HALF as i32) >> 23;
    let x = f32::from_bits((bits as i32 - (exponent << 23)) as u32) - 1.0;
    let square = x * x;
    // In pairs: one term after the other would take twice as long.
    let pair = |a: f32, b: f32| a * x + b;
    let high = pair(7.037_683_6e-2, -1.151_461e-1) * square + pair(1.167_699_9e-1, -1.242_014_1e-1);
    let low = pair(1.424_932_3e-1, -1.666_805_7e-1) * square + pair(2.000_071_5e-1, -2.499_999_4e-1);
    let p = (high * (square * square) + low) * x + 3.333_333e-1;
    let e = exponent as f32;
    let ln = x + ((x * square * p + e * LN2_LOW) - 0.5 * square) + e * LN2_HIGH;
    -ln
}

/// e^x - 1, exact to rounding near zero.
#[inline]
pub fn exp_m1(x: f32) -> f32 {
    libm::expm1f(x)
}

/// ln(1 + x), exact to rounding near zero.
#[inline]
pub fn ln_1p(x: f32) -> f32 {
    libm::log1pf(x)
}

/// x^y.
#[inline]
pub fn pow(x: f32, y: f32) -> f32 {
    libm::powf(x, y)
}

/// Cube root.
#[inline]
pub fn cbrt(x: f32) -> f32 {
    libm::cbrtf(x)
}

/// Sine and cosine of an angle in radians.
#[inline]
pub fn sin_cos(x: f32) -> (f32, f32) {
    libm::sincosf(x)
}

/// Sine and cosine of 2 pi u for u in [0, 1], without a branch: absolute error below 2e-7.
///
/// The angle's distance to the nearest quarter turn goes into the polynomials of Cephes' `sinf` and `cosf`.
#[inline]
pub fn sin_cos_of_turn(u: f32) -> (f32, f32) {
    let quarters = (4.0 * u + 0.5) as i32;
    let r = (4.0 * u - quarters as f32) * std::f32::consts::FRAC_PI_2;
    let square = r * r;
    let sin = r + r * square * (-0.166_666_55 + square * (8.332_161e-3 - square * 1.951_529_6e-4));
    let cos = 1.0 - 0.5 * square
        + square * square * (4.166_664_6e-2 + square * (-1.388_731_6e-3 + square * 2.443_315_7e-5));
    let (s, c) = if quarters & 1 == 0 { (sin, cos) } else { (cos, sin) };
    // Bit 1 of the quarter is the sign of the sine, that of the next one the sign of the cosine.
    let sign = |value: f32, bit: i32| f32::from_bits(value.to_bits() ^ ((bit as u32 & 2) << 30));
    (sign(s, quarters), sign(c, quarters + 1))
}

/// Tangent.
#[inline]
pub fn tan(x: f32) -> f32 {
    libm::tanf(x)
}

/// Inverse cosine; arguments beyond [-1, 1] by rounding are brought back.
#[inline]
pub fn acos(x: f32) -> f32 {
    libm::acosf(x.clamp(-1.0, 1.0))
}

/// Angle of the point (x, y), in (-pi, pi].
#[inline]
pub fn atan2(y: f32, x: f32) -> f32 {
    libm::atan2f(y, x)
}

/// e^x on four lanes: 0 below -87.3, finite above 88.
///
/// x = n ln 2 + r with |r| <= ln 2 / 2 and e^r by the polynomial of Cephes' `expf`; relative error below 2e-7.
#[inline]
pub fn exp4(x: Vec4) -> Vec4 {
    const LN2_HIGH: f32 = 0.693_359_4;
    const LN2_LOW: f32 = -2.121_944_4e-4;
    let clamped = x.clamp(Vec4::splat(-87.3), Vec4::splat(88.0));
    let n = (clamped * std::f32::consts::LOG2_E).round();
    let r = clamped - n * LN2_HIGH - n * LN2_LOW;
    let mut p = Vec4::splat(1.987_569_1e-4);
    for c in [1.398_199_9e-3, 8.333_452e-3, 4.166_579_6e-2, 0.166_666_65, 0.5] {
        p = p * r + Vec4::splat(c);
    }
    let mantissa = p * r * r + r + Vec4::ONE;
    let power = Vec4::from_array(n.to_array().map(|k| f32::from_bits(((k as i32 + 127) as u32) << 23)));
    let below = x.cmplt(Vec4::splat(-87.3));
    Vec4::select(below, Vec4::ZERO, mantissa * power)
}

/// 1 - e^-x on four lanes, x >= 0, with its digits near zero too: relative error below 1e-6.
#[inline]
pub fn one_minus_exp4(x: Vec4) -> Vec4 {
    // Below 0.1 the series, whose first omitted term is x^6 / 720 of x.
    let small = [6.0_f32, 5.0, 4.0, 3.0, 2.0].iter().fold(Vec4::ONE, |p, n| Vec4::ONE - x / *n * p) * x;
    Vec4::select(x.cmplt(Vec4::splat(0.1)), small, Vec4::ONE - exp4(-x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_minus_exp4_keeps_its_digits() {
        for i in 0..4000 {
            let x = libm::pow(10.0, -8.0 + 10.0 * f64::from(i) / 4000.0) as f32;
            let got = f64::from(one_minus_exp4(Vec4::splat(x)).x);
            let want = -(-f64::from(x)).exp_m1();
            // At 0.1 the difference from one has lost a digit: 6e-8 of 0.095.
            assert!((got / want - 1.0).abs() < 1e-6, "{x}: {got} {want}");
        }
        assert_eq!(one_minus_exp4(Vec4::ZERO), Vec4::ZERO);
        assert_eq!(one_minus_exp4(Vec4::splat(f32::INFINITY)), Vec4::ONE);
    }

    #[test]
    fn logarithms_of_random_numbers_agree_with_double_precision() {
        let all = (0..1 << 24).step_by(37).chain(0..4096).chain((1 << 24) - 4096..1 << 24);
        for u in all.map(|i| i as f32 / 16_777_216.0) {
            let want = -(-f64::from(u)).ln_1p();
            let got = f64::from(minus_ln_of_rest(u));
            assert!((got - want).abs() <= 3e-7 * want, "{u}: {got} {want}");
        }
    }

    #[test]
    fn turns_agree_with_double_precision() {
        for i in 0..=200_000 {
            let u = i as f32 / 200_000.0;
            let (sin, cos) = sin_cos_of_turn(u);
            let (want_sin, want_cos) = (2.0 * std::f64::consts::PI * f64::from(u)).sin_cos();
            let worst = (f64::from(sin) - want_sin).abs().max((f64::from(cos) - want_cos).abs());
            assert!(worst < 2e-7, "{u}: {sin} {cos}");
        }
        assert_eq!(sin_cos_of_turn(0.0), (0.0, 1.0));
        assert_eq!(sin_cos_of_turn(0.25), (1.0, 0.0));
    }

    #[test]
    fn exp4_agrees_with_double_precision() {
        let mut worst = 0.0_f64;
        for i in 0..200_000 {
            let x = -87.0 + 175.0 * f64::from(i) / 200_000.0;
            let x = x as f32;
            let got = f64::from(exp4(Vec4::splat(x)).x);
            let want = f64::from(x).exp();
            worst = worst.max((got / want - 1.0).abs());
        }
        assert!(worst < 2e-7, "relative error {worst}");
        assert_eq!(exp4(Vec4::ZERO), Vec4::ONE);
        assert_eq!(exp4(Vec4::splat(f32::NEG_INFINITY)), Vec4::ZERO);
    }
}
