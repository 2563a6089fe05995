//! The phase function of many spheres together, at angles that mirror each other.
//!
//! ```text
//! S_1 +- S_2 = sum (2n+1)/(n(n+1)) (a_n +- b_n) (pi_n +- tau_n)                                       (1)
//! (pi_n +- tau_n)(-mu) = (-1)^(n+1) (pi_n -+ tau_n)(mu)                                               (2)
//! |S_1|^2 + |S_2|^2 = (|S_1 + S_2|^2 + |S_1 - S_2|^2) / 2                                             (3)
//! p = sum w (|S_1|^2 + |S_2|^2) / (4 pi sum (2n+1) (|a_n|^2 + |b_n|^2)) / sum w,   w = N C_sca       (4)
//! ```
//!
//! (1) is half of the products of `[BOHREN83 eq. 4.74]` `[WISCOMBE80]`; by (2), the parity of Legendre functions, one
//! table of pi_n and tau_n serves both sides. The angles go side by side, the spheres one after the other.

use std::f64::consts::PI;

use num_complex::Complex64;
use rayon::prelude::*;

use super::coefficients::SideBySide;
use super::many::{LANES, LONGEST, Summing, filled, from_the_largest};
use super::{Coefficients, Efficiencies, Sphere};
use crate::geometry::machine::{Work, in_wide_registers};

/// Angles side by side.
const ANGLES: usize = 8;

/// What some spheres scatter, ready to be asked for any angle.
#[derive(Clone, Debug, PartialEq)]
pub struct Pattern {
    spheres: Vec<Share>,
}

/// One sphere's part.
#[derive(Clone, Debug, PartialEq)]
struct Share {
    /// What its number of spheres scatters, up to a factor that all have.
    scattered: f64,
    /// The factor of |S_1 + S_2|^2 + |S_1 - S_2|^2.
    weight: f64,
    /// (2n+1)/(n(n+1)) (a_n +- b_n), n from 1 on: real and imaginary part of the sum and of the difference.
    terms: Vec<[f64; 4]>,
}

impl Pattern {
    /// Of spheres in the numbers given; each counts as much as it scatters.
    pub fn new(spheres: &[Sphere], numbers: &[f64]) -> Self {
        let groups: Vec<Vec<Share>> = from_the_largest(spheres)
            .par_chunks(LANES)
            .map_init(SideBySide::default, |memory, places| shares(spheres, numbers, places, memory))
            .collect();
        let mut spheres: Vec<Share> = groups.into_iter().flatten().collect();
        let total: f64 = spheres.iter().map(|s| s.scattered).sum();
        spheres.retain(|s| s.scattered > 0.0);
        spheres.iter_mut().for_each(|s| s.weight *= s.scattered / total);
        Self { spheres }
    }

    /// The phase function per steradian at some cosines, and at what is opposite to each.
    pub fn both_ways(&self, cosines: &[f64]) -> [Vec<f64>; 2] {
        let last = self.spheres.iter().map(|s| s.terms.len()).max().unwrap_or(0);
        let blocks: Vec<[[f64; ANGLES]; 2]> = cosines
            .par_chunks(ANGLES)
            .map(|chunk| {
                let cosines = std::array::from_fn(|i| chunk[i.min(chunk.len() - 1)]);
                in_wide_registers(Block { spheres: &self.spheres, cosines, last })
            })
            .collect();
        [0, 1].map(|way| {
            let values = blocks.iter().flat_map(|block| block[way]);
            values.take(cosines.len()).collect()
        })
    }
}

fn shares(
    spheres: &[Sphere],
    numbers: &[f64],
    places: &[usize],
    memory: &mut SideBySide<LANES>,
) -> Vec<Share> {
    let scattered = |i: usize, e: Efficiencies| numbers[i] * spheres[i].size().powi(2) * e.scattering;
    if spheres[places[0]].number_of_terms() > LONGEST {
        let alone = places.iter().map(|&i| {
            let coefficients = Coefficients::new(spheres[i]);
            let terms = coefficients.terms().iter().copied();
            Share::new(scattered(i, coefficients.efficiencies()), coefficients.squares(), terms)
        });
        return alone.collect();
    }
    let sums = in_wide_registers(Summing { group: &filled(spheres, places), memory });
    let lanes = places.iter().enumerate().map(|(lane, &i)| {
        let terms = memory.terms.iter().map(|[a, b]| [a.at(lane), b.at(lane)]);
        let terms = terms.take(spheres[i].number_of_terms());
        Share::new(scattered(i, sums.efficiencies(lane, &spheres[i])), sums.squares[lane], terms)
    });
    lanes.collect()
}

