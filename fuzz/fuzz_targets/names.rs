//! Names of frames, patterns and ranges.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| floe_fuzz::names(bytes));
