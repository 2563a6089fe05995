//! Pictures that are there already: what they are told by, and that a run which was broken off ends as if it had not been.
#![allow(clippy::unwrap_used)]

mod accumulation;
mod command;
mod fingerprint;
#[cfg(unix)]
mod impatient;
#[cfg(unix)]
mod interrupted;
mod numbers;
mod pictures;
#[cfg(unix)]
mod restarts;
mod runs;
#[path = "../small/mod.rs"]
mod small;
mod status;
#[cfg(unix)]
mod stopping;
#[cfg(unix)]
mod together;
