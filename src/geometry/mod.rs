//! Rays, boxes, frames and the elementary functions that every other stage stands on.

pub mod bounds;
pub mod elementary;
pub mod frame;
pub(crate) mod machine;
pub(crate) mod nearness;
pub mod offset;
pub(crate) mod portable;
pub mod ray;
pub mod triangle;
pub(crate) mod wide;

pub use bounds::Bounds;
pub use frame::Frame;
pub use ray::Ray;
