//! Random and low-discrepancy numbers, and the warps that turn them into directions and points.
//!
//! A sample depends on (seed, frame, pixel, sample index, dimension) and on nothing else: not on thread, tile, order
//! or host. [`SampleStream`] is that dependence; [`warp`] and [`distribution`] use its numbers.

pub mod distribution;
pub mod seed;
pub mod sobol;
pub mod warp;

pub use distribution::{Distribution1d, Distribution2d};
pub use seed::{REPLICATES, SampleSeed, SampleStream};
