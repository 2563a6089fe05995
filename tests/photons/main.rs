//! Photon mapping against path tracing, closed forms and another renderer.
//!
//! Photons are shared by all pixels of a pass, so errors are measured between independent seeds. A picture whose kernels
//! are r wide is biased by a r + b r^2; from radii r, 2 r and 4 r the value at 0 follows without both terms.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

#[path = "../common/mod.rs"]
mod common;

mod agreement;
mod closed_forms;
mod convergence;
mod references;
mod seeds;
