//! Owns the loop: which frames, in which order, on how many threads, and what is told about them.
//!
//! [`job::Job`] opens a scene file or a folder. [`render()`] goes through its frames, one at a time, all threads on the
//! tiles of one frame while one more makes the next frame ready, and writes a line into the ledger for each. A bad frame
//! never takes the others with it when [`RenderOptions::keep_going`] is set.

mod ahead;
pub mod error;
pub mod frame_seeds;
pub mod job;
pub mod ledger;
pub mod preview;
pub mod render;
mod session;
pub mod tiles;

pub use error::RenderError;
pub use job::Job;
pub use ledger::{FrameRecord, Status};
pub use render::{Observer, RenderOptions, RenderReport, check_pictures, render};
