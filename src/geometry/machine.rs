//! What the machine offers and the language does not check: wide registers, memory that need not be cleared, large
//! pages. All `unsafe` code that rendering runs is in this file.
//!
//! Traversal and random walks are written once over [`Lanes`] and compiled twice: for any machine, and for those with
//! AVX2 and FMA, which [`with_best`] recognises at run time. Box tests are conservative however they round; all else
//! does the same operations in the same order in either, none of them fused. So both give the same results to the last
//! bit.
#![allow(unsafe_code)]

use std::mem::MaybeUninit;

use super::portable::Portable;

/// Eight floats in memory.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub(crate) struct Eight(pub [f32; 8]);

/// Eight numbers of a lane each, in registers.
pub(crate) trait Lanes: Copy {
    type Words: Words<Lanes = Self>;
    fn splat(x: f32) -> Self;
    fn load(from: &Eight) -> Self;
    fn store(self, to: &mut Eight);
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    /// `self * factor + term`, rounded once or twice.
    fn scaled(self, factor: Self, term: Self) -> Self;
    /// The lesser; the other where either is no number.
    fn min(self, other: Self) -> Self;
    /// The greater; the other where either is no number.
    fn max(self, other: Self) -> Self;
    /// A bit for each lane in which this is at most the other.
    fn at_most(self, other: Self) -> u32;
    /// In lane i what is in lane `from[i]`; only the lowest three bits of an index count.
    fn pick(self, from: &[u8; 8]) -> Self;
    fn div(self, other: Self) -> Self;
    fn sqrt(self) -> Self;
    /// The least of a number and of all lanes that are numbers.
    #[inline(always)]
    fn least_below(self, number: f32) -> f32 {
        if self.at_most(Self::splat(number)) == 0 {
            return number;
        }
        let lanes = self.min(Self::splat(number));
        let halves = lanes.min(lanes.pick(&[4, 5, 6, 7, 0, 1, 2, 3]));
        let quarters = halves.min(halves.pick(&[2, 3, 0, 1, 0, 1, 2, 3]));
        let mut all = Eight([0.0; 8]);
        quarters.store(&mut all);
        all.0[0].min(all.0[1])
    }
    /// In each lane the first where the sign bit of this is set, as that of -0 is, else the second.
    fn negative(self, first: Self, second: Self) -> Self;
    /// `first` and all lanes but the last.
    fn preceded_by(self, first: f32) -> Self;
    /// Sums of the lanes up to each: of pairs first, then of fours.
    fn running_sums(self) -> Self;
    /// The whole numbers towards zero, of numbers between -2^31 and 2^31: what others become depends on the machine.
    fn truncated(self) -> Self::Words;
    fn to_bits(self) -> Self::Words;
}

/// Whole numbers that wrap around: one, or eight in registers.
pub(crate) trait Word: Copy {
    fn splat(x: u32) -> Self;
    fn add(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn xor(self, other: Self) -> Self;
    fn shifted_left<const BITS: i32>(self) -> Self;
    fn shifted_right<const BITS: i32>(self) -> Self;
}

/// Eight of them.
pub(crate) trait Words: Word {
    type Lanes: Lanes;
    /// 0 to 7.
    fn lane_numbers() -> Self;
    fn and(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    /// Shifts numbers with a sign, which is repeated.
    fn signed_shifted_right<const BITS: i32>(self) -> Self;
    /// The value of numbers with a sign.
    fn signed_value(self) -> Self::Lanes;
    fn as_bits(self) -> Self::Lanes;
}

impl Word for u32 {
    #[inline(always)]
    fn splat(x: u32) -> Self {
        x
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.wrapping_add(other)
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.wrapping_mul(other)
    }

    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        self ^ other
    }

    #[inline(always)]
    fn shifted_left<const BITS: i32>(self) -> Self {
        self << BITS
    }

    #[inline(always)]
    fn shifted_right<const BITS: i32>(self) -> Self {
        self >> BITS
    }
}

#[cfg(target_arch = "x86_64")]
use avx2::Avx2;

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use std::arch::x86_64::*;

    use super::{Eight, Lanes, Word, Words};

    /// Lanes of an AVX2 register.
    ///
    /// Invariant: values are made only within functions that have the features `avx2` and `fma` enabled, which
    /// [`super::with_best`] calls only on machines that have them; no other module can name the type. Every intrinsic
    /// below rests on that alone, but for the loads and stores, whose pointers come from references to aligned arrays
    /// of the right size.
    #[derive(Clone, Copy)]
    pub(super) struct Avx2(__m256);

    impl Lanes for Avx2 {
        type Words = Avx2Words;

