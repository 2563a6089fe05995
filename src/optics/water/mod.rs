//! Pure water, sea water, and what natural waters carry.
//!
//! [`refractive_index`] and [`absorption`](self::absorption()) are water itself; [`natural`] adds what is suspended and
//! dissolved in it.

mod absorption;
mod constituents;
mod index;
mod molecules;
pub mod natural;

pub use absorption::{MEASURED_AT, absorption, absorption_at, dissolved_matter};
pub use constituents::{algae, mineral, rock_flour};
pub use index::{FITTED_WAVELENGTHS, SALINITY_RANGE, TEMPERATURE_RANGE, refractive_index};
pub use molecules::molecular_scattering;
