//! Finds out how well pictures are made: renders the same frames in several ways and compares.
//!
//! * [`temporal`] measures the errors of a sequence as an eye sees them, over several frames.
//! * [`seed_modes`] takes these measures for each way in which frames can share their random numbers.
//! * [`metrics`] says how far a picture is from a reference.
//! * [`distributions`] has the quantiles that tests of pictures need.
//! * [`plot`] draws results.
//! * [`table`] writes results for people and for programs.
//! * [`stability`] compares with what is known, where a parameter makes a scene hard.
#![doc = include_str!("temporal.md")]

pub mod distributions;
pub mod error;
pub mod metrics;
pub mod plot;
pub mod seed_modes;
pub mod stability;
pub mod table;
pub mod temporal;

pub use error::StudyError;
pub use seed_modes::{SeedModeStudy, TemporalStudy, study_seed_modes};
pub use temporal::{TemporalErrors, TemporalMetrics};
