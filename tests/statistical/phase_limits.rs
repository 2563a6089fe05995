//! Where their parameters say so, phase functions become each other.

use floe::optics::phase::*;

/// Angles over the whole sphere, close to both ends too.
fn angles() -> impl Iterator<Item = Deflection> {
    let steps = (0..=400).map(|i| 10_f32.powf(-9.0 * (1.0 - i as f32 / 400.0)));
    steps.flat_map(|t| [Deflection::from_one_minus_cos(t), Deflection::from_one_plus_cos(t)])
}

/// Greatest relative difference of two functions.
fn difference(a: &PhaseFunction, b: &PhaseFunction) -> f64 {
    angles().map(|d| (f64::from(a.value(d)) / f64::from(b.value(d)) - 1.0).abs()).fold(0.0, f64::max)
}

fn henyey_greenstein(g: f32) -> PhaseFunction {
    PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g })
}

fn made<T>(phase: Option<T>) -> T {
    let Some(phase) = phase else { panic!("the parameters are in range") };
    phase
}

fn draine(g: f32, alpha: f32) -> PhaseFunction {
    PhaseFunction::Draine(made(Draine::new(g, alpha)))
}

fn shanks(g: f32) -> PhaseFunction {
    PhaseFunction::CornetteShanks(made(CornetteShanks::new(g)))
}

fn sakas(n: f32) -> PhaseFunction {
    PhaseFunction::Sakas(Sakas { n })
}

fn two_term(share: f32, g1: f32, g2: f32) -> PhaseFunction {
    PhaseFunction::TwoTermHenyeyGreenstein(TwoTermHenyeyGreenstein {
        share,
        first: HenyeyGreenstein { g: g1 },
        second: HenyeyGreenstein { g: g2 },
    })
}

#[test]
fn limits_are_met() {
    let isotropic = || PhaseFunction::Isotropic(Isotropic);
    let rayleigh = || PhaseFunction::Rayleigh(Rayleigh);
    let schlick = |k| PhaseFunction::Schlick(Schlick { k });
    let cases = [
        ("Henyey-Greenstein, g = 0", henyey_greenstein(0.0), isotropic()),
        ("Schlick, k = 0", schlick(0.0), isotropic()),
        ("linear, a = 0", PhaseFunction::LinearAnisotropic(LinearAnisotropic { a: 0.0 }), isotropic()),
        ("Gaussian, gamma = 0", PhaseFunction::Gaussian(made(Gaussian::new(0.0))), isotropic()),
        ("Sakas, n = 0", sakas(0.0), isotropic()),
        ("Sakas, n = 2", sakas(2.0), rayleigh()),
        ("Cornette-Shanks, g = 0", shanks(0.0), rayleigh()),
        ("Draine, alpha = 1, g = 0", draine(0.0, 1.0), rayleigh()),
        ("Draine, alpha = 0", draine(0.8, 0.0), henyey_greenstein(0.8)),
        ("Draine, alpha = 0, g < 0", draine(-0.999, 0.0), henyey_greenstein(-0.999)),
        ("Draine, alpha = 1", draine(0.6, 1.0), shanks(0.6)),
        ("two equal terms", two_term(0.3, 0.7, 0.7), henyey_greenstein(0.7)),
        ("the first of two terms", two_term(1.0, 0.7, -0.2), henyey_greenstein(0.7)),
        ("the second of two terms", two_term(0.0, 0.7, -0.2), henyey_greenstein(-0.2)),
    ];
    for (name, function, limit) in cases {
        let apart = difference(&function, &limit);
        let means = (function.mean_cosine() - limit.mean_cosine()).abs();
        println!("{name}: {apart:.1e}, mean cosines {means:.1e}");
        // Some ten roundings of f32.
        assert!(apart < 1e-6 && means < 3e-7, "{name}: off by {apart:e}, mean cosines by {means:e}");
    }
}

/// Near g = 0 every lobe departs from the isotropic one by 3 g cos, Schlick's by 2 k cos.
#[test]
fn small_asymmetries_are_linear() {
    let small = 1e-3;
    for (name, phase, slope) in [
        ("Henyey-Greenstein", henyey_greenstein(small), 3.0),
        ("Schlick", PhaseFunction::Schlick(Schlick { k: small }), 2.0),
        ("linear", PhaseFunction::LinearAnisotropic(LinearAnisotropic { a: small }), 1.0),
    ] {
        for d in angles() {
            let departure = f64::from(phase.value(d)) * 4.0 * std::f64::consts::PI - 1.0;
            // The next term is 7.5 g^2 at most.
            let expected = f64::from(slope * small * d.cosine());
            assert!((departure - expected).abs() < 9e-6, "{name}: {departure} for {expected}");
        }
        assert!((phase.mean_cosine() - slope * small / 3.0).abs() < 1e-8, "{name}");
    }
}

/// The fits of Blasi, Le Saëc and Schlick have their published mean cosines. How much of the light they send elsewhere
/// than what they fit is measured here: 1.2 %, 4.3 % and 14 %.
#[test]
fn fits_by_two_terms_are_as_good_as_published() {
    let cases = [
        (TwoTermSchlick::RAYLEIGH, PhaseFunction::Rayleigh(Rayleigh), 0.0, 0.012),
        (TwoTermSchlick::HAZY, PhaseFunction::Atmosphere(Atmosphere::HAZY), 0.4205, 0.043),
        (TwoTermSchlick::MURKY, PhaseFunction::Atmosphere(Atmosphere::MURKY), 0.5423, 0.14),
    ];
    for (fit, function, mean_cosine, tolerance) in cases {
        let fit = PhaseFunction::TwoTermSchlick(fit);
        let rings = (0..4000).map(|i| Deflection::from_one_minus_cos((i as f32 + 0.5) / 2000.0));
        let total: f64 = rings.map(|d| f64::from(fit.value(d) - function.value(d)).abs()).sum();
        // Of the light, half of what is misplaced is counted at each of its two places.
        let misplaced = 0.5 * total * 4.0 * std::f64::consts::PI / 4000.0;
        println!("{fit:?}: {misplaced:.4} of the light is misplaced");
        assert!(misplaced < tolerance, "{fit:?}: {misplaced} of the light is misplaced");
        assert!((fit.mean_cosine() - mean_cosine).abs() < 5e-5, "{fit:?}: {}", fit.mean_cosine());
    }
}
