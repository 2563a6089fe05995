//! What a sample depends on.
//!
//! The samples of a pixel are drawn in [`REPLICATES`] independently scrambled replicates: sample s is point
//! s / R of replicate s mod R. The variance of the pixel's mean comes from the spread of the replicates' means, since
//! the points of one low-discrepancy sequence are not independent of each other.
//!
//! Frames either have sequences of their own or share them ([`SampleSeed::turn`]): in turn t, sample s of a pixel is
//!
//! ```text
//! point t ceil(S / R) + floor(s / R) of replicate s mod R                           (1)
//! ```
//!
//! With a stride S that is a power of two, what a frame takes of a sequence is an elementary block of it, stratified by
//! itself, and the blocks of the frames 0 .. 2^k are one again (`src/study/temporal.md` shows what that brings). The
//! points of a sequence end at 2^32; what lies beyond, or before its beginning, is another sequence.
//!
//! Within a sample, numbers come in sets of four. Each set is a four-dimensional Sobol sequence with its own scramble
//! and its own order (padding, `[BURLEY20 section 4]`). Late sets, which belong to deep bounces, are plain hashes.

use super::sobol;
use crate::geometry::machine::{Eight, Lanes, Word, Words};

/// Independently scrambled replicates in a pixel.
pub const REPLICATES: u32 = 4;

/// Sets of four numbers that are stratified; later ones are independent.
const STRATIFIED_SETS: u32 = 24;

/// The fourth word that late sets are hashed from.
const OF_LATE_SETS: u32 = 0x85eb_ca6b;
/// The step between random numbers.
const UNIT: f32 = 1.0 / 16_777_216.0;

/// Everything but the pixel and the sample's index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SampleSeed {
    /// The scene's seed.
    pub seed: u64,
    /// The frame's key; the same for frames that share their sequences.
    pub frame: i64,
    /// The frame's place among those that take one block after the other of shared sequences.
    pub turn: i64,
    /// Samples of a pixel from one turn to the next: a power of two.
    pub stride: u32,
}

impl SampleSeed {
    /// The seed of a single frame of key 0.
    pub const fn new(seed: u64) -> Self {
        Self { seed, frame: 0, turn: 0, stride: 1 }
    }
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
        let first = seed.turn.wrapping_mul(seed.stride.div_ceil(REPLICATES).into());
        Self::at(key(seed, x, y, sample % REPLICATES), first, sample / REPLICATES) // (1)
    }

    /// The stream of photon `photon` of the `count` of one kind of light in pass `pass`. They are stratified among each
    /// other, and with those of the same pass in other turns.
    pub fn of_photon(seed: SampleSeed, pass: u32, kind: u32, count: u32, photon: u32) -> Self {
        // No pixel lies in that column.
        let key = hash_pair(key(seed, u32::MAX, pass, 0), 0x9d1e_57a3 ^ kind);
        Self::at(key, seed.turn.wrapping_mul(count.next_power_of_two().into()), photon)
    }

    /// The stream of the point that lies `offset` after point `first`; past 2^32 points another sequence begins.
    fn at(key: u32, first: i64, offset: u32) -> Self {
        let point = first.wrapping_add(offset.into());
        let key = match (point >> 32) as u32 {
            0 => key,
            sequence => hash_pair(key, sequence),
        };
        Self { key, index: point as u32, set: 0 }
    }

    /// The next four numbers in [0, 1).
    ///
    /// Long walks draw late sets only, in a loop that a call makes some 6 % slower.
    #[inline(always)]
    pub fn next4(&mut self) -> [f32; 4] {
        let set = self.set;
        self.set += 1;
        if set < STRATIFIED_SETS {
            self.stratified4(set)
        } else {
            pcg4d([self.index, self.key, set, OF_LATE_SETS]).map(unit_float)
        }
    }

    /// The next eight sets by number and set, none of which is taken yet.
    #[inline(always)]
    pub(crate) fn ahead<L: Lanes>(&self) -> [L; 4] {
        if self.set < STRATIFIED_SETS {
            let [a, b, c, d] = &self.ahead_one_by_one();
            return [L::load(a), L::load(b), L::load(c), L::load(d)];
        }
        let sets = L::Words::splat(self.set).add(L::Words::lane_numbers());
        let (index, key) = (L::Words::splat(self.index), L::Words::splat(self.key));
        let [a, b, c, d] = pcg4d([index, key, sets, L::Words::splat(OF_LATE_SETS)]);
        [unit_floats(a), unit_floats(b), unit_floats(c), unit_floats(d)]
    }

    #[inline(never)]
    fn ahead_one_by_one(&self) -> [Eight; 4] {
        let mut stream = *self;
        let sets: [[f32; 4]; 8] = std::array::from_fn(|_| stream.next4());
        std::array::from_fn(|number| Eight(sets.map(|set| set[number])))
    }

    /// Takes so many sets.
    #[inline(always)]
    pub(crate) fn skip(&mut self, sets: usize) {
        self.set += sets as u32;
    }

    #[inline(never)]
    fn stratified4(&self, set: u32) -> [f32; 4] {
        sobol::scrambled4(self.index, hash_pair(self.key, set)).map(unit_float)
    }

    /// A stream of other numbers for branch `branch` of a path that splits here.
    #[must_use]
    pub fn fork(&self, branch: u32) -> Self {
        Self { key: hash_pair(self.key ^ 0x68bc_21eb, self.set.wrapping_mul(0x9e37_79b9) ^ branch), ..*self }
    }
}

