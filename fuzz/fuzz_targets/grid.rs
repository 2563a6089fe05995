//! Grids of densities: `.npy` and NRRD.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| floe_fuzz::grid(bytes));
