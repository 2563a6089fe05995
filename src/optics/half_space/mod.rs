//! Light that a half space of particles reflects, without a walk among them.
#![doc = include_str!("half_space.md")]

pub mod h_function;
pub mod incidence;
pub mod reflection;
pub mod table;

pub use reflection::{HalfSpace, HalfSpaceLanes, Reflection};
