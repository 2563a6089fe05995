//! One frame as rays see it, and the scene file that says what is in it.
//!
//! A [`description::SceneDescription`] is the scene file as plain data. [`world::World`] is what all frames share;
//! [`assembly`] adds the meshes of one frame and gives a [`frame::Frame`], which light transport reads.

pub mod assembly;
mod beneath;
mod bodies;
pub mod camera;
pub mod camera_path;
mod density;
pub mod description;
pub mod domain;
pub mod error;
pub mod frame;
pub mod geometry;
pub mod half_spaces;
pub mod inputs;
pub mod layers;
mod modelled;
mod motion;
pub mod needs;
mod parts;
mod resolution;
pub mod surface;
pub mod thick;
mod thickness;
pub mod world;

pub use error::FrameError;
