//! A sun: a disc of even radiance, infinitely far away.
//!
//! ```text
//! L = E / (pi sin^2(alpha)),   alpha half the angular diameter, E on a plane perpendicular to the direction
//! ```

use glam::Vec3;

use crate::geometry::Frame;
use crate::geometry::elementary::sin_cos;
use crate::sampling::warp;
use crate::spectrum::{LaneCurve, Lanes, Wavelengths};

use super::LightSample;

/// The disc of a sun.
#[derive(Clone, Debug)]
pub struct Sun {
    frame: Frame,
    one_minus_cos: f32,
    sin_squared: f32,
    irradiance: LaneCurve,
}

impl Sun {
    /// A disc of `angular_diameter` degrees (0 < d < 180) around the unit vector `direction`.
    pub fn new(direction: Vec3, angular_diameter: f32, irradiance: LaneCurve) -> Self {
        let alpha = 0.5 * angular_diameter.to_radians();
        let half_sine = sin_cos(0.5 * alpha).0;
        let sine = sin_cos(alpha).0;
        Self {
            frame: Frame::around(direction),
            one_minus_cos: 2.0 * half_sine * half_sine,
            sin_squared: sine * sine,
            irradiance,
        }
    }

    /// Unit vector towards the disc's centre.
    pub fn direction(&self) -> Vec3 {
        self.frame.n
    }

    /// 1 less the cosine of half its angular diameter; times 2 pi its solid angle.
    pub fn one_minus_cos(&self) -> f32 {
        self.one_minus_cos
    }

    /// Half its angular diameter, in radians.
    pub fn half_angle(&self) -> f32 {
        let sine = self.sin_squared.sqrt();
        crate::geometry::elementary::atan2(sine, 1.0 - self.one_minus_cos)
    }

    /// Radiance from a direction: that of the disc, or nothing.
    pub fn radiance(&self, direction: Vec3, wavelengths: &Wavelengths) -> Lanes {
        if self.contains(direction) { self.disc_radiance(wavelengths) } else { Lanes::ZERO }
    }

    /// True inside the disc.
    #[inline]
    pub fn contains(&self, direction: Vec3) -> bool {
        0.5 * (direction - self.frame.n).length_squared() <= self.one_minus_cos
    }

    /// A direction towards the disc.
    pub fn sample(&self, u: [f32; 2], wavelengths: &Wavelengths) -> LightSample {
        LightSample {
            wi: self.frame.to_world(warp::cone(u, self.one_minus_cos)).normalize(),
            distance: f32::INFINITY,
            triangle: None,
            radiance: self.disc_radiance(wavelengths),
            pdf_w: warp::cone_pdf_w(self.one_minus_cos),
        }
    }

    /// The greatest irradiance that a lane can have, which is zero only of a sun without light.
    pub fn power(&self) -> f32 {
        self.irradiance.maximum()
    }

    /// Its light spread over all directions.
    pub fn mean_radiance(&self, wavelengths: &Wavelengths) -> Lanes {
        self.irradiance.lanes(wavelengths) * (0.25 * std::f32::consts::FRAC_1_PI)
    }

    fn disc_radiance(&self, wavelengths: &Wavelengths) -> Lanes {
        self.irradiance.lanes(wavelengths) / (std::f32::consts::PI * self.sin_squared)
    }
}
