//! The phase functions that tests walk: one of each kind, and its extremes.

use std::f64::consts::PI;
use std::sync::LazyLock;

use super::{
    Atmosphere, CornetteShanks, DiffuseSpheres, Draine, FournierForand, Gaussian, HenyeyGreenstein,
    Isotropic, LinearAnisotropic, PhaseFunction, Rayleigh, Sakas, Schlick, SpectralPhase, SpecularSpheres,
    Tabulated, TwoTermHenyeyGreenstein, TwoTermSchlick,
};
use crate::spectrum::Spectrum;

/// Phase functions with their names.
pub type Examples = Vec<(&'static str, PhaseFunction)>;

/// One of each kind, and its extremes.
pub static EXAMPLES: LazyLock<Examples> = LazyLock::new(|| {
    let mut examples = closed_forms();
    examples.extend(with_tables().into_iter().filter_map(|(name, phase)| Some((name, phase?))));
    examples
});

/// Phase functions over wavelength: those that differ little, much, and in where they vanish.
pub static SPECTRAL_EXAMPLES: LazyLock<Vec<(&'static str, SpectralPhase)>> = LazyLock::new(|| {
    let hg = |wavelengths: &[f32], values: &[f32]| {
        let (wavelengths, values) = (wavelengths.to_vec(), values.to_vec());
        SpectralPhase::henyey_greenstein(Spectrum::Table { wavelengths, values })
    };
    let steps = [0.3, 1.0, 2.0, 3.0];
    let stepped = [[4.0, 0.0, 0.0, 1.0], [0.0, 1.0, 2.0, 0.0], [1.0; 4]].map(Vec::from);
    let (angles, peak) = peaked();
    // Ever wider, with an ever weaker glory.
    let peaks: Vec<Vec<f64>> =
        (1..=4).map(|k| peak.iter().map(|p| libm::pow(*p, 1.0 / f64::from(k))).collect()).collect();
    let all = [
        ("henyey-greenstein 0.8 to 0.85", hg(&[400.0, 700.0], &[0.85, 0.8])),
        ("henyey-greenstein -0.6 to 0.95", hg(&[400.0, 550.0, 700.0], &[-0.6, 0.95, 0.0])),
        ("henyey-greenstein 0 or 0.9999", hg(&[549.0, 551.0], &[0.0, 0.9999])),
        ("one table", SpectralPhase::tabulated(&[550.0], &steps, &stepped[..1])),
        ("tables with holes", SpectralPhase::tabulated(&[450.0, 550.0, 650.0], &steps, &stepped)),
        ("tables of peaks", SpectralPhase::tabulated(&[430.0, 500.0, 610.0, 680.0], &angles, &peaks)),
    ];
    all.into_iter().filter_map(|(name, phase)| Some((name, phase?))).collect()
});

fn closed_forms() -> Examples {
    let hg = |g| HenyeyGreenstein { g };
    let two = |share, g1, g2| {
        PhaseFunction::TwoTermHenyeyGreenstein(TwoTermHenyeyGreenstein {
            share,
            first: hg(g1),
            second: hg(g2),
        })
    };
    vec![
        ("isotropic", PhaseFunction::Isotropic(Isotropic)),
        ("linear-anisotropic 1", PhaseFunction::LinearAnisotropic(LinearAnisotropic { a: 1.0 })),
        ("linear-anisotropic -0.6", PhaseFunction::LinearAnisotropic(LinearAnisotropic { a: -0.6 })),
        ("rayleigh", PhaseFunction::Rayleigh(Rayleigh)),
        ("hazy", PhaseFunction::Atmosphere(Atmosphere::HAZY)),
        ("murky", PhaseFunction::Atmosphere(Atmosphere::MURKY)),
        ("murky halved", PhaseFunction::Atmosphere(Atmosphere::MURKY_HALVED)),
        ("henyey-greenstein 0", PhaseFunction::HenyeyGreenstein(hg(0.0))),
        ("henyey-greenstein 0.5", PhaseFunction::HenyeyGreenstein(hg(0.5))),
        ("henyey-greenstein -0.7", PhaseFunction::HenyeyGreenstein(hg(-0.7))),
        ("henyey-greenstein 0.95", PhaseFunction::HenyeyGreenstein(hg(0.95))),
        ("henyey-greenstein 0.9999", PhaseFunction::HenyeyGreenstein(hg(0.9999))),
        ("henyey-greenstein -0.9999", PhaseFunction::HenyeyGreenstein(hg(-0.9999))),
        ("two-term-henyey-greenstein", two(0.9, 0.92, -0.4)),
        ("schlick 0.8", PhaseFunction::Schlick(Schlick { k: 0.8 })),
        ("schlick -0.05", PhaseFunction::Schlick(Schlick { k: -0.05 })),
        ("schlick -0.9999", PhaseFunction::Schlick(Schlick { k: -0.9999 })),
        ("two-term-schlick rayleigh", PhaseFunction::TwoTermSchlick(TwoTermSchlick::RAYLEIGH)),
        ("two-term-schlick hazy", PhaseFunction::TwoTermSchlick(TwoTermSchlick::HAZY)),
        ("two-term-schlick murky", PhaseFunction::TwoTermSchlick(TwoTermSchlick::MURKY)),
        ("sakas 0.5", PhaseFunction::Sakas(Sakas { n: 0.5 })),
        ("sakas 40", PhaseFunction::Sakas(Sakas { n: 40.0 })),
    ]
}

