//! Reads `[render]`.

use toml::de::DeValue;

use super::allowed::Allowed;
use super::document::Source;
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
            dispersion: false,
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

impl PhotonDescription {
    /// Photons of each pass of a picture of so many pixels, at least one for each kind of light.
    pub fn count_of(&self, pixels: u32) -> u32 {
        if self.count == 0 { pixels.clamp(10_000, 1_000_000) } else { self.count.max(3) }
    }

    /// Those of each pass beside beams, which bring little of the light: more would cost more time than they save.
    pub fn count_of_strays(&self, pixels: u32) -> u32 {
        if self.count == 0 { (pixels / 32).clamp(2048, 1_000_000) } else { self.count }
    }

    /// Settings that blur half as wide with the noise of these: four times the photons, each over a quarter of the area.
    #[must_use]
    pub fn finer(&self, pixels: u32) -> Self {
        let count = self.count_of(pixels).saturating_mul(4).min(MOST_PHOTONS as u32);
        let [radius, volume_radius] = [self.radius, self.volume_radius].map(|r| r.map(|r| 0.5 * r));
        Self { count, radius, volume_radius, ..*self }
    }
}

const INTEGRATORS: [(&str, IntegratorKind); 7] = [
    ("auto", IntegratorKind::Auto),
    ("path", IntegratorKind::Path),
    ("photon", IntegratorKind::Photon),
    ("beams", IntegratorKind::Beams),
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

impl RenderDescription {
    /// Whether a frame that was assembled for these settings serves others too: most settings are for what is done with it.
    pub fn share_frames(&self, other: &Self) -> bool {
        let is_open = |settings: &Self| settings.integrator == IntegratorKind::AmbientOcclusion;
        self.similarity == other.similarity
            && self.dispersion == other.dispersion
            && is_open(self) == is_open(other)
    }

    /// These settings with others in their place: keys of `[render]`, with commas in between, such as
    /// `split = 2, photons = { shrink = 1 }`.
    ///
    /// # Errors
    /// [`SceneError`], whose columns count from a brace before the text, which is shown with its braces as coming from
    /// `origin`.
    pub fn with(&self, text: &str, origin: &str) -> Result<Self, SceneError> {
        let text = format!("{{{text}}}");
        let file = format!("{origin} {text}");
        let source = Source { text: &text, file: file.as_ref() };
        let value = DeValue::parse(&text).map_err(|error| SceneError::Syntax {
            place: source.place(error.span().map_or(0, |span| span.start)),
            message: error.message().to_owned(),
        })?;
        read_over(&Value::new(source, "render".into(), &value), self)
    }
}

/// Reads `[render]`.
pub(super) fn read(value: &Value<'_>) -> Result<RenderDescription, SceneError> {
    read_over(value, &RenderDescription::default())
}

/// Reads `[render]`; what it does not say is as in `default`.
fn read_over(value: &Value<'_>, default: &RenderDescription) -> Result<RenderDescription, SceneError> {
    let table = value.table("a table [render]")?;
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
        dispersion: table.get("dispersion").map_or(Ok(default.dispersion), |v| v.boolean())?,
        seed: table.get("seed").map_or(Ok(default.seed), |v| v.integer(0, u64::MAX.into()))?,
        seed_mode: table
            .get("seed_mode")
            .map(|v| v.choice(&SeedMode::ALL))
            .transpose()?
            .or(default.seed_mode),
        filter: table.get("filter").map_or(Ok(default.filter), |v| v.choice(&FILTERS))?,
        photons: table.get("photons").map_or(Ok(default.photons), |v| photons(&v, &default.photons))?,
    };
    table.finish()?;
    Ok(render)
}

/// Reads `render.photons`; what it does not say is as in `default`.
fn photons(value: &Value<'_>, default: &PhotonDescription) -> Result<PhotonDescription, SceneError> {
    let table = value.table("a table such as { count = 100000, final_gather = true }")?;
    let length = |key| table.get(key).map(|v| v.number(&Allowed::LENGTH)).transpose();
    let flag = |key, default| table.get(key).map_or(Ok(default), |v| v.boolean());
    let photons = PhotonDescription {
        count: table.get("count").map_or(Ok(default.count), |v| v.integer(0, MOST_PHOTONS))?,
        radius: length("radius")?.map(|r| r as f32).or(default.radius),
        volume_radius: length("volume_radius")?.map(|r| r as f32).or(default.volume_radius),
        shrink: table.get("shrink").map_or(Ok(default.shrink.into()), |v| v.number(&Allowed::SHRINKAGE))?
            as f32,
        kernel: table.get("kernel").map_or(Ok(default.kernel), |v| v.choice(&KERNELS))?,
        final_gather: flag("final_gather", default.final_gather)?,
        guide: flag("guide", default.guide)?,
        sky: table.get("sky").map(|v| v.boolean()).transpose()?.or(default.sky),
    };
    table.finish()?;
    Ok(photons)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_take_the_place_of_others_and_leave_the_rest() {
        let photons = PhotonDescription { radius: Some(0.5), ..PhotonDescription::default() };
        let scene = RenderDescription { split: 3, seed: 9, photons, ..RenderDescription::default() };
        let changed = scene.with("integrator = 'photon', photons = { shrink = 1 }", "--settings").unwrap();
        let expected = RenderDescription {
            integrator: IntegratorKind::Photon,
            photons: PhotonDescription { shrink: 1.0, ..photons },
            ..scene.clone()
        };
        assert_eq!(changed, expected);
        assert_eq!(scene.with("", "--settings").unwrap(), scene);
        for (text, words) in [
            ("split = 99", ["--settings {split = 99}:1:10", "16"]),
            ("splitt = 2", ["splitt", "`split`"]),
            ("split 2", ["--settings {split 2}", "1:"]),
        ] {
            let error = scene.with(text, "--settings").unwrap_err().to_string();
            assert!(words.iter().all(|word| error.contains(word)), "{error}");
        }
    }
}
