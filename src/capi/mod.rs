//! The library for programs in C: `include/floe.h`, behind the feature `capi`.
//!
//! A program opens a scene, sets a mesh, renders it and takes the pixels; [`functions`] has each call and what it asks of
//! its arguments, [`scene`] what a handle holds and what is serialised.
//!
//! * Nothing is taken on trust that can be checked: null pointers, pointers that are not aligned, counts, indices, numbers
//!   that are not finite and texts that are not UTF-8 are errors with a message. That arrays are as long as their counts
//!   say, and that a scene is not used after it is freed, nobody can check.
//! * No panic crosses the border: it becomes [`Status::Internal`]. Memory that is not there ends the process, as in Rust.
//! * `include/floe.h` is written by cbindgen from these files; `tests/capi_header.rs` compares them.

pub mod functions;
mod message;
pub mod scene;
pub mod status;

pub use scene::Scene;
pub use status::Status;
