//! What a frame needs of the renderer, and what is left out.
#![doc = include_str!("left_out.md")]

use std::fmt;

/// Computed from a frame; light transport is specialised over it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// Some medium that is in the frame scatters.
    pub scattering: bool,
    /// Some light is worth looking for from a vertex.
    pub direct_light: bool,
    /// Some boundary is passed straight through, so shadow rays cannot stop at the first hit.
    pub matched_interfaces: bool,
    /// Meshes overlap, so that which media a triangle parts depends on what else is there.
    pub layers: bool,
    /// Some medium absorbs or scatters.
    pub attenuation: bool,
    /// The density of a medium in the frame changes from place to place.
    pub heterogeneous: bool,
    /// A medium in the frame emits light.
    pub emission: bool,
    /// Something is given over wavelength.
    pub spectral: bool,
    /// Wavelengths bend at indices of their own.
    pub dispersive: bool,
    /// There are diffuse surfaces.
    pub diffuse: bool,
    /// There are interfaces that refract, or metals.
    pub specular: bool,
    /// The open air scatters: there are no photons then.
    pub turbid_air: bool,
    /// There are a sun or emitters.
    pub lamps: bool,
    /// The sky is not black.
    pub sky: bool,
    /// A small part of the sky has most of its light.
    pub peaked_sky: bool,
    /// Scattering in thick media was replaced by what is similar from afar: the picture is biased.
    pub similarity: bool,
    /// A medium is too thick to walk through and is seen as a half space: the picture is biased.
    pub half_spaces: bool,
    /// Something moves while the shutter is open.
    pub motion: bool,
    /// The camera has a lens: what is not in focus is blurred.
    pub lens: bool,
    /// A sun shines on a refracting interface: its light beyond is left out.
    pub sun_behind_interface: bool,
}

impl Needs {
    /// The part that only photons can be.
    pub const SUN: &'static str = "sun through refracting interfaces";

    /// A line for each part: what is used or left out, and why.
    pub fn lines(&self) -> Vec<NeedLine> {
        let mut lines = vec![
            line(
                "spectral lanes",
                self.spectral,
                if self.spectral { "something is given over wavelength" } else { "all is given in RGB" },
            ),
            line(
                "dispersion",
                self.dispersive,
                if self.dispersive {
                    "render.dispersion is on and an index varies over wavelength: where that parts directions one wavelength of four goes on, which is noise of colour"
                } else {
                    "render.dispersion is off, or no index varies over wavelength: rays bend at that of 589.3 nm"
                },
            ),
            line(
                "scattering",
                self.scattering,
                if self.scattering {
                    "a medium in the frame scatters"
                } else {
                    "no medium in the frame scatters"
                },
            ),
            line(
                "transmittance",
                self.attenuation,
                if self.attenuation { "a medium absorbs or scatters" } else { "all media are clear" },
            ),
            line(
                "varying density",
                self.heterogeneous,
                if self.heterogeneous {
                    "a medium in the frame is stratified or a grid"
                } else {
                    "all media in the frame are homogeneous"
                },
            ),
            line(
                "emission of media",
                self.emission,
                if self.emission { "a medium in the frame glows" } else { "no medium in the frame glows" },
            ),
            line(
                "next-event estimation",
                self.direct_light,
                if self.direct_light {
                    "a sun, a sky that is not even or an emitter can be seen from a scattering or diffuse vertex"
                } else {
                    "no light can be looked for from any vertex"
                },
            ),
            line(
                "shadow rays through boundaries",
                self.direct_light && self.matched_interfaces,
                if self.matched_interfaces {
                    "some boundaries are index-matched"
                } else {
                    "no boundary is index-matched"
                },
            ),
            line(
                "priorities of meshes",
                self.layers,
                if self.layers {
                    "meshes overlap, or may: the one of higher priority is there"
                } else {
                    "no two meshes are in the same place"
                },
            ),
            line(
                "motion blur",
                self.motion,
                if self.motion {
                    "vertices have velocities and the shutter opens"
                } else {
                    "the shutter stays closed, or no vertex has a velocity"
                },
            ),
            line(
                "depth of field",
                self.lens,
                if self.lens { "the camera has an aperture" } else { "the camera is a pinhole" },
            ),
            line(
                Self::SUN,
                false,
                if self.sun_behind_interface {
                    "the sun shines on a refracting interface, but a path tracer finds it beyond only as fireflies: its light there is left out; integrator = \"photon\" or \"beams\" follows it"
                } else {
                    "no sun shines on a refracting interface"
                },
            ),
        ];
        lines.extend(self.biased_lines());
        lines
    }

    fn biased_lines(&self) -> [NeedLine; 2] {
        [
            line(
                "similarity reduction (biased)",
                self.similarity,
                if self.similarity {
                    "render.similarity is set and a medium is thick: it scatters less often and wider than it says"
                } else {
                    "render.similarity is 0, or no medium is thick and scatters forward"
                },
            ),
            line(
                "half-space reflection (biased)",
                self.half_spaces,
                if self.half_spaces {
                    "a medium is too thick to walk through: light leaves it where it came in"
                } else {
                    "no medium has an optical size above 100,000 or free paths that coordinates cannot tell, or it is walked through all the same"
                },
            ),
        ]
    }
}

fn line(part: &'static str, used: bool, because: &'static str) -> NeedLine {
    NeedLine { part, used, because }
}

/// One line of the report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NeedLine {
    /// The part of the renderer.
    pub part: &'static str,
    /// Whether it runs.
    pub used: bool,
    /// Why.
    pub because: &'static str,
}

impl fmt::Display for NeedLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let state = if self.used { "used" } else { "left out" };
        write!(f, "{:<34} {state:<9} {}", self.part, self.because)
    }
}