/// Names the sequence of a replicate of a pixel.
fn key(seed: SampleSeed, x: u32, y: u32, replicate: u32) -> u32 {
    let words = [
        seed.seed as u32,
        (seed.seed >> 32) as u32,
        seed.frame as u32,
        (seed.frame >> 32) as u32,
        x,
        y,
        replicate,
    ];
    words.into_iter().fold(0x9e37_79b9, hash_pair)
}

/// The 24 high bits as a number in [0, 1).
#[inline]
pub fn unit_float(bits: u32) -> f32 {
    (bits >> 8) as f32 * UNIT
}

/// The same of eight; by way of signed numbers, for which there is an instruction.
#[inline(always)]
fn unit_floats<W: Words>(bits: W) -> W::Lanes {
    bits.shifted_right::<8>().signed_value().mul(Lanes::splat(UNIT))
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
#[inline(always)]
fn pcg4d<W: Word>([x, y, z, w]: [W; 4]) -> [W; 4] {
    let [x, y, z, w] = pcg4d_round([stepped(x), stepped(y), stepped(z), stepped(w)]);
    pcg4d_round([folded(x), folded(y), folded(z), folded(w)])
}

#[inline(always)]
fn stepped<W: Word>(word: W) -> W {
    word.mul(W::splat(1_664_525)).add(W::splat(1_013_904_223))
}

#[inline(always)]
fn folded<W: Word>(word: W) -> W {
    word.xor(word.shifted_right::<16>())
}

#[inline(always)]
fn pcg4d_round<W: Word>([mut x, mut y, mut z, mut w]: [W; 4]) -> [W; 4] {
    x = x.add(y.mul(w));
    y = y.add(z.mul(x));
    z = z.add(x.mul(y));
    w = w.add(y.mul(z));
    [x, y, z, w]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::machine::{WithLanes, with_best};
    use crate::geometry::portable::Portable;

    struct Ahead(SampleStream);

    impl WithLanes for Ahead {
        type Output = [Eight; 4];

        #[inline(always)]
        fn run<L: Lanes>(self) -> [Eight; 4] {
            self.0.ahead::<L>().map(|numbers| {
                let mut all = Eight([0.0; 8]);
                numbers.store(&mut all);
                all
            })
        }
    }

    #[test]
    fn what_is_drawn_ahead_is_what_comes() {
        let mut ahead = SampleStream::new(SEED, 1, 2, 5);
        let mut stream = ahead;
        for taken in (0..40).map(|i| i % 9) {
            let sets = with_best(Ahead(ahead));
            assert_eq!(sets, Ahead(ahead).run::<Portable>());
            for set in 0..taken {
                assert_eq!([0, 1, 2, 3].map(|number| sets[number].0[set]), stream.next4());
            }
            ahead.skip(taken);
        }
    }

    const SEED: SampleSeed = SampleSeed { seed: 7, frame: 3, turn: 0, stride: 64 };

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
            first(SampleSeed { turn: 1, ..SEED }, 1, 2, 5),
            first(SampleSeed { turn: -1, ..SEED }, 1, 2, 5),
            // Past the end of the sequence: 2^28 turns of 16 points.
            first(SampleSeed { turn: 1 << 28, ..SEED }, 1, 2, 5),
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

    /// All sets, the late ones too.
    fn numbers(mut stream: SampleStream) -> Vec<[f32; 4]> {
        (0..STRATIFIED_SETS + 4).map(|_| stream.next4()).collect()
    }

    #[test]
    fn a_turn_goes_on_where_the_one_before_it_ends() {
        let next = SampleSeed { turn: 1, ..SEED };
        for i in [0, 1, 6, 63] {
            assert_eq!(
                numbers(SampleStream::new(next, 1, 2, i)),
                numbers(SampleStream::new(SEED, 1, 2, SEED.stride + i))
            );
            assert_eq!(
                numbers(SampleStream::of_photon(next, 5, 1, 100, i)),
                numbers(SampleStream::of_photon(SEED, 5, 1, 100, 128 + i))
            );
        }
        // One sample a turn stays in its replicate.
        let turn = |turn| SampleSeed { turn, stride: 1, ..SEED };
        assert_eq!(
            numbers(SampleStream::new(turn(3), 1, 2, 0)),
            numbers(SampleStream::new(turn(0), 1, 2, 3 * REPLICATES))
        );
        let photon = |kind| SampleStream::of_photon(SEED, 5, kind, 100, 3).next4();
        assert_ne!(photon(0), photon(1));
    }

    #[test]
    fn photons_of_each_kind_of_light_are_stratified() {
        for kind in 0..3 {
            let photon = |i| SampleStream::of_photon(SEED, 2, kind, 64, i).next4();
            assert!(is_net(&(0..64).map(photon).collect::<Vec<_>>(), 6), "{kind}");
        }
    }

    /// Every box of 2^-a x 2^-b with a + b = m holds exactly one of 2^m points.
    fn is_net(points: &[[f32; 4]], m: i32) -> bool {
        (0..=m).all(|a| {
            let cell = |p: &[f32; 4]| ((p[0] * 2_f32.powi(a)) as u32, (p[1] * 2_f32.powi(m - a)) as u32);
            let cells: std::collections::BTreeSet<_> = points.iter().map(cell).collect();
            cells.len() == points.len()
        })
    }

    #[test]
    fn the_frames_of_aligned_turns_are_one_net_in_each_replicate() {
        let last = (1 << 28) - 8;
        for (first, count) in [(0, 1), (0, 8), (4, 4), (-8, 8), (last, 8), (1 << 40, 2)] {
            for replicate in 0..REPLICATES {
                let of_turn = |turn| {
                    let seed = SampleSeed { turn, ..SEED };
                    (0..16).map(move |i| SampleStream::new(seed, 9, 4, i * REPLICATES + replicate).next4())
                };
                let points: Vec<_> = (first..first + count).flat_map(of_turn).collect();
                assert!(is_net(&points, 4 + count.ilog2() as i32), "{first} {count} {replicate}");
            }
        }
        // Frames of their own are nets each, but not together.
        let of_frame = |frame| {
            let seed = SampleSeed { frame, ..SEED };
            (0..16).map(move |i| SampleStream::new(seed, 9, 4, i * REPLICATES).next4())
        };
        assert!(!is_net(&(0..8).flat_map(of_frame).collect::<Vec<_>>(), 7));
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
