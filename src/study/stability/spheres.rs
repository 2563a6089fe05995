//! Spheres by Lorenz-Mie theory, from a millionth of a wavelength to a hundred thousand, and in hosts that let nothing through.
//!
//! ```text
//! x -> 0:          Q_sca = 8/3 x^4 |p|^2 (1 + O(x^2)),   Q_ext = 4 x Im p (1 + O(x^2)),   p = (m^2 - 1) / (m^2 + 2)
//! x -> infinity:   Q_ext = 2 + O(x^(-2/3))
//! real m:          Q_ext = Q_sca
//! ```
//! `[BOHREN83 sections 5.1 and 4.4.3]`

use super::{Case, Group, Measurement, Reference};
use crate::optics::lorenz_mie::{Coefficients, Complex64, Efficiencies, Sphere};
use crate::study::StudyError;

/// The group.
pub(super) const GROUP: Group = Group {
    name: "spheres",
    parameter: "size parameter x; what the host absorbs within it",
    about: "Lorenz-Mie theory of the smallest and the largest spheres, and in black hosts.",
    cases,
};

/// Relative indices: ice or glass in air, a bubble in water, and a metal.
const CLEAR: [f64; 2] = [1.5, 0.75];
const METAL: Complex64 = Complex64::new(10.0, 10.0);
const TURBID: Complex64 = Complex64::new(1.33, 0.01);

fn cases() -> Vec<Case> {
    let sizes = [1e-6, 1e-3, 1.0, 1e3, 1e5];
    let balance = CLEAR.into_iter().flat_map(|m| {
        sizes.map(|x| {
            let name = format!("m = {m}: extinction over scattering");
            Case::new(&GROUP, name, x, move || Ok(balanced(of(m.into(), x)?))).quick_if(x < 1e4)
        })
    });
    let small = [1e-6, 1e-4, 1e-2];
    let scattered = small
        .map(|x| Case::new(&GROUP, "scattering over Rayleigh's", x, move || rayleigh(CLEAR[0], x)).quick());
    let absorbed =
        small.map(|x| Case::new(&GROUP, "absorption over its limit", x, move || absorbed(x)).quick());
    let large = [1e3, 1e4, 1e5].into_iter().flat_map(|x| {
        [("m = 1.33 + 0.01i", TURBID), ("m = 10 + 10i", METAL)].map(|(name, m)| {
            Case::new(&GROUP, format!("{name}: extinction"), x, move || Ok(twice(x, of(m, x)?)))
                .quick_if(x < 1e4)
        })
    });
    let black = [0.1, 1.0, 10.0, 150.0].map(|depth| {
        Case::new(&GROUP, "numbers that are none, in a black host", depth, move || in_the_dark(depth)).quick()
    });
    balance.chain(scattered).chain(absorbed).chain(large).chain(black).collect()
}

fn of(m: Complex64, x: f64) -> Result<Efficiencies, StudyError> {
    in_host(m, Complex64::ONE, x)
}

fn in_host(particle: Complex64, host: Complex64, size: f64) -> Result<Efficiencies, StudyError> {
    Ok(Coefficients::new(Sphere::new(particle, host, size)?).efficiencies())
}

/// Sums of x terms, each off by some last bits.
fn balanced(found: Efficiencies) -> Measurement {
    Measurement::new(Reference::Invariance, 1.0, found.extinction / found.scattering).tolerance(1e-10)
}

fn rayleigh(m: f64, x: f64) -> Result<Measurement, StudyError> {
    let p = (m * m - 1.0) / (m * m + 2.0);
    let limit = 8.0 / 3.0 * x * x * x * x * p * p;
    let found = of(m.into(), x)?.scattering / limit;
    Ok(Measurement::new(Reference::Limit, 1.0, found).tolerance(x * x + 1e-11))
}

/// What scatters is x^3 of what is absorbed, and some 10 times that as little is absorbed.
fn absorbed(x: f64) -> Result<Measurement, StudyError> {
    let p = (TURBID * TURBID - 1.0) / (TURBID * TURBID + 2.0);
    let found = of(TURBID, x)?.extinction / (4.0 * x * p.im);
    Ok(Measurement::new(Reference::Limit, 1.0, found).tolerance(2.0 * x * x + 1e-11))
}

fn twice(x: f64, found: Efficiencies) -> Measurement {
    // What the edge does to light is 2 x^(-2/3) of water, 2.4 to 2.8 of this metal; the next term is of some units over x.
    let edge = 3.0 / libm::cbrt(x * x) + 10.0 / x;
    Measurement::new(Reference::Limit, 2.0, found.extinction).tolerance(edge)
}

/// How many numbers are none, of a bubble and of a metal of three sizes.
fn in_the_dark(depth: f64) -> Result<Measurement, StudyError> {
    let mut none = 0;
    for x in [1e-3, 1.0, 100.0] {
        let host = Complex64::new(1.0, depth / x);
        for particle in [Complex64::ONE, METAL] {
            let Efficiencies { extinction, scattering, backward, asymmetry } = in_host(particle, host, x)?;
            none += [extinction, scattering, backward, asymmetry].iter().filter(|q| !q.is_finite()).count();
            none += usize::from(scattering < 0.0) + usize::from(asymmetry.abs() > 1.0);
        }
    }
    Ok(Measurement::new(Reference::Limit, 0.0, none as f64))
}
