//! Pictures that are there already: what they are told by, and that a run which was broken off ends as if it had not been.
#![allow(clippy::unwrap_used)]

mod fingerprint;
mod pictures;
#[path = "../small/mod.rs"]
mod small;
