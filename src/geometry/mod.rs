//! Rays, boxes, frames and the elementary functions that every other stage stands on.

pub mod bounds;
pub mod elementary;
pub mod frame;
pub mod offset;
pub mod ray;
pub mod triangle;

pub use bounds::Bounds;
pub use frame::Frame;
pub use ray::Ray;
