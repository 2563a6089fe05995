//! What light meets: refractive indices, surfaces between media, and what is in the media.
//!
//! [`water`], [`ice`] and [`milk`] say what these are made of: measured tables of the pure matter, and what natural waters,
//! icebergs and milk carry. By Lorenz-Mie theory ([`lorenz_mie`]) [`particles`] makes coefficients and phase functions of
//! that, and [`apparent`] what a deep body of it looks like. A [`medium`] has them, given or computed, with its phase
//! function ([`phase`]) and [`density`]. An index over wavelength is a [`RefractiveIndex`]. Smooth boundaries reflect after
//! Fresnel ([`fresnel`]) and bend after Snell ([`refraction`]).
//!
//! Indices are n + i k with k >= 0 absorbing. `eta_t_over_i` is the index on the far side over the index on the side
//! that the light, or the path, comes from. Coefficients are in 1/m, wavelengths in nm in vacuum.

pub mod apparent;
pub mod density;
pub mod dwivedi;
pub mod fresnel;
pub mod half_space;
pub mod ice;
pub mod lorenz_mie;
pub mod medium;
pub mod medium_reduction;
pub mod milk;
pub mod particles;
pub mod phase;
pub mod refraction;
pub mod refractive_index;
pub mod similarity;
pub mod volume;
pub mod water;

pub use refractive_index::RefractiveIndex;
