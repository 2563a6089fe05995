//! The rates that intervals state, and those at which they hold.
//!
//! Significance is 1e-4 for each test: a rate is too low when so many or fewer would be held in fewer than 1e-4 of all
//! cases, over all pictures and, divided by their number, over those of each scene.

use crate::coverage::{Tally, stopped, tallies};
use crate::scenes::{Scene, firefly_scenes, scenes};

const SIGNIFICANCE: f64 = 1e-4;

/// What the intervals state.
const STATED: [f64; 2] = [0.95, 0.68];

/// Rates over all pictures without a warning that are too high: such an interval says too little. Intervals are too wide
/// where pixels have heavy tails; over 200 seeds 0.97 and 0.77 are measured (`src/film/estimate.md`).
const TOO_HIGH: [f64; 2] = [0.99, 0.86];

/// Prints the table and returns what is in it.
fn measured(scenes: &[Scene], times: u32, plan: &[(u32, u32)], more: u32) -> Vec<(&'static str, Tally)> {
    println!(
        "| scene | samples | error | estimate | width | 95 % | 68 % | warned |\n|---|---|---|---|---|---|---|---|"
    );
    let mut all = Vec::new();
    for scene in scenes {
        for tally in tallies(scene, times, plan, more) {
            println!("{}", tally.line(scene.name));
            all.push((scene.name, tally));
        }
    }
    all
}

/// Probability of `count` or fewer of `n`, each of probability `p`.
fn binomial_tail(count: u32, n: u32, p: f64) -> f64 {
    let ln_choose = |k: f64| {
        let n = f64::from(n);
        libm::lgamma(n + 1.0) - libm::lgamma(k + 1.0) - libm::lgamma(n - k + 1.0)
    };
    let term =
        |k: u32| (ln_choose(k.into()) + f64::from(k) * p.ln() + f64::from(n - k) * (1.0 - p).ln()).exp();
    (0..=count).map(term).sum()
}

fn assert_rates(rows: &[(&str, Tally)]) {
    for (i, stated) in STATED.into_iter().enumerate() {
        for (name, tally) in rows {
            let chance = binomial_tail(tally.held[i], tally.pictures, stated);
            let limit = SIGNIFICANCE / rows.len() as f64;
            assert!(
                chance > limit,
                "{name}, {} samples: rate {:.3} for {stated}",
                tally.samples,
                tally.rate(i)
            );
        }
        let sum = |f: &dyn Fn(&Tally) -> u32| rows.iter().map(|(_, tally)| f(tally)).sum::<u32>();
        let (held, pictures) = (sum(&|t| t.held[i]), sum(&|t| t.pictures));
        let silent: Vec<&Tally> = rows.iter().map(|(_, t)| t).filter(|t| t.warned == 0).collect();
        let rate = silent.iter().map(|t| t.rate(i)).sum::<f64>() / silent.len() as f64;
        println!("{stated}: {held} of {pictures} are held; rate without warnings {rate:.3}");
        assert!(binomial_tail(held, pictures, stated) > SIGNIFICANCE, "{held} of {pictures} for {stated}");
        assert!(rate < TOO_HIGH[i], "a rate of {rate:.3} for {stated} says too little");
    }
}

#[test]
fn intervals_of_twenty_scenes_hold_at_the_rate_that_they_state() {
    assert_rates(&measured(&scenes(), 1, &[(4, 20), (16, 20)], 512));
}

/// Pictures that stop at a target, of 48 x 32 pixels in six tiles: to stop when the error is small enough is not to choose
/// the pictures whose estimate is too small.
#[test]
fn intervals_of_pictures_that_stop_at_a_target_hold_too() {
    let targets = [
        ("clear waves, sky", 0.045),
        ("turbid cube, lamp and sky", 0.07),
        ("turbid waves, sky picture", 0.12),
        ("stratified sea ball, sun", 0.09),
        ("photons: moving ball, sun", 0.11),
    ];
    let scenes = scenes();
    let row = |(name, target): (&'static str, f64)| {
        let Some(scene) = scenes.iter().find(|scene| scene.name == name) else { panic!("no {name}") };
        let tally = stopped(scene, target, 20, 1024);
        println!("{} {} of {} uneven", tally.line(name), tally.uneven, tally.pictures);
        (name, tally)
    };
    let rows = targets.map(row);
    assert!(rows.iter().filter(|(_, tally)| tally.uneven > 0).count() >= 3, "tiles have unlike counts");
    assert_rates(&rows);
}

#[test]
#[ignore = "ten minutes: the table of src/film/estimate.md"]
fn intervals_of_twenty_scenes_over_many_seeds() {
    assert_rates(&measured(&scenes(), 1, &[(4, 200), (16, 200), (64, 100)], 4096));
}

/// Of 6144 pixels, whose error is known to a hundredth: there is no room for a bias of the estimate.
#[test]
#[ignore = "minutes: the second table of src/film/estimate.md"]
fn intervals_of_larger_pictures() {
    assert_rates(&measured(&scenes(), 4, &[(4, 20), (16, 20)], 0));
}

/// What chance finds rarely is told, or the interval holds. Of light that no sample has found nothing can be told:
/// pictures of 24 x 16 pixels are too small for these scenes.
#[test]
#[ignore = "minutes: the third table of src/film/estimate.md"]
fn fireflies_are_told() {
    let rows = measured(&firefly_scenes(), 4, &[(4, 20), (16, 20)], 1024);
    for (name, tally) in &rows {
        println!("{name}: {} of {} are silent and wrong", tally.silent, tally.pictures);
        assert!(
            tally.silent <= 1,
            "{name}, {} samples: {} are silent and wrong",
            tally.samples,
            tally.silent
        );
    }
}
