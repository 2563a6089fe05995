//! Any mesh at all as a frame: made fit, put into a hierarchy and rendered.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| floe_fuzz::frame(bytes));
