//! What an integrator runs of what a frame needs, and what it leaves out.

use super::{Integrator, Scattered};
use crate::scene::needs::{NeedLine, Needs};

/// Of the sun's light, what neither beams nor photons beside them carry.
const ON_HALF_SPACES: &str =
    "sunlight that comes to media seen as half spaces through two or more refracting interfaces, or mirrored";
/// What beams do not carry, where there are no photons.
const BENT_TWICE: &str =
    "sunlight through two or more refracting interfaces, or reflected before it gets through one";
/// The same where meshes overlap.
const LAYERS: &str =
    "sunlight through the interfaces of meshes that overlap, or through two or more, or reflected before";

impl Integrator {
    /// What a picture of a frame with these needs lacks.
    pub fn left_out(&self, needs: &Needs) -> Vec<&'static str> {
        let of_scattering = match self {
            Self::Auto(_) => return self.on(needs).left_out(needs),
            Self::Path(tracer) => match tracer.scattered {
                Scattered::Always => None,
                Scattered::Once => Some("light scattered more than once"),
                Scattered::Ambient => Some("all scattered light but an ambient one"),
            },
            Self::Beams(_) if !needs.turbid_air => {
                return if needs.half_spaces { vec![ON_HALF_SPACES] } else { Vec::new() };
            }
            Self::Beams(_) => None,
            Self::Photon(_) if !needs.turbid_air => return Vec::new(),
            Self::Photon(_) => None,
            Self::AmbientOcclusion(_) => return vec!["all but the openness of the first surface"],
        };
        let lacks = match self {
            Self::Beams(_) if needs.layers => LAYERS,
            Self::Beams(_) => BENT_TWICE,
            _ => "sunlight through refracting interfaces",
        };
        needs
            .sun_behind_interface
            .then_some(lacks)
            .into_iter()
            .chain(of_scattering.filter(|_| needs.scattering))
            .collect()
    }

    /// A line for each part of the renderer: what runs or is left out, and why.
    pub fn lines(&self, needs: &Needs) -> Vec<NeedLine> {
        if let Self::Auto(_) = self {
            return self.on(needs).lines(needs);
        }
        let met = self.meets(needs).lines();
        let lines = needs.lines().into_iter().zip(met);
        lines
            .map(|(line, met)| match line.used && !met.used {
                true => NeedLine { used: false, because: "the integrator does without", ..line },
                false if line.part == Needs::SUN && needs.sun_behind_interface && self.has_photons(needs) => {
                    NeedLine { used: true, because: "photons carry it", ..line }
                }
                false if line.part == Needs::SUN && needs.sun_behind_interface && self.has_beams() => {
                    let because = match needs.turbid_air {
                        false => {
                            "all ways of it through one interface are found, and photons carry what is bent twice or mirrored"
                        }
                        true => {
                            "all ways of it through one interface are found; it is left out beyond two, and where it was reflected before"
                        }
                    };
                    NeedLine { used: true, because, ..line }
                }
                false => line,
            })
            .chain(self.photon_lines(needs))
            .collect()
    }

    fn has_photons(&self, needs: &Needs) -> bool {
        matches!(self, Self::Photon(_)) && !needs.turbid_air
    }

    fn has_beams(&self) -> bool {
        matches!(self, Self::Beams(_))
    }

    /// A line for each photon map.
    fn photon_lines(&self, needs: &Needs) -> [NeedLine; 3] {
        let emits = match self {
            Self::Photon(mapper) => Some(needs.lamps || mapper.carries_sky(needs)),
            Self::Beams(_) => Some(needs.sun_behind_interface),
            _ => None,
        };
        let is_alone = !self.has_beams();
        let takes = |part, needed: &[(bool, &'static str)], because| {
            let lacking = needed.iter().find(|(is_there, _)| !is_there).map(|(_, why)| *why);
            match (emits, lacking) {
                (None, _) => NeedLine { part, used: false, because: "the integrator has no photons" },
                (Some(false), _) => NeedLine { part, used: false, because: "no light emits photons" },
                (Some(true), Some(why)) => NeedLine { part, used: false, because: why },
                (Some(true), None) => NeedLine { part, used: true, because },
            }
        };
        let air = (!needs.turbid_air, "the open air scatters: they would have to begin at infinity");
        let diffuse = (needs.diffuse, "no diffuse surface takes them");
        let specular = (needs.specular, "nothing bends or mirrors light");
        let scattering = (needs.scattering, "no medium in the frame scatters");
        let global = (is_alone, "photons end where light is scattered");
        [
            takes(
                "caustic photons",
                &[air, diffuse, specular],
                "specular surfaces turn light onto diffuse ones",
            ),
            takes("global photons", &[air, global, diffuse], "light is scattered onto diffuse surfaces"),
            takes("volume photons", &[air, scattering], "a medium in the frame scatters"),
        ]
    }

    /// The needs that this integrator meets.
    fn meets(&self, needs: &Needs) -> Needs {
        match self {
            Self::Path(tracer) if tracer.scattered == Scattered::Ambient => {
                Needs { scattering: false, direct_light: needs.direct_light && needs.diffuse, ..*needs }
            }
            Self::Auto(_) | Self::Path(_) | Self::Beams(_) | Self::Photon(_) => *needs,
            Self::AmbientOcclusion(_) => Needs { motion: needs.motion, lens: needs.lens, ..Needs::default() },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{AmbientOcclusion, PathTracer, PhotonMapper};
    use super::*;
    use crate::scene::description::PhotonDescription;

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
        assert_eq!(path.lines(&sunny)[..sunny.lines().len()], sunny.lines());
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
        let photon = Integrator::Photon(PhotonMapper { path: PATH, settings: PhotonDescription::default() });
        assert!(photon.left_out(&sunny).is_empty());
        let misty = Needs { turbid_air: true, lamps: true, ..sunny };
        assert_eq!(photon.left_out(&misty), ["sunlight through refracting interfaces"]);
        assert!(used(&photon, &misty).iter().all(|part| !part.ends_with("photons")));
        let maps =
            |needs: &Needs| used(&photon, needs).into_iter().filter(|p| p.ends_with("photons")).count();
        let lamp = Needs { lamps: true, ..diffuse };
        assert_eq!([maps(&diffuse), maps(&lamp), maps(&Needs { specular: true, ..lamp })], [0, 2, 3]);
        assert_eq!(maps(&Needs { lamps: true, specular: true, ..Needs::default() }), 0);
        assert!(used(&path, &lamp).iter().all(|part| !part.ends_with("photons")));
        assert!(used(&openness, &diffuse).is_empty() && openness.left_out(&Needs::default()).len() == 1);
    }
}