        #[inline(always)]
        fn splat(x: f32) -> Self {
            Self(unsafe { _mm256_set1_ps(x) })
        }

        #[inline(always)]
        fn load(from: &Eight) -> Self {
            Self(unsafe { _mm256_load_ps(from.0.as_ptr()) })
        }

        #[inline(always)]
        fn store(self, to: &mut Eight) {
            unsafe { _mm256_store_ps(to.0.as_mut_ptr(), self.0) }
        }

        #[inline(always)]
        fn add(self, other: Self) -> Self {
            Self(unsafe { _mm256_add_ps(self.0, other.0) })
        }

        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            Self(unsafe { _mm256_sub_ps(self.0, other.0) })
        }

        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            Self(unsafe { _mm256_mul_ps(self.0, other.0) })
        }

        #[inline(always)]
        fn scaled(self, factor: Self, term: Self) -> Self {
            Self(unsafe { _mm256_fmadd_ps(self.0, factor.0, term.0) })
        }

        #[inline(always)]
        fn min(self, other: Self) -> Self {
            Self(unsafe { _mm256_min_ps(self.0, other.0) })
        }

        #[inline(always)]
        fn max(self, other: Self) -> Self {
            Self(unsafe { _mm256_max_ps(self.0, other.0) })
        }

        #[inline(always)]
        fn at_most(self, other: Self) -> u32 {
            unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0)) as u32 }
        }

        #[inline(always)]
        fn pick(self, from: &[u8; 8]) -> Self {
            unsafe {
                let indices = _mm256_cvtepu8_epi32(_mm_loadl_epi64(from.as_ptr().cast()));
                Self(_mm256_permutevar8x32_ps(self.0, indices))
            }
        }

        #[inline(always)]
        fn div(self, other: Self) -> Self {
            Self(unsafe { _mm256_div_ps(self.0, other.0) })
        }

        #[inline(always)]
        fn sqrt(self) -> Self {
            Self(unsafe { _mm256_sqrt_ps(self.0) })
        }

        #[inline(always)]
        fn negative(self, first: Self, second: Self) -> Self {
            Self(unsafe { _mm256_blendv_ps(second.0, first.0, self.0) })
        }

        #[inline(always)]
        fn preceded_by(self, first: f32) -> Self {
            unsafe {
                let turned = _mm256_permutevar8x32_ps(self.0, _mm256_setr_epi32(7, 0, 1, 2, 3, 4, 5, 6));
                Self(_mm256_blend_ps::<1>(turned, _mm256_set1_ps(first)))
            }
        }

        #[inline(always)]
        fn running_sums(self) -> Self {
            unsafe {
                let bits = _mm256_castps_si256(self.0);
                let pairs = _mm256_add_ps(self.0, _mm256_castsi256_ps(_mm256_slli_si256::<4>(bits)));
                let bits = _mm256_castps_si256(pairs);
                let fours = _mm256_add_ps(pairs, _mm256_castsi256_ps(_mm256_slli_si256::<8>(bits)));
                // The low half in place of the high one, nothing in that of the low one.
                let low = _mm256_permute2f128_ps::<0x08>(fours, fours);
                Self(_mm256_add_ps(fours, _mm256_permute_ps::<0xff>(low)))
            }
        }

        #[inline(always)]
        fn truncated(self) -> Avx2Words {
            Avx2Words(unsafe { _mm256_cvttps_epi32(self.0) })
        }

        #[inline(always)]
        fn to_bits(self) -> Avx2Words {
            Avx2Words(unsafe { _mm256_castps_si256(self.0) })
        }
    }

    /// Whole numbers in such a register, under the same invariant.
    #[derive(Clone, Copy)]
    pub(super) struct Avx2Words(__m256i);

    impl Word for Avx2Words {
        #[inline(always)]
        fn splat(x: u32) -> Self {
            Self(unsafe { _mm256_set1_epi32(x as i32) })
        }

        #[inline(always)]
        fn add(self, other: Self) -> Self {
            Self(unsafe { _mm256_add_epi32(self.0, other.0) })
        }

        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            Self(unsafe { _mm256_mullo_epi32(self.0, other.0) })
        }

        #[inline(always)]
        fn xor(self, other: Self) -> Self {
            Self(unsafe { _mm256_xor_si256(self.0, other.0) })
        }

        #[inline(always)]
        fn shifted_left<const BITS: i32>(self) -> Self {
            Self(unsafe { _mm256_slli_epi32::<BITS>(self.0) })
        }

        #[inline(always)]
        fn shifted_right<const BITS: i32>(self) -> Self {
            Self(unsafe { _mm256_srli_epi32::<BITS>(self.0) })
        }
    }

    impl Words for Avx2Words {
        type Lanes = Avx2;

        #[inline(always)]
        fn lane_numbers() -> Self {
            Self(unsafe { _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7) })
        }

        #[inline(always)]
        fn and(self, other: Self) -> Self {
            Self(unsafe { _mm256_and_si256(self.0, other.0) })
        }

        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            Self(unsafe { _mm256_sub_epi32(self.0, other.0) })
        }

        #[inline(always)]
        fn signed_shifted_right<const BITS: i32>(self) -> Self {
            Self(unsafe { _mm256_srai_epi32::<BITS>(self.0) })
        }

        #[inline(always)]
        fn signed_value(self) -> Avx2 {
            Avx2(unsafe { _mm256_cvtepi32_ps(self.0) })
        }

        #[inline(always)]
        fn as_bits(self) -> Avx2 {
            Avx2(unsafe { _mm256_castsi256_ps(self.0) })
        }
    }
}

