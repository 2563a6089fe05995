//! Reads a medium whose keys are given one by one, as on a command line.

use std::path::Path;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::MediumDescription;
use super::document::Source;
use super::error::SceneError;
use super::media;
use super::value::Value;

impl MediumDescription {
    /// The medium of `settings`, lines `key = value` whose places are told as those of `origin`, and of `implied` ones,
    /// which are told as `medium`'s.
    ///
    /// # Errors
    /// [`SceneError`], with the place of what is wrong.
    pub fn from_settings(
        origin: &Path,
        settings: &[String],
        medium: &Path,
        implied: &[String],
    ) -> Result<Self, SceneError> {
        let text = [settings, implied].concat().join("\n");
        let source = Source { text: &text, file: origin };
        read(source, medium).map_err(|mut error| {
            if let Some(place) = error.place_mut()
                && place.line > settings.len()
            {
                place.line -= settings.len();
                place.file = medium.to_owned();
            }
            error
        })
    }
}

fn read(source: Source<'_>, medium: &Path) -> Result<MediumDescription, SceneError> {
    let root = DeTable::parse(source.text).map_err(|error| SceneError::Syntax {
        place: source.place(error.span().map_or(0, |span| span.start)),
        message: error.message().to_owned(),
    })?;
    let whole = Spanned::new(root.span(), DeValue::Table(root.into_inner()));
    media::medium(&Value::new(source, medium.display().to_string(), &whole))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn medium(settings: &[&str], implied: &[&str]) -> Result<MediumDescription, String> {
        let [settings, implied] =
            [settings, implied].map(|list| list.iter().map(ToString::to_string).collect::<Vec<_>>());
        MediumDescription::from_settings(Path::new("--set"), &settings, Path::new("sea"), &implied)
            .map_err(|error| error.to_string())
    }

    #[test]
    fn settings_are_keys_of_a_medium() {
        let found = medium(&["scattering=2"], &["absorption = 0.5", "ior = 1.3"]).unwrap();
        assert_eq!(found.scattering, crate::spectrum::Spectrum::Constant(2.0));
        assert!((found.ior.n(550.0) - 1.3).abs() < 1e-6);
    }

    #[test]
    fn places_count_settings_and_what_is_implied_apart() {
        for (settings, implied, says) in [
            (
                &["scattering=2", "absorption = -1"][..],
                &["ior = 1.3"][..],
                "--set:2:14: sea.absorption: -1: write",
            ),
            (
                &["scatering=2"],
                &[],
                "--set:1:1: unknown key `scatering` in [sea]; did you mean `scattering`?",
            ),
            (&["scattering=2"], &["ior = 1.3", "absorption = -1"], "sea:2:14: sea.absorption: -1"),
            (&["scattering=="], &[], "--set:1:12: this is not TOML"),
            (&["ior=1.4"], &["ior = 1.3"], "sea:1:1: this is not TOML: duplicate key"),
        ] {
            let message = medium(settings, implied).unwrap_err();
            assert!(message.starts_with(says), "{message}");
        }
    }
}
