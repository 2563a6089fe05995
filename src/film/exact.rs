//! Sums of numbers in single precision that depend on the addends alone, not on their order.
//!
//! Samples of a frame may be drawn by several machines, and a sum of sums is rounded in other places than one sum is. So
//! nothing is lost here: what rounding takes from a sum in double precision is a number of that precision too,
//!
//! ```text
//! s = fl(a + b)    t = fl(s - a)    e = fl(fl(a - fl(s - t)) + fl(b - t))    a + b = s + e      [SHEWCHUK97 thm. 7]
//! ```
//!
//! and mostly 0, since a double has 29 bits more than the addends. What it is else goes into an integer that counts
//! units of 2^-149, of which every finite single is a multiple. Up to 2^32 of them, each below 2^128, stay below
//! 2^(128 + 32 + 149) = 2^309 of these units; the integer has 320 bits. The value of a sum is the exact one, rounded once.

use std::ops::AddAssign;

use serde::{Deserialize, Serialize};

/// Sums that are kept side by side: those of a pixel.
pub(super) const SUMS: usize = 25;

/// Limbs of the integers.
const LIMBS: usize = 5;

/// Exponent of the unit of the integers, negated.
const UNIT: i32 = 149;

/// Sums, and what rounding took from some of them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct ExactSums {
    rounded: [f64; SUMS],
    rests: Vec<Rest>,
}

/// What rounding took from one of the sums.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Rest {
    of: u8,
    units: Units,
}

/// A number of units of 2^-149 in two's complement, the lowest limb first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Units([u64; LIMBS]);

impl ExactSums {
    /// Adds to the sums from `first` on.
    #[inline]
    pub fn add<const N: usize>(&mut self, first: usize, addends: [f32; N]) {
        for (at, addend) in (first..).zip(addends) {
            self.add_one(at, addend.into());
        }
    }

    /// The sums, each rounded once.
    pub fn values(&self) -> [f64; SUMS] {
        let mut values = self.rounded;
        for rest in &self.rests {
            if let Some(value) = values.get_mut(usize::from(rest.of)) {
                *value = rest.units.plus(*value);
            }
        }
        values
    }

    #[inline]
    fn add_one(&mut self, at: usize, addend: f64) {
        let (sum, error) = two_sum(self.rounded[at], addend);
        self.rounded[at] = sum;
        if error != 0.0 {
            self.rest(at).add(error);
        }
    }

    #[cold]
    fn rest(&mut self, at: usize) -> &mut Units {
        let known = self.rests.iter().position(|rest| usize::from(rest.of) == at);
        let place = known.unwrap_or_else(|| {
            // Few sums have any, and there are as many of them as pixels.
            self.rests.reserve_exact(1);
            self.rests.push(Rest { of: at as u8, units: Units::default() });
            self.rests.len() - 1
        });
        &mut self.rests[place].units
    }
}

impl AddAssign<&Self> for ExactSums {
    fn add_assign(&mut self, other: &Self) {
        for (at, addend) in other.rounded.into_iter().enumerate() {
            self.add_one(at, addend);
        }
        for rest in &other.rests {
            *self.rest(rest.of.into()) += rest.units;
        }
    }
}

/// A sum as it is rounded, and what that takes from it.
#[inline]
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let from_b = sum - a;
    (sum, (a - (sum - from_b)) + (b - from_b))
}

impl Units {
    /// Adds a multiple of the unit that is below 2^170; of anything else the part that has a place.
    fn add(&mut self, value: f64) {
        let bits = value.to_bits();
        let exponent = (bits >> 52 & 0x7ff) as i32;
        // Numbers of the lowest exponent are far below the unit.
        let mantissa = if exponent == 0 { 0 } else { bits & ((1 << 52) - 1) | 1 << 52 };
        let shift = exponent - 1075 + UNIT;
        let (limb, wide) = if shift < 0 {
            (0, mantissa.checked_shr(shift.unsigned_abs()).unwrap_or(0).into())
        } else {
            (shift as usize / 64, i128::from(mantissa) << (shift % 64))
        };
        self.add_at(limb, if value.is_sign_negative() { -wide } else { wide });
    }

    fn add_at(&mut self, limb: usize, wide: i128) {
        let mut addend = wide;
        let mut carry = false;
        for limb in self.0.iter_mut().skip(limb) {
            let (sum, over) = limb.overflowing_add(addend as u64);
            let (sum, over_again) = sum.overflowing_add(carry.into());
            (*limb, carry) = (sum, over || over_again);
            addend >>= 64;
        }
    }

    /// The sum with a number, rounded to the nearest and to even in between.
    fn plus(mut self, value: f64) -> f64 {
        self.add(value);
        let is_negative = self.0[LIMBS - 1] >> 63 == 1;
        if is_negative {
            self.0 = self.0.map(|limb| !limb);
            self.add_at(0, 1);
        }
        let magnitude = self.magnitude();
        if is_negative { -magnitude } else { magnitude }
    }

    /// As a number without sign.
    fn magnitude(&self) -> f64 {
        let Some(top) = self.0.iter().rposition(|&limb| limb != 0) else { return 0.0 };
        let below = if top > 0 { self.0[top - 1] } else { 0 };
        let lead = self.0[top].leading_zeros();
        let two = (u128::from(self.0[top]) << 64 | u128::from(below)) << lead;
        // Whatever is further below only tells whether it is more than half of the last digit.
        let has_more = two as u64 != 0 || self.0[..top.saturating_sub(1)].iter().any(|&limb| limb != 0);
        let digits = ((two >> 64) as u64 | u64::from(has_more)) as f64;
        let exponent = 64 * top as i32 - lead as i32 - UNIT;
        digits * f64::from_bits(((exponent + 1023) as u64) << 52)
    }
}

impl AddAssign for Units {
    fn add_assign(&mut self, other: Self) {
        for (at, limb) in other.0.into_iter().enumerate() {
            self.add_at(at, limb.into());
        }
    }
}

#[cfg(test)]
mod tests;