/// A stack whose memory need not be cleared for every ray.
pub(crate) struct Stack<const SIZE: usize> {
    /// Invariant: the first `len` are written.
    entries: [MaybeUninit<u64>; SIZE],
    len: usize,
}

impl<const SIZE: usize> Stack<SIZE> {
    #[inline(always)]
    pub fn new() -> Self {
        Self { entries: [const { MaybeUninit::uninit() }; SIZE], len: 0 }
    }

    #[inline(always)]
    pub fn push(&mut self, entry: u64) {
        self.entries[self.len].write(entry);
        self.len += 1;
    }

    #[inline(always)]
    pub fn pop(&mut self) -> Option<u64> {
        self.len = self.len.checked_sub(1)?;
        // Was among the first `len` until now.
        Some(unsafe { self.entries[self.len].assume_init() })
    }

    #[inline(always)]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Puts the last entry below those from `base` on that are less.
    #[inline(always)]
    pub fn sink(&mut self, base: usize) {
        let Some(last) = self.pop() else { return };
        let mut place = self.len;
        while place > base {
            // Below the place, and so among the first `len`.
            let before = unsafe { self.entries[place - 1].assume_init() };
            if before >= last {
                break;
            }
            self.entries[place].write(before);
            place -= 1;
        }
        self.entries[place].write(last);
        self.len += 1;
    }
}

/// Asks the system to put a large array onto pages of 2 MiB, so that rays which jump about in it do not wait for the
/// translation of addresses. Nothing but time depends on whether it does.
pub(crate) fn on_large_pages<T>(array: &[T]) {
    #[cfg(target_os = "linux")]
    {
        const PAGE: usize = 2 << 20;
        const WORTH_ASKING: usize = 8 * PAGE;
        if size_of_val(array) < WORTH_ASKING {
            return;
        }
        let bytes = array.as_ptr().cast::<u8>();
        let before = bytes.align_offset(PAGE);
        let whole = size_of_val(array).saturating_sub(before) / PAGE * PAGE;
        // The range lies within the array, and the call changes no byte of it. Where the system cannot, all stays as
        // it is.
        unsafe { libc::madvise(bytes.wrapping_add(before).cast_mut().cast(), whole, libc::MADV_COLLAPSE) };
    }
}

/// Work that can be done with any lanes.
pub(crate) trait WithLanes {
    type Output;
    fn run<L: Lanes>(self) -> Self::Output;
}

/// Does the work with the widest lanes that this machine has.
#[inline(always)]
pub(crate) fn with_best<W: WithLanes>(work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx2,fma,bmi1,bmi2")]
        fn run<W: WithLanes>(work: W) -> W::Output {
            work.run::<Avx2>()
        }
        if is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
        {
            // The features were found just now.
            return unsafe { run(work) };
        }
    }
    work.run::<Portable>()
}

/// Work in loops that compilers make wide registers of. All that it calls must be compiled into it.
pub(crate) trait Work {
    type Output;
    fn run(self) -> Self::Output;
}

/// Does the work with the widest registers that this machine has; the results are the same with any.
#[inline(always)]
pub(crate) fn in_wide_registers<W: Work>(work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx512f,avx512dq,avx512vl")]
        fn widest<W: Work>(work: W) -> W::Output {
            work.run()
        }
        #[target_feature(enable = "avx2")]
        fn wide<W: Work>(work: W) -> W::Output {
            work.run()
        }
        if is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512vl")
        {
            // The features were found just now.
            return unsafe { widest(work) };
        }
        if is_x86_feature_detected!("avx2") {
            // The feature was found just now.
            return unsafe { wide(work) };
        }
    }
    work.run()
}
