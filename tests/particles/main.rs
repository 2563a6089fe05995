//! Coefficients and phase functions of mixtures: against another program, against sums that are written out here, and
//! against what must hold for any of them.

// Measured numbers, for `--nocapture`.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

#[path = "../common/mie.rs"]
mod slow;

mod bulk;
mod errors;
mod mixtures;
mod phase;
mod published;
mod scattering;
mod side_by_side;