impl Share {
    fn new(scattered: f64, squares: f64, terms: impl Iterator<Item = [Complex64; 2]>) -> Self {
        let term = |(i, [a, b]): (usize, [Complex64; 2])| {
            let n = i as f64 + 1.0;
            let weight = (2.0 * n + 1.0) / (n * (n + 1.0));
            let (sum, difference) = (weight * (a + b), weight * (a - b));
            [sum.re, sum.im, difference.re, difference.im]
        };
        let weight = 1.0 / (8.0 * PI * squares); // (3), (4)
        Self { scattered, weight, terms: terms.enumerate().map(term).collect() }
    }
}

/// All spheres at some angles.
struct Block<'a> {
    spheres: &'a [Share],
    cosines: [f64; ANGLES],
    last: usize,
}

impl Work for Block<'_> {
    type Output = [[f64; ANGLES]; 2];

    #[inline(always)]
    fn run(self) -> [[f64; ANGLES]; 2] {
        let table = functions(&self.cosines, self.last);
        let mut values = [[0.0; ANGLES]; 2];
        for sphere in self.spheres {
            let sums = amplitudes(&sphere.terms, &table);
            for (way, values) in values.iter_mut().enumerate() {
                for i in 0..ANGLES {
                    let [a, b, c, d] = [0, 1, 2, 3].map(|part| sums[4 * way + part][i]);
                    values[i] += sphere.weight * (a * a + b * b + c * c + d * d); // (3)
                }
            }
        }
        values
    }
}

/// pi_n + tau_n and pi_n - tau_n at each angle.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
struct Functions {
    plus: [f64; ANGLES],
    minus: [f64; ANGLES],
}

/// Those of n from 1 on.
#[inline(always)]
fn functions(cosines: &[f64; ANGLES], last: usize) -> Vec<Functions> {
    let (mut before, mut pi) = ([0.0; ANGLES], [1.0; ANGLES]);
    let mut table = vec![Functions { plus: before, minus: before }; last];
    for (i, place) in table.iter_mut().enumerate() {
        let n = i as f64 + 1.0;
        let (up, down) = ((2.0 * n + 1.0) / n, (n + 1.0) / n);
        for j in 0..ANGLES {
            let tau = n * cosines[j] * pi[j] - (n + 1.0) * before[j];
            place.plus[j] = pi[j] + tau;
            place.minus[j] = pi[j] - tau;
            let next = up * cosines[j] * pi[j] - down * before[j];
            before[j] = pi[j];
            pi[j] = next;
        }
    }
    table
}

/// Real and imaginary parts of S_1 + S_2 and of S_1 - S_2, ahead and at the opposite angles, by (1) and (2).
#[inline(always)]
fn amplitudes(terms: &[[f64; 4]], table: &[Functions]) -> [[f64; ANGLES]; 8] {
    let mut sums = [[0.0; ANGLES]; 8];
    let (pairs, rest) = terms.as_chunks::<2>();
    let (tables, _) = table.as_chunks::<2>();
    // Two at once: the sums may have to go to memory and back in between.
    for (terms, table) in pairs.iter().zip(tables) {
        add(&mut sums, terms, table);
    }
    if let [term] = rest {
        let functions = table[terms.len() - 1];
        add(&mut sums, &[*term, [0.0; 4]], &[functions, functions]);
    }
    sums
}

/// Adds the terms of two n in a row, the first of them odd.
#[inline(always)]
#[allow(clippy::needless_range_loop)] // of the one loop over all sums wide registers are made
fn add(sums: &mut [[f64; ANGLES]; 8], [one, two]: &[[f64; 4]; 2], [odd, even]: &[Functions; 2]) {
    for j in 0..ANGLES {
        let (p, q, r, s) = (odd.plus[j], odd.minus[j], even.plus[j], even.minus[j]);
        sums[0][j] += one[0] * p + two[0] * r;
        sums[1][j] += one[1] * p + two[1] * r;
        sums[2][j] += one[2] * q + two[2] * s;
        sums[3][j] += one[3] * q + two[3] * s;
        sums[4][j] += one[0] * q - two[0] * s;
        sums[5][j] += one[1] * q - two[1] * s;
        sums[6][j] += one[2] * p - two[2] * r;
        sums[7][j] += one[3] * p - two[3] * r;
    }
}
