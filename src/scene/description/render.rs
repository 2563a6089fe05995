//! Reads `[render]`.

use super::error::SceneError;
use super::value::Value;
use super::{FilterKind, IntegratorKind, RenderDescription};
use crate::optics::similarity::HIGHEST_ORDER;

impl Default for RenderDescription {
    fn default() -> Self {
        Self {
            integrator: IntegratorKind::Auto,
            samples: 64,
            max_depth: 0,
            split: 1,
            similarity: 0,
            seed: 0,
            filter: FilterKind::Box,
        }
    }
}

const INTEGRATORS: [(&str, IntegratorKind); 3] = [
    ("auto", IntegratorKind::Auto),
    ("path", IntegratorKind::Path),
    ("ambient-occlusion", IntegratorKind::AmbientOcclusion),
];

const FILTERS: [(&str, FilterKind); 3] = [
    ("box", FilterKind::Box),
    ("gaussian", FilterKind::Gaussian),
    ("blackman-harris", FilterKind::BlackmanHarris),
];

/// Most interface hits at which both branches are followed: the paths double at each.
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
        similarity: whole("similarity", 0, HIGHEST_ORDER as i128, default.similarity)?,
        seed: table.get("seed").map_or(Ok(default.seed), |v| v.integer(0, u64::MAX.into()))?,
        filter: table.get("filter").map_or(Ok(default.filter), |v| v.choice(&FILTERS))?,
    };
    table.finish()?;
    Ok(render)
}
