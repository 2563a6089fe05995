//! The cosines under which light comes in that a half space reflects.

use floe::optics::density::Density;
use floe::optics::half_space::{HalfSpace, Reflection};
use floe::optics::medium::Medium;
use floe::optics::phase::{HenyeyGreenstein, PhaseFunction};
use floe::sampling::{SampleSeed, SampleStream};
use floe::spectrum::{LaneCurve, Lanes, Wavelengths};

use super::tests_of_fit::{assert_fits, cell_of};

const CELLS: usize = 40;

/// Of reduced albedos 1, 0.99, 0.5 and 0 in its lanes.
fn along(mu: f32) -> Reflection {
    let (sigma_s, g) = (Lanes::new(2.0, 0.99, 0.5, 0.0), 0.5);
    let medium = Medium {
        name: "milk".into(),
        n: 1.0,
        sigma_a: LaneCurve::Rgb(Lanes::new(0.0, 0.01, 0.5, 1.0)),
        sigma_s: LaneCurve::Rgb(sigma_s / (1.0 - g)),
        emission: LaneCurve::Constant(0.0),
        phase: PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g }).into(),
        density: Density::Homogeneous,
    };
    HalfSpace::of(&medium).lanes(&Wavelengths::RGB).along(mu)
}

/// In cells that are even in the root of the cosine, by 64 points of the midpoint rule in each: measured 1e-6 off.
#[test]
fn incoming_cosines_follow_their_density() {
    let throughputs = [Lanes::X, Lanes::Y, Lanes::Z, Lanes::new(0.3, 0.5, 1.0, 0.7)];
    for ((i, mu), (j, throughput)) in
        (0..).zip([1.0, 0.3, 0.001]).flat_map(|a| (0..).zip(throughputs).map(move |b| (a, b)))
    {
        let reflection = along(mu);
        let share = |cell: usize| -> f64 {
            let points = (0..64).map(|k| (cell as f64 + (f64::from(k) + 0.5) / 64.0) / CELLS as f64);
            let density = |root: f64| {
                let pdf_w = reflection.pdf_w((root * root) as f32, throughput);
                f64::from(pdf_w) * 2.0 * std::f64::consts::PI * 2.0 * root / (64.0 * CELLS as f64)
            };
            points.map(density).sum()
        };
        let shares: Vec<f64> = (0..CELLS).map(share).collect();
        let total: f64 = shares.iter().sum();
        assert!((total - 1.0).abs() < 1e-4, "mu {mu}, {throughput}: {total}");
        let shares: Vec<f64> = shares.iter().map(|share| share / total).collect();
        let mut draws = 0;
        assert_fits(&format!("half space, mu {mu}, {throughput}"), 80 + u64::from(4 * i + j), &shares, |u| {
            draws += 1;
            let mut stream = SampleStream::new(SampleSeed::new(5), draws, i, j);
            let drawn = reflection.sample(throughput, u[0], &mut stream);
            cell_of(drawn.map_or(0.0, |(mu0, _)| f64::from(mu0).sqrt()), CELLS)
        });
    }
}