fn with_tables() -> Vec<(&'static str, Option<PhaseFunction>)> {
    let shanks = |g| CornetteShanks::new(g).map(PhaseFunction::CornetteShanks);
    let draine = |g, alpha| Draine::new(g, alpha).map(PhaseFunction::Draine);
    let spheres = |eta, k| SpecularSpheres::new(eta, k).map(PhaseFunction::SpecularSpheres);
    let gaussian = |gamma| Gaussian::new(gamma).map(PhaseFunction::Gaussian);
    let ocean = |index, slope| FournierForand::new(index, slope).map(PhaseFunction::FournierForand);
    vec![
        ("cornette-shanks 0.7", shanks(0.7)),
        ("cornette-shanks -0.9999", shanks(-0.9999)),
        ("draine 0.8 2", draine(0.8, 2.0)),
        ("draine 0.9999 0.5", draine(0.9999, 0.5)),
        ("diffuse-spheres", DiffuseSpheres::new().map(PhaseFunction::DiffuseSpheres)),
        ("specular-spheres water", spheres(1.33, 0.0)),
        ("specular-spheres bubbles", spheres(1.0 / 1.33, 0.0)),
        ("specular-spheres silver", spheres(0.13, 3.2)),
        ("gaussian 2", gaussian(2.0)),
        ("gaussian 1e6", gaussian(1e6)),
        ("fournier-forand 1.1 3.58", ocean(1.1, 3.5835)),
        ("fournier-forand 1.175 4.065", ocean(1.175, 4.065)),
        (
            "tabulated steps",
            Tabulated::new(&[0.3, 1.0, 2.0, 3.0], &[4.0, 0.0, 0.0, 1.0]).map(PhaseFunction::Tabulated),
        ),
        ("tabulated peak", {
            let (angles, values) = peaked();
            Tabulated::new(&angles, &values).map(PhaseFunction::Tabulated)
        }),
    ]
}

/// Angles even in their logarithm; 1e6 times its mean at 0, a glory of 30 times at 180 degrees.
fn peaked() -> (Vec<f64>, Vec<f64>) {
    let steps: Vec<f64> =
        (0..=240).map(|i| 1e-5 * libm::pow(0.5 * PI / 1e-5, f64::from(i) / 240.0)).collect();
    let ahead = std::iter::once(0.0).chain(steps.iter().copied());
    let back = steps.iter().rev().skip(1).map(|angle| PI - angle).chain([PI]);
    let angles: Vec<f64> = ahead.chain(back).collect();
    let value = |angle: f64| {
        let peak = 1e6 / libm::pow(1.0 + angle * angle / 1e-6, 1.5);
        let glory = 30.0 / (1.0 + (PI - angle) * (PI - angle) / 1e-4);
        peak + glory + 0.2
    };
    let values = angles.iter().map(|a| value(*a)).collect();
    (angles, values)
}
