//! The phase function of many spheres together, at angles that mirror each other.
//!
//! ```text
//! S_1 +- S_2 = sum (2n+1)/(n(n+1)) (a_n +- b_n) (pi_n +- tau_n)                                       (1)
//! (pi_n +- tau_n)(-mu) = (-1)^(n+1) (pi_n -+ tau_n)(mu)                                               (2)
//! |S_1|^2 + |S_2|^2 = (|S_1 + S_2|^2 + |S_1 - S_2|^2) / 2                                             (3)
//! p = sum w (|S_1|^2 + |S_2|^2) / (4 pi sum (2n+1) (|a_n|^2 + |b_n|^2)) / sum w                       (4)
//! ```
//!
//! (1) is half of the products of `[BOHREN83 eq. 4.74]` `[WISCOMBE80]`; by (2), the parity of Legendre functions, one
//! table of pi_n and tau_n serves both sides. The angles go side by side, the spheres one after the other.

use std::f64::consts::PI;

use rayon::prelude::*;

use super::coefficients::SideBySide;
use super::efficiencies::Sums;
use super::many::{LANES, LONGEST, filled, from_the_largest};
use super::{Coefficients, Sphere};
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
    /// The factor of |S_1 + S_2|^2 + |S_1 - S_2|^2.
    weight: f64,
    /// (2n+1)/(n(n+1)) (a_n +- b_n), n from 1 on: real and imaginary part of the sum and of the difference.
    terms: Vec<[f64; 4]>,
}

impl Pattern {
    /// Of spheres that scatter as much as their weights say, of which one at least is above 0.
    pub fn new(spheres: &[Sphere], weights: &[f64]) -> Self {
        let total: f64 = weights.iter().sum();
        let order = from_the_largest(spheres);
        let shares: Vec<Vec<Share>> = order
            .par_chunks(LANES)
            .map_init(SideBySide::default, |memory, places| {
                let shares = shares(spheres, places, memory);
                let weighted = shares.into_iter().zip(places);
                weighted
                    .map(|(share, &i)| Share { weight: share.weight * (weights[i] / total), ..share })
                    .collect()
            })
            .collect();
        Self { spheres: shares.into_iter().flatten().collect() }
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

fn shares(spheres: &[Sphere], places: &[usize], memory: &mut SideBySide<LANES>) -> Vec<Share> {
    if spheres[places[0]].number_of_terms() > LONGEST {
        let alone = places.iter().map(|&i| {
            let coefficients = Coefficients::new(spheres[i]);
            Share::new(coefficients.squares(), coefficients.terms().iter().copied())
        });
        return alone.collect();
    }
    let sums = in_wide_registers(Expanding { group: &filled(spheres, places), memory });
    let lanes = places.iter().enumerate().map(|(lane, &i)| {
        let terms = memory.terms.iter().map(|[a, b]| [a.at(lane), b.at(lane)]);
        Share::new(sums.squares[lane], terms.take(spheres[i].number_of_terms()))
    });
    lanes.collect()
}

impl Share {
    fn new(squares: f64, terms: impl Iterator<Item = [num_complex::Complex64; 2]>) -> Self {
        let term = |(i, [a, b]): (usize, [num_complex::Complex64; 2])| {
            let n = i as f64 + 1.0;
            let weight = (2.0 * n + 1.0) / (n * (n + 1.0));
            let (sum, difference) = (weight * (a + b), weight * (a - b));
            [sum.re, sum.im, difference.re, difference.im]
        };
        // A sphere of the host's own matter scatters nothing anywhere.
        let weight = if squares > 0.0 { 1.0 / (8.0 * PI * squares) } else { 0.0 }; // (3), (4)
        Self { weight, terms: terms.enumerate().map(term).collect() }
    }
}

struct Expanding<'a> {
    group: &'a [Sphere; LANES],
    memory: &'a mut SideBySide<LANES>,
}

impl Work for Expanding<'_> {
    type Output = Sums<LANES>;

    #[inline(always)]
    fn run(self) -> Sums<LANES> {
        self.memory.compute(self.group);
        let mut sums = Sums::new();
        for (i, terms) in self.memory.terms.iter().enumerate() {
            sums.add(i as f64 + 1.0, terms);
        }
        sums
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

/// pi_n + tau_n and pi_n - tau_n at each angle, n from 1 on.
#[inline(always)]
fn functions(cosines: &[f64; ANGLES], last: usize) -> Vec<[[f64; ANGLES]; 2]> {
    let (mut before, mut pi) = ([0.0; ANGLES], [1.0; ANGLES]);
    let mut table = vec![[[0.0; ANGLES]; 2]; last];
    for (i, place) in table.iter_mut().enumerate() {
        let n = i as f64 + 1.0;
        let (up, down) = ((2.0 * n + 1.0) / n, (n + 1.0) / n);
        for j in 0..ANGLES {
            let tau = n * cosines[j] * pi[j] - (n + 1.0) * before[j];
            place[0][j] = pi[j] + tau;
            place[1][j] = pi[j] - tau;
            let next = up * cosines[j] * pi[j] - down * before[j];
            before[j] = pi[j];
            pi[j] = next;
        }
    }
    table
}

/// Real and imaginary parts of S_1 + S_2 and of S_1 - S_2, ahead and at the opposite angles, by (1) and (2).
#[inline(always)]
fn amplitudes(terms: &[[f64; 4]], table: &[[[f64; ANGLES]; 2]]) -> [[f64; ANGLES]; 8] {
    let mut sums = [[0.0; ANGLES]; 8];
    let mut pairs = terms.chunks_exact(2).zip(table.chunks_exact(2));
    for (terms, table) in pairs.by_ref() {
        let ([a, b, c, d], [e, f, g, h]) = (terms[0], terms[1]);
        for j in 0..ANGLES {
            let ([p, q], [r, s]) = ([table[0][0][j], table[0][1][j]], [table[1][0][j], table[1][1][j]]);
            sums[0][j] += a * p + e * r;
            sums[1][j] += b * p + f * r;
            sums[2][j] += c * q + g * s;
            sums[3][j] += d * q + h * s;
            sums[4][j] += a * q - e * s;
            sums[5][j] += b * q - f * s;
            sums[6][j] += c * p - g * r;
            sums[7][j] += d * p - h * r;
        }
    }
    if let [[a, b, c, d]] = *terms.chunks_exact(2).remainder() {
        let [plus, minus] = &table[terms.len() - 1];
        for j in 0..ANGLES {
            sums[0][j] += a * plus[j];
            sums[1][j] += b * plus[j];
            sums[2][j] += c * minus[j];
            sums[3][j] += d * minus[j];
            sums[4][j] += a * minus[j];
            sums[5][j] += b * minus[j];
            sums[6][j] += c * plus[j];
            sums[7][j] += d * plus[j];
        }
    }
    sums
}
