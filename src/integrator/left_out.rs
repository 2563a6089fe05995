//! What an integrator runs of what a frame needs, and what it leaves out.

use super::{Integrator, Scattered};
use crate::scene::needs::{NeedLine, Needs};

impl Integrator {
    /// What a picture of a frame with these needs lacks.
    pub fn left_out(&self, needs: &Needs) -> Vec<&'static str> {
        let of_scattering = match self {
            Self::Path(tracer) => match tracer.scattered {
                Scattered::Always => None,
                Scattered::Once => Some("light scattered more than once"),
                Scattered::Ambient => Some("all scattered light but an ambient one"),
            },
            Self::AmbientOcclusion(_) => return vec!["all but the openness of the first surface"],
        };
        let of_the_sun = needs.sun_behind_interface.then_some("sunlight through refracting interfaces");
        of_the_sun.into_iter().chain(of_scattering.filter(|_| needs.scattering)).collect()
    }

    /// A line for each part of the renderer: what runs or is left out, and why.
    pub fn lines(&self, needs: &Needs) -> Vec<NeedLine> {
        let met = self.meets(needs).lines();
        let lines = needs.lines().into_iter().zip(met);
        lines
            .map(|(line, met)| match line.used && !met.used {
                true => NeedLine { used: false, because: "the integrator does without", ..line },
                false => line,
            })
            .collect()
    }

    /// The needs that this integrator meets.
    fn meets(&self, needs: &Needs) -> Needs {
        match self {
            Self::Path(tracer) if tracer.scattered == Scattered::Ambient => {
                Needs { scattering: false, direct_light: needs.direct_light && needs.diffuse, ..*needs }
            }
            Self::Path(_) => *needs,
            Self::AmbientOcclusion(_) => Needs::default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{AmbientOcclusion, PathTracer};
    use super::*;

    const PATH: PathTracer = PathTracer { max_depth: 0, split: 1, forced: 0, scattered: Scattered::Always };

    fn used(integrator: &Integrator, needs: &Needs) -> Vec<&'static str> {
        integrator.lines(needs).into_iter().filter(|line| line.used).map(|line| line.part).collect()
    }

    #[test]
    fn what_an_integrator_does_without_is_left_out() {
        let turbid = Needs { scattering: true, attenuation: true, direct_light: true, ..Needs::default() };
        let sunny = Needs { sun_behind_interface: true, ..turbid };
        let path = Integrator::Path(PATH);
        let once = Integrator::Path(PathTracer { scattered: Scattered::Once, ..PATH });
        let fog = Integrator::Path(PathTracer { scattered: Scattered::Ambient, ..PATH });
        let openness = Integrator::AmbientOcclusion(AmbientOcclusion);
        assert_eq!(path.lines(&sunny), sunny.lines());
        assert_eq!(path.left_out(&sunny), ["sunlight through refracting interfaces"]);
        assert_eq!(
            once.left_out(&sunny),
            ["sunlight through refracting interfaces", "light scattered more than once"]
        );
        assert_eq!(used(&once, &turbid), ["scattering", "transmittance", "next-event estimation"]);
        assert_eq!(used(&fog, &turbid), ["transmittance"]);
        assert_eq!(fog.left_out(&turbid), ["all scattered light but an ambient one"]);
        let diffuse = Needs { diffuse: true, ..turbid };
        assert_eq!(used(&fog, &diffuse), ["transmittance", "next-event estimation"]);
        for integrator in [path, once, fog] {
            assert!(integrator.left_out(&Needs::default()).is_empty(), "nothing scatters");
        }
        assert!(used(&openness, &diffuse).is_empty() && openness.left_out(&Needs::default()).len() == 1);
    }
}
