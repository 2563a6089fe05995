//! Pure ice, and ice with air and brine in it.
//!
//! [`refractive_index`] and [`absorption`](self::absorption()) are ice itself; [`iceberg`] adds what it encloses.

mod brine_volume;
pub mod iceberg;
mod inclusions;
mod index;

pub use brine_volume::{IceContents, IceError, TEMPERATURE_RANGE, contents, density};
pub use inclusions::{air, brine};
pub use index::{absorption, extinction_index, refractive_index};
