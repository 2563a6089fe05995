//! Light transport against closed forms, through the whole renderer, on small scenes made on the spot.
//!
//! Exact results are compared with a tolerance for the rounding of f32, estimates with their own standard error: an
//! estimate fails beyond five of them (a chance of 6e-7 each, were the errors normal; seeds are fixed).

// Measured numbers, for `--nocapture`.
#![allow(clippy::print_stdout)]

mod common;

mod analytic {
    mod boundaries;
    mod environment;
    mod estimates;
    mod fog;
    mod forced_scattering;
    mod furnaces;
    mod half_space;
    mod lamps;
    mod led_walks;
    mod limits;
    mod media;
    mod reflected;
    mod reflected_measured;
    mod reflected_where;
    mod single_scattering;
    mod spectral;
    mod spectral_phases;
    mod sunlight;
    mod thick_media;
    mod thick_media_measured;
    mod walls;
}
