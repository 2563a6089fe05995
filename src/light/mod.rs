//! Where light comes from: the sky, the discs of suns, emitting triangles. Where the sun stands at a time and a place is
//! [`sun_position`].
//!
//! Each light is found by chance (a path that runs into it) and, where that pays, by next-event estimation; the
//! balance heuristic weights the two `[VEACH97 section 9.2.2]`.
//!
//! * A constant sky is found by chance only: directions drawn from the surface or phase function are already right.
//! * A picture of the sky is importance sampled, and so is a clear sky ([`clear_sky`]), which comes from the same sun and
//!   air as the sun's beam ([`atmosphere`]).
//! * A sun's disc is so small that chance never finds it: it is counted by next-event estimation, and on paths that
//!   have met nothing but specular surfaces since the eye. Its light through a refracting interface is that of beams and
//!   photons, where the integrator has these. A vertex looks for every sun, with the same random numbers.
//! * Emitting triangles are sampled by area.
//! * Beneath a refracting interface directions are drawn in which compact lights are likely to be seen ([`beneath`]).
//!
//! Where nobody looks for them, sky and suns are an ambient radiance from all around,
//!
//! ```text
//! L_ambient = (integral of L_sky over the sphere + sum of E over the suns) / (4 pi)
//! ```

pub mod area;
pub mod atmosphere;
pub mod beneath;
pub mod clear_sky;
pub mod environment;
mod hosek_wilkie;
mod picture;
mod sphere_map;
pub mod sun;
pub mod sun_position;

pub use area::AreaLights;
pub use beneath::Beneath;
pub use clear_sky::{ClearAir, ClearSky};
pub use environment::Environment;
pub use picture::{ImageError, Picture};
pub(crate) use picture::{check_exr_size, read_exr};
pub use sun::Sun;

use glam::Vec3;

use crate::spectrum::{Lanes, Wavelengths};

/// Every light of a scene.
#[derive(Clone, Debug)]
pub struct Lights {
    /// Light from infinity in all directions.
    pub environment: Environment,
    /// The discs of suns, the one that lights a clear sky first.
    pub suns: Vec<Sun>,
    /// Emitting triangles.
    pub area: Option<AreaLights>,
}

/// A direction towards a light, drawn by next-event estimation.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Unit direction towards the light.
    pub wi: Vec3,
    /// How far it is; infinite for the sky and the sun.
    pub distance: f32,
    /// The emitting triangle, if any.
    pub triangle: Option<u32>,
    /// Radiance that arrives if nothing is in between.
    pub radiance: Lanes,
    /// Density per solid angle.
    pub pdf_w: f32,
}

impl Lights {
    /// True when next-event estimation can find anything.
    pub fn are_sampled(&self) -> bool {
        self.environment.is_sampled() || !self.suns.is_empty() || self.area.is_some()
    }

    /// Sky and suns spread over all directions; emitting triangles have no part in it.
    pub fn ambient(&self, wavelengths: &Wavelengths) -> Lanes {
        let suns = self.suns.iter().map(|sun| sun.mean_radiance(wavelengths)).sum::<Lanes>();
        self.environment.mean_radiance(wavelengths) + suns
    }

    /// Radiance of the suns whose discs a direction meets.
    pub fn of_suns(&self, direction: Vec3, wavelengths: &Wavelengths) -> Lanes {
        self.suns.iter().map(|sun| sun.radiance(direction, wavelengths)).sum()
    }
}

/// The balance heuristic's weight of a sample with density `pdf` where another strategy has `other`.
#[inline]
pub fn balance(pdf: f32, other: f32) -> f32 {
    if pdf > 0.0 { 1.0 / (1.0 + other / pdf) } else { 0.0 }
}
