//! Functions of [`super::elementary`] on eight numbers at a time, with the same bits as those of one.

use super::machine::{Lanes, Word, Words};

/// As [`super::elementary::minus_ln_of_rest`].
#[inline(always)]
pub(crate) fn minus_ln_of_rest<L: Lanes>(u: L) -> L {
    let bits = L::splat(1.0).sub(u).to_bits();
    let exponent =
        bits.sub(L::Words::splat(std::f32::consts::FRAC_1_SQRT_2.to_bits())).signed_shifted_right::<23>();
    let x = bits.sub(exponent.shifted_left::<23>()).as_bits().sub(L::splat(1.0));
    let square = x.mul(x);
    let pair = |a: f32, b: f32| L::splat(a).mul(x).add(L::splat(b));
    let high = pair(7.037_683_6e-2, -1.151_461e-1).mul(square).add(pair(1.167_699_9e-1, -1.242_014_1e-1));
    let low = pair(1.424_932_3e-1, -1.666_805_7e-1).mul(square).add(pair(2.000_071_5e-1, -2.499_999_4e-1));
    let p = high.mul(square.mul(square)).add(low).mul(x).add(L::splat(3.333_333e-1));
    let e = exponent.signed_value();
    let small = x.mul(square).mul(p).add(e.mul(L::splat(-2.121_944_4e-4))).sub(L::splat(0.5).mul(square));
    let ln = x.add(small).add(e.mul(L::splat(0.693_359_4)));
    flipped(ln, L::Words::splat(1 << 31))
}

/// As [`super::elementary::sin_cos_of_turn`].
#[inline(always)]
pub(crate) fn sin_cos_of_turn<L: Lanes>(u: L) -> (L, L) {
    let four = L::splat(4.0).mul(u);
    let quarters = four.add(L::splat(0.5)).truncated();
    let r = four.sub(quarters.signed_value()).mul(L::splat(std::f32::consts::FRAC_PI_2));
    let square = r.mul(r);
    let term = |a: f32, b: L| L::splat(a).add(square.mul(b));
    let sin = r.add(r.mul(square).mul(term(-0.166_666_55, term(8.332_161e-3, L::splat(-1.951_529_6e-4)))));
    let cos = term(4.166_664_6e-2, term(-1.388_731_6e-3, L::splat(2.443_315_7e-5)));
    let cos = L::splat(1.0).sub(L::splat(0.5).mul(square)).add(square.mul(square).mul(cos));
    let is_odd = quarters.shifted_left::<31>().as_bits();
    let (s, c) = (is_odd.negative(cos, sin), is_odd.negative(sin, cos));
    let two = L::Words::splat(2);
    let sign_s = quarters.and(two).shifted_left::<30>();
    let sign_c = quarters.add(L::Words::splat(1)).and(two).shifted_left::<30>();
    (flipped(s, sign_s), flipped(c, sign_c))
}

#[inline(always)]
fn flipped<L: Lanes>(value: L, sign: L::Words) -> L {
    value.to_bits().xor(sign).as_bits()
}

#[cfg(test)]
mod tests {
    use super::super::elementary;
    use super::super::machine::{Eight, WithLanes, with_best};
    use super::super::portable::Portable;
    use super::*;

    struct All(Eight);

    impl WithLanes for All {
        type Output = [[u32; 8]; 3];

        #[inline(always)]
        fn run<L: Lanes>(self) -> Self::Output {
            let u = L::load(&self.0);
            let (sin, cos) = sin_cos_of_turn(u);
            [minus_ln_of_rest(u), sin, cos].map(|lanes| {
                let mut all = Eight([0.0; 8]);
                lanes.store(&mut all);
                all.0.map(f32::to_bits)
            })
        }
    }

    #[test]
    fn eight_numbers_have_the_bits_of_each() {
        for i in (0..1 << 24).step_by(8 * 37).chain([0, (1 << 24) - 8, 1 << 22, 1 << 23, 3 << 22]) {
            let u: [f32; 8] = std::array::from_fn(|k| (i + k) as f32 / 16_777_216.0);
            let alone = [
                u.map(|u| elementary::minus_ln_of_rest(u).to_bits()),
                u.map(|u| elementary::sin_cos_of_turn(u).0.to_bits()),
                u.map(|u| elementary::sin_cos_of_turn(u).1.to_bits()),
            ];
            assert_eq!(with_best(All(Eight(u))), alone, "{u:?}");
            assert_eq!(All(Eight(u)).run::<Portable>(), alone, "{u:?}");
        }
    }
}
