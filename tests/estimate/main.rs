//! Whether the error that a picture states is the error that it has: on scenes of all kinds, over many seeds.
//!
//! Rates are compared with the binomial distribution; seeds are fixed.
#![allow(clippy::print_stdout)]

#[path = "../common/mod.rs"]
mod common;

mod coverage;
mod rates;
mod scenes;
