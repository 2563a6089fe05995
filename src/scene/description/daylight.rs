//! How bright the scene's suns and sky are.

use std::f64::consts::{FRAC_1_PI, PI};

use super::{Axis, SkyDescription, SunDescription};
use crate::spectrum::luminance::{LUMENS_PER_WATT, luminance_f64};
use crate::spectrum::{Role, Spectrum};

/// Illuminances in lux; radiance in other units than W m^-2 sr^-1 nm^-1 makes them relative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Daylight {
    /// Of the suns, each on a plane perpendicular to its beam.
    pub sun: f64,
    /// Of the suns on level ground.
    pub sun_level: f64,
    /// Of the sky on level ground; `None` where the sky is a picture.
    pub sky_level: Option<f64>,
}

impl Daylight {
    /// Of a scene's lights.
    pub fn new(suns: &[SunDescription], sky: &SkyDescription, up: Axis) -> Self {
        let direct = |sun: &SunDescription| lux(&sun.irradiance);
        let level = |sun| direct(sun) * f64::from(sun.direction.dot(up.vector()).max(0.0));
        let sky_level = match (sky, suns.first()) {
            (SkyDescription::Constant(radiance), _) => Some(PI * lux(radiance)),
            (SkyDescription::Clear(air), Some(sun)) => {
                Some(lux(&air.light(sun.direction, up.vector()).level))
            }
            (SkyDescription::Clear(_), None) | (SkyDescription::Image { .. }, _) => None,
        };
        Self { sun: suns.iter().map(direct).sum(), sun_level: suns.iter().map(level).sum(), sky_level }
    }

    /// The exposure in stops, to a tenth, that shows a white card as radiance 1 that the sun falls on straight, and so
    /// does any other, with the sky's light on level ground.
    ///
    /// Level ground instead of the card would leave a low sun's sky too bright: there it is as bright as the ground.
    pub fn exposure(&self) -> f32 {
        let white = (self.sun + self.sky_level.unwrap_or(0.0)) * FRAC_1_PI / LUMENS_PER_WATT;
        let stops = if white > 0.0 { -libm::log2(white) } else { 0.0 };
        ((stops.clamp(-60.0, 60.0) * 10.0).round() / 10.0) as f32
    }
}

fn lux(spectrum: &Spectrum) -> f64 {
    LUMENS_PER_WATT * luminance_f64(spectrum.to_rgb(Role::Illuminant).as_dvec3())
}
