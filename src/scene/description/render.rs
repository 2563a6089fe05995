//! Reads `[render]`.

use super::error::SceneError;
use super::value::Value;
use super::{FilterKind, IntegratorKind, RenderDescription};

impl Default for RenderDescription {
    fn default() -> Self {
        Self {
            integrator: IntegratorKind::Auto,
            samples: 64,
            max_depth: 0,
            split: 1,
            forced_scattering: 0,
            seed: 0,
            filter: FilterKind::Box,
        }
    }
}

const INTEGRATORS: [(&str, IntegratorKind); 5] = [
    ("auto", IntegratorKind::Auto),
    ("path", IntegratorKind::Path),
    ("single-scattering", IntegratorKind::SingleScattering),
    ("fog", IntegratorKind::Fog),
    ("ambient-occlusion", IntegratorKind::AmbientOcclusion),
];

const FILTERS: [(&str, FilterKind); 3] = [
    ("box", FilterKind::Box),
    ("gaussian", FilterKind::Gaussian),
    ("blackman-harris", FilterKind::BlackmanHarris),
];

/// Most interface hits, and ways through media, at which both branches are followed: the paths double at each.
const MOST_SPLITS: i128 = 16;

/// Reads `[render]`.
pub(super) fn read(value: &Value<'_>) -> Result<RenderDescription, SceneError> {
    let table = value.table("a table [render]")?;
    let default = RenderDescription::default();
    let whole = |key, least, greatest: i128, default| {
        table.get(key).map_or(Ok(default), |v| v.integer::<u32>(least, greatest))
    };
    let render = RenderDescription {
        integrator: table.get("integrator").map_or(Ok(default.integrator), |v| v.choice(&INTEGRATORS))?,
        samples: whole("samples", 1, u32::MAX.into(), default.samples)?,
        max_depth: whole("max_depth", 0, u32::MAX.into(), default.max_depth)?,
        split: whole("split", 0, MOST_SPLITS, default.split)?,
        forced_scattering: whole("forced_scattering", 0, MOST_SPLITS, default.forced_scattering)?,
        seed: table.get("seed").map_or(Ok(default.seed), |v| v.integer(0, u64::MAX.into()))?,
        filter: table.get("filter").map_or(Ok(default.filter), |v| v.choice(&FILTERS))?,
    };
    table.finish()?;
    Ok(render)
}
