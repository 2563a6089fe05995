//! Eight numbers at a time on any machine: what stands in for wide registers where there are none.

use glam::Vec4;

use super::machine::{Eight, Lanes, Word, Words};

/// Lanes of any machine.
#[derive(Clone, Copy)]
pub(crate) struct Portable([Vec4; 2]);

impl Portable {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(Vec4, Vec4) -> Vec4) -> Self {
        Self([f(self.0[0], other.0[0]), f(self.0[1], other.0[1])])
    }

    #[inline(always)]
    fn to_array(self) -> [f32; 8] {
        let mut all = Eight([0.0; 8]);
        self.store(&mut all);
        all.0
    }
}

impl Lanes for Portable {
    type Words = PortableWords;

    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self([Vec4::splat(x); 2])
    }

    #[inline(always)]
    fn load(from: &Eight) -> Self {
        let [a, b, c, d, e, f, g, h] = from.0;
        Self([Vec4::new(a, b, c, d), Vec4::new(e, f, g, h)])
    }

    #[inline(always)]
    fn store(self, to: &mut Eight) {
        to.0[..4].copy_from_slice(&self.0[0].to_array());
        to.0[4..].copy_from_slice(&self.0[1].to_array());
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }

    #[inline(always)]
    fn scaled(self, factor: Self, term: Self) -> Self {
        self.mul(factor).zip(term, |a, b| a + b)
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // Those of glam let a lane that is no number win on some machines and lose on others.
        self.zip(other, |a, b| Vec4::select(a.cmplt(b), a, b))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| Vec4::select(a.cmpgt(b), a, b))
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        let bits = |i: usize| self.0[i].cmple(other.0[i]).bitmask();
        bits(0) | bits(1) << 4
    }

    #[inline(always)]
    fn pick(self, from: &[u8; 8]) -> Self {
        let mut all = Eight([0.0; 8]);
        self.store(&mut all);
        Self::load(&Eight(from.map(|i| all.0[usize::from(i & 7)])))
    }

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.zip(other, |a, b| a / b)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(|four| Vec4::from_array(four.to_array().map(f32::sqrt))))
    }

    #[inline(always)]
    fn negative(self, first: Self, second: Self) -> Self {
        let [signs, first, second] = [self, first, second].map(Self::to_array);
        let of = |i: usize| if signs[i].is_sign_negative() { first[i] } else { second[i] };
        Self::load(&Eight(std::array::from_fn(of)))
    }

    #[inline(always)]
    fn preceded_by(self, first: f32) -> Self {
        let [a, b, c, d, e, f, g, _] = self.to_array();
        Self([Vec4::new(first, a, b, c), Vec4::new(d, e, f, g)])
    }

    #[inline(always)]
    fn running_sums(self) -> Self {
        let [low, high] = self.0.map(|four| {
            let pairs = four + Vec4::new(0.0, four.x, four.y, four.z);
            pairs + Vec4::new(0.0, 0.0, pairs.x, pairs.y)
        });
        // Nothing is added to the low ones, which makes 0 of -0.
        Self([low + Vec4::ZERO, high + low.w])
    }

    #[inline(always)]
    fn truncated(self) -> PortableWords {
        PortableWords(self.to_array().map(|x| x as i32 as u32))
    }

    #[inline(always)]
    fn to_bits(self) -> PortableWords {
        PortableWords(self.to_array().map(f32::to_bits))
    }
}

/// Whole numbers of any machine.
#[derive(Clone, Copy)]
pub(crate) struct PortableWords([u32; 8]);

impl PortableWords {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(u32, u32) -> u32) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }
}

impl Word for PortableWords {
    #[inline(always)]
    fn splat(x: u32) -> Self {
        Self([x; 8])
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, u32::wrapping_add)
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, u32::wrapping_mul)
    }

    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        self.zip(other, |a, b| a ^ b)
    }

    #[inline(always)]
    fn shifted_left<const BITS: i32>(self) -> Self {
        Self(self.0.map(|x| x << BITS))
    }

    #[inline(always)]
    fn shifted_right<const BITS: i32>(self) -> Self {
        Self(self.0.map(|x| x >> BITS))
    }
}

impl Words for PortableWords {
    type Lanes = Portable;

