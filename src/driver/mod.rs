//! Owns the loop: which frames, in which order, on how many threads, and what is told about them.
//!
//! [`job::Job`] opens a scene file or a folder. [`render()`] goes through its frames, one at a time, all threads on the
//! tiles of one frame while one more makes the next frame ready, and writes a line into the ledger for each. A bad frame
//! never takes the others with it when [`RenderOptions::keep_going`] is set.
//!
//! A frame ends with its last sample, at a target for its error, or when its time is up ([`stopping`]).
//!
//! Several machines may each draw some samples of a frame ([`samples_range`]); [`merge()`] makes of them the picture that one
//! run writes.
//!
//! A [`Renderer`] draws meshes that are in memory.
//!
//! A run may be broken off at any moment. [`fingerprint`] and [`picture`] tell which pictures are there and up to date,
//! an [`accumulation::Accumulation`] holds what is done of a frame, and [`interrupt`] says when that has to be saved.
#![doc = include_str!("farm.md")]

pub mod accumulation;
mod ahead;
mod allocation;
mod arrivals;
mod checkpoint;
mod chosen;
pub mod error;
pub mod fingerprint;
pub mod frame_seeds;
pub(crate) mod guard;
mod half_tile;
mod halves;
pub mod interrupt;
pub mod job;
mod keeper;
mod ladder;
mod lap;
pub mod ledger;
pub mod ledgers;
pub mod merge;
pub mod meshes;
mod partial;
mod parts;
mod passes;
pub mod picture;
pub mod preview;
pub mod ready;
pub mod render;
pub mod rendered;
pub mod renderer;
mod restart;
mod resume;
pub mod samples_range;
mod sealed;
mod session;
pub mod stopping;
pub mod survey;
mod tile_loop;
pub mod tiles;
mod uniform;
pub mod watch;
pub mod whole;

pub use error::RenderError;
pub use fingerprint::{Fingerprint, Fingerprints, FrameSource, Identity};
pub use interrupt::Interrupt;
pub use job::Job;
pub use ledger::{FrameRecord, Status};
pub use merge::merge;
pub use picture::{PictureState, read_identity};
pub use render::{Observer, RenderOptions, RenderReport, check_pictures, render};
pub use rendered::Rendered;
pub use renderer::Renderer;
pub use restart::Restart;
pub use samples_range::SamplesRange;
pub use stopping::{StoppedBy, Target};
pub use survey::{FrameState, survey};
pub use watch::{WatchOptions, WatchReport, WatchStatus, watch};
