//! Four lanes of light: linear RGB, or four hero wavelengths.
//!
//! Transport carries [`Lanes`]. They are linear Rec. 709 RGB (the fourth lane zero) when everything in the scene is
//! given in RGB, and four wavelengths of one path when anything is spectral. Integrators do not know which.
//!
//! A scene's [`Spectrum`] is prepared once ([`Spectrum::prepare`]) into a [`LaneCurve`]; paths look that up on their
//! [`Wavelengths`], and the film takes the colour of what they bring back ([`film_rgb`]).
//!
//! The colour of radiance L is RGB of its X, Y, Z = integral of L (xbar, ybar, zbar) over nm, without the factor
//! 683 lm/W: D65 of luminance (Y) 1 is RGB (1, 1, 1).
#![doc = include_str!("colour_noise.md")]

pub mod blackbody;
pub mod cie;
pub mod curve;
pub mod lab;
pub mod light_primaries;
pub mod luminance;
pub mod rgb;
pub mod solar;
pub mod wavelength;

use glam::Vec4;

pub use curve::{LaneCurve, Role};
pub use wavelength::{Wavelengths, film_rgb};

/// Throughput, radiance or a coefficient on the four lanes of a path.
pub type Lanes = Vec4;

/// What the four lanes of a scene's paths stand for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LaneMode {
    /// (R, G, B, 0), linear, Rec. 709 primaries, D65 white.
    Rgb,
    /// Four hero wavelengths between 380 and 780 nm.
    Spectral,
}

impl LaneMode {
    /// One on every lane that carries light.
    pub fn white(self) -> Lanes {
        match self {
            Self::Rgb => Vec4::new(1.0, 1.0, 1.0, 0.0),
            Self::Spectral => Vec4::ONE,
        }
    }
}

/// A quantity over wavelength as the scene file gives it.
#[derive(Clone, Debug, PartialEq)]
pub enum Spectrum {
    /// The same at every wavelength; for a light: that much of white (D65).
    Constant(f32),
    /// Linear Rec. 709 RGB.
    Rgb([f32; 3]),
    /// Values between wavelengths in nm (strictly rising), linear in between, constant beyond the ends.
    Table {
        /// Wavelengths in nm, strictly rising.
        wavelengths: Vec<f32>,
        /// One value for each wavelength.
        values: Vec<f32>,
    },
    /// Planck's radiation scaled to a luminance: the integral of L times the CIE 1931 y-bar is `luminance`
    /// (683 cd/m^2 or lx are 1).
    Blackbody {
        /// Temperature in kelvin.
        temperature: f32,
        /// Integral of the spectrum times y-bar.
        luminance: f32,
    },
    /// Planck's radiation as it is, in W m^-2 sr^-1 nm^-1.
    Planck {
        /// Temperature in kelvin.
        temperature: f32,
    },
}
