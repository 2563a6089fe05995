//! What particles in a fluid or in ice do to light: coefficients and phase functions of mixtures, by Lorenz-Mie theory.
//!
//! A [`Mixture`] is a [`Host`], such as sea water, and [`Species`] of spheres in it, each of one matter and with a
//! [`SizeDistribution`] that its volume fraction scales. [`Mixture::bulk`] has its coefficients, [`Mixture::scattering`]
//! its phase function, too. That takes tenths of a second; a [`Cache`] keeps it.
//!
//! Radii and lengths are in metres, wavelengths in nm in vacuum, coefficients in 1/m, angles in radians.

mod angles;
mod bulk;
mod cache;
mod ensemble;
mod error;
mod key;
mod mixture;
mod quadrature;
mod sizes;

pub use bulk::{Bulk, SpeciesBulk};
pub use cache::Cache;
pub use ensemble::{EnsemblePhase, Scattering};
pub use error::{MixtureError, SizesError};
pub use mixture::{Host, Mixture, Species};
pub use sizes::{Cylinder, SizeDistribution};
