//! Four dimensions of Sobol's sequence with Owen's scrambling, for any 32-bit index.
//!
//! The index is shuffled and each dimension scrambled by nested uniform scrambling, done by a hash in which low bits
//! only reach higher ones, on numbers with their bits reversed `[BURLEY20]`. The hash is that of N. Vegdahl, whose
//! statistics are closer to a true Owen scramble than the original constants.

/// What each value of each byte of the index adds to the first four dimensions, bits reversed.
static BYTES: [[[u32; 4]; 256]; 4] = byte_tables();

/// The sums of direction numbers over the bits of a byte.
const fn byte_tables() -> [[[u32; 4]; 256]; 4] {
    let directions = direction_numbers();
    let mut tables = [[[0_u32; 4]; 256]; 4];
    let mut entry = 0;
    while entry < 4 * 256 * 32 {
        let (byte, value, bit, dimension) = (entry / 8192, entry / 32 % 256, entry / 4 % 8, entry % 4);
        if value >> bit & 1 == 1 {
            tables[byte][value][dimension] ^= directions[8 * byte + bit][dimension];
        }
        entry += 1;
    }
    tables
}

/// Direction numbers, bits reversed: row b is XORed in when bit b of the index is set.
///
/// Dimension 0 is van der Corput's; the others follow from primitive polynomials (degree, inner coefficients) and
/// initial numbers `[JOE08]`.
const fn direction_numbers() -> [[u32; 4]; 32] {
    const POLYNOMIALS: [(usize, u32, [u32; 3]); 3] =
        [(1, 0, [1, 0, 0]), (2, 1, [1, 3, 0]), (3, 1, [1, 3, 1])];
    let mut rows = [[0_u32; 4]; 32];
    let mut bit = 0;
    while bit < 32 {
        rows[bit][0] = (1_u32 << (31 - bit)).reverse_bits();
        bit += 1;
    }
    let mut dimension = 0;
    while dimension < 3 {
        let (degree, coefficients, initial) = POLYNOMIALS[dimension];
        let mut v = [0_u32; 32];
        let mut i = 0;
        while i < 32 {
            v[i] = if i < degree {
                initial[i] << (31 - i)
            } else {
                let mut word = v[i - degree] ^ (v[i - degree] >> degree);
                let mut k = 1;
                while k < degree {
                    if (coefficients >> (degree - 1 - k)) & 1 == 1 {
                        word ^= v[i - k];
                    }
                    k += 1;
                }
                word
            };
            rows[i][dimension + 1] = v[i].reverse_bits();
            i += 1;
        }
        dimension += 1;
    }
    rows
}

/// Point `index` of the sequence with scramble `seed`, as 32-bit fractions.
#[inline(always)]
pub fn scrambled4(index: u32, seed: u32) -> [u32; 4] {
    let shuffled = scramble(index.reverse_bits(), seed).reverse_bits();
    let rows: [&[u32; 4]; 4] =
        std::array::from_fn(|byte| &BYTES[byte][(shuffled >> (8 * byte) & 255) as usize]);
    let reversed: [u32; 4] = std::array::from_fn(|d| rows[0][d] ^ rows[1][d] ^ rows[2][d] ^ rows[3][d]);
    let seeds = [0x8c8c_8d3f_u32, 0x1f12_3bb5, 0x5fa4_f4d1, 0xb492_b66f];
    std::array::from_fn(|d| scramble(reversed[d], seed.wrapping_mul(0x9e37_79b1) ^ seeds[d]).reverse_bits())
}

/// Nested uniform scrambling of a number whose bits are reversed.
#[inline]
fn scramble(mut x: u32, seed: u32) -> u32 {
    let seed = seed ^ (seed >> 15);
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every box of 2^-a x 2^-b with a + b = m holds exactly one of 2^m points of a (0, m, 2)-net.
    fn is_net(points: &[[u32; 4]], d: (usize, usize), m: u32) -> bool {
        (0..=m).all(|a| {
            let mut cells: Vec<u64> = points
                .iter()
                .map(|p| (u64::from(p[d.0]) >> (32 - a)) << 32 | (u64::from(p[d.1]) >> (32 - (m - a))))
                .collect();
            cells.sort_unstable();
            cells.dedup();
            cells.len() == points.len()
        })
    }

    #[test]
    fn the_first_two_dimensions_are_a_net_under_any_scramble_and_offset() {
        for seed in [0, 1, 0xdead_beef, 12345] {
            for start in [0_u32, 256, 0x4000_0000] {
                let points: Vec<_> = (start..start + 256).map(|i| scrambled4(i, seed)).collect();
                assert!(is_net(&points, (0, 1), 8), "seed {seed} start {start}");
            }
        }
    }

    #[test]
    fn every_dimension_is_stratified_far_into_the_sequence() {
        let points: Vec<_> = (0x8000_0000_u32..0x8000_0400).map(|i| scrambled4(i, 99)).collect();
        for d in 0..4 {
            let mut cells: Vec<u32> = points.iter().map(|p| p[d] >> 22).collect();
            cells.sort_unstable();
            cells.dedup();
            assert_eq!(cells.len(), 1024);
        }
    }

    #[test]
    fn the_error_of_a_smooth_integral_falls_faster_than_random_sampling() {
        // f = product of 2 x_d integrates to 1. Random sampling with n points has a standard error of
        // sqrt((4/3)^4 - 1) / sqrt(n) = 0.023 at 4096; the mean of 16 scrambled sequences stays well below a tenth of it.
        let mut worst = 0.0_f64;
        for seed in 0..16_u32 {
            let sum: f64 = (0..4096)
                .map(|i| {
                    scrambled4(i, seed.wrapping_mul(0x1234_5677))
                        .iter()
                        .map(|&x| 2.0 * f64::from(x) / 4_294_967_296.0)
                        .product::<f64>()
                })
                .sum();
            worst = worst.max((sum / 4096.0 - 1.0).abs());
        }
        assert!(worst < 0.0023, "worst error {worst}");
    }
}
