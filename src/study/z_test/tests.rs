//! How often the test is wrong, and what it finds.

use glam::{DVec3, Vec2, Vec3};

use super::*;
use crate::film::{FilmSample, Pixel, PixelAccumulator};
use crate::sampling::seed::{hash_pair, unit_float};

/// Uniform numbers that depend on their place in a sequence.
struct Random(u32, u32);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.1 += 1;
        f64::from(unit_float(hash_pair(self.0, self.1)))
    }

    /// Of variance 1: a sum of 12.
    fn bell(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }

    /// Of variance 1.
    fn exponential(&mut self) -> f64 {
        -(1.0 - self.uniform()).ln() - 1.0
    }

    /// Of variance 1: mostly the same, and rarely 14 deviations above.
    fn rare(&mut self) -> f64 {
        if self.uniform() < 0.005 { 14.1 } else { -0.0707 }
    }
}

/// Finished pixels of 8 samples of mean 1 and the deviation `noise` in independent channels.
fn pixels(noise: f64, draw: fn(&mut Random) -> f64, seed: u32) -> Vec<Pixel> {
    let mut random = Random(seed, 0);
    let mut pixel = || {
        let mut sums = PixelAccumulator::new();
        for s in 0..8 {
            let mut radiance = || (1.0 + noise * draw(&mut random)) as f32;
            let radiance = Vec3::new(radiance(), radiance(), radiance());
            sums.add(s, &FilmSample { motion: Vec2::ZERO, ..FilmSample::of_sky(radiance) });
        }
        sums.finish()
    };
    (0..4096).map(|_| pixel()).collect()
}

/// A picture of pixels that are drawn from some.
fn drawn(from: &[&[Pixel]], width: usize, height: usize, random: &mut Random) -> StoredPicture {
    let mut draw = |p: usize| {
        let from = from[p % from.len()];
        from[(random.uniform() * from.len() as f64) as usize]
    };
    let pixels: Vec<Pixel> = (0..width * height).map(&mut draw).collect();
    StoredPicture {
        width,
        height,
        colours: pixels.iter().map(|pixel| pixel.rgb).collect(),
        alpha: None,
        variances: Some(pixels.iter().map(|pixel| pixel.variance).collect()),
        samples: Some(pixels.iter().map(|pixel| pixel.samples as f32).collect()),
        rounding: 2.4e-7,
        shares_noise: false,
    }
}

/// How many of some pairs of pictures (three blocks) that differ by nothing but noise have p below each.
fn wrong(from: &[&[Pixel]], pairs: usize, below: [f64; 2]) -> [usize; 2] {
    let mut random = Random(7, 0);
    let mut wrong = [0; 2];
    for _ in 0..pairs {
        let [a, b] = [(); 2].map(|()| drawn(from, 3 * BLOCK, BLOCK, &mut random));
        let p = z_test(&a, &b).unwrap().p;
        wrong.iter_mut().zip(below).for_each(|(wrong, below)| *wrong += usize::from(p < below));
    }
    wrong
}

/// Of 20,000 pairs a test of the size alpha is wrong 20,000 alpha times, +- the root: 20 +- 4.5 and 1000 +- 31. Bonferroni's
/// bound is not quite reached: the twelve hypotheses are independent but for a whole that contains its parts, so
/// 0.05 becomes 0.049 and less. Four deviations to either side, and for the larger 5 % of Bonferroni below.
#[test]
fn the_test_is_wrong_as_often_as_it_says() {
    let even = pixels(0.1, Random::bell, 1);
    let [few, many] = wrong(&[&even], 20_000, [0.001, 0.05]);
    assert!((3..=38).contains(&few) && (820..=1124).contains(&many), "{few} {many}");
}

/// One pixel in eight has 30 times the noise of the others, so 32 of a block count: some 192 degrees of freedom. The limits
/// are those above.
#[test]
fn pixels_of_uneven_noise_make_it_wrong_no_more_often() {
    let [quiet, loud] = [(0.01, 2), (0.3, 3)].map(|(noise, seed)| pixels(noise, Random::bell, seed));
    let from = [&loud, &quiet, &quiet, &quiet, &quiet, &quiet, &quiet, &quiet].map(Vec::as_slice);
    let [few, many] = wrong(&from, 20_000, [0.001, 0.05]);
    assert!((3..=38).contains(&few) && (820..=1124).contains(&many), "{few} {many}");
}

/// Skewed noise, and noise that is seldom seen at all: at most as often as it says, four deviations.
#[test]
fn noise_with_great_values_makes_it_wrong_less_often() {
    for draw in [Random::exponential, Random::rare] {
        let [few, many] = wrong(&[&pixels(0.3, draw, 4)], 10_000, [0.001, 0.05]);
        assert!(few <= 10 + 12 && many <= 500 + 87, "{few} {many}");
    }
}

