//! Milk against the reference and against measurements.

use floe::optics::milk::{Milk, PRESETS};

use crate::{REFERENCE, bulk, deviation, number, rows};

fn milk(fat: f64, pressure: Option<f64>) -> Milk {
    Milk { fat, pressure, ..PRESETS[0].1 }
}

/// The rule of the reference has steps of 50 nm, too coarse for the small globules of milk with 1.5 % of fat that is
/// homogenised: it is off by 3.2e-3 at most there, which [`homogenised_milk_is_that_of_a_fine_rule`] shows.
#[test]
fn milk_is_that_of_the_reference() {
    let mut worst = [0.0_f64; 2];
    for [case, fat, pressure, lambda, expected @ ..] in rows::<8>(include_str!("../data/models/milk.csv")) {
        let milk = milk(number(fat), pressure.parse().ok());
        let found = bulk(&milk.mixture(), &[number(lambda)]);
        let [a, s, g] = [found.sigma_a[0], found.sigma_s[0], found.g[0]];
        let coarse = usize::from(case == "homogenised_20MPa" && fat == "1.5");
        for (found, expected) in [a + s, s, a, g].into_iter().zip(expected.map(number)) {
            worst[coarse] = worst[coarse].max(deviation(found, expected));
        }
    }
    println!("all but one: {:.1e}, that one {:.1e}", worst[0], worst[1]);
    assert!(worst[0] < REFERENCE && worst[1] < 4e-3, "{worst:?}");
}

/// Worked out by another program with steps of 2 nm, at which it had settled to ten digits.
#[test]
fn homogenised_milk_is_that_of_a_fine_rule() {
    for (lambda, sigma_s, g) in [(400.0, 24192.16173, 0.792_257_491), (550.0, 10886.09748, 0.748_760_607)] {
        let found = bulk(&milk(1.5, Some(20.0)).mixture(), &[lambda]);
        println!(
            "{lambda} nm: {:.1e} {:.1e}",
            deviation(found.sigma_s[0], sigma_s),
            deviation(found.g[0], g)
        );
        assert!(deviation(found.sigma_s[0], sigma_s) < 1e-4, "{}", found.sigma_s[0]);
        assert!(deviation(found.g[0], g) < 1e-4, "{}", found.g[0]);
    }
}

/// Narasimhan et al. measured regular milk diluted, by its reduced scattering sigma_s (1 - g), in 1/mm. What we compute
/// has 8 to 16 % less with globules homogenised at 20 MPa, 20 to 25 % less with the default ones: how theirs was
/// homogenised is not known.
#[test]
fn milk_is_nearly_that_of_the_measurements() {
    let measured = [(650.0, 4.55), (550.0, 5.83), (450.0, 7.14)];
    for (lambda, measured) in measured {
        for (what, pressure, bounds) in [("20 MPa", Some(20.0), 0.84..0.92), ("default", None, 0.74..0.81)] {
            let found = bulk(&milk(3.5, pressure).mixture(), &[lambda]);
            let reduced = 1e-3 * found.sigma_s[0] * (1.0 - found.g[0]);
            println!("{lambda} nm, {what}: {reduced:.3} /mm, {:.3} of that measured", reduced / measured);
            assert!(bounds.contains(&(reduced / measured)), "{lambda} nm: {reduced}");
        }
    }
}

#[test]
fn presets_in_numbers() {
    for (name, milk) in PRESETS {
        let found = bulk(&milk.mixture(), &[550.0]);
        let [a, s, g] = [found.sigma_a[0], found.sigma_s[0], found.g[0]];
        println!("| `{name}` | {:.1} % | {a:.3} | {s:.0} | {g:.3} | {:.1} um |", milk.fat, 1e6 / (a + s));
        assert!(a > 1.0 && s > 1000.0 && g > 0.5, "{name}: {found:?}");
    }
}

/// Nothing in it, and hardly anything in it, is no reason to fail.
#[test]
fn milk_without_fat_or_protein_is_water() {
    for fat in [0.0, 1e-9, 50.0] {
        for pressure in [None, Some(0.0), Some(50.0)] {
            let found = bulk(&Milk { protein: 0.0, ..milk(fat, pressure) }.mixture(), &[400.0, 700.0]);
            assert!(
                found.sigma_s.iter().chain(&found.sigma_a).all(|s| s.is_finite() && *s >= 0.0),
                "{found:?}"
            );
        }
    }
}
