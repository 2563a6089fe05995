//! Measures: how well pictures are made, by rendering the same frames in several ways, and what media do to light.
//!
//! * [`compare`] compares pictures that are there with others.
//! * [`convergence`] measures errors against run time, by means of [`statistics`].
//! * [`cost`] says what a sequence will cost, by a trial of a few frames.
//! * [`temporal`] measures the errors of a sequence as an eye sees them, over several frames.
//! * [`seed_modes`] takes these measures for each way in which frames can share their random numbers.
//! * [`flip`](mod@flip) says how different two pictures look.
//! * [`medium`] says what a medium does to light.
//! * [`metrics`] says how far a picture is from a reference.
//! * [`distributions`] has the quantiles that tests of pictures need.
//! * [`plot`] draws results.
//! * [`report`] says what the ledgers of a sequence tell.
//! * [`z_test`](mod@z_test) tells a difference from noise.
//! * [`table`] writes results for people and for programs.
//! * [`stability`] compares with what is known, where a parameter makes a scene hard.
#![doc = include_str!("temporal.md")]

pub mod compare;
pub mod convergence;
pub mod cost;
pub mod distributions;
pub mod error;
pub mod flip;
pub mod medium;
pub mod metrics;
pub mod plot;
pub mod report;
pub mod seed_modes;
pub mod stability;
pub mod statistics;
pub mod table;
pub mod temporal;
pub mod z_test;

pub use convergence::{ConvergenceResults, ConvergenceStudy, study_convergence};
pub use cost::{CostEstimate, FrameCost, estimate_cost};
pub use error::StudyError;
pub use seed_modes::{SeedModeStudy, TemporalStudy, study_seed_modes};
pub use temporal::{TemporalErrors, TemporalMetrics};
