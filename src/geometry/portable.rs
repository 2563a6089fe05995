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
        self.zip(other, Vec4::min)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, Vec4::max)
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
        Self([low, high + low.w])
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