/// 20 % of noise a sample are 7 % a pixel: a mean of 64 x 64 pixels is known to 0.11 %, a difference of two to 0.16 %.
/// At p = 0.001 / 6 one of 3.8 deviations is found every other time: 0.6 %. One of 1.5 % is 9.6 deviations.
#[test]
fn a_bias_of_the_whole_picture_is_found() {
    let from = pixels(0.2, Random::bell, 5);
    let mut random = Random(8, 0);
    for bias in [0.985, 1.015] {
        let mut a = drawn(&[&from], 64, 64, &mut random);
        let b = drawn(&[&from], 64, 64, &mut random);
        a.colours.iter_mut().for_each(|c| c.y *= bias);
        let test = z_test(&a, &b).unwrap();
        assert!(test.p < 1e-9, "{test:?}");
        assert_eq!((test.worst.channel, test.worst.size), ("G", [64, 64]));
        assert_eq!(test.worst.t > 0.0, bias > 1.0);
        assert!((test.worst.relative - f64::from(bias - 1.0)).abs() < 0.007, "{test:?}");
        assert!((test.detectable - 0.006).abs() < 0.0003, "{test:?}");
    }
}

/// The difference of the last block, which has 10 x 8 pixels, is known to 1.1 %: 10 % are 8.9 deviations. Of the whole they
/// are 0.03 %, half a deviation.
#[test]
fn a_difference_in_one_place_is_found_and_named() {
    let from = pixels(0.2, Random::bell, 6);
    let mut random = Random(9, 0);
    let [mut a, b] = [(); 2].map(|()| drawn(&[&from], 250, 120, &mut random));
    for p in (0..a.colours.len()).filter(|p| p % 250 / BLOCK == 15 && p / 250 / BLOCK == 7) {
        a.colours[p] *= 0.9;
    }
    let test = z_test(&a, &b).unwrap();
    assert!(test.p < 1e-6, "{test:?}");
    assert_eq!((test.worst.at, test.worst.size), ([240, 112], [10, 8]));
}

#[test]
fn degrees_of_freedom_are_those_of_equal_pixels() {
    let pixel = |v: f64| Sums {
        variance: DVec3::splat(v),
        squares: DVec3::splat(v * v / 5.0),
        pixels: 1,
        ..Sums::default()
    };
    assert!((pixel(0.3).degrees_of_freedom(0) - 3.0).abs() < 1e-12);
    // Estimates that happen to be equal are of more degrees than those of one variance: 5 N - 2.
    let mut sums = pixel(0.3);
    (1..10).for_each(|_| sums.add(&pixel(0.3)));
    assert!((sums.degrees_of_freedom(2) - 48.0).abs() < 1e-9);
    assert_eq!(pixel(0.0).degrees_of_freedom(1), 1.0);
}

#[test]
fn pixels_without_noise_may_differ_by_rounding_alone() {
    let flat = |value: f32, with: bool| StoredPicture {
        width: 4,
        height: 4,
        colours: vec![Vec3::splat(value); 16],
        alpha: None,
        variances: with.then(|| vec![Vec3::ZERO; 16]),
        samples: None,
        rounding: 2.4e-7,
        shares_noise: false,
    };
    let test = |a: f32, b: f32| z_test(&flat(a, true), &flat(b, false)).unwrap();
    assert_eq!(test(0.6, 0.6_f32.next_up().next_up()).p, 1.0);
    let different = test(0.6, 0.600_01);
    assert_eq!((different.p, different.worst.t), (0.0, f64::NEG_INFINITY));
    assert_eq!(z_test(&flat(0.6, false), &flat(0.6, false)), Err(NoTest::NoVariance));
    let photons = StoredPicture { shares_noise: true, ..flat(0.6, true) };
    assert_eq!(z_test(&flat(0.6, true), &photons), Err(NoTest::SharedNoise));
}

#[test]
fn what_cannot_be_tested_is_left_out() {
    let from = pixels(0.2, Random::bell, 5);
    let mut random = Random(10, 0);
    let [mut a, mut b] = [(); 2].map(|()| drawn(&[&from], 20, 20, &mut random));
    a.colours[3] = Vec3::NAN;
    b.colours[4].y = f32::INFINITY;
    b.samples.as_mut().unwrap()[5] = 1.0;
    a.variances.as_mut().unwrap()[6].x = f32::NAN;
    let test = z_test(&a, &b).unwrap();
    assert!(test.left_out == 4 && test.p > 0.001, "{test:?}");
    b.samples.as_mut().unwrap().fill(1.0);
    assert_eq!(z_test(&a, &b), Err(NoTest::TooFewSamples));
}
