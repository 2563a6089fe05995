//! What the fuzz targets do with their bytes: whatever these are, there is an error or something sound, and no panic.

mod frame;
mod readers;

pub use frame::frame;
pub use readers::{grid, mesh, names, picture, scene};
