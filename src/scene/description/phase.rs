//! Reads `phase = { kind = .. }`: where a medium's scattered light goes.

use super::allowed::Allowed;
use super::document::Table;
use super::error::SceneError;
use super::spectral_phase;
use super::value::Value;
use crate::optics::phase::*;

const FORMS: &str = "{ kind = \"isotropic\" } or { kind = \"henyey-greenstein\", g = 0.9 }";

type Reader = for<'t, 'v> fn(&'v Table<'t>, &'v Value<'t>) -> Result<PhaseFunction, SceneError>;

/// Every kind with the reader of its parameters.
const KINDS: [(&str, Reader); 17] = [
    ("isotropic", |_, _| Ok(PhaseFunction::Isotropic(Isotropic))),
    ("henyey-greenstein", |table, _| Ok(PhaseFunction::HenyeyGreenstein(henyey_greenstein(table, "g")?))),
    ("two-term-henyey-greenstein", two_term_henyey_greenstein),
    ("cornette-shanks", cornette_shanks),
    ("draine", draine),
    ("schlick", |table, _| Ok(PhaseFunction::Schlick(schlick(table, "k")?))),
    ("two-term-schlick", two_term_schlick),
    ("rayleigh", |_, _| Ok(PhaseFunction::Rayleigh(Rayleigh))),
    ("linear-anisotropic", linear_anisotropic),
    ("sakas", sakas),
    ("hazy", |table, _| atmosphere(table, [Atmosphere::HAZY, Atmosphere::HAZY])),
    ("murky", |table, _| atmosphere(table, [Atmosphere::MURKY, Atmosphere::MURKY_HALVED])),
    ("gaussian", gaussian),
    ("diffuse-spheres", |_, value| made(value, DiffuseSpheres::new().map(PhaseFunction::DiffuseSpheres))),
    ("specular-spheres", specular_spheres),
    ("fournier-forand", fournier_forand),
    ("tabulated", tabulated),
];

/// Reads a phase function.
pub(super) fn read(value: &Value<'_>) -> Result<MediumPhase, SceneError> {
    let table = value.table(FORMS)?;
    let kind = table.require("kind", &format!("write {FORMS}"))?;
    let reader = kind.choice(&KINDS)?;
    let phase = match spectral_phase::read(kind.text("a kind")?, &table, value)? {
        Some(spectral) => spectral.into(),
        None => reader(&table, value)?.into(),
    };
    table.finish()?;
    Ok(phase)
}

/// What was made of parameters that are each in their range; together they may still make nothing.
pub(super) fn made<T>(value: &Value<'_>, phase: Option<T>) -> Result<T, SceneError> {
    phase.ok_or_else(|| value.invalid("these parameters leave no light to scatter: change them"))
}

fn number(table: &Table<'_>, key: &'static str, allowed: &Allowed, cure: &str) -> Result<f32, SceneError> {
    table.require(key, cure)?.number32(allowed)
}

fn optional(
    table: &Table<'_>,
    key: &'static str,
    allowed: &Allowed,
    default: f32,
) -> Result<f32, SceneError> {
    table.get(key).map_or(Ok(default), |v| v.number32(allowed))
}

fn henyey_greenstein(table: &Table<'_>, key: &'static str) -> Result<HenyeyGreenstein, SceneError> {
    let cure = format!("write the mean cosine, such as {key} = 0.9");
    Ok(HenyeyGreenstein { g: number(table, key, &Allowed::MEAN_COSINE, &cure)? })
}

fn schlick(table: &Table<'_>, key: &'static str) -> Result<Schlick, SceneError> {
    let cure = format!("write the elongation, such as {key} = 0.7");
    Ok(Schlick { k: number(table, key, &Allowed::MEAN_COSINE, &cure)? })
}

/// `share`: how much of the light is in the first of two lobes.
fn share(table: &Table<'_>) -> Result<f32, SceneError> {
    number(table, "share", &Allowed::UNIT, "write the share of the first lobe, such as share = 0.9")
}

fn two_term_henyey_greenstein(table: &Table<'_>, _: &Value<'_>) -> Result<PhaseFunction, SceneError> {
    Ok(PhaseFunction::TwoTermHenyeyGreenstein(TwoTermHenyeyGreenstein {
        share: share(table)?,
        first: henyey_greenstein(table, "g1")?,
        second: henyey_greenstein(table, "g2")?,
    }))
}

fn two_term_schlick(table: &Table<'_>, _: &Value<'_>) -> Result<PhaseFunction, SceneError> {
    let fits = [
        ("rayleigh", TwoTermSchlick::RAYLEIGH),
        ("hazy", TwoTermSchlick::HAZY),
        ("murky", TwoTermSchlick::MURKY),
    ];
    Ok(PhaseFunction::TwoTermSchlick(match table.get("fit") {
        Some(fit) => fit.choice(&fits)?,
        None => TwoTermSchlick {
            share: share(table)?,
            first: schlick(table, "k1")?,
            second: schlick(table, "k2")?,
        },
    }))
}

