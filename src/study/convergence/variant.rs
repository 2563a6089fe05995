//! Which integrators and settings are studied, and with how many samples.

use std::str::FromStr;

use crate::scene::description::{IntegratorKind, RenderDescription};
use crate::scene::needs::Needs;
use crate::study::error::StudyError;

/// A way to render.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Variant {
    /// What results call it.
    pub name: String,
    /// The settings.
    pub render: RenderDescription,
}

/// Every integrator with all settings. Without integrators it is that of the scene, and where that is `auto` what it runs, with
/// photons alone besides if the sun shines where paths do not find it.
pub(super) fn variants(
    scene: &RenderDescription,
    needs: &Needs,
    integrators: &[String],
    settings: &[String],
) -> Result<Vec<Variant>, StudyError> {
    let is_auto = scene.integrator == IntegratorKind::Auto;
    let default: &[&str] = match (is_auto, needs.sun_behind_interface) {
        (true, true) => &["beams", "photon"],
        (true, false) => &["path"],
        (false, _) => &[],
    };
    let named: Vec<String> = match integrators {
        [] => default.iter().map(|name| format!("integrator = '{name}'")).collect(),
        names => names.iter().map(|name| format!("integrator = '{name}'")).collect(),
    };
    let as_it_is = [String::new()];
    let named = if named.is_empty() { &as_it_is[..] } else { &named };
    let settings = if settings.is_empty() { &as_it_is[..] } else { settings };
    let scene_error = |error| StudyError::Render(crate::driver::RenderError::Scene(error));
    let mut variants: Vec<Variant> = Vec::new();
    for integrator in named {
        let scene = scene.with(integrator, "--integrators").map_err(scene_error)?;
        for text in settings {
            let render = scene.with(text, "--settings").map_err(scene_error)?;
            if (render.samples, render.seed) != (scene.samples, scene.seed) {
                return Err(StudyError::NotASetting { text: text.clone() });
            }
            let integrator = crate::integrator::Integrator::new(&render).name();
            let name = if text.is_empty() { integrator.into() } else { format!("{integrator}, {text}") };
            if variants.iter().all(|other| other.name != name) {
                variants.push(Variant { name, render });
            }
        }
    }
    Ok(variants)
}

/// Numbers of samples a pixel, in rising order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Budgets(pub Vec<u32>);

impl Default for Budgets {
    /// From one sample of each replicate on.
    fn default() -> Self {
        Self((2..=8).map(|power| 1 << power).collect())
    }
}

impl FromStr for Budgets {
    type Err = String;

    /// `4-64` doubles from 4 to 64; `4,12,36` is as it stands.
    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!(
                "`{text}` is no list of samples: write 4-256, which doubles in between, or such as 4,12,36"
            )
        };
        let number = |text: &str| text.trim().parse().ok().filter(|n| *n > 0).ok_or_else(wrong);
        let budgets = match text.split_once('-') {
            Some((first, last)) => {
                let (first, last) = (number(first)?, number(last)?);
                std::iter::successors(Some(first), |n: &u32| n.checked_mul(2))
                    .take_while(|n| *n <= last)
                    .collect()
            }
            None => text.split(',').map(number).collect::<Result<Vec<u32>, _>>()?,
        };
        let rises = budgets.windows(2).all(|pair| pair[0] < pair[1]);
        if rises && !budgets.is_empty() { Ok(Self(budgets)) } else { Err(wrong()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn budgets_double_or_are_listed() {
        for (text, budgets) in [
            ("4-32", vec![4, 8, 16, 32]),
            ("3-20", vec![3, 6, 12]),
            ("1, 10,100", vec![1, 10, 100]),
            ("7", vec![7]),
        ] {
            assert_eq!(text.parse(), Ok(Budgets(budgets)), "{text}");
        }
        assert_eq!(Budgets::default(), "4-256".parse().unwrap());
        for text in ["", "0", "8-4", "4,4", "8,4", "4-", "-4", "4..8", "a", "99999999999"] {
            assert!(text.parse::<Budgets>().unwrap_err().contains("4-256"), "{text}");
        }
    }

    #[test]
    fn every_integrator_has_all_settings() {
        let scene = RenderDescription::default();
        let names = |needs: &Needs, integrators: &[&str], settings: &[&str]| -> Vec<String> {
            let [integrators, settings] = [integrators, settings]
                .map(|texts| texts.iter().map(ToString::to_string).collect::<Vec<_>>());
            variants(&scene, needs, &integrators, &settings).unwrap().into_iter().map(|v| v.name).collect()
        };
        let dry = Needs::default();
        let under_water = Needs { sun_behind_interface: true, ..dry };
        assert_eq!(names(&dry, &[], &[]), ["path"]);
        assert_eq!(names(&under_water, &[], &[]), ["beams", "photon"]);
        assert_eq!(names(&under_water, &["path", "path"], &[]), ["path"]);
        assert_eq!(
            names(&dry, &["path", "fog"], &["", "split = 2"]),
            ["path", "path, split = 2", "fog", "fog, split = 2"]
        );
        for (integrator, setting, word) in [("paths", "", "path"), ("path", "samples = 9", "--budgets")] {
            let error = variants(&scene, &dry, &[integrator.into()], &[setting.into()]).unwrap_err();
            assert!(error.to_string().contains(word), "{error}");
        }
    }
}
