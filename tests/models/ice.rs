//! What ice encloses, and what that does to light.

use floe::optics::ice::iceberg::{Iceberg, PRESETS, TEMPERATURE};
use floe::optics::ice::{contents, density};

use crate::{bulk, deviation, number, rows};

/// The reference has six digits.
#[test]
fn brine_and_air_are_those_of_cox_and_weeks() {
    let mut count = 0;
    for row in rows::<5>(include_str!("../data/models/ice.csv")) {
        let [temperature, salinity, kg, brine, air] = row.map(number);
        let found = contents(temperature, salinity, kg).unwrap();
        assert!((found.brine - brine).abs() < 1e-6, "{row:?}: {found}");
        assert!((found.air - air).abs() < 1e-6, "{row:?}: {found}");
        assert!(deviation(density(temperature, salinity, found.air), kg) < 1e-12, "{row:?}");
        count += 1;
    }
    assert_eq!(count, 10);
}

/// Large spheres that refract scatter two times their shadow, 2 x 3 v / (4 r_32), and by a series of Hankel functions
/// 1.01 times that; r_32 = int r^3 N / int r^2 N is 44.9 um for N ~ r^-1.24 from 4 to 70 um.
#[test]
fn bubbles_scatter_by_their_shadow() {
    let power = |e: f64| (70e-6_f64.powf(e) - 4e-6_f64.powf(e)) / e;
    let shadow = 1.5 * 0.01 / (power(4.0 - 1.24) / power(3.0 - 1.24));
    let ice = Iceberg { temperature: -15.0, salinity: 0.0, density: density(-15.0, 0.0, 0.01), algae: 0.0 };
    let found = bulk(&ice.mixture().unwrap(), &[550.0]);
    println!("{} 1/m, shadow {shadow} 1/m, g {}", found.sigma_s[0], found.g[0]);
    assert!((1.0..1.02).contains(&(found.sigma_s[0] / shadow)), "{}", found.sigma_s[0]);
    // 337.36 1/m and 0.8583, worked out elsewhere.
    assert!(deviation(found.sigma_s[0], 337.36366) < 1e-3, "{}", found.sigma_s[0]);
    assert!(deviation(found.g[0], 0.85829354) < 1e-3, "{}", found.g[0]);
    // 4 pi 2.289e-9 / 550 nm.
    assert!(deviation(found.sigma_a[0], 0.0523) < 2e-2, "{}", found.sigma_a[0]);
}

#[test]
fn presets_in_numbers() {
    for (name, preset) in PRESETS {
        let kg = density(TEMPERATURE, 0.0, preset.air);
        let ice = Iceberg { temperature: TEMPERATURE, salinity: 0.0, density: kg, algae: preset.algae };
        let found = bulk(&ice.mixture().unwrap(), &[550.0]);
        let [a, s, g] = [found.sigma_a[0], found.sigma_s[0], found.g[0]];
        println!(
            "| `{name}` | {kg:.1} | {:.2} % | {a:.4} | {s:.1} | {g:.3} | {:.1} mm |",
            100.0 * preset.air,
            1e3 / (a + s)
        );
        assert!(a > 0.05 && s > 0.0 && g > 0.8, "{name}: {found:?}");
    }
}

/// Brine that melts within ice scatters ahead: its index is near to that of ice.
#[test]
fn salt_ice_has_brine_that_scatters_ahead() {
    let ice = Iceberg { temperature: -5.0, salinity: 5.0, density: density(-5.0, 5.0, 0.0), algae: 0.0 };
    let mixture = ice.mixture().unwrap();
    assert_eq!(mixture.species.iter().map(|s| s.name.as_str()).collect::<Vec<_>>(), ["brine"]);
    let found = bulk(&mixture, &[550.0]);
    println!("brine of 5 parts per thousand at -5 degrees: {} 1/m, g {}", found.sigma_s[0], found.g[0]);
    assert!(found.g[0] > 0.98, "{}", found.g[0]);
}