fn cornette_shanks(table: &Table<'_>, value: &Value<'_>) -> Result<PhaseFunction, SceneError> {
    let g = number(table, "g", &Allowed::PEAKED, "write its parameter, such as g = 0.8")?;
    made(value, CornetteShanks::new(g).map(PhaseFunction::CornetteShanks))
}

fn draine(table: &Table<'_>, value: &Value<'_>) -> Result<PhaseFunction, SceneError> {
    let g = number(table, "g", &Allowed::PEAKED, "write its parameter, such as g = 0.8")?;
    let alpha = number(table, "alpha", &Allowed::EXPONENT, "write its parameter, such as alpha = 1")?;
    made(value, Draine::new(g, alpha).map(PhaseFunction::Draine))
}

fn linear_anisotropic(table: &Table<'_>, _: &Value<'_>) -> Result<PhaseFunction, SceneError> {
    let a = number(table, "a", &Allowed::SLOPE, "write the factor of the cosine, such as a = 0.5")?;
    Ok(PhaseFunction::LinearAnisotropic(LinearAnisotropic { a }))
}

fn sakas(table: &Table<'_>, _: &Value<'_>) -> Result<PhaseFunction, SceneError> {
    let n = number(table, "n", &Allowed::EXPONENT, "write the exponent of the cosine, such as n = 2")?;
    Ok(PhaseFunction::Sakas(Sakas { n }))
}

/// `form`: Nishita's function, or the one that halves the light between its lobe and all directions.
fn atmosphere(table: &Table<'_>, forms: [Atmosphere; 2]) -> Result<PhaseFunction, SceneError> {
    let [nishita, halved] = forms;
    let names = [("nishita", nishita), ("normalised", halved)];
    let form = table.get("form").map_or(Ok(nishita), |v| v.choice(&names))?;
    Ok(PhaseFunction::Atmosphere(form))
}

fn gaussian(table: &Table<'_>, value: &Value<'_>) -> Result<PhaseFunction, SceneError> {
    let gamma = number(table, "gamma", &Allowed::GAUSSIAN, "write how fast it falls, such as gamma = 10")?;
    made(value, Gaussian::new(gamma).map(PhaseFunction::Gaussian))
}

fn specular_spheres(table: &Table<'_>, value: &Value<'_>) -> Result<PhaseFunction, SceneError> {
    let cure = "write the index of the spheres relative to the medium, such as ior = 1.33";
    let eta = number(table, "ior", &Allowed::RELATIVE_INDEX, cure)?;
    let k = optional(table, "k", &Allowed::RELATIVE_ABSORPTION, 0.0)?;
    SpecularSpheres::new(eta, k)
        .map(PhaseFunction::SpecularSpheres)
        .ok_or_else(|| value.invalid("spheres of the medium's own index reflect nothing: change ior"))
}

fn fournier_forand(table: &Table<'_>, value: &Value<'_>) -> Result<PhaseFunction, SceneError> {
    let phase = match table.get("backscatter") {
        Some(share) => FournierForand::of_backscatter(share.number(&Allowed::BACKSCATTER)?),
        None => {
            let cure = "write the index of the particles relative to water and the slope of their sizes, \
                        such as ior = 1.1, mu = 3.58, or backscatter = 0.018";
            let index = table.require("ior", cure)?.number(&Allowed::OCEAN_INDEX)?;
            let slope = table.require("mu", cure)?.number(&Allowed::OCEAN_SLOPE)?;
            FournierForand::new(index, slope)
        }
    };
    made(value, phase.map(PhaseFunction::FournierForand))
}

fn tabulated(table: &Table<'_>, value: &Value<'_>) -> Result<PhaseFunction, SceneError> {
    let angles = angles(table)?;
    let values = table.require("value", "write one number for each angle, in any unit")?;
    made(value, Tabulated::new(&angles, &numbers(&values, angles.len())?).map(PhaseFunction::Tabulated))
}

/// `angle = [..]` in degrees, strictly rising; in radians.
pub(super) fn angles(table: &Table<'_>) -> Result<Vec<f64>, SceneError> {
    const FORM: &str = "rising angles in degrees, such as angle = [0, 1, 5, 20, 90, 180]";
    let mut angles: Vec<f64> = Vec::new();
    for element in table.require("angle", &format!("write {FORM}"))?.elements(FORM)? {
        let angle = element.number(&Allowed::DEFLECTION)?.to_radians();
        if angles.last().is_some_and(|&last| last >= angle) {
            return Err(element.invalid("angles must rise strictly: sort them and keep each once"));
        }
        angles.push(angle.min(std::f64::consts::PI));
    }
    Ok(angles)
}

/// One number for each angle.
pub(super) fn numbers(values: &Value<'_>, count: usize) -> Result<Vec<f64>, SceneError> {
    let numbers = values.elements("one number for each angle")?;
    if numbers.len() != count || numbers.is_empty() {
        let found = numbers.len();
        return Err(values.invalid(format!("{found} numbers for {count} angles: write one for each")));
    }
    numbers.iter().map(|v| v.number(&Allowed::NOT_NEGATIVE)).collect()
}
