//! Henyey and Greenstein's lobe `[HENYEY41 eq. 2]`.
//!
//! ```text
//! p = (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^(3/2)),   1 + g^2 - 2 g cos = (1 - |g|)^2 + 2 |g| (1 -+ cos)
//! ```
//! g in (-1, 1) is the mean cosine; the upper sign is that of g > 0. The right-hand form, and a sampling written in the
//! same terms, keep the peaks of |g| = 0.9999 (2e8 times the isotropic value) in single precision, forward and backward.

use std::f32::consts::FRAC_1_PI;

use super::Lobe;
use super::deflection::Deflection;
use crate::geometry::machine::Lanes;
use crate::spectrum;

/// The Henyey-Greenstein phase function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HenyeyGreenstein {
    /// Mean cosine, in (-1, 1).
    pub g: f32,
}

impl Lobe for HenyeyGreenstein {
    #[inline]
    fn value(&self, deflection: Deflection) -> f32 {
        let from_peak = if self.g >= 0.0 { deflection.one_minus_cos() } else { deflection.one_plus_cos() };
        let g = self.g.abs();
        let squared = (1.0 - g) * (1.0 - g) + 2.0 * g * from_peak;
        0.25 * FRAC_1_PI * (1.0 - g) * (1.0 + g) / (squared * squared.sqrt())
    }

    /// The angle at the fraction `u` of the cumulative distribution, counted from the backward end.
    ///
    /// With q = (1 - g)(1 - u) + (1 + g) u and s = (1 - g^2) / q, cos = (1 + g^2 - s^2) / 2g, so
    /// 1 - cos = (1 - g)(1 - u)(s + 1 - g) / q: no difference of like numbers, no branch at g = 0.
    #[inline]
    fn sample(&self, u: f32) -> Deflection {
        let g = self.g.abs();
        let (u, rest) = if self.g >= 0.0 { (u, 1.0 - u) } else { (1.0 - u, u) };
        let (back, forth) = (1.0 - g, 1.0 + g);
        let q = back * rest + forth * u;
        let s = back * forth / q;
        let from_peak = Deflection::from_one_minus_cos((back * rest * (s + back) / q).clamp(0.0, 2.0));
        if self.g >= 0.0 { from_peak } else { from_peak.reversed() }
    }

    fn mean_cosine(&self) -> f32 {
        self.g
    }
}

/// Values at the g of each lane.
#[inline]
pub(super) fn on_lanes(g: spectrum::Lanes, turned: Deflection) -> spectrum::Lanes {
    use spectrum::Lanes;
    let [ahead, back] = [turned.one_minus_cos(), turned.one_plus_cos()].map(Lanes::splat);
    let from_peak = Lanes::select(g.cmpge(Lanes::ZERO), ahead, back);
    let g = g.abs();
    let rest = Lanes::ONE - g;
    let squared = rest * rest + 2.0 * g * from_peak;
    let root = Lanes::from_array(squared.to_array().map(f32::sqrt));
    0.25 * FRAC_1_PI * rest * (Lanes::ONE + g) / (squared * root)
}

impl HenyeyGreenstein {
    /// Cosines and sines of the angles of [`Lobe::sample`] at eight numbers.
    #[inline(always)]
    pub(super) fn sample_eight<L: Lanes>(&self, u: L) -> (L, L) {
        let (one, two) = (L::splat(1.0), L::splat(2.0));
        let g = self.g.abs();
        let (back, forth) = (L::splat(1.0 - g), L::splat(1.0 + g));
        let other = one.sub(u);
        let (u, rest) = if self.g >= 0.0 { (u, other) } else { (other, u) };
        let q = back.mul(rest).add(forth.mul(u));
        let s = back.mul(forth).div(q);
        let from_peak = back.mul(rest).mul(s.add(back)).div(q).max(L::splat(0.0)).min(two);
        let cos = if self.g >= 0.0 { one.sub(from_peak) } else { from_peak.sub(one) };
        (cos, from_peak.mul(two.sub(from_peak)).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::machine::{Eight, WithLanes, with_best};
    use crate::geometry::portable::Portable;

    struct All(HenyeyGreenstein, Eight);

    impl WithLanes for All {
        type Output = [Eight; 2];

        #[inline(always)]
        fn run<L: Lanes>(self) -> Self::Output {
            let (cos, sin) = self.0.sample_eight(L::load(&self.1));
            let mut all = [Eight([0.0; 8]); 2];
            cos.store(&mut all[0]);
            sin.store(&mut all[1]);
            all
        }
    }

    #[test]
    fn eight_angles_are_those_of_each_number() {
        for g in [-0.9999, -0.3, 0.0, 0.86, 0.9999] {
            let lobe = HenyeyGreenstein { g };
            for i in (0..1 << 24).step_by(8 * 997).chain([(1 << 24) - 8]) {
                let u: [f32; 8] = std::array::from_fn(|k| (i + k) as f32 / 16_777_216.0);
                let alone = [u.map(|u| lobe.sample(u).cosine()), u.map(|u| lobe.sample(u).sine())].map(Eight);
                assert_eq!(with_best(All(lobe, Eight(u))), alone, "{g} {u:?}");
                assert_eq!(All(lobe, Eight(u)).run::<Portable>(), alone, "{g} {u:?}");
            }
        }
    }
}
