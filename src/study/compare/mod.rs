//! Compares pictures with reference pictures, and says whether they differ by more than noise.
//!
//! A is the candidate, B the reference; that matters to relative errors, which are parts of B, and to FLIP, whose
//! exposures are those of B.
//!
//! * [`pairs`](mod@pairs) finds which picture belongs to which.
//! * [`measure`](mod@measure) takes the measures of a pair.
//! * [`limits`](mod@limits) judges them.
//! * [`report`] writes them down for people and for programs.
//! * [`difference`] shows where they differ.

pub mod difference;
pub mod error;
pub mod limits;
pub mod measure;
pub mod pairs;
pub mod report;

pub use error::CompareError;
pub use limits::{Limits, Verdict};
pub use measure::{Comparison, compare};
pub use pairs::{Pair, Pairs};
