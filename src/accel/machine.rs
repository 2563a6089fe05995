//! What the machine offers and the language does not check: wide registers, memory that need not be cleared, large pages.
//! All `unsafe` code of the crate is in this file.
//!
//! Traversal is written once over [`Lanes`] and compiled twice: for any machine, and for those with AVX2 and FMA,
//! which [`with_best`] recognises at run time. Box tests are conservative however they round; the triangle test does
//! the same operations in the same order in either, none of them fused. So both give the same results to the last bit.
#![allow(unsafe_code)]

use std::mem::MaybeUninit;

use glam::Vec4;

/// Eight floats in memory.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub(super) struct Eight(pub [f32; 8]);

/// Eight numbers of a lane each, in registers.
pub(super) trait Lanes: Copy {
    fn splat(x: f32) -> Self;
    fn load(from: &Eight) -> Self;
    fn store(self, to: &mut Eight);
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    /// `self * factor + term`, rounded once or twice.
    fn scaled(self, factor: Self, term: Self) -> Self;
    fn min(self, other: Self) -> Self;
    fn max(self, other: Self) -> Self;
    /// A bit for each lane in which this is at most the other.
    fn at_most(self, other: Self) -> u32;
    /// In lane i what is in lane `from[i]`; only the lowest three bits of an index count.
    fn pick(self, from: &[u8; 8]) -> Self;
}

/// Lanes of any machine.
#[derive(Clone, Copy)]
pub(super) struct Portable([Vec4; 2]);

impl Portable {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(Vec4, Vec4) -> Vec4) -> Self {
        Self([f(self.0[0], other.0[0]), f(self.0[1], other.0[1])])
    }
}

impl Lanes for Portable {
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
}

#[cfg(target_arch = "x86_64")]
pub(super) use avx2::Avx2;

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use std::arch::x86_64::*;

    use super::{Eight, Lanes};

    /// Lanes of an AVX2 register.
    ///
    /// Invariant: values are made only within functions that have the features `avx2` and `fma` enabled, which
    /// [`super::with_best`] calls only on machines that have them. Every intrinsic below rests on that alone,
    /// but for the loads and stores, whose pointers come from references to aligned arrays of the right size.
    #[derive(Clone, Copy)]
    pub(in crate::accel) struct Avx2(__m256);

    impl Lanes for Avx2 {
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
    }
}

/// A stack whose memory need not be cleared for every ray.
pub(super) struct Stack<const SIZE: usize> {
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
pub(super) fn on_large_pages<T>(array: &[T]) {
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
        // The range lies within the array, and the call changes no byte of it. Where the system cannot, all stays as it is.
        unsafe { libc::madvise(bytes.wrapping_add(before).cast_mut().cast(), whole, libc::MADV_COLLAPSE) };
    }
}

/// Work that can be done with any lanes.
pub(super) trait WithLanes {
    type Output;
    fn run<L: Lanes>(self) -> Self::Output;
}

/// Does the work with the widest lanes that this machine has.
#[inline(always)]
pub(super) fn with_best<W: WithLanes>(work: W) -> W::Output {
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
