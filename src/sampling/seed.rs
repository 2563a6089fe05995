//! What a sample depends on.
//!
//! The samples of a pixel are drawn in [`REPLICATES`] independently scrambled replicates: sample s is point
//! s / R of replicate s mod R. The variance of the pixel's mean comes from the spread of the replicates' means, since
//! the points of one low-discrepancy sequence are not independent of each other.
//!
//! Within a sample, numbers come in sets of four. Each set is a four-dimensional Sobol sequence with its own scramble
//! and its own order (padding, `[BURLEY20 section 4]`). Late sets, which belong to deep bounces, are plain hashes.

use super::sobol;

/// Independently scrambled replicates in a pixel.
pub const REPLICATES: u32 = 4;

/// Sets of four numbers that are stratified; later ones are independent.
const STRATIFIED_SETS: u32 = 24;

/// Everything but the pixel and the sample's index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SampleSeed {
    /// The scene's seed.
    pub seed: u64,
    /// The frame's key.
    pub frame: i64,
}

/// The numbers of one sample, four at a time.
#[derive(Clone, Copy, Debug)]
pub struct SampleStream {
    key: u32,
    index: u32,
    set: u32,
}

impl SampleStream {
    /// The stream of sample `sample` in pixel (x, y).
    pub fn new(seed: SampleSeed, x: u32, y: u32, sample: u32) -> Self {
        let words = [
            seed.seed as u32,
            (seed.seed >> 32) as u32,
            seed.frame as u32,
            (seed.frame >> 32) as u32,
            x,
            y,
            sample % REPLICATES,
        ];
        let key = words.into_iter().fold(0x9e37_79b9, hash_pair);
        Self { key, index: sample / REPLICATES, set: 0 }
    }

    /// The stream of photon `photon` of pass `pass`; the photons of one pass are stratified among each other.
    pub fn of_photon(seed: SampleSeed, pass: u32, photon: u32) -> Self {
        // No pixel lies in that column.
        let key = hash_pair(Self::new(seed, u32::MAX, pass, 0).key, 0x9d1e_57a3);
        Self { key, index: photon, set: 0 }
    }

    /// The next four numbers in [0, 1).
    #[inline]
    pub fn next4(&mut self) -> [f32; 4] {
        let set = self.set;
        self.set += 1;
        if set < STRATIFIED_SETS {
            sobol::scrambled4(self.index, hash_pair(self.key, set)).map(unit_float)
        } else {
            pcg4d([self.index, self.key, set, 0x85eb_ca6b]).map(unit_float)
        }
    }

    /// A stream of other numbers for branch `branch` of a path that splits here.
    #[must_use]
    pub fn fork(&self, branch: u32) -> Self {
        Self { key: hash_pair(self.key ^ 0x68bc_21eb, self.set.wrapping_mul(0x9e37_79b9) ^ branch), ..*self }
    }
}

/// The 24 high bits as a number in [0, 1).
#[inline]
pub fn unit_float(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// Mixes `value` into `state`; every bit of both reaches every bit of the result.
#[inline]
pub fn hash_pair(state: u32, value: u32) -> u32 {
    // The "lowbias32" finaliser of C. Wellons' hash prospector over a rotated combination.
    let mut x = state.rotate_left(5) ^ value.wrapping_mul(0xcc9e_2d51).wrapping_add(0xe654_6b64);
    x ^= x >> 16;
    x = x.wrapping_mul(0x7feb_352d);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

/// Four hashes of four words `[JARZYNSKI20 listing 9]`.
#[inline]
fn pcg4d(words: [u32; 4]) -> [u32; 4] {
    let mixed = pcg4d_round(words.map(|v| v.wrapping_mul(1_664_525).wrapping_add(1_013_904_223)));
    pcg4d_round(mixed.map(|v| v ^ (v >> 16)))
}

#[inline]
fn pcg4d_round([mut x, mut y, mut z, mut w]: [u32; 4]) -> [u32; 4] {
    x = x.wrapping_add(y.wrapping_mul(w));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    w = w.wrapping_add(y.wrapping_mul(z));
    [x, y, z, w]
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEED: SampleSeed = SampleSeed { seed: 7, frame: 3 };

    #[test]
    fn streams_differ_in_every_argument_and_repeat_otherwise() {
        let first = |seed, x, y, s| SampleStream::new(seed, x, y, s).next4();
        let base = first(SEED, 1, 2, 5);
        assert_eq!(base, first(SEED, 1, 2, 5));
        for other in [
            first(SampleSeed { seed: 8, ..SEED }, 1, 2, 5),
            first(SampleSeed { seed: 7 + (1 << 32), ..SEED }, 1, 2, 5),
            first(SampleSeed { frame: 4, ..SEED }, 1, 2, 5),
            first(SampleSeed { frame: 3 + (1 << 32), ..SEED }, 1, 2, 5),
            first(SEED, 2, 1, 5),
            first(SEED, 1, 2, 6),
            first(SEED, 1, 2, 9),
        ] {
            assert_ne!(base, other);
        }
        let mut stream = SampleStream::new(SEED, 1, 2, 5);
        assert_ne!(stream.fork(0).next4(), stream.fork(1).next4());
        assert_ne!(stream.next4(), stream.next4());
    }

    #[test]
    fn each_replicate_is_stratified_in_each_dimension_and_pair() {
        for replicate in 0..REPLICATES {
            let points: Vec<[f32; 4]> =
                (0..64).map(|i| SampleStream::new(SEED, 11, 4, i * REPLICATES + replicate).next4()).collect();
            for d in 0..4 {
                let mut cells: Vec<u32> = points.iter().map(|p| (p[d] * 64.0) as u32).collect();
                cells.sort_unstable();
                assert_eq!(cells, (0..64).collect::<Vec<_>>(), "dimension {d}");
            }
            let mut cells: Vec<u32> =
                points.iter().map(|p| (p[0] * 8.0) as u32 * 8 + (p[1] * 8.0) as u32).collect();
            cells.sort_unstable();
            assert_eq!(cells, (0..64).collect::<Vec<_>>());
        }
    }

    #[test]
    fn late_sets_and_pixels_are_uniform_and_uncorrelated() {
        // 4096 pixels, set 30: sample mean of n uniform numbers has standard deviation sqrt(1 / 12 n); 4.5 sigma is
        // p < 1e-5 for each of the four, the correlation of neighbours likewise.
        let values: Vec<[f32; 4]> = (0..4096)
            .map(|i| {
                let mut stream = SampleStream::new(SEED, i % 64, i / 64, 0);
                for _ in 0..30 {
                    stream.next4();
                }
                stream.next4()
            })
            .collect();
        for d in 0..4 {
            let centred: Vec<f64> = values.iter().map(|v| f64::from(v[d]) - 0.5).collect();
            let mean = centred.iter().sum::<f64>() / 4096.0;
            assert!(mean.abs() < 4.5 * (1.0 / (12.0 * 4096.0_f64)).sqrt());
            let lag: f64 = centred.windows(2).map(|w| w[0] * w[1]).sum::<f64>() * 12.0 / 4095.0;
            assert!(lag.abs() < 4.5 / 4095.0_f64.sqrt());
        }
    }
}
