//! What happens while the shutter is open: motion blur, the moving camera, its lens, and motions in the picture.
//!
//! Estimates are compared with their own standard errors; seeds are fixed.

// Measured numbers, for `--nocapture`.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

mod common;
mod small;

mod motion {
    mod blur;
    mod camera;
    mod frames;
    mod vectors;
}
