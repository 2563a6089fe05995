//! Which medium a name on the command line means.

use std::path::Path;

use crate::cli::exit::Exit;
use crate::driver::{Job, RenderError};
use crate::scene::description::{MediumDescription, ModelKind, SceneDescription, suggestion};
use crate::study::medium::Subject;

/// Places of `--set` are told as if it were a file with a line for each.
const SETTINGS: &str = "--set";

/// Why there is nothing to show.
pub(super) struct Refusal {
    pub exit: Exit,
    pub message: String,
}

impl Refusal {
    pub fn usage(message: String) -> Self {
        Self { exit: Exit::Usage, message }
    }
}

impl From<RenderError> for Refusal {
    fn from(error: RenderError) -> Self {
        Self { exit: Exit::from(&error), message: error.to_string() }
    }
}

/// A medium that is asked for.
pub(super) struct Request {
    /// What results call it.
    pub name: String,
    pub subject: Subject,
    pub warnings: Vec<String>,
    /// How it ends if its particles cannot be computed.
    pub blame: Exit,
}

impl Request {
    /// The medium of this name, with these settings of its model.
    pub fn new(name: &str, settings: &[String]) -> Result<Self, Refusal> {
        match name.rsplit_once(':') {
            Some((scene, medium)) => Self::of_scene(scene, medium, settings),
            None => Self::of_model(name, settings),
        }
    }

    fn of_model(name: &str, settings: &[String]) -> Result<Self, Refusal> {
        let of_kind = |kind: ModelKind| kind.presets().into_iter().map(move |preset| (preset, kind));
        let presets: Vec<(&str, ModelKind)> = ModelKind::ALL.into_iter().flat_map(of_kind).collect();
        let model = ModelKind::ALL.into_iter().find(|kind| kind.name() == name);
        let implied = match (model, presets.iter().find(|(preset, _)| *preset == name)) {
            (Some(kind), _) => vec![format!("model = \"{}\"", kind.name())],
            (None, Some((preset, kind))) => {
                vec![format!("model = \"{}\"", kind.name()), format!("preset = \"{preset}\"")]
            }
            (None, None) => {
                let known: Vec<&str> = presets
                    .iter()
                    .map(|(name, _)| *name)
                    .chain(ModelKind::ALL.map(ModelKind::name))
                    .collect();
                let near = suggestion(name, &known, "");
                let near = if near.ends_with('?') { format!("{near} ") } else { String::new() };
                return Err(Refusal::usage(format!("there is no medium `{name}`: {near}{}", list())));
            }
        };
        let lines: Vec<String> = settings.iter().map(|text| line(text)).collect::<Result<_, _>>()?;
        let medium = MediumDescription::from_settings(Path::new(SETTINGS), &lines, Path::new(name), &implied)
            .map_err(|error| Refusal::usage(error.to_string()))?;
        let told = if settings.is_empty() { String::new() } else { format!(", {}", settings.join(", ")) };
        let name = format!("{name}{told}");
        match Subject::of_model(&medium) {
            Some((subject, warnings)) => Ok(Self { name, subject, warnings, blame: Exit::Usage }),
            None => Err(Refusal::usage(format!("{name} is no model"))),
        }
    }

    fn of_scene(scene: &str, name: &str, settings: &[String]) -> Result<Self, Refusal> {
        if !settings.is_empty() {
            return Err(Refusal::usage(format!(
                "--set changes a model: what `{scene}` says of `{name}` is changed in the scene file"
            )));
        }
        let description = described(Path::new(scene))?;
        let Some(medium) = description.media.get(name) else {
            let known: Vec<&str> = description.media.keys().map(String::as_str).collect();
            let near = suggestion(name, &known, "it has");
            return Err(Refusal::usage(format!("{scene} has no medium `{name}`: {near}")));
        };
        let title = format!("{scene}:{name}");
        let (subject, warnings) = match Subject::of_model(medium) {
            Some(found) => found,
            None => {
                let given = Box::new(medium.over_wavelength());
                (Subject::Given { index: medium.ior.clone(), medium: given }, medium.warnings())
            }
        };
        Ok(Self { name: title, subject, warnings, blame: Exit::Configuration })
    }
}

/// What a scene file says, or that of a folder; of a folder of frames, what stands in for it.
fn described(scene: &Path) -> Result<SceneDescription, RenderError> {
    let file = if scene.is_dir() { scene.join("scene.toml") } else { scene.into() };
    if scene.is_dir() && !file.exists() {
        return Ok(Job::open(scene)?.world.description);
    }
    Ok(SceneDescription::from_file(&file)?)
}

/// A setting as a line of TOML; a single word need not be in quotes.
fn line(setting: &str) -> Result<String, Refusal> {
    let Some((key, value)) = setting.split_once('=').filter(|_| !setting.contains(['\n', '\r'])) else {
        return Err(Refusal::usage(format!(
            "--set {setting}: write a key and a value on one line, such as temperature=10"
        )));
    };
    let is_word = value.starts_with(|c: char| c.is_ascii_alphabetic())
        && value.chars().all(|c| c.is_ascii_alphanumeric() || c == '-')
        && !["true", "false", "inf", "nan"].contains(&value);
    Ok(if is_word { format!("{key}=\"{value}\"") } else { setting.into() })
}

/// All models with their presets.
pub(super) fn list() -> String {
    let model = |kind: ModelKind| match kind.presets().as_slice() {
        [] => format!("\n  {}", kind.name()),
        presets => format!("\n  {}, or a preset of it: {}", kind.name(), presets.join(", ")),
    };
    let models: Vec<String> = ModelKind::ALL.into_iter().map(model).collect();
    format!("There are{}\nand SCENE:NAME for a medium of a scene file or folder", models.concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Presets are named without their model here.
    #[test]
    fn a_name_means_one_thing() {
        let presets = ModelKind::ALL.into_iter().flat_map(ModelKind::presets);
        let mut names: Vec<&str> = presets.chain(ModelKind::ALL.map(ModelKind::name)).collect();
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count, "{names:?}");
    }

    #[test]
    fn words_are_quoted_and_values_are_not() {
        for (setting, expected) in [
            ("phase=henyey-greenstein", "phase=\"henyey-greenstein\""),
            ("molecular_scattering=true", "molecular_scattering=true"),
            ("temperature=-5.5", "temperature=-5.5"),
            ("ior={ table = \"water\" }", "ior={ table = \"water\" }"),
            ("preset=\"baltic\"", "preset=\"baltic\""),
        ] {
            assert_eq!(line(setting).ok().as_deref(), Some(expected));
        }
        for bad in ["temperature", "a=1\nb=2"] {
            assert!(line(bad).is_err_and(|refusal| refusal.message.contains("such as temperature=10")));
        }
    }
}
