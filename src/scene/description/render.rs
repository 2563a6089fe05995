//! Reads `[render]`.

use super::allowed::Allowed;
use super::error::SceneError;
use super::value::Value;
use super::{FilterKind, IntegratorKind, KernelKind, PhotonDescription, RenderDescription, SeedMode};
use crate::optics::similarity::HIGHEST_ORDER;

impl Default for RenderDescription {
    fn default() -> Self {
        Self {
            integrator: IntegratorKind::Auto,
            samples: 64,
            target_error: None,
            confidence: 0.95,
            max_depth: 0,
            split: 1,
            forced_scattering: 0,
            similarity: 0,
            seed: 0,
            seed_mode: None,
            filter: FilterKind::Box,
            photons: PhotonDescription::default(),
        }
    }
}

impl Default for PhotonDescription {
    fn default() -> Self {
        Self {
            count: 0,
            radius: None,
            volume_radius: None,
            shrink: 2.0 / 3.0,
            kernel: KernelKind::default(),
            final_gather: true,
            guide: true,
            sky: None,
        }
    }
}

const INTEGRATORS: [(&str, IntegratorKind); 6] = [
    ("auto", IntegratorKind::Auto),
    ("path", IntegratorKind::Path),
    ("photon", IntegratorKind::Photon),
    ("single-scattering", IntegratorKind::SingleScattering),
    ("fog", IntegratorKind::Fog),
    ("ambient-occlusion", IntegratorKind::AmbientOcclusion),
];

const FILTERS: [(&str, FilterKind); 3] = [
    ("box", FilterKind::Box),
    ("gaussian", FilterKind::Gaussian),
    ("blackman-harris", FilterKind::BlackmanHarris),
];

const KERNELS: [(&str, KernelKind); 3] = [
    ("constant", KernelKind::Constant),
    ("cone", KernelKind::Cone),
    ("epanechnikov", KernelKind::Epanechnikov),
];

/// Most photons in a pass. While their maps are made they take up to 1 kB each in media that scatter: 10 GB.
const MOST_PHOTONS: i128 = 10_000_000;

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
        target_error: table.get("target_error").map(|v| v.number(&Allowed::TARGET_ERROR)).transpose()?,
        confidence: table
            .get("confidence")
            .map_or(Ok(default.confidence), |v| v.number(&Allowed::CONFIDENCE))?,
        max_depth: whole("max_depth", 0, u32::MAX.into(), default.max_depth)?,
        split: whole("split", 0, MOST_SPLITS, default.split)?,
        forced_scattering: whole("forced_scattering", 0, MOST_SPLITS, default.forced_scattering)?,
        similarity: whole("similarity", 0, HIGHEST_ORDER as i128, default.similarity)?,
        seed: table.get("seed").map_or(Ok(default.seed), |v| v.integer(0, u64::MAX.into()))?,
        seed_mode: table.get("seed_mode").map(|v| v.choice(&SeedMode::ALL)).transpose()?,
        filter: table.get("filter").map_or(Ok(default.filter), |v| v.choice(&FILTERS))?,
        photons: table.get("photons").map_or(Ok(default.photons), |v| photons(&v))?,
    };
    table.finish()?;
    Ok(render)
}

/// Reads `render.photons`.
fn photons(value: &Value<'_>) -> Result<PhotonDescription, SceneError> {
    let table = value.table("a table such as { count = 100000, final_gather = true }")?;
    let default = PhotonDescription::default();
    let length = |key| table.get(key).map(|v| v.number(&Allowed::LENGTH)).transpose();
    let flag = |key, default| table.get(key).map_or(Ok(default), |v| v.boolean());
    let photons = PhotonDescription {
        count: table.get("count").map_or(Ok(default.count), |v| v.integer(0, MOST_PHOTONS))?,
        radius: length("radius")?.map(|r| r as f32),
        volume_radius: length("volume_radius")?.map(|r| r as f32),
        shrink: table.get("shrink").map_or(Ok(default.shrink.into()), |v| v.number(&Allowed::SHRINKAGE))?
            as f32,
        kernel: table.get("kernel").map_or(Ok(default.kernel), |v| v.choice(&KERNELS))?,
        final_gather: flag("final_gather", default.final_gather)?,
        guide: flag("guide", default.guide)?,
        sky: table.get("sky").map(|v| v.boolean()).transpose()?,
    };
    table.finish()?;
    Ok(photons)
}