    #[inline(always)]
    fn lane_numbers() -> Self {
        Self([0, 1, 2, 3, 4, 5, 6, 7])
    }

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self.zip(other, |a, b| a & b)
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, u32::wrapping_sub)
    }

    #[inline(always)]
    fn signed_shifted_right<const BITS: i32>(self) -> Self {
        Self(self.0.map(|x| (x as i32 >> BITS) as u32))
    }

    #[inline(always)]
    fn signed_value(self) -> Portable {
        Portable::load(&Eight(self.0.map(|x| x as i32 as f32)))
    }

    #[inline(always)]
    fn as_bits(self) -> Portable {
        Portable::load(&Eight(self.0.map(f32::from_bits)))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::machine::{WithLanes, with_best};
    use super::*;

    /// What becomes of eight numbers and eight others: bits by the names of functions.
    struct All([f32; 8], [f32; 8]);

    impl WithLanes for All {
        type Output = Vec<(&'static str, [u32; 8])>;

        #[inline(always)]
        fn run<L: Lanes>(self) -> Self::Output {
            let (x, y) = (L::load(&Eight(self.0)), L::load(&Eight(self.1)));
            let most = L::splat(2_147_483_520.0);
            let representable = x.max(L::splat(0.0).sub(most)).min(most);
            vec![
                ("min", bits(x.min(y))),
                ("max", bits(x.max(y))),
                ("at_most", [x.at_most(y); 8]),
                ("pick", bits(x.pick(&[7, 2, 2, 0, 1, 6, 5, 12]))),
                ("least_below", [(x.least_below(LIMIT) + 0.0).to_bits(); 8]),
                ("negative", bits(x.negative(y, L::splat(3.0)))),
                ("preceded_by", bits(x.preceded_by(-4.0))),
                ("running_sums", bits(x.running_sums())),
                ("truncated", bits(representable.truncated().signed_value())),
            ]
        }
    }

    const LIMIT: f32 = 5.0;

    /// Which bits stand for what is no number depends on the order of a sum's terms.
    fn bits(lanes: impl Lanes) -> [u32; 8] {
        let mut all = Eight([0.0; 8]);
        lanes.store(&mut all);
        all.0.map(|x| if x.is_nan() { f32::NAN.to_bits() } else { x.to_bits() })
    }

    fn assert_same(x: [f32; 8], y: [f32; 8]) {
        let portable = All(x, y).run::<Portable>();
        assert_eq!(with_best(All(x, y)), portable, "{x:?} {y:?}");
        // And they are what the names say.
        let of = |name: &str| {
            portable.iter().find(|(of, _)| *of == name).map(|(_, bits)| bits.map(f32::from_bits))
        };
        let least = x.into_iter().fold(LIMIT, f32::min);
        assert_eq!(of("least_below").map(|all| all[0]), Some(least), "{x:?}");
        let lesser = std::array::from_fn(|i| bits_of(if x[i] < y[i] { x[i] } else { y[i] }));
        let greater = std::array::from_fn(|i| bits_of(if x[i] > y[i] { x[i] } else { y[i] }));
        let chosen = std::array::from_fn(|i| bits_of(if x[i].is_sign_negative() { y[i] } else { 3.0 }));
        let before = std::array::from_fn(|i| bits_of(if i == 0 { -4.0 } else { x[i - 1] }));
        let picked = [7, 2, 2, 0, 1, 6, 5, 4].map(|i: usize| bits_of(x[i]));
        for (name, expected) in [
            ("min", lesser),
            ("max", greater),
            ("negative", chosen),
            ("preceded_by", before),
            ("pick", picked),
        ] {
            assert_eq!(of(name).map(|all| all.map(f32::to_bits)), Some(expected), "{name} {x:?} {y:?}");
        }
    }

    fn bits_of(x: f32) -> u32 {
        bits(Portable::splat(x))[0]
    }

    #[test]
    fn zeros_with_signs_and_lanes_without_numbers_are_the_same_on_all_machines() {
        assert_same([-0.0; 8], [0.0; 8]);
        assert_same([0.0; 8], [-0.0; 8]);
        assert_same([f32::NAN; 8], [1.0; 8]);
        assert_same([1.0; 8], [-f32::NAN; 8]);
        for lane in 0..8 {
            // One number, which no other lane may hide; and one that is none, in turn.
            assert_same(std::array::from_fn(|i| if i == lane { 0.5 } else { f32::NAN }), [1.0; 8]);
            assert_same(std::array::from_fn(|i| if i == lane { -f32::NAN } else { i as f32 }), [1.0; 8]);
        }
    }

    fn number() -> impl Strategy<Value = f32> {
        let special =
            [0.0, -0.0, 1.0, -1.0, 1e-40, 3e9, f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
        prop_oneof![2 => -10.0_f32..10.0, 1 => prop::sample::select(special.to_vec())]
    }

    proptest! {
        #[test]
        fn lanes_are_the_same_on_all_machines(
            x in prop::array::uniform8(number()), y in prop::array::uniform8(number()),
        ) {
            assert_same(x, y);
        }
    }
}
